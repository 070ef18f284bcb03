#include "interflect/render/pictures/outlines.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/raycast/camera.h"
#include "interflect/render/pictures/camera_samples.h"

namespace interflect::detail {

namespace {

/// Rays at three corners of a square of the line's width. A sample is on a line if they hit different leaves.
constexpr std::size_t rays_per_sample = 3;

float outlined_share(const PixelSamples& samples, const ElementForest& forest) {
    const auto leaf = [&](std::size_t i) { return leaf_of_hit(forest, samples.rays[i], samples.hits[i]); };
    int outlined = 0;
    for (std::size_t i = 0; i < samples.rays.size(); i += rays_per_sample)
        outlined += leaf(i) != leaf(i + 1) || leaf(i) != leaf(i + 2);
    return static_cast<float>(outlined * rays_per_sample) / static_cast<float>(samples.rays.size());
}

void require_valid(const OutlineOptions& options) {
    if (!(options.width > 0 && std::isfinite(options.width)))
        throw InputError(fmt::format("outlines {} pixels wide: expected more than 0, and finite", options.width));
    if (!(options.opacity >= 0 && options.opacity <= 1))
        throw InputError(fmt::format("outlines of opacity {}: expected 0 to 1", options.opacity));
}

}  // namespace

Image draw_outlines(const Image& picture, const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                    const View& view, int samples, std::uint64_t seed, const OutlineOptions& options,
                    const Monitor& monitor) {
    ray_caster.require_made_for(scene);
    forest.require_made_for(scene);
    require_valid(options);
    require_pixels(picture);
    const Camera camera(view, picture.width, picture.height, scene.origin);
    const float half = 0.5f * options.width;
    const std::array<PixelOffset, rays_per_sample> offsets{{{-half, -half}, {half, -half}, {-half, half}}};
    Image outlined = picture;
    trace_pixels(camera, ray_caster, {picture.width, picture.height, samples, seed}, offsets, monitor,
                 [&](const PixelSamples& pixel) {
                     const float share = options.opacity * outlined_share(pixel, forest);
                     Rgb& shown = outlined.pixels[pixel.pixel];
                     shown = shown * (1 - share) + options.colour * share;
                 });
    return outlined;
}

}  // namespace interflect::detail
