#include "interflect/render/pictures/pixel_statistics.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

/// A neighbourhood of radius r has (2 r + 1)^2 pixels.
constexpr std::size_t neighbourhood_radius = 3, radius_of_lamps = 1, radius_of_edges = 1;
/// First hits are added to pixels whose error, relative to the light around, exceeds this.
constexpr double first_hit_target = hybrid_target / 6;
/// Maximum number of first hits of a half. If a whole picture shows edges, they take about the time of eight samples a
/// pixel.
constexpr double most_first_hits = 32;

std::array<RgbD, 3> parts_of(const PathLight& light) {
    return {light.emitted + light.direct + light.indirect, light.direct, light.indirect};
}

/// Returns value(pixel) of each pixel.
template <class Value>
std::vector<double> of_pixels(const std::vector<PixelStatistics>& pixels, const Value& value) {
    std::vector<double> values(pixels.size());
    parallel_for_indices(pixels.size(), [&](std::size_t i) { values[i] = value(pixels[i]); });
    return values;
}

/// Light of all pixels, mean channel.
struct MeanLight {
    std::vector<double> all, emitted, reflected;
};

/// Computes all light at once, because reading the samples of all pixels takes most of the time.
MeanLight mean_light(const std::vector<PixelStatistics>& pixels) {
    MeanLight mean;
    for (std::vector<double>* part : {&mean.all, &mean.emitted, &mean.reflected}) part->resize(pixels.size());
    parallel_for_indices(pixels.size(), [&](std::size_t i) {
        const PathLight light = pixels[i].light();
        mean.all[i] = mean_channel(parts_of(light)[0]);
        mean.emitted[i] = mean_channel(light.emitted);
        mean.reflected[i] = mean_channel(light.direct + light.indirect);
    });
    return mean;
}

/// Sums each value over its neighbours in a line. Line j starts at index j line_step; its values are `step` apart.
std::vector<double> sums_along(const std::vector<double>& values, std::size_t lines, std::size_t line_step,
                               std::size_t length, std::size_t step, std::size_t radius) {
    constexpr std::size_t lines_per_task = 16;
    std::vector<double> sums(values.size());
    parallel_for_ranges(lines, lines_per_task, [&](std::size_t begin, std::size_t end_of_lines) {
        for (std::size_t line = begin; line < end_of_lines; ++line)
            for (std::size_t i = 0; i < length; ++i) {
                const std::size_t first = i - std::min(i, radius), end = std::min(length, i + radius + 1);
                double& sum = sums[line * line_step + i * step];
                for (std::size_t k = first; k < end; ++k) sum += values[line * line_step + k * step];
            }
    });
    return sums;
}

std::vector<double> sums_around(std::vector<double> values, const PictureOptions& options,
                                std::size_t radius = neighbourhood_radius) {
    const auto width = static_cast<std::size_t>(options.width), height = static_cast<std::size_t>(options.height);
    values = sums_along(values, height, width, width, 1, radius);
    return sums_along(values, width, 1, height, width, radius);
}

/// Returns the light to which the error of each pixel is relative: the mean of its neighbours, at least the mean of the
/// picture. The pixel itself is left out, because its noisy value would hide errors of rare light and bias the number
/// of its samples.
std::vector<double> error_scale(const MeanLight& light, const PictureOptions& options) {
    std::vector<double> scale = sums_around(light.all, options);
    const std::vector<double> count = sums_around(std::vector<double>(scale.size(), 1.0), options);
    const double least = std::accumulate(light.reflected.begin(), light.reflected.end(), 0.0) /
                         static_cast<double>(light.reflected.size());
    for (std::size_t i = 0; i < scale.size(); ++i)
        scale[i] = std::max(least, count[i] > 1 ? (scale[i] - light.all[i]) / (count[i] - 1) : 0);
    return scale;
}

/// Returns the variance of the light at the centre and at the corners of a pixel; the last column and the last row have
/// corners on one side only.
double variance_of_places(const std::vector<LightAtPlaces>& places, std::size_t pixel, const PictureOptions& options) {
    const auto width = static_cast<std::size_t>(options.width);
    const std::size_t right = pixel % width + 1 < width ? 1 : 0, below = pixel + width < places.size() ? width : 0;
    const std::array<double, 5> light{places[pixel].centre, places[pixel].corner, places[pixel + right].corner,
                                      places[pixel + below].corner, places[pixel + right + below].corner};
    double sum = 0, squares = 0;
    for (const double l : light) {
        sum += l;
        squares += l * l;
    }
    const double mean = sum / light.size();
    return std::max(0.0, squares / light.size() - mean * mean);
}

