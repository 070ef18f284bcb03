#pragma once

#include <ImathBox.h>

#include <vector>

#include "interflect/luminaires/emission.h"
#include "interflect/ray_caster.h"
#include "interflect/scene.h"
#include "interflect/solve_options.h"
#include "interflect/solver/clusters/patch_clusters.h"
#include "interflect/solver/light/group_light.h"
#include "interflect/solver/light/materials.h"
#include "interflect/solver/state/element_floor.h"

namespace interflect::detail {

/// Maximum number of chains of targets, and of all targets. The 20 halvings of a chain reach from 10 km to 1 cm.
inline constexpr int max_chains = 4, max_targets = 80;

/// The scene of a run. Constant, except for views and dimmed sources.
struct RunInputs {
    /// @param scene, caster  Must outlive this.
    RunInputs(const Scene& scene, const RayCaster& caster, const SolveOptions& options);

    const Scene& scene;
    const Scene* lit = &scene;  // scene with dimmed sources
    const RayCaster& ray_caster;
    const SourceGroups groups;
    Materials materials;
    std::vector<Imath::Box3f> targets;  // targets of outdoor light for the current views
    Emission emission;
    ElementFloor element_floor;           // minimum size of elements for the current views
    std::vector<PatchClusters> clusters;  // empty if differences between patches are not shrunk
    /// Number of pixels that each node of the first tree of clusters covers in the current views; empty without either.
    std::vector<double> cluster_pixels;
};

}  // namespace interflect::detail
