// Formulas and constants of Andersson et al. 2020 (docs/method/metrics.md).
#include <ImathMatrix.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"
#include "interflect/metrics.h"
#include "interflect/plots.h"

namespace interflect {

using namespace detail;

namespace {

using Imath::M33d;
using Imath::V3d;

constexpr double max_pixels_per_degree = 1000;  // eight times the resolution of the eye

/// Linear Rec. 709 to XYZ relative to white (D65), exact. Transposed, because Imath multiplies row vectors.
const M33d xyz_of_rgb(10135552.0 / 23359437, 2613072.0 / 12288897, 1425312.0 / 80288307,  //
                      8788810.0 / 23359437, 8788810.0 / 12288897, 8788810.0 / 80288307,   //
                      4435075.0 / 23359437, 887015.0 / 12288897, 70074185.0 / 80288307);
const M33d rgb_of_xyz = xyz_of_rgb.inverse();

/// Converts to YCxCz, which is CIE L*a*b* without cube roots. It is linear in XYZ, hence blurring preserves sums of
/// light.
V3d opponent_of_xyz(const V3d& xyz) { return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)}; }

V3d xyz_of_opponent(const V3d& opponent) {
    const double y = (opponent.x + 16) / 116;
    return {y + opponent.y / 500, y, y - opponent.z / 200};
}

V3d lab_of_xyz(const V3d& xyz) {
    constexpr double delta = 6.0 / 29;
    const auto compress = [](double t) {
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
    };
    return opponent_of_xyz({compress(xyz.x), compress(xyz.y), compress(xyz.z)});
}

V3d clamped(const V3d& rgb) {
    return {std::clamp(rgb.x, 0.0, 1.0), std::clamp(rgb.y, 0.0, 1.0), std::clamp(rgb.z, 0.0, 1.0)};
}

/// L*a*b* with less saturated dark colours (Hunt effect).
V3d perceived_colour(const V3d& rgb) {
    const V3d lab = lab_of_xyz(rgb * xyz_of_rgb);
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

struct Channel {
    int width = 0, height = 0;
    std::vector<float> values;

    Channel(int plane_width, int plane_height)
        : width(plane_width),
          height(plane_height),
          values(static_cast<std::size_t>(plane_width) * static_cast<std::size_t>(plane_height)) {}

    std::span<float> row(int y) { return std::span(values).subspan(start(y), static_cast<std::size_t>(width)); }
    std::span<const float> row(int y) const {
        return std::span(values).subspan(start(y), static_cast<std::size_t>(width));
    }

  private:
    std::size_t start(int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width); }
};

/// Weights at -radius ... radius [pixels].
using Kernel = std::vector<float>;

int radius_of(const Kernel& kernel) { return static_cast<int>(kernel.size() / 2); }

/// Samples a function, and scales the positive and the negative weights to absolute sums of 1.
template <class Function>
Kernel normalised_kernel(int radius, const Function& function) {
    double above = 0, below = 0;
    for (int x = -radius; x <= radius; ++x) (function(x) > 0 ? above : below) += std::abs(function(x));
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x) {
        const double weight = function(x);
        kernel.push_back(weight == 0 ? 0.0f : static_cast<float>(weight / (weight > 0 ? above : below)));
    }
    return kernel;
}

void add_scaled(std::span<float> sum, float factor, const float* values) {
    for (std::size_t x = 0; x < sum.size(); ++x) sum[x] += factor * values[x];
}

template <class Body>
void for_each_row(int height, const Body& body) {
    constexpr std::size_t rows_per_task = 16;
    parallel_for_ranges(static_cast<std::size_t>(height), rows_per_task, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) body(static_cast<int>(y));
    });
}

Channel filter_rows(const Channel& plane, const Kernel& kernel) {
    Channel result(plane.width, plane.height);
    const int radius = radius_of(kernel);
    for_each_row(plane.height, [&](int y) {
        const auto row = plane.row(y);
        std::vector<float> padded(static_cast<std::size_t>(radius), row.front());
        padded.insert(padded.end(), row.begin(), row.end());
        padded.insert(padded.end(), static_cast<std::size_t>(radius), row.back());
        for (std::size_t k = 0; k < kernel.size(); ++k) add_scaled(result.row(y), kernel[k], padded.data() + k);
    });
    return result;
}

Channel filter_columns(const Channel& plane, const Kernel& kernel) {
    Channel result(plane.width, plane.height);
    const int radius = radius_of(kernel);
    for_each_row(plane.height, [&](int y) {
        for (int k = 0; k <= 2 * radius; ++k)
            add_scaled(result.row(y), kernel[static_cast<std::size_t>(k)],
                       plane.row(std::clamp(y + k - radius, 0, plane.height - 1)).data());
    });
    return result;
}

Channel filter(const Channel& plane, const Kernel& along_x, const Kernel& along_y) {
    return filter_columns(filter_rows(plane, along_x), along_y);
}