/// Returns the mean emitted light of each pixel and the eight around it, because the neighbourhood of a small lamp is
/// much darker than the lamp. The mean is used because a single noisy pixel would hide its own error.
std::vector<double> lamps_around(const MeanLight& light, const PictureOptions& options) {
    std::vector<double> emitted = sums_around(light.emitted, options, radius_of_lamps);
    const std::vector<double> count = sums_around(std::vector<double>(emitted.size(), 1.0), options, radius_of_lamps);
    for (std::size_t i = 0; i < emitted.size(); ++i) emitted[i] /= count[i];
    return emitted;
}

}  // namespace

void PixelStatistics::Spread::add(const PathLight& light) {
    const std::array<RgbD, 3> value = parts_of(light);
    ++parts;
    for (std::size_t k = 0; k < value.size(); ++k) {
        const RgbD difference = value[k] - mean[k];
        mean[k] += difference / static_cast<double>(parts);
        squares[k] += difference * (value[k] - mean[k]);
    }
}

void PixelStatistics::add(const SampleBatch& b, ErrorSource source) {
    samples_ += b.half_size;
    for (const FirstHit& first : b.first) first_sum_ += first;
    for (std::size_t h = 0; h < 2; ++h) sums_[h] += b.halves[h];
    if (source == ErrorSource::halves) {
        spread_ = {};
        for (std::size_t h = 0; h < 2; ++h) spread_.add(half_mean(h));
    } else if (source == ErrorSource::half_batches) {
        for (const PathLight& sum : b.halves) spread_.add(sum * (1.0 / b.half_size));
    } else {
        PathLight sum = b.halves[0];
        sum += b.halves[1];
        spread_.add(sum * (0.5 / b.half_size));
    }
}

void PixelStatistics::replace_prediction(const SampleBatch& b) {
    assert(b.half_size == samples_);
    for (std::size_t h = 0; h < 2; ++h) {
        sums_[h].predicted = b.halves[h].predicted;
        sums_[h].square_of_first_hit = b.halves[h].square_of_first_hit;
    }
}

void PixelStatistics::add_first_hits(const SampleBatch& b) {
    number_of_first_hits_ = b.half_size;
    for (const FirstHit& first : b.first) first_sum_ += first;
    for (std::size_t h = 0; h < 2; ++h)
        first_hits_[h] = {Rgb(b.halves[h].emitted / static_cast<double>(b.half_size)),
                          Rgb(b.halves[h].predicted / static_cast<double>(b.half_size))};
    spread_ = {};
    for (std::size_t h = 0; h < 2; ++h) spread_.add(half_mean(h));
}

PathLight PixelStatistics::half_mean(std::size_t h) const {
    PathLight mean = sums_[h] * (samples_ > 0 ? 1.0 / samples_ : 0.0);
    if (number_of_first_hits_ == 0) return mean;
    const RgbD emitted(first_hits_[h][0]), predicted(first_hits_[h][1]);
    const RgbD missing = predicted - mean.predicted;
    // Divide the difference into direct and indirect light in the ratio of the other half, which is independent of it.
    const PathLight& other = sums_[1 - h];
    for (int k = 0; k < 3; ++k) {
        const double reflected = other.direct[k] + other.indirect[k];
        const double direct = reflected > 0 ? std::clamp(other.direct[k] / reflected, 0.0, 1.0) : 0.5;
        mean.direct[k] += direct * missing[k];
        mean.indirect[k] += (1 - direct) * missing[k];
    }
    mean.emitted = emitted;
    mean.predicted = predicted;
    return mean;
}

PathLight PixelStatistics::light() const {
    PathLight sum = half_mean(0);
    sum += half_mean(1);
    return sum * 0.5;
}

RgbD PixelStatistics::mean() const { return parts_of(light())[0]; }

FirstHit PixelStatistics::first() const {
    FirstHit mean = first_sum_;
    const double samples = std::max(1.0, 2.0 * (samples_ + number_of_first_hits_));
    mean.albedo /= samples;
    mean.normal /= samples;
    mean.position /= samples;
    mean.distance /= samples;
    mean.level /= samples;
    return mean;
}

