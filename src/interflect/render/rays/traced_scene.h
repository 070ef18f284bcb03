#pragma once

#include <optional>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/textures/texture_mapping.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/panes.h"
#include "interflect/render/lights/light_sources.h"
#include "interflect/render/lights/unoccluded_light.h"
#include "interflect/render/smooth/smooth_normals.h"
#include "interflect/scene.h"

namespace interflect::detail {

struct SurfaceColours {
    Rgb exitance;  ///< [lm/m^2 or W/m^2]
    Rgb reflectance;
};

/// A scene prepared for paths. Immutable, thread-safe.
struct TracedScene {
    /// Arguments must outlive this object.
    TracedScene(const Scene& scene, const RayCaster& ray_caster);
    TracedScene(const TracedScene&) = delete;
    TracedScene& operator=(const TracedScene&) = delete;

    const Scene& scene;
    const RayCaster& ray_caster;
    const std::vector<PatchGeometry> geometry;  ///< Geometry of each patch.
    const LightSources sources;
    const UnoccludedLight unoccluded_light;
    const Panes panes;
    const bool has_mirrors;
    std::optional<SmoothNormals> smooth_normals;  ///< Shading normals, in scenes with normals.

    /// Projects x onto its patch, to remove rounding errors, and lifts it off by the offset of rays.
    V3f lifted(PatchIndex patch, const V3f& x) const {
        const PatchGeometry& g = geometry[patch];
        return g.point(g.parameters_of(x)) + g.normal() * ray_caster.ray_offset(patch);
    }
    const Material& material(PatchIndex patch) const { return scene.materials[scene.patches[patch].material]; }
    /// Returns the colours at a point of a patch.
    SurfaceColours colours(PatchIndex patch, const V3f& x) const {
        const Material& m = material(patch);
        if (!m.is_textured()) return {m.exitance, m.reflectance};
        const Parameters p = geometry[patch].parameters_of(x);
        return {exitance_at(scene, scene.patches[patch], p), reflectance_at(scene, scene.patches[patch], p)};
    }
    /// Returns the shading normal at a point of a visible surface.
    V3f shading_normal(PatchIndex patch, const V3f& x) const {
        const PatchGeometry& g = geometry[patch];
        return smooth_normals ? smooth_normals->at(g, patch, g.parameters_of(x)) : g.normal();
    }
};

}  // namespace interflect::detail
