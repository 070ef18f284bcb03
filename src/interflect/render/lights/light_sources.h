#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/luminaires/skies/skies.h"
#include "interflect/render/lights/light_tree.h"
#include "interflect/render/lights/luminaire_choice.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Kinds of light sources. Each kind has separate shadow rays, so a hidden bright source does not reduce the rays to
/// other kinds.
enum class SourceKind {
    patches,  ///< Emitting patches.
    lamps,    ///< Luminaires with a position.
    suns,     ///< Directional lights.
};
inline constexpr std::array source_kinds{SourceKind::patches, SourceKind::lamps, SourceKind::suns};

/// One sample of a light source, seen from a point x on a surface with normal n.
struct SourceSample {
    std::uint32_t index = none;  ///< Index of the patch or luminaire; none: no source.
    V3f direction{0, 0, 1};
    PatchIndex patch{};  ///< Patch that the shadow ray must hit; none: it must be free up to `distance`.
    float distance = 0;  ///< [m]
    Rgb irradiance{0, 0,
                   0};  ///< Unoccluded irradiance over the sampling density; its mean is that of all sources [as H].
    float density = 0;  ///< Density of the direction [1/sr]; 0 if directions never find the source.
};

/// Samples light sources by estimated unoccluded irradiance. Constant methods are thread-safe.
class LightSources {
  public:
    /// Arguments must outlive this.
    LightSources(const Scene& scene, std::span<const PatchGeometry> geometry);

    /// Calls LightTree::weigh() for patches or lamps. @param weights  By SourceSample::index, above 0.
    void weigh(SourceKind kind, std::span<const float> weights);

    /// Returns the number of useful shadow rays, at most `most`: 0 without sources of this kind, and at most one per
    /// source if all rays to a source are equal.
    std::uint32_t useful_rays(SourceKind kind, std::uint32_t most) const;
    /// Samples a source of this kind. The irradiance is 0 if no source can light x.
    SourceSample sample(SourceKind kind, const V3f& x, const V3f& n, const LightSample& numbers) const;
    /// Returns the density of sample() towards an emitting patch that was hit [1/sr]. @param distance2  [m^2]
    float density(PatchIndex patch, const V3f& x, const V3f& n, const V3f& direction, float distance2) const;
    const Skies& skies() const { return skies_; }

  private:
    SourceSample sample_patch(const V3f& x, const V3f& n, const LightSample& numbers) const;

    const Scene& scene_;
    std::span<const PatchGeometry> geometry_;
    LightTree patches_;
    LuminaireChoice luminaires_;
    Skies skies_;
};

}  // namespace interflect::detail
