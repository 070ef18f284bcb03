#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "interflect/core.h"
#include "interflect/render/lights/light_sources.h"
#include "interflect/render/lights/path_samples.h"
#include "interflect/render/lights/unoccluded_light.h"
#include "interflect/render/rays/path_rays.h"
#include "interflect/render/rays/sample_batch.h"

namespace interflect::detail {

/// Direct light at the first points of paths in hybrid shading, from shadow rays and a control variate.
///
/// Let U_g be the unoccluded irradiance of a point by group g of UnoccludedLight, f / p the unoccluded contribution of
/// a shadow ray (irradiance over density) and V its visibility. The estimate of the point is
///
///     E = sum over the rays of V f / p / rays + sum over the groups of c_g (U_g - sum over the rays to g of f / p /
///     rays)
///
/// Its expected value is that of the first sum, for any coefficients c_g that do not depend on these rays. Hence c_g
/// comes from the other half of this batch and of adjacent batches: the visible share of the light of g at points of
/// the same surface (cross-fitting). So the estimate is unbiased for any number of samples. A group that is completely
/// visible, or completely hidden, from all these points adds little noise.
class DirectLight {
  public:
    /// @param unoccluded  Must outlive this.
    explicit DirectLight(const UnoccludedLight& unoccluded) : unoccluded_(unoccluded) {}
    void clear() {
        points_.clear();
        rays_.clear();
    }

    /// Adds the path's vertex. @param numbers  Random numbers that place the strata of UnoccludedLight.
    void add_point(const Path& path, const LightSample& numbers);
    /// Adds a shadow ray of the last point. Returns its index.
    /// @param source  SourceSample::index, of a kind that UnoccludedLight has.
    /// @param irradiance  f / p over the number of rays.
    std::uint32_t add_ray(SourceKind kind, std::uint32_t source, const Rgb& irradiance);
    /// Sets the part of a ray's irradiance that arrives; 0 if it is never called.
    void set_visible(std::uint32_t ray, const Rgb& irradiance) { rays_[ray].visible = irradiance; }

    /// Adds the light of all points to the sums of the half batches 2 k and 2 k + 1, which are the halves of one batch.
    void add_to(std::span<PathLight> halves);

  private:
    struct Ray {
        std::uint32_t group;
        Rgb sampled, visible{0, 0, 0};  // irradiance
    };
    struct Point {
        std::uint32_t half_batch;
        V3f position, normal;
        Rgb throughput;
        float u, v;
        std::size_t first_ray;
        std::size_t surface = 0;
    };
    /// Points near one plane, with similar normals.
    struct Surface {
        V3f position, normal;  // of its first point
    };
    /// Sums over the shadow rays of one half to a group, and the coefficient for the other half.
    struct GroupSums {
        Rgb sampled{0, 0, 0}, visible{0, 0, 0};  // irradiance
        float rays = 0;
        Rgb coefficient{0, 0, 0};
        Rgb usual_light{0, 0, 0};  // sampled light of all groups of this kind, mean over the points
    };
    /// Shadow rays of one half from the points of a surface.
    struct HalfSums {
        float points = 0;
        std::array<GroupSums, UnoccludedLight::max_groups> groups{};
        std::array<std::uint8_t, UnoccludedLight::max_groups> is_used{};  // whether the coefficient is above 0
    };

    std::span<const Ray> rays_of(std::size_t point) const;
    /// Adds the light of the points from `first` to `last`, which share coefficients.
    void add_points(std::size_t first, std::size_t last, std::span<PathLight> halves);
    void find_surface(Point& point);
    void set_coefficients(HalfSums& sums) const;
    Rgb light_of(std::size_t point, const HalfSums& other_half) const;

    const UnoccludedLight& unoccluded_;
    std::vector<Point> points_;
    std::vector<Ray> rays_;
    std::vector<Surface> surfaces_;
    std::vector<std::array<HalfSums, 2>> sums_;  // by surface
    std::array<HalfSums, 2> all_;                // of all surfaces
};

}  // namespace interflect::detail