RgbD PixelStatistics::squared_sampling_error(std::size_t part) const {
    if (!has_error()) return RgbD(0);
    return spread_.squares[part] / ((spread_.parts - 1.0) * spread_.parts);
}

RgbD PixelStatistics::squared_record_error() const {
    const PathLight mean = light();
    const double indirect = mean_channel(mean.indirect);
    if (!(indirect > 0)) return RgbD(mean.record_error * mean.record_error);
    const RgbD error = mean.indirect * (mean.record_error / indirect);
    return error * error;
}

double relative_error(const std::vector<PixelStatistics>& pixels, const PictureOptions& options) {
    const auto has_error = [](const PixelStatistics& p) { return p.has_error(); };
    if (!std::all_of(pixels.begin(), pixels.end(), has_error)) return std::numeric_limits<double>::infinity();
    const MeanLight light = mean_light(pixels);
    const std::vector<double> around = error_scale(light, options), lamps = lamps_around(light, options);
    const std::vector<double> squares =
        of_pixels(pixels, [](const PixelStatistics& p) { return mean_channel(p.squared_error()); });
    double sum = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double scale = std::max(around[i], lamps[i]);
        if (scale > 0) sum += squares[i] / (scale * scale);
    }
    return std::sqrt(sum / static_cast<double>(pixels.size()));
}

std::vector<double> needed_samples(const std::vector<PixelStatistics>& pixels, const PictureOptions& options,
                                   double target) {
    const std::vector<double> scale = error_scale(mean_light(pixels), options);
    // Variance of a mean of two samples, one from each half
    const std::vector<double> variance = of_pixels(pixels, [](const PixelStatistics& p) {
        return mean_channel(p.squared_sampling_error()) * p.samples_of_half();
    });
    const std::vector<double> sums = sums_around(variance, options);
    const std::vector<double> count = sums_around(std::vector<double>(pixels.size(), 1.0), options);
    std::vector<double> needed(pixels.size(), 0);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double around = count[i] > 1 ? std::max(0.0, sums[i] - variance[i]) / (count[i] - 1) : variance[i];
        if (scale[i] > 0) needed[i] = around / (scale[i] * scale[i] * target * target);
    }
    return needed;
}

std::vector<std::uint32_t> needed_first_hits(const std::vector<PixelStatistics>& pixels,
                                             const std::vector<LightAtPlaces>& places, const PictureOptions& options) {
    // At an edge, the error of a mean of n stratified samples is about their standard deviation times n to the power of
    // -3/4.
    constexpr double exponent = 4.0 / 3;
    const MeanLight mean = mean_light(pixels);
    const std::vector<double> scale = error_scale(mean, options);
    const std::vector<double>& emitted = mean.emitted;
    const std::vector<double> variance = of_pixels(pixels, [](const PixelStatistics& p) {
        const PathLight light = p.light();
        const double of_first_hits = mean_channel(light.emitted + light.predicted);
        return std::max(0.0, light.square_of_first_hit - of_first_hits * of_first_hits);
    });
    const std::vector<double> sums = sums_around(variance, options, radius_of_edges);
    const std::vector<double> sums_of_lamps = sums_around(emitted, options, radius_of_edges);
    const std::vector<double> count = sums_around(std::vector<double>(pixels.size(), 1.0), options, radius_of_edges);
    std::vector<std::uint32_t> needed(pixels.size(), 0);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!(count[i] > 1)) continue;
        const double others = count[i] - 1, lamps = (sums_of_lamps[i] - emitted[i]) / others;
        const double relative_to = std::max(scale[i], lamps);
        if (!(relative_to > 0)) continue;
        const double variance_around = std::max(0.0, sums[i] - variance[i]) / others;
        const double deviation =
            std::sqrt(std::max(variance_around, variance_of_places(places, i, options))) / relative_to;
        const double of_half = std::pow(deviation / first_hit_target, exponent) / 2;
        if (of_half > pixels[i].samples_of_half())
            needed[i] = std::bit_ceil(static_cast<std::uint32_t>(std::min(most_first_hits, of_half)));
    }
    return needed;
}

}  // namespace interflect::detail
