#include "interflect/image/eye_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "interflect/base/error.h"
#include "interflect/base/parallel.h"
#include "interflect/base/points.h"
#include "interflect/base/random.h"

namespace interflect {

namespace {

/// Rays that are traced together, about: many enough to hide the cost of a batch, few enough to stay in the cache.
constexpr std::size_t rays_per_batch = 4096;

void append_pixel_rays(const Camera& camera, std::size_t pixel, const EyeSampling& sampling,
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

void trace_pixels(const Camera& camera, const RayCaster& ray_caster, const EyeSampling& sampling,
                  std::span<const PixelOffset> offsets, const std::function<void(const PixelSamples&)>& visit) {
    if (sampling.samples < 1) throw InputError(fmt::format("{} samples a pixel: expected 1 or more", sampling.samples));
    const std::size_t pixel_count =
        static_cast<std::size_t>(sampling.width) * static_cast<std::size_t>(sampling.height);
    const std::size_t rays_per_pixel = static_cast<std::size_t>(sampling.samples) * offsets.size();
    const std::size_t pixels_per_batch = std::max<std::size_t>(1, rays_per_batch / rays_per_pixel);

    parallel_for_ranges(pixel_count, pixels_per_batch, [&](std::size_t begin, std::size_t end) {
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
    });
}

void require_of_scene(const Scene& scene, const ElementForest& forest) {
    if (forest.patch_count() != scene.patches.size())
        throw InputError(fmt::format("the forest is of {} patches, expected the scene's {}", forest.patch_count(),
                                     scene.patches.size()));
}

void require_values_of_elements(const Scene& scene, const ElementForest& forest, std::size_t value_count,
                                const char* what) {
    require_of_scene(scene, forest);
    if (value_count != forest.size())
        throw InputError(fmt::format("{} has {} values, expected one for each of the forest's {} elements", what,
                                     value_count, forest.size()));
}

}  // namespace interflect
