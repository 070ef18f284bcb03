#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/luminaires/emission.h"
#include "interflect/ray_caster.h"
#include "interflect/raycast/panes.h"
#include "interflect/render/lights/light_tree.h"
#include "interflect/scene.h"

namespace interflect::detail {

/// Point lights that represent all reflected light of a scene (instant radiosity, Keller 1997). Random walks from the
/// light sources add a light at each diffuse reflection. For any function f, the expected value of the sum of (flux /
/// pi) f(position) over the lights is the integral of f times the reflected radiance over all surfaces. Constant
/// methods are thread-safe.
class VirtualLights {
  public:
    struct Light {
        V3f position;  ///< On the patch, relative to the scene's origin [m].
        PatchIndex patch;
        Rgb flux;  ///< Reflected flux, cosine-distributed [lm or W].
    };

    /// Creates no lights; call renew(). Arguments must outlive this.
    /// @param walks  Number of walks from the light sources for each set of lights, > 0.
    VirtualLights(const Scene& scene, const RayCaster& ray_caster, std::span<const PatchGeometry> geometry,
                  const Panes& panes, std::size_t walks, std::uint64_t seed);

    /// Replaces the lights by an independent set; the same number always gives the same bits.
    void renew(std::uint32_t number);
    std::span<const Light> lights() const { return lights_; }
    std::int64_t rays() const { return rays_; }  ///< Total over all sets.

    /// Samples a light for point x on a surface with normal n, in proportion to its estimated unoccluded irradiance.
    LightTree::Choice choose(const V3f& x, const V3f& n, double uniform) const;

    /// Returns the bound of the geometric term cos cos / distance^2 for the lights of a patch [1/m^2]. If the term is
    /// below the bound, the lights represent all light from the patch (Kollig and Keller 2004 use a constant bound).
    /// The bound does not depend on the lights in use.
    float bound(PatchIndex patch) const { return bounds_[patch]; }

  private:
    struct Walk {
        Ray ray;
        Rgb flux;            // [lm or W]
        PatchIndex patch{};  // patch at the start of the ray; none behind a pane
    };
    std::vector<Walk> start(std::uint64_t key) const;
    void start_at_patch(PatchIndex patch, std::uint64_t key, std::span<Walk> walks) const;
    void start_at_luminaire(std::size_t part, std::uint64_t key, std::span<Walk> walks) const;
    /// Traces the walks to their next surfaces. Returns their reflected and transmitted parts.
    std::vector<Walk> meet_surfaces(std::span<const Walk> walks);
    std::vector<Walk> survivors(std::vector<Walk> walks, double uniform) const;
    /// Adds the lights of reflected walks and samples their directions.
    void add_lights(std::span<Walk> walks, std::uint64_t key);
    void compute_bounds();

    const Scene& scene_;
    const RayCaster& ray_caster_;
    std::span<const PatchGeometry> geometry_;
    const Panes& panes_;
    std::size_t walks_;
    std::uint64_t seed_;
    Emission emission_;
    std::vector<double> source_power_;  // powers of patches, then of the luminaires' parts; sum of channels [lm or W]
    double total_power_ = 0;
    std::vector<float> bounds_;  // bound() of each patch [1/m^2]
    std::vector<Light> lights_;
    std::optional<LightTree> tree_;
    std::int64_t rays_ = 0;
};

}  // namespace interflect::detail
