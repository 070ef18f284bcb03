#pragma once

#include <cstdint>
#include <vector>

#include "interflect/ray_caster.h"
#include "interflect/render/rays/sample_batch.h"
#include "interflect/render/rays/traced_scene.h"

namespace interflect::detail {

/// How light sources were sampled at a path's last vertex. The weight of the next hit depends on it.
struct SourceSampling {
    std::uint32_t rays = 1;      ///< Maximum number of shadow rays to each kind of source, and to skies.
    std::uint32_t guide = none;  ///< Record whose SkyGuide samples the sky; none: no guide.
    float directions = 1;  ///< Expected number of sampled directions per path; below 1 if only some paths sample one.
    /// Whether the path ends at its next surface, where it only collects emitted light.
    bool ends_at_next_hit = false;
    bool directions_find_patches =
        true;  ///< Whether paths add the emission of patches that they hit. Else shadow rays alone do.
};

struct Path {
    Rgb throughput{1, 1, 1};
    std::uint32_t half_batch = 0;         ///< Index of the half batch: 2 k and 2 k + 1 are the halves of batch k.
    std::uint32_t sample = 0;             ///< Index of the camera or gauge sample among all half batches.
    std::uint32_t index_in_sequence = 0;  ///< Index of the path in the sequence of its half.
    // The last vertex of the path:
    V3f position{0, 0, 0};  ///< Position, lifted off the surface, or that of the camera [m].
    /// Position at which records are looked up: `position`, or the middle of the gauge [m].
    V3f lookup_position{0, 0, 0};
    V3f normal{0, 0, 0};  ///< Shading normal.
    PatchIndex patch{};   ///< Patch of the vertex; none for the camera and gauges in space.
    SourceSampling sampling{};
    float travelled = 0;  ///< Distance from the vertex to the ray's origin, through panes and by mirrors [m].
    bool sets_first_hit =
        true;  ///< Whether only clear panes and pure mirrors precede the next hit, which is then the first hit.
    /// Number of samples for which the first hit of this path gives the level of the element; 0 for most paths, because
    /// elements are found slowly.
    std::uint32_t level_samples = 0;
};

/// Paths with their current rays and, after find_surfaces(), the hits of these rays.
struct PathRays {
    std::vector<Path> paths;
    std::vector<Ray> rays;
    std::vector<Hit> hits;

    void clear() {
        paths.clear();
        rays.clear();
    }
    void add(const Path& path, const Ray& ray) {
        paths.push_back(path);
        rays.push_back(ray);
    }
};

/// Finds the first surface of each path. Adds paths behind panes, and in mirrors for rays from the camera.
/// @param splits       Whether paths are split at panes and mirrors.
/// @param has_mirrors  Whether mirrors reflect the paths; false for rays that do not start at the camera.
void find_surfaces(const TracedScene& scene, bool splits, bool has_mirrors, PathRays& paths, RayCounts& counts);

}  // namespace interflect::detail
