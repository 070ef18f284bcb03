#include "interflect/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "interflect/core.h"
#include "interflect/geometry/textures/tangent_frame.h"
#include "interflect/render/pictures/path_picture.h"
#include "interflect/render/rays/gauge.h"

namespace interflect {

using namespace detail;

namespace {

/// Returns the offset of rays from a point [m]. It exceeds rounding at the farthest vertex, because the point may lie
/// on any surface.
float offset_for(const Scene& scene, const V3f& position) {
    constexpr float relative_offset = 0x1p-17f;  // as RayCaster::ray_offset()
    float reach = 0;
    for (const V3f& v : scene.vertices)
        for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(v[k]));
    for (int k = 0; k < 3; ++k) reach = std::max(reach, std::abs(position[k]));
    return relative_offset * reach;
}

V3f direction_of(const V3f& v, const char* what, std::size_t point) {
    const float length = v.length();
    if (!(length > 0 && std::isfinite(length)))
        throw InputError(fmt::format("measuring point {}: its {} has no direction", point, what));
    return v / length;
}

Gauge gauge_of(const MeasuringPoint& point, std::size_t index, const Imath::V3d& origin) {
    constexpr float pi = std::numbers::pi_v<float>;
    Gauge gauge;
    gauge.position = V3f(point.position - origin);
    if (!std::isfinite(gauge.position.length2()))
        throw InputError(fmt::format("measuring point {}: its position is not finite", index));
    if (point.receiver == Receiver::planar) {
        gauge.normal = direction_of(point.normal, "normal", index);
        return gauge;
    }
    const V3f axis = direction_of(point.axis, "axis", index);
    const bool is_full_circle = point.receiver == Receiver::cylindrical;
    gauge.half_arc = is_full_circle ? pi : pi / 2;
    gauge.normal = is_full_circle ? TangentFrame(axis).s
                                  : direction_of(point.normal - axis * axis.dot(point.normal), "normal", index);
    gauge.tangent = axis.cross(gauge.normal);
    return gauge;
}

/// Returns the options of a picture with one pixel per point.
/// @throws InputError for a shading that is not available for points.
PictureOptions picture_options(const MeasuringOptions& options, std::size_t points) {
    return {.width = static_cast<int>(points),
            .height = 1,
            .shading = options.shading,
            .samples = require_samples(options.shading, &DefaultSamples::point, options.samples),
            .max_samples = options.max_samples,
            .until = options.until,
            .time = options.time,
            .quantity = PictureQuantity::irradiance,
            .seed = options.seed};
}

}  // namespace

std::vector<MeasuredIrradiance> measure_irradiance(const Scene& scene, const Solution* solution,
                                                   const RayCaster& ray_caster, std::span<const MeasuringPoint> points,
                                                   const MeasuringOptions& options, const Monitor& monitor) {
    const PictureOptions drawing = picture_options(options, points.size());
    if (needs_solution(drawing.shading) && !solution)
        throw InputError(fmt::format("{} shading needs a solution", label(drawing.shading)));
    if (points.empty()) return {};
    if (points.size() > std::numeric_limits<int>::max())
        throw InputError(
            fmt::format("{} measuring points: expected at most {}", points.size(), std::numeric_limits<int>::max()));
    std::vector<Gauge> gauges;
    gauges.reserve(points.size());
    for (const MeasuringPoint& point : points) gauges.push_back(gauge_of(point, gauges.size(), scene.origin));
    V3f farthest(0);
    for (const Gauge& gauge : gauges)
        if (gauge.position.length2() > farthest.length2()) farthest = gauge.position;
    const float offset = offset_for(scene, farthest);
    for (Gauge& gauge : gauges) gauge.offset = offset;

    const PathStart start{{}, 0, gauges};
    std::optional<KnownIrradiance> known;
    if (needs_solution(drawing.shading)) known.emplace(known_irradiance(scene, *solution));
    const Rendering traced = trace_picture(scene, ray_caster, start, drawing, monitor, known ? &*known : nullptr);
    std::vector<MeasuredIrradiance> measured(points.size());
    const SampledLight& light = traced.layers.reflected;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool is_measured = traced.batches[i] > 1;
        measured[i] = {light.direct.pixels[i], light.indirect.pixels[i],
                       is_measured ? traced.standard_error.pixels[i] : Rgb(std::numeric_limits<float>::infinity()),
                       std::sqrt(light.indirect_variance[i])};
    }
    return measured;
}

}  // namespace interflect
