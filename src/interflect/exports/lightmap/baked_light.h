#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "interflect/export.h"
#include "interflect/render/gauges/gauge_light.h"
#include "interflect/render/rays/gauge.h"
#include "interflect/render/smooth/element_vertices.h"
#include "interflect/render/smooth/smooth_field.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// Point of a surface whose light is stored in a texel or vertex.
struct BakedPoint {
    PatchIndex patch{};
    Parameters at;
    /// Sides of a parallelogram around the point, over which hybrid shading averages direct light.
    std::array<Parameters, 2> sides{};
};

/// Sampling of direct light in hybrid shading.
struct DirectSampling {
    LightUse use;       ///< Selects the default number of samples.
    double max_noise;   ///< Estimated relative error below which fewer samples suffice.
    bool calls_direct;  ///< Whether BakedLight::direct() will be called.
};

/// Grid of neighbouring points on a surface: their indices, row by row; `none` outside the surface.
struct PointGrid {
    int width;
    std::vector<std::uint32_t> points;
};

/// Computes the irradiance of points by the chosen shading.
class BakedLight {
  public:
    /// Refers to its arguments.
    BakedLight(const Scene& scene, const Solution& solution, const BakeOptions& options,
               const DirectSampling& sampling);

    /// @param grids  Grids in which the noise of hybrid shading is filtered; they contain all points or none.
    /// @return       One value per point [unit of H]. @throws Stopped
    std::vector<Rgb> irradiance(std::span<const BakedPoint> points, std::span<const PointGrid> grids,
                                const Monitor& monitor) const;
    /// Returns the direct light of hybrid shading. Requires calls_direct and a shading other than smooth.
    std::vector<SampledIrradiance> direct(std::span<const BakedPoint> points, int max_samples,
                                          const Monitor& monitor) const;
    /// Returns the interpolated irradiance of the solution (SmoothField).
    Rgb interpolated(const BakedPoint& point) const { return smooth_.at(point.patch, point.at); }

  private:
    PictureOptions path_options() const;
    std::vector<Gauge> gauges(std::span<const BakedPoint> points, bool are_filtered = false) const;
    std::vector<Rgb> gathered(std::span<const BakedPoint> points, const Monitor& monitor) const;

    const Scene& scene_;
    const Solution& solution_;
    const BakeOptions& options_;
    const DirectSampling sampling_;
    ElementVertices vertices_;
    SmoothField smooth_;
    KnownIrradiance known_;
    std::optional<RayCaster> ray_caster_;  // empty for smooth shading
    std::optional<TracedScene> traced_;
};

}  // namespace interflect::detail
