#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interflect/raycast/camera.h"
#include "interflect/render.h"
#include "interflect/render/rays/gauge.h"
#include "interflect/render/rays/traced_scene.h"

namespace interflect::detail {

class IndirectField;
class KnownLight;
class SkyGuide;
class VirtualLights;

/// Where paths start: at the camera, or at one gauge per pixel.
struct PathStart {
    std::optional<Camera> camera;
    float pixel_angle = 0;  ///< Angle of a pixel of a perspective camera [rad]; else 0.
    std::span<const Gauge> gauges{};
    float pixel_size = 0;  ///< Size of a pixel of a parallel camera [m]; else 0.
};

/// Data for the hybrid shading of first points: direct light by DirectLight, indirect light from records.
struct HybridLight {
    const IndirectField* field = nullptr;  ///< Records of indirect light; null: direct light only.
    const SkyGuide* guide = nullptr;       ///< Directions to the sky around the records; may be null.
};

/// Inputs of a PathIntegrator. Pictures, texels, vertices and measuring points differ only in their plan:
///
///     path tracing                             the defaults
///     instant radiosity                        virtual_lights
///     final gathering                          known, first_shadow_rays
///     hybrid shading                           known, first_shadow_rays, hybrid with its field and guide
///     direct light of texels and vertices      first_shadow_rays, hybrid without a field
///     indirect light of a record               known, paths_per_place, has_direct = false
///
/// All may have seen_sources.
struct PathPlan {
    const TracedScene& scene;
    const PathStart& start;
    const PictureOptions& options;
    std::uint32_t first_shadow_rays = 1;         ///< Shadow rays to each kind of source at first points.
    bool has_direct = true;                      ///< Whether light that is reflected once is included.
    bool has_direct_sunlight = true;             ///< Whether directional lights light the first points.
    const LightSources* seen_sources = nullptr;  ///< Sources weighted by visibility; null: those of the scene.
    const KnownLight* known = nullptr;           ///< Light at which paths end; null: only Russian roulette ends them.
    std::uint32_t paths_per_place = 1;           ///< Number of paths for each ray to a place of KnownLight::sample().
    const VirtualLights* virtual_lights =
        nullptr;  ///< Lights for every vertex; paths find the light beyond their bounds.
    const HybridLight* hybrid = nullptr;

    const LightSources& sources() const { return seen_sources ? *seen_sources : scene.sources; }
    bool shows_irradiance() const { return options.quantity == PictureQuantity::irradiance; }
};

}  // namespace interflect::detail
