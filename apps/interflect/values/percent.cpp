#include "apps/interflect/values/percent.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace interflect::command {

std::string percent(double share) {
    constexpr double largest = 9999;
    constexpr int max_decimals = 6;
    if (!std::isfinite(share)) return "-";
    const double hundredths = 100 * share;
    if (hundredths > largest) return fmt::format("over {}%", largest);
    if (!(hundredths > 0)) return "0%";
    // 9.96 rounds to 10, which needs no decimal.
    const double leading_digit = std::floor(std::log10(hundredths * 1.005));
    return fmt::format("{:.{}f}%", hundredths, std::clamp(1 - static_cast<int>(leading_digit), 0, max_decimals));
}

std::string text_of_error(const IterationReport& report) {
    const std::string all = percent(report.error_estimate);
    if (!(report.discretisation_estimate > 0)) return all + " (noise alone)";
    return fmt::format("{} (noise {}, mesh {})", all, percent(report.noise_estimate),
                       percent(report.discretisation_estimate));
}

}  // namespace interflect::command
