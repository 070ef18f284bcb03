#include "interflect/render/paths/first_points.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include "interflect/render/paths/group_mean.h"
#include "interflect/render/paths/indirect_field.h"
#include "interflect/render/paths/sky_guide.h"

namespace interflect::detail {

namespace {

/// Sums of the contributions of shadow rays.
struct ShadowRaySums {
    Rgb sampled{0, 0, 0}, visible{0, 0, 0};
    int points = 0;
};

/// Returns the coefficient c of the control variate: the visible share of the light at similar points of the other half
/// or, if these have no light, at all points of the other half. Without light, c is 0. The coefficient is reduced if
/// the points have far less unoccluded light than this one, because a hidden bright source may be below their horizons.
/// @param unoccluded  Exact unoccluded irradiance of this point; 0 if it has noise, which would bias the estimate.
Rgb coefficient(const ShadowRaySums& similar, const ShadowRaySums& all, const Rgb& unoccluded) {
    constexpr float least_share = 0.125f;  // for smaller shares, the control variate adds more noise than it removes
    constexpr float most_over_mean = 32;   // a larger ratio of unoccluded light to the mean sample reduces c
    Rgb c(0);
    for (int k = 0; k < 3; ++k) {
        const ShadowRaySums& sums = similar.sampled[k] > 0 ? similar : all;
        if (!(sums.sampled[k] > 0)) continue;
        const float excess = unoccluded[k] * static_cast<float>(sums.points) / (most_over_mean * sums.sampled[k]);
        const float share = std::min(1.0f, sums.visible[k] / sums.sampled[k]) / std::max(1.0f, excess);
        if (share > least_share) c[k] = share;
    }
    return c;
}

}  // namespace

const FirstPoints::Group& FirstPoints::group_of(const Path& path) {
    constexpr float same_cosine = 0.999f;
    const std::uint32_t batch = path.half_batch / 2;
    for (std::size_t i = groups_.size(); i > 0 && groups_[i - 1].batch == batch; --i)
        if (groups_[i - 1].patch == path.patch && groups_[i - 1].normal.dot(path.normal) >= same_cosine &&
            (groups_[i - 1].position - path.lookup_position).length() <= groups_[i - 1].radius)
            return groups_[i - 1];
    Group& group = groups_.emplace_back(Group{batch, path.patch, path.normal, path.lookup_position});
    const IndirectField* const field = plan_.hybrid->field;
    if (!field) {
        group.lookup.is_found = true;
        group.radius = std::numeric_limits<float>::infinity();
        return group;
    }
    const auto found = field->at(path.lookup_position, path.normal, path.patch);
    if (!found) return group;
    group.lookup.is_found = true;
    group.irradiance = found->irradiance;
    group.error = found->error;
    group.radius = found->reach / 2;
    const SkyGuide* const guide = plan_.hybrid->guide;
    if (guide && guide->sees_sky(found->record)) group.lookup.guide = found->record;
    return group;
}

FirstPoints::Lookup FirstPoints::add_indirect(const Path& path, PathLight& light) {
    const Group& group = group_of(path);
    const Rgb per_irradiance = path.throughput / std::numbers::pi_v<float>;
    light.indirect += RgbD(per_irradiance * group.irradiance);
    const double share = mean_channel(RgbD(per_irradiance));
    light.record_error += share * static_cast<double>(group.error);
    return group.lookup;
}

std::uint32_t FirstPoints::add(const Path& path, const LightSample& numbers) {
    Point& point = points_.emplace_back(Point{path.half_batch, path.normal, path.throughput});
    for (const SourceKind kind : source_kinds)
        if (plan_.scene.sources.useful_rays(kind, 1) > 0 && plan_.scene.unoccluded_light.has(kind))
            point.sources[static_cast<std::size_t>(kind)].unoccluded =
                plan_.scene.unoccluded_light.at(kind, path.position, path.normal, numbers.u, numbers.v);
    return static_cast<std::uint32_t>(points_.size() - 1);
}

void FirstPoints::add_direct(std::span<PathLight> halves) const {
    constexpr float similar_cosine = 0.9f;
    for (std::size_t first = 0, last = 0; first < points_.size(); first = last) {
        const std::uint32_t batch = points_[first].half_batch / 2;
        while (last < points_.size() && points_[last].half_batch / 2 == batch) ++last;
        const auto points = std::span(points_).subspan(first, last - first);
        for (const Point& point : points)
            for (std::size_t k = 0; k < point.sources.size(); ++k) {
                const Source& source = point.sources[k];
                ShadowRaySums similar, all;
                for (const Point& p : points) {
                    if (p.half_batch == point.half_batch) continue;
                    const Source& other = p.sources[k];
                    all.sampled += other.sampled;
                    all.visible += other.visible;
                    ++all.points;
                    if (p.normal.dot(point.normal) < similar_cosine) continue;
                    similar.sampled += other.sampled;
                    similar.visible += other.visible;
                    ++similar.points;
                }
                const bool is_exact = plan_.scene.unoccluded_light.is_exact(source_kinds[k]);
                const Rgb c = coefficient(similar, all, is_exact ? source.unoccluded : Rgb(0));
                const Rgb irradiance = c * source.unoccluded + (source.visible - c * source.sampled);
                halves[point.half_batch].direct += RgbD(point.throughput / std::numbers::pi_v<float> * irradiance);
            }
    }
}

}  // namespace interflect::detail