/// Contrast sensitivity term a sqrt(pi / b) exp(-pi^2 r^2 / b), r in degrees.
struct Gaussian {
    double a, b;
};
constexpr std::array<Gaussian, 1> achromatic = {{{1, 0.0047}}}, red_green = {{{1, 0.0053}}};
constexpr std::array<Gaussian, 2> blue_yellow = {{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double widest = 0.04;  // b that determines the size of all filters

using Opponent = std::array<Channel, 3>;

Opponent opponent_colours(const Image& image) {
    const Channel empty(image.width, image.height);
    Opponent planes{empty, empty, empty};
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const V3d colour = opponent_of_xyz(clamped(V3d(image.pixels[i])) * xyz_of_rgb);
        for (std::size_t c = 0; c < 3; ++c) planes[c].values[i] = static_cast<float>(colour[static_cast<int>(c)]);
    }
    return planes;
}

/// Blurs a channel by the contrast sensitivity of the eye.
Channel seen(const Channel& plane, std::span<const Gaussian> sensitivity, double pixels_per_degree) {
    using std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    std::vector<double> volumes;
    double volume = 0;
    const auto gaussian = [&](double b) {
        return [=](double x) { return std::exp(-pi * pi * x * x / (b * pixels_per_degree * pixels_per_degree)); };
    };
    for (const auto& [a, b] : sensitivity) {
        double sum = 0;
        for (int x = -radius; x <= radius; ++x) sum += gaussian(b)(x);
        volumes.push_back(a * std::sqrt(pi / b) * sum * sum);
        volume += volumes.back();
    }
    Channel result(plane.width, plane.height);
    for (std::size_t k = 0; k < sensitivity.size(); ++k) {
        const Kernel kernel = normalised_kernel(radius, gaussian(sensitivity[k].b));
        add_scaled(result.values, static_cast<float>(volumes[k] / volume), filter(plane, kernel, kernel).values.data());
    }
    return result;
}

Opponent seen(const Opponent& planes, double pixels_per_degree) {
    return {seen(planes[0], achromatic, pixels_per_degree), seen(planes[1], red_green, pixels_per_degree),
            seen(planes[2], blue_yellow, pixels_per_degree)};
}

V3d perceived_colour(const Opponent& planes, std::size_t pixel) {
    const V3d opponent(planes[0].values[pixel], planes[1].values[pixel], planes[2].values[pixel]);
    return perceived_colour(clamped(xyz_of_opponent(opponent) * rgb_of_xyz));
}

/// Power of the HyAB distance (Abasi et al. 2020), valid for large differences.
double compressed_distance(const V3d& a, const V3d& b) {
    constexpr double colour_exponent = 0.7;
    return std::pow(std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z), colour_exponent);
}

/// Returns the difference in [0, 1]. Distances up to 0.4 of the largest use 0.95 of the range.
double colour_difference(const V3d& a, const V3d& b) {
    constexpr double knee_share = 0.4, knee_value = 0.95;
    static const double largest = compressed_distance(perceived_colour(V3d(0, 1, 0)), perceived_colour(V3d(0, 0, 1)));
    const double distance = compressed_distance(a, b), knee = knee_share * largest;
    if (distance < knee) return knee_value * distance / knee;
    return knee_value + (1 - knee_value) * (distance - knee) / (largest - knee);
}

/// Returns the magnitude of the responses of a detector along both axes.
Channel response(const Channel& lightness, const Kernel& detector, const Kernel& blur) {
    const Channel across = filter(lightness, detector, blur), down = filter(lightness, blur, detector);
    Channel length = across;
    for (std::size_t i = 0; i < length.values.size(); ++i)
        length.values[i] = std::hypot(across.values[i], down.values[i]);
    return length;
}

struct Features {
    Channel edges, points;
};

/// Detects edges and points by derivatives of a Gaussian, as wide as edge detectors in the eye.
Features find_features(const Channel& achromatic_channel, double pixels_per_degree) {
    constexpr double width = 0.082;  // from peak to trough [degrees]
    const double deviation = 0.5 * width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto gaussian = [=](double x) { return std::exp(-x * x / (2 * deviation * deviation)); };
    const Kernel blur = normalised_kernel(radius, gaussian);
    const Kernel edge = normalised_kernel(radius, [=](double x) { return -x * gaussian(x); });
    const Kernel point =
        normalised_kernel(radius, [=](double x) { return (x * x / (deviation * deviation) - 1) * gaussian(x); });

    Channel lightness = achromatic_channel;
    for (float& value : lightness.values) value = (value + 16) / 116;  // in [0, 1]
    return {response(lightness, edge, blur), response(lightness, point, blur)};
}

double feature_difference(const Features& a, const Features& b, std::size_t pixel) {
    constexpr double feature_exponent = 0.5;
    const double edge = std::abs(a.edges.values[pixel] - b.edges.values[pixel]);
    const double point = std::abs(a.points.values[pixel] - b.points.values[pixel]);
    return std::pow(std::max(edge, point) / std::numbers::sqrt2, feature_exponent);
}

}  // namespace

Image flip_map(const Image& image, const Image& reference, const FlipOptions& options) {
    require_same_size(image, reference);
    const double pixels_per_degree = options.pixels_per_degree;
    if (!(pixels_per_degree > 0 && pixels_per_degree <= max_pixels_per_degree))
        throw InputError(fmt::format("{} pixels per degree: expected above 0, at most {}", pixels_per_degree,
                                     max_pixels_per_degree));
    const Opponent a = opponent_colours(image), b = opponent_colours(reference);
    const Features features_a = find_features(a[0], pixels_per_degree);
    const Features features_b = find_features(b[0], pixels_per_degree);
    const Opponent seen_a = seen(a, pixels_per_degree), seen_b = seen(b, pixels_per_degree);

    Image map(image.width, image.height);
    for_each_row(image.height, [&](int y) {
        for (int x = 0; x < image.width; ++x) {
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
            const double colour = colour_difference(perceived_colour(seen_a, i), perceived_colour(seen_b, i));
            const double feature = feature_difference(features_a, features_b, i);
            map.pixels[i] = Rgb(static_cast<float>(std::pow(colour, 1 - feature)));
        }
    });
    return map;
}

Image show_flip_map(const Image& map) {
    constexpr ColourScale scale{0, 1, Spacing::linear};
    Image picture = map;
    for (Rgb& pixel : picture.pixels) pixel = false_colour(scale.position(pixel.x));
    return with_legend(picture, scale, "FLIP: 0 looks the same, 1 as different as can be");
}

}  // namespace interflect
