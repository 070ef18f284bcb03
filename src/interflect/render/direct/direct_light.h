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
/// Let U_l be the unoccluded irradiance of a point by lamp l, f / p the unoccluded contribution of a shadow ray
/// (irradiance over density) and V its visibility. The estimate of the point is
///
///     E = sum over the rays of V f / p / rays + sum over the lamps of c_l (U_l - sum over the rays to l of f / p /
///     rays)
///
/// The expected value is the mean of V f / p for any coefficients c_l that do not depend on these shadow rays. Hence
/// c_l comes from the other halves of this and near batches, as the visible share of their light from l at similar
/// points (cross-fitting). The estimate is unbiased for any number of samples. A lamp that is visible, or hidden, from
/// all these points adds no noise.
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
    /// @param source  SourceSample::index. @param irradiance  f / p over the number of rays.
    std::uint32_t add_ray(SourceKind kind, std::uint32_t source, const Rgb& irradiance);
    /// Sets the part of a ray's irradiance that arrives; 0 if it is never called.
    void set_visible(std::uint32_t ray, const Rgb& irradiance) { rays_[ray].visible = irradiance; }

    /// Adds the light of all points to the sums of the half batches 2 k and 2 k + 1, which are the halves of one batch.
    void add_to(std::span<PathLight> halves);

  private:
    struct Ray {
        std::uint32_t lamp;
        Rgb sampled, visible{0, 0, 0};  // irradiance
    };
    struct Point {
        std::uint32_t half_batch;
        V3f position, normal;
        Rgb throughput;
        float u, v;
        std::size_t first_ray;
        std::uint32_t neighbourhood = 0;
    };
    /// Near points with similar normals.
    struct Neighbourhood {
        V3f position, normal;  // of its first point
    };
    /// Shadow rays of one half to a lamp, and what follows for the other half.
    struct LampSums {
        Rgb sampled{0, 0, 0}, visible{0, 0, 0};  // irradiance
        float rays = 0;
        Rgb coefficient{0, 0, 0};  // c_l
        Rgb usual_light{0, 0, 0};  // mean light of a point by all lamps of this kind
    };
    /// Shadow rays of one half from the points of a neighbourhood.
    struct HalfSums {
        float points = 0;
        std::array<LampSums, UnoccludedLight::max_lamps> lamps{};
        std::array<std::uint8_t, UnoccludedLight::max_lamps> is_used{};  // whether the coefficient is above 0
    };

    std::span<const Ray> rays_of(std::size_t point) const;
    /// Adds the light of the points from `first` to `last`, which are near each other.
    void add_near_points(std::size_t first, std::size_t last, std::span<PathLight> halves);
    void find_neighbourhood(Point& point);
    void set_coefficients(HalfSums& sums) const;
    Rgb light_of(std::size_t point, const HalfSums& other_half) const;

    const UnoccludedLight& unoccluded_;
    std::vector<Point> points_;
    std::vector<Ray> rays_;
    std::vector<Neighbourhood> neighbourhoods_;
    std::vector<std::array<HalfSums, 2>> sums_;  // by neighbourhood
    std::array<HalfSums, 2> all_;                // of all neighbourhoods
};

}  // namespace interflect::detail
