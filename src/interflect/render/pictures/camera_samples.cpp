#include "interflect/render/pictures/camera_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

/// Enough rays to amortise the cost of a batch.
constexpr std::size_t rays_per_batch = 4096;
constexpr std::size_t batches_per_report = 256;

void require_valid(const CameraSampling& sampling) {
    if (sampling.samples < 1) throw InputError(fmt::format("{} samples a pixel: expected 1 or more", sampling.samples));
    if (sampling.width < 1 || sampling.height < 1)
        throw InputError(
            fmt::format("a picture of {} x {} pixels: expected 1 x 1 or more", sampling.width, sampling.height));
}

void append_pixel_rays(const Camera& camera, std::size_t pixel, const CameraSampling& sampling,
                       std::span<const PixelOffset> offsets, std::vector<Ray>& rays) {
    const auto width = static_cast<std::size_t>(sampling.width);
    const std::size_t column = pixel % width, row = pixel / width;
    const auto left = static_cast<float>(column), top = static_cast<float>(row);
    const auto samples = static_cast<std::size_t>(sampling.samples);
    thread_local PointBlock points;
    for (std::size_t first = 0; first < samples; first += PointBlock::capacity) {
        const std::size_t count = std::min(PointBlock::capacity, samples - first);
        fill_points(PointSet::sobol, mix(sampling.seed, pixel), first, count, points);
        for (std::size_t i = 0; i < count; ++i)
            for (const PixelOffset& offset : offsets)
                rays.push_back(
                    camera.ray(left + points.coordinate[0][i] + offset.x, top + points.coordinate[1][i] + offset.y));
    }
}

}  // namespace

void trace_pixels(const Camera& camera, const RayCaster& ray_caster, const CameraSampling& sampling,
                  std::span<const PixelOffset> offsets, const Monitor& monitor,
                  const std::function<void(const PixelSamples&)>& visit) {
    require_valid(sampling);
    const std::size_t pixel_count =
        static_cast<std::size_t>(sampling.width) * static_cast<std::size_t>(sampling.height);
    const std::size_t rays_per_pixel = static_cast<std::size_t>(sampling.samples) * offsets.size();
    const std::size_t pixels_per_batch = std::max<std::size_t>(1, rays_per_batch / rays_per_pixel);
    const auto stopped = [&] { return monitor.stop && *monitor.stop; };

    const auto trace_batch = [&](std::size_t begin, std::size_t end) {
        if (stopped()) return;
        std::vector<Ray> rays;
        rays.reserve((end - begin) * rays_per_pixel);
        for (std::size_t pixel = begin; pixel < end; ++pixel) append_pixel_rays(camera, pixel, sampling, offsets, rays);
        std::vector<Hit> hits(rays.size());
        ray_caster.trace(rays, hits);
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            const std::size_t first = (pixel - begin) * rays_per_pixel;
            visit({pixel, std::span(rays).subspan(first, rays_per_pixel),
                   std::span(hits).subspan(first, rays_per_pixel)});
        }
    };

    const std::size_t pixels_per_report = pixels_per_batch * batches_per_report;
    for (std::size_t begin = 0; begin < pixel_count && !stopped(); begin += pixels_per_report) {
        const std::size_t end = std::min(pixel_count, begin + pixels_per_report);
        parallel_for_ranges(end - begin, pixels_per_batch,
                            [&](std::size_t first, std::size_t last) { trace_batch(begin + first, begin + last); });
        if (monitor.on_progress)
            monitor.on_progress({static_cast<std::int64_t>(end * rays_per_pixel),
                                 static_cast<double>(end) / static_cast<double>(pixel_count)});
    }
}

void require_values_of_elements(const ElementForest& forest, std::size_t value_count, const char* what) {
    if (value_count != forest.size())
        throw InputError(fmt::format("{} has {} values, expected one for each of the forest's {} elements", what,
                                     value_count, forest.size()));
}

}  // namespace interflect::detail
