#include "interflect/luminaires/web_sampler.h"

#include <algorithm>
#include <cmath>

#include "interflect/scene/core/web_angles.h"

namespace interflect::detail {

namespace {

/// Returns x in [0, 1] where the integral of a linear function from a to b reaches `share` of its total.
double invert_linear(double a, double b, double share) {
    const double whole = (a + b) / 2;
    if (!(whole > 0)) return share;
    const double root = std::sqrt(std::max(0.0, a * a + (b * b - a * a) * share));
    return std::clamp(2 * whole * share / (a + root), 0.0, 1.0);
}

/// Returns t in [t0, t1] [rad] where the integral of sin t times a linear function from a to b reaches `target`.
double invert_band(double t0, double t1, double a, double b, double target) {
    constexpr int max_steps = 24;
    constexpr double precision = 1e-9;  // [radians]
    const double slope = (b - a) / (t1 - t0);
    double low = t0, high = t1, t = (t0 + t1) / 2;
    for (int i = 0; i < max_steps; ++i) {
        const double value = a + slope * (t - t0);
        const double excess = a * std::cos(t0) - value * std::cos(t) + slope * (std::sin(t) - std::sin(t0)) - target;
        (excess > 0 ? high : low) = t;
        const double density = value * std::sin(t);
        double next = density > 0 ? t - excess / density : low;
        if (!(next > low && next < high)) next = (low + high) / 2;
        const bool is_close = std::abs(next - t) < precision;
        t = next;
        if (is_close) break;
    }
    return t;
}

std::vector<double> all_radians(const std::vector<float>& angles) {
    std::vector<double> result;
    result.reserve(angles.size());
    for (const float angle : angles) result.push_back(radians(angle));
    return result;
}

}  // namespace

WebSampler::WebSampler(const PhotometricWeb& web)
    : pole_(web.pole),
      polar_(all_radians(web.polar)),
      azimuth_(all_radians(web.azimuth)),
      intensities_(web.intensities) {
    const std::size_t height = polar_.size();
    for (std::size_t i = 0; i < azimuth_.size(); ++i) {
        const float* column = web.at_azimuth(i);
        double sum = 0;
        cumulative_.push_back(0);
        for (std::size_t j = 0; j + 1 < height; ++j) {
            const BandWeights weights(polar_[j], polar_[j + 1]);
            cumulative_.push_back(sum += weights.at_a * column[j] + weights.at_b * column[j + 1]);
        }
        if (i == 0) {
            azimuth_flux_.push_back(0);
            continue;
        }
        const double mean = (cumulative_[i * height - 1] + sum) / 2;
        azimuth_flux_.push_back(azimuth_flux_.back() + mean * (azimuth_[i] - azimuth_[i - 1]));
    }
}

WebSampler::Azimuth WebSampler::azimuth_at(double flux) const {
    const auto above = std::upper_bound(azimuth_flux_.begin() + 1, azimuth_flux_.end() - 1, flux);
    const auto index = static_cast<std::size_t>(above - azimuth_flux_.begin()) - 1;
    const double below = azimuth_flux_[index], of_sector = azimuth_flux_[index + 1] - below;
    const std::size_t height = polar_.size();
    const double a = cumulative_[(index + 1) * height - 1], b = cumulative_[(index + 2) * height - 1];
    return {index, invert_linear(a, b, of_sector > 0 ? (flux - below) / of_sector : 0)};
}

double WebSampler::polar_at(const Azimuth& azimuth, float v) const {
    const std::size_t height = polar_.size();
    const auto mixed = [&](const auto& table, std::size_t j) {
        const double left = table[azimuth.index * height + j], right = table[(azimuth.index + 1) * height + j];
        return left + (right - left) * azimuth.share;
    };
    const double target = v * mixed(cumulative_, height - 1);
    std::size_t low = 0, high = height - 1;
    while (high - low > 1) {
        const std::size_t middle = (low + high) / 2;
        (mixed(cumulative_, middle) > target ? high : low) = middle;
    }
    return invert_band(polar_[low], polar_[high], mixed(intensities_, low), mixed(intensities_, high),
                       target - mixed(cumulative_, low));
}

V3f WebSampler::direction(float u, float v) const {
    const Azimuth azimuth = azimuth_at(u * flux());
    const double phi =
        azimuth_[azimuth.index] + azimuth.share * (azimuth_[azimuth.index + 1] - azimuth_[azimuth.index]);
    const double theta = polar_at(azimuth, v);
    const WebAxes axes(pole_);
    const auto along = static_cast<float>(std::cos(theta)), a = static_cast<float>(std::sin(theta) * std::cos(phi)),
               b = static_cast<float>(std::sin(theta) * std::sin(phi));
    return axes.pole * along + axes.zero * a + axes.quarter * b;
}

}  // namespace interflect::detail
