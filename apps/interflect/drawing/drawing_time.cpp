#include "apps/interflect/drawing/drawing_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "apps/interflect/processes/shared_light.h"
#include "apps/interflect/processes/signals.h"

namespace interflect::command {

namespace {

using Clock = std::chrono::steady_clock;

const Clock::time_point process_start = Clock::now();

/// Reduction of width and height, and exponent of the time as a function of the number of pixels. Measured: hybrid
/// shading of 64 times the pixels traces 23 to 31 times the rays in three offices and a corridor, since records are
/// sparser than pixels; smooth shading of 16 times the pixels takes 5 times the time, since it also prepares elements.
struct Growth {
    int reduction;
    double exponent;
};
constexpr Growth hybrid_growth{8, 0.81}, gathering_growth{16, 1}, element_growth{4, 0.6};

constexpr double writing = 0.5e-6;  // [s] per pixel: exposure, tone mapping and compression

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

template <class Work>
double seconds_of(const Work& work) {
    const auto start = Clock::now();
    work();
    return seconds_since(start);
}

/// Reduces a picture's size. Returns the ratio of the numbers of pixels.
double reduce(int& width, int& height, int reduction) {
    const double pixels = static_cast<double>(width) * height;
    width = std::max(1, width / reduction);
    height = std::max(1, height / reduction);
    return pixels / (static_cast<double>(width) * height);
}

}  // namespace

double seconds_of_process() { return seconds_since(process_start); }

int DrawingTime::samples_within(double seconds) const {
    constexpr int usual = 8;                  // the noise determines the number of later samples
    constexpr double usual_over_least = 2.2;  // ratio of the times, measured in office-graz
    const double share = std::clamp((seconds / least - 1) / (usual_over_least - 1), 0.0, 1.0);
    return least_samples + 2 * static_cast<int>(share * (usual - least_samples) / 2);
}

DrawingTime predict_time_of_paths(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                  const View& view, const PictureOptions& options, std::optional<Denoiser> denoiser,
                                  double limit) {
    constexpr double shortest = 1e-9;  // time limit that ends the picture after least_samples [s]
    SharedLight shared_light(scene, &solution);
    const double sending = seconds_of([&] { shared_light.start(); });
    Rendering traced;
    const auto seconds_to_draw = [&](const PictureOptions& picture) {
        return seconds_of([&] {
            shared_light.share({{}, &stop_flag()}, [&](const Monitor& monitor) {
                traced = render(scene, solution, ray_caster, view, picture, monitor);
            });
        });
    };
    // Measure the preparation and the start of the filter with a picture of one pixel.
    PictureOptions one = options;
    one.time = shortest;
    one.samples = DrawingTime::least_samples;
    one.width = one.height = 1;
    if (denoiser) available_denoiser(*denoiser);  // loads its library
    const auto seconds_to_filter = [&] {
        return denoiser ? seconds_of([&] { denoise(traced.layers, *denoiser); }) : 0;
    };
    const double preparation = seconds_to_draw(one), starting_filter = seconds_to_filter();
    // Measure a smaller picture.
    PictureOptions small = options;
    small.time = shortest;
    small.samples = DrawingTime::least_samples;
    const Growth& growth = options.shading == Shading::hybrid ? hybrid_growth : gathering_growth;
    const double ratio = reduce(small.width, small.height, growth.reduction);
    const double drawing = seconds_to_draw(small);
    const double of_pixels = std::max(0.0, drawing - preparation), filtering = seconds_to_filter() - starting_filter;
    // Extrapolate to all pixels, or to a preview that the limit permits.
    const double pixels = static_cast<double>(options.width) * options.height;
    // Surfaces of a preview take two to four camera rays per pixel; other rays take more time than these.
    const double of_surfaces = 2 * pixels * of_pixels / static_cast<double>(std::max<std::int64_t>(1, traced.rays));
    const auto time = [&](int reduction) {
        const double more_pixels = ratio / (reduction * reduction);
        const double least = sending + preparation + of_pixels * std::pow(more_pixels, growth.exponent);
        return DrawingTime{least + (reduction > 1 ? of_surfaces : 0),
                           starting_filter + more_pixels * std::max(0.0, filtering) + writing * pixels, reduction};
    };
    const int largest = options.shading == Shading::hybrid ? largest_reduction : 1;
    int reduction = 1;
    while (reduction < largest && time(reduction).total() > limit) ++reduction;
    return time(reduction);
}

DrawingTime predict_time_of_elements(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                     const View& view, const PictureOptions& options) {
    PictureOptions small = options;
    const double ratio = reduce(small.width, small.height, element_growth.reduction);
    const double drawing = seconds_of([&] { render(scene, solution, ray_caster, view, small, {{}, &stop_flag()}); });
    const double least = std::pow(ratio, element_growth.exponent) * drawing;
    return {least, writing * options.width * options.height};
}

double reserved_for(const DrawingTime& predicted, bool is_refined, double left) {
    constexpr double share_of_paths = 3.0 / 4;
    const double drawing = is_refined ? std::max(share_of_paths * left, predicted.least) : predicted.least;
    return std::min(largest_drawing_share * left, drawing + predicted.finishing);
}

}  // namespace interflect::command
