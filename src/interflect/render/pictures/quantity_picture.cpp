#include "interflect/render/pictures/quantity_picture.h"

#include <cmath>
#include <vector>

#include "interflect/elements/forest.h"
#include "interflect/raycast/camera.h"
#include "interflect/render/pictures/camera_samples.h"

namespace interflect::detail {

namespace {

struct Seen {
    double sum = 0;
    int rays = 0;

    float mean() const { return rays > 0 ? static_cast<float>(sum / rays) : 0; }
};

Seen seen_by(const PixelSamples& samples, const ElementForest& forest, std::span<const float> values) {
    Seen seen;
    for (std::size_t i = 0; i < samples.rays.size(); ++i) {
        const ElementIndex leaf = leaf_of_hit(forest, samples.rays[i], samples.hits[i]);
        if (leaf == none) continue;
        seen.sum += values[leaf];
        ++seen.rays;
    }
    return seen;
}

ColourScale scale_of(const std::vector<Seen>& pixels, Spacing spacing) {
    std::vector<float> values;
    for (const Seen& pixel : pixels)
        if (pixel.rays > 0) values.push_back(pixel.mean());
    return fit_scale(std::move(values), spacing);
}

}  // namespace

QuantityPicture render_quantity(const Scene& scene, const ElementForest& forest, const RayCaster& ray_caster,
                                const View& view, const Quantity& quantity, const CameraSampling& sampling,
                                const Monitor& monitor) {
    ray_caster.require_made_for(scene);
    forest.require_made_for(scene);
    require_values_of_elements(forest, quantity.values.size(), quantity.name.c_str());
    const Camera camera(view, sampling.width, sampling.height, scene.origin);
    QuantityPicture result;
    result.values = result.shown = Image(sampling.width, sampling.height);
    std::vector<Seen> pixels(result.values.pixels.size());
    trace_pixels(camera, ray_caster, sampling, monitor, [&](const PixelSamples& samples) {
        pixels[samples.pixel] = seen_by(samples, forest, quantity.values);
    });

    result.scale = scale_of(pixels, quantity.spacing);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const float value = pixels[i].mean();
        const float share = static_cast<float>(pixels[i].rays) / static_cast<float>(sampling.samples);
        result.values.pixels[i] = Rgb(value);
        result.shown.pixels[i] = std::isfinite(value) ? share * false_colour(result.scale.position(value)) : Rgb(value);
    }
    result.non_finite_pixels = count_non_finite(result.values);
    result.interrupted = monitor.stop && *monitor.stop;
    return result;
}

}  // namespace interflect::detail
