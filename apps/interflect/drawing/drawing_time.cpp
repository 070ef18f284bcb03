#include "apps/interflect/drawing/drawing_time.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include "apps/interflect/processes/shared_light.h"
#include "apps/interflect/processes/signals.h"
#include "interflect/light_sources.h"
#include "interflect/preview.h"

namespace interflect::command {

namespace {

using Clock = std::chrono::steady_clock;

const Clock::time_point process_start = Clock::now();

/// Extrapolation from a measured small picture to the full one: the time grows as pixels^exponent.
struct TimeGrowth {
    int reduction;  ///< The small picture has 1 / reduction of the width and of the height.
    double exponent;
};
/// Measured: 64 times the pixels trace 23 to 31 times the rays in three offices and a corridor, since records are
/// sparser than pixels.
constexpr TimeGrowth hybrid_growth{8, 0.81};
constexpr TimeGrowth gathering_growth{16, 1};
/// Measured: 16 times the pixels take 5 times the time, since part of it prepares the elements.
constexpr TimeGrowth element_growth{4, 0.6};

/// Time of exposure, tone mapping and compression per pixel [s].
constexpr double writing_time = 0.5e-6;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

template <class Work>
double seconds_of(const Work& work) {
    const auto start = Clock::now();
    work();
    return seconds_since(start);
}

double pixels_of(const PictureOptions& options) { return static_cast<double>(options.width) * options.height; }

PictureOptions with_size(PictureOptions options, int width, int height) {
    options.width = width;
    options.height = height;
    return options;
}

/// Returns options of the same picture with fewer pixels.
PictureOptions reduced(const PictureOptions& options, int reduction) {
    return with_size(options, std::max(1, options.width / reduction), std::max(1, options.height / reduction));
}

struct MeasuredPicture {
    double drawing = 0;    // [s]
    double filtering = 0;  // [s]; 0 without a denoiser
    std::int64_t rays = 0;
};

/// Measured times of two pictures drawn by paths with DrawingTime::min_samples, from which the time of the full picture
/// follows.
struct PathTimes {
    double sending = 0;         // time of sending the light to the other processes [s]
    MeasuredPicture one_pixel;  // its time is that of preparing the light and starting the filter
    MeasuredPicture small;
    double pixels = 1;       // of the full picture
    double pixel_ratio = 1;  // pixels of the full picture over those of the small one
    double exponent = 1;     // TimeGrowth::exponent

    /// Predicts the time of the full picture, or of a preview if `reduction` is above 1.
    DrawingTime predict(double reduction) const {
        const double small_tracing = std::max(0.0, small.drawing - one_pixel.drawing);
        const double small_filtering = std::max(0.0, small.filtering - one_pixel.filtering);
        const double more_pixels = pixel_ratio / (reduction * reduction);
        const double tracing = sending + one_pixel.drawing + small_tracing * std::pow(more_pixels, exponent);
        // A camera ray of a preview, with the interpolation of its light, takes about the time of the mean ray.
        const double finding_surfaces = PreviewOptions{reduction}.camera_rays() * pixels * small_tracing /
                                        static_cast<double>(std::max<std::int64_t>(1, small.rays));
        return {.drawing = tracing + (reduction > 1 ? finding_surfaces : 0),
                .finishing = one_pixel.filtering + more_pixels * small_filtering + writing_time * pixels,
                .reduction = reduction};
    }
};

PathTimes measure_path_times(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                             const View& view, const PictureOptions& options, std::optional<Denoiser> denoiser) {
    SharedLight shared_light(scene, &solution);
    PathTimes times;
    times.sending = seconds_of([&] { shared_light.start(); });
    if (denoiser) available_denoiser(*denoiser);  // loads its library before the measurements
    const auto measure = [&](PictureOptions picture) {
        picture.time = 1e-9;  // [s]; ends the picture after min_samples
        picture.samples = DrawingTime::min_samples;
        Rendering drawn;
        MeasuredPicture measured;
        measured.drawing = seconds_of([&] {
            shared_light.share({{}, &stop_flag()}, [&](const Monitor& monitor) {
                drawn = render(scene, solution, ray_caster, view, picture, monitor);
            });
        });
        if (denoiser) measured.filtering = seconds_of([&] { denoise(drawn.layers, *denoiser); });
        measured.rays = drawn.rays;
        return measured;
    };
    const TimeGrowth& growth = options.shading == Shading::hybrid ? hybrid_growth : gathering_growth;
    const PictureOptions small_picture = reduced(options, growth.reduction);
    times.one_pixel = measure(with_size(options, 1, 1));
    times.small = measure(small_picture);
    times.pixels = pixels_of(options);
    times.pixel_ratio = pixels_of(options) / pixels_of(small_picture);
    times.exponent = growth.exponent;
    const bool has_sky = std::any_of(scene.luminaires.begin(), scene.luminaires.end(), is_sky);
    if (options.shading == Shading::hybrid && has_sky) {
        // Most rays of small pictures search for the sky around the records, whose number grows more slowly
        const PictureOptions smaller_picture = reduced(small_picture, 4);
        const double pixels = pixels_of(small_picture) / pixels_of(smaller_picture);
        const double rays = static_cast<double>(times.small.rays) / static_cast<double>(measure(smaller_picture).rays);
        if (pixels > 1 && rays > 1) times.exponent = std::min(times.exponent, std::log(rays) / std::log(pixels));
    }
    return times;
}

}  // namespace

double seconds_of_process() { return seconds_since(process_start); }

int DrawingTime::samples_within(double seconds) const {
    constexpr int most = 8;             // more samples are only drawn where pixels are noisy
    constexpr double time_ratio = 2.2;  // of 8 and 2 samples, measured in office-graz
    const double share = std::clamp((seconds / drawing - 1) / (time_ratio - 1), 0.0, 1.0);
    const auto additional_pairs = static_cast<int>(share * (most - min_samples) / 2);
    return min_samples + 2 * additional_pairs;
}

DrawingTime predict_time_of_paths(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                  const View& view, const PictureOptions& options, std::optional<Denoiser> denoiser,
                                  double limit) {
    const PathTimes times = measure_path_times(scene, solution, ray_caster, view, options, denoiser);
    constexpr double step = 0.25;  // a smaller one changes the time by less than the error of its prediction
    const double last_reduction = options.shading == Shading::hybrid ? largest_reduction : 1;
    double reduction = 1;
    while (reduction < last_reduction && times.predict(reduction).total() > limit) reduction += step;
    return times.predict(reduction);
}

DrawingTime predict_time_of_elements(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                                     const View& view, const PictureOptions& options) {
    const PictureOptions small_picture = reduced(options, element_growth.reduction);
    const double pixel_ratio = pixels_of(options) / pixels_of(small_picture);
    const double small_drawing = seconds_of([&] {
        render(scene, solution, ray_caster, view, small_picture, {{}, &stop_flag()});
    });
    return {.drawing = std::pow(pixel_ratio, element_growth.exponent) * small_drawing,
            .finishing = writing_time * options.width * options.height};
}

double reserved_for(const DrawingTime& predicted, bool takes_more_samples, double left) {
    constexpr double share_of_samples = 3.0 / 4;
    const double drawing =
        takes_more_samples ? std::max(share_of_samples * left, predicted.drawing) : predicted.drawing;
    return std::min(largest_drawing_share * left, drawing + predicted.finishing);
}

}  // namespace interflect::command
