#include "interflect/light_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "interflect/core.h"

namespace interflect {

namespace {

double gradation(const SkyModel& m, double zenith_cosine) {
    constexpr double min_cosine = 1e-6;  // exp(b / cos Z) has reached its limit
    return std::max(0.0, 1 + double{m.a} * std::exp(double{m.b} / std::max(zenith_cosine, min_cosine)) +
                             double{m.g} * zenith_cosine);
}

double indicatrix(const SkyModel& m, double sun_cosine) {
    if (m.c == 0 && m.e == 0) return 1;
    const double chi = std::acos(std::clamp(sun_cosine, -1.0, 1.0));
    return std::max(0.0,
                    1 + double{m.c} * (std::exp(double{m.d} * chi) - std::exp(double{m.d} * std::numbers::pi / 2)) +
                        double{m.e} * sun_cosine * sun_cosine);
}

}  // namespace

double SkyModel::relative_luminance(double zenith_cosine, double sun_cosine) const {
    return gradation(*this, zenith_cosine) * indicatrix(*this, sun_cosine);
}

/// Midpoint rule over half of the sky, symmetric about the sun's meridian.
double SkyModel::horizontal_integral(double sun_cosine) const {
    constexpr int rows = 512, columns = 256;
    const double sun_sine = std::sqrt(std::max(0.0, 1 - sun_cosine * sun_cosine));
    double sum = 0;
    for (int row = 0; row < rows; ++row) {
        const double angle = std::numbers::pi / 2 * (row + 0.5) / rows, cosine = std::cos(angle),
                     sine = std::sin(angle);
        double of_row = 0;
        for (int column = 0; column < columns; ++column) {
            const double azimuth = std::numbers::pi * (column + 0.5) / columns;
            of_row += indicatrix(*this, cosine * sun_cosine + sine * sun_sine * std::cos(azimuth));
        }
        sum += of_row * gradation(*this, cosine) * cosine * sine;
    }
    return std::numbers::pi * std::numbers::pi * sum / (rows * columns);
}

SkyModel cie_standard_sky(int type) {
    constexpr std::array<SkyModel, 16> types = {{
        {4, -0.7f, 0, -1, 0},  // 1: steep overcast
        {4, -0.7f, 2, -1.5f, 0.15f},
        {1.1f, -0.8f, 0, -1, 0},
        {1.1f, -0.8f, 2, -1.5f, 0.15f},
        {0, -1, 0, -1, 0},  // 5: uniform
        {0, -1, 2, -1.5f, 0.15f},
        {0, -1, 5, -2.5f, 0.3f},  // 7: partly cloudy
        {0, -1, 10, -3, 0.45f},
        {-1, -0.55f, 2, -1.5f, 0.15f},
        {-1, -0.55f, 5, -2.5f, 0.3f},
        {-1, -0.55f, 10, -3, 0.45f},
        {-1, -0.32f, 10, -3, 0.45f},  // 12: clear, low turbidity
        {-1, -0.32f, 16, -3, 0.3f},
        {-1, -0.15f, 16, -3, 0.3f},
        {-1, -0.15f, 24, -2.8f, 0.15f},
        {0, -1, 0, -1, 0, 2},  // 16: traditional overcast
    }};
    if (type < 1 || type > static_cast<int>(types.size()))
        throw InputError(fmt::format("unknown CIE sky {}; expected type 1 to {}", type, types.size()));
    return types[static_cast<std::size_t>(type - 1)];
}

int cie_sky_type(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, int>, 4> names = {
        {{"overcast", 1}, {"uniform", 5}, {"intermediate", 7}, {"clear", 12}}};
    for (const auto& [known, type] : names)
        if (name == known) return type;
    constexpr int last_type = 16;
    for (int type = 1; type <= last_type; ++type)
        if (name == fmt::format("cie-{}", type)) return type;
    return 0;
}

std::string sky_fault(const SkyModel& m) {
    constexpr float largest_parameter = 1000;
    for (const float x : {m.a, m.b, m.c, m.d, m.e, m.g})
        if (!(std::abs(x) <= largest_parameter)) return fmt::format("has a parameter {} beyond 1000", x);
    if (m.b > 0)
        return fmt::format("has b = {}: it would be infinitely bright at the horizon; expected 0 or less", m.b);
    const double all = m.horizontal_integral(1);
    if (!(all > 0 && std::isfinite(all))) return "has no luminance, or an infinite one";
    return {};
}

}  // namespace interflect
