#include "interflect/render/direct/direct_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace interflect::detail {

void DirectLight::add_point(const Path& path, const LightSample& numbers) {
    points_.push_back({.half_batch = path.half_batch,
                       .position = path.position,
                       .normal = path.normal,
                       .throughput = path.throughput,
                       .u = numbers.u,
                       .v = numbers.v,
                       .first_ray = rays_.size()});
}

std::uint32_t DirectLight::add_ray(SourceKind kind, std::uint32_t source, const Rgb& irradiance) {
    rays_.push_back({unoccluded_.lamp_of(kind, source), irradiance});
    return static_cast<std::uint32_t>(rays_.size() - 1);
}

std::span<const DirectLight::Ray> DirectLight::rays_of(std::size_t point) const {
    const std::size_t begin = points_[point].first_ray;
    const std::size_t end = point + 1 < points_.size() ? points_[point + 1].first_ray : rays_.size();
    return std::span(rays_).subspan(begin, end - begin);
}

void DirectLight::add_to(std::span<PathLight> halves) {
    // Batches of few samples share coefficients with the batches before and after them, which are near.
    constexpr std::size_t near_points = 64;
    for (std::size_t first = 0, last = 0; first < points_.size(); first = last) {
        const auto is_same_batch = [&] { return points_[last].half_batch / 2 == points_[last - 1].half_batch / 2; };
        while (last < points_.size() && (last - first < near_points || is_same_batch())) ++last;
        add_near_points(first, last, halves);
    }
}

void DirectLight::add_near_points(std::size_t first, std::size_t last, std::span<PathLight> halves) {
    neighbourhoods_.clear();
    for (std::size_t i = first; i < last; ++i) find_neighbourhood(points_[i]);
    sums_.assign(neighbourhoods_.size(), {});
    all_ = {};
    for (std::size_t i = first; i < last; ++i) {
        const std::size_t half = points_[i].half_batch % 2;
        for (HalfSums* sums : {&sums_[points_[i].neighbourhood][half], &all_[half]}) {
            ++sums->points;
            for (const Ray& ray : rays_of(i)) {
                LampSums& lamp = sums->lamps[ray.lamp];
                lamp.sampled += ray.sampled;
                lamp.visible += ray.visible;
                ++lamp.rays;
            }
        }
    }
    for (auto& both : sums_)
        for (HalfSums& sums : both) set_coefficients(sums);
    for (HalfSums& sums : all_) set_coefficients(sums);
    for (std::size_t i = first; i < last; ++i) {
        const Point& p = points_[i];
        const std::size_t other = 1 - p.half_batch % 2;
        const HalfSums& similar = sums_[p.neighbourhood][other];
        const Rgb irradiance = light_of(i, similar.points > 0 ? similar : all_[other]);
        halves[p.half_batch].direct += RgbD(p.throughput / std::numbers::pi_v<float> * irradiance);
    }
}

void DirectLight::find_neighbourhood(Point& point) {
    constexpr float similar_cosine = 0.9f;
    constexpr float most_slope = 0.25f;      // of the line between two points against the surface
    constexpr float rounding_error = 1e-3f;  // [m]
    const auto contains = [&](const Neighbourhood& n) {
        const V3f d = point.position - n.position;
        return n.normal.dot(point.normal) >= similar_cosine &&
               std::abs(d.dot(point.normal)) <= most_slope * d.length() + rounding_error;
    };
    const auto found = std::find_if(neighbourhoods_.begin(), neighbourhoods_.end(), contains);
    point.neighbourhood = static_cast<std::uint32_t>(found - neighbourhoods_.begin());
    if (found == neighbourhoods_.end()) neighbourhoods_.push_back({point.position, point.normal});
}

void DirectLight::set_coefficients(HalfSums& sums) const {
    constexpr float least_share = 0.125f;  // for smaller shares, the control variate adds more noise than it removes
    for (const auto& [first, last] : unoccluded_.lamps_by_kind()) {
        LampSums kind;
        for (std::size_t l = first; l < last; ++l) {
            kind.sampled += sums.lamps[l].sampled;
            kind.visible += sums.lamps[l].visible;
            kind.rays += sums.lamps[l].rays;
        }
        for (std::size_t l = first; l < last; ++l)
            for (int k = 0; k < 3; ++k) {
                if (!(kind.sampled[k] > 0)) continue;
                // The visible share of all lamps counts like one more ray, since few rays may have sampled this lamp.
                const float ray = kind.sampled[k] / kind.rays, share_of_kind = kind.visible[k] / kind.sampled[k];
                LampSums& lamp = sums.lamps[l];
                const float share = (lamp.visible[k] + share_of_kind * ray) / (lamp.sampled[k] + ray);
                lamp.usual_light[k] = kind.sampled[k] / sums.points;
                if (share < least_share) continue;
                lamp.coefficient[k] = std::min(1.0f, share);
                sums.is_used[l] = 1;
            }
    }
}

Rgb DirectLight::light_of(std::size_t point, const HalfSums& other_half) const {
    // A lamp that is far brighter here than all lamps at the other points may be hidden, but below their horizons.
    constexpr float most_over_usual = 32;
    const Point& p = points_[point];
    std::array<Rgb, UnoccludedLight::max_lamps> left;  // unoccluded light of each lamp that the rays have not sampled
    left.fill(Rgb(0));
    unoccluded_.add(p.position, p.normal, p.u, p.v, other_half.is_used, left);
    std::array<Rgb, UnoccludedLight::max_lamps> coefficients;
    const std::size_t lamps = unoccluded_.lamp_count();
    for (std::size_t l = 0; l < lamps; ++l) {
        coefficients[l] = other_half.lamps[l].coefficient;
        if (!unoccluded_.is_exact(l)) continue;  // noise of the unoccluded light would bias the estimate
        for (int k = 0; k < 3; ++k) {
            const float most = most_over_usual * other_half.lamps[l].usual_light[k];
            if (left[l][k] > most) coefficients[l][k] *= most / left[l][k];
        }
    }
    Rgb irradiance(0);
    for (const Ray& ray : rays_of(point)) {
        irradiance += ray.visible;
        left[ray.lamp] -= ray.sampled;
    }
    for (std::size_t l = 0; l < lamps; ++l) irradiance += coefficients[l] * left[l];
    return irradiance;
}

}  // namespace interflect::detail
