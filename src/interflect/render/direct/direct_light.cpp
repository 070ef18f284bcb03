#include "interflect/render/direct/direct_light.h"

#include <algorithm>
#include <cassert>
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
    rays_.push_back({unoccluded_.group_of(kind, source), irradiance});
    assert(rays_.back().group < unoccluded_.group_count());
    return static_cast<std::uint32_t>(rays_.size() - 1);
}

std::span<const DirectLight::Ray> DirectLight::rays_of(std::size_t point) const {
    const std::size_t begin = points_[point].first_ray;
    const std::size_t end = point + 1 < points_.size() ? points_[point + 1].first_ray : rays_.size();
    return std::span(rays_).subspan(begin, end - begin);
}

void DirectLight::add_to(std::span<PathLight> halves) {
    // Minimum number of points that share coefficients. Error a pixel of two samples, without the worst 1%:
    //
    //     points         16     32     64     128
    //     office-graz    9.8    9.5    9.3    9.3%
    //     office.mgf    10.0    9.7    9.5    9.4%
    constexpr std::size_t sharing_points = 64;
    for (std::size_t first = 0, last = 0; first < points_.size(); first = last) {
        const auto is_same_batch = [&] { return points_[last].half_batch / 2 == points_[last - 1].half_batch / 2; };
        while (last < points_.size() && (last - first < sharing_points || is_same_batch())) ++last;
        if (points_.size() - last < sharing_points) last = points_.size();
        add_points(first, last, halves);
    }
}

void DirectLight::add_points(std::size_t first, std::size_t last, std::span<PathLight> halves) {
    surfaces_.clear();
    for (std::size_t i = first; i < last; ++i) find_surface(points_[i]);
    sums_.assign(surfaces_.size(), {});
    all_ = {};
    for (std::size_t i = first; i < last; ++i) {
        const std::size_t half = points_[i].half_batch % 2;
        for (HalfSums* sums : {&sums_[points_[i].surface][half], &all_[half]}) {
            ++sums->points;
            for (const Ray& ray : rays_of(i)) {
                GroupSums& group = sums->groups[ray.group];
                group.sampled += ray.sampled;
                group.visible += ray.visible;
                ++group.rays;
            }
        }
    }
    for (auto& both : sums_)
        for (HalfSums& sums : both) set_coefficients(sums);
    for (HalfSums& sums : all_) set_coefficients(sums);
    for (std::size_t i = first; i < last; ++i) {
        const Point& p = points_[i];
        const std::size_t other = 1 - p.half_batch % 2;
        const HalfSums& of_surface = sums_[p.surface][other];
        const Rgb irradiance = light_of(i, of_surface.points > 0 ? of_surface : all_[other]);
        halves[p.half_batch].direct += RgbD(p.throughput / std::numbers::pi_v<float> * irradiance);
    }
}

void DirectLight::find_surface(Point& point) {
    constexpr float similar_cosine = 0.9f;
    constexpr float most_slope = 0.25f;  // of the chord of an arc whose normals differ by acos(similar_cosine)
    const auto contains = [&](const Surface& s) {
        const V3f d = point.position - s.position;
        return s.normal.dot(point.normal) >= similar_cosine && std::abs(d.dot(point.normal)) <= most_slope * d.length();
    };
    const auto found = std::find_if(surfaces_.begin(), surfaces_.end(), contains);
    point.surface = static_cast<std::size_t>(found - surfaces_.begin());
    if (found == surfaces_.end()) surfaces_.push_back({point.position, point.normal});
}

void DirectLight::set_coefficients(HalfSums& sums) const {
    constexpr float least_share = 0.125f;  // for smaller shares, the control variate adds more noise than it removes
    for (const auto& [first, last] : unoccluded_.groups_by_kind()) {
        GroupSums kind;
        for (std::size_t g = first; g < last; ++g) {
            kind.sampled += sums.groups[g].sampled;
            kind.visible += sums.groups[g].visible;
            kind.rays += sums.groups[g].rays;
        }
        for (std::size_t g = first; g < last; ++g)
            for (int k = 0; k < 3; ++k) {
                if (!(kind.sampled[k] > 0)) continue;
                // The visible share of all groups counts like one more ray. Else a group with a single ray would have a
                // coefficient of 0 or 1.
                const float ray = kind.sampled[k] / kind.rays, share_of_kind = kind.visible[k] / kind.sampled[k];
                GroupSums& group = sums.groups[g];
                const float share = (group.visible[k] + share_of_kind * ray) / (group.sampled[k] + ray);
                group.usual_light[k] = kind.sampled[k] / sums.points;
                if (share < least_share) continue;
                group.coefficient[k] = std::min(1.0f, share);
                sums.is_used[g] = 1;
            }
    }
}

Rgb DirectLight::light_of(std::size_t point, const HalfSums& other_half) const {
    // A group that is far brighter here than all groups at the other points was below their horizons. Then their rays
    // do not show whether it is hidden, so its coefficient is reduced.
    constexpr float most_over_usual = 32;
    const Point& p = points_[point];
    std::array<Rgb, UnoccludedLight::max_groups> unsampled;  // unoccluded light of each group, without that of the rays
    unsampled.fill(Rgb(0));
    unoccluded_.add(p.position, p.normal, p.u, p.v, other_half.is_used, unsampled);
    std::array<Rgb, UnoccludedLight::max_groups> coefficients;
    const std::size_t groups = unoccluded_.group_count();
    for (std::size_t g = 0; g < groups; ++g) {
        coefficients[g] = other_half.groups[g].coefficient;
        if (!unoccluded_.is_exact(g)) continue;  // the coefficient must not depend on the noise of the unoccluded light
        for (int k = 0; k < 3; ++k) {
            const float most = most_over_usual * other_half.groups[g].usual_light[k];
            if (unsampled[g][k] > most) coefficients[g][k] *= most / unsampled[g][k];
        }
    }
    Rgb irradiance(0);
    for (const Ray& ray : rays_of(point)) {
        irradiance += ray.visible;
        unsampled[ray.group] -= ray.sampled;
    }
    for (std::size_t g = 0; g < groups; ++g) irradiance += coefficients[g] * unsampled[g];
    return irradiance;
}

}  // namespace interflect::detail
