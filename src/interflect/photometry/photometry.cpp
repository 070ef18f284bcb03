#include "interflect/measure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace interflect {

namespace {

/// Returns the illuminance on a horizontal plane: the exact integral of luminance times cosine over the sky.
double horizontal_illuminance(const EnvironmentMap& map) {
    const Texture& image = *map.image;
    const auto height_squared = [&](std::uint32_t edge) {
        const double cosine = std::cos(std::numbers::pi * edge / image.height);
        return cosine > 0 ? cosine * cosine : 0;
    };
    double sum = 0;
    for (std::uint32_t y = 0; y < image.height; ++y) {
        double row = 0;
        for (std::uint32_t x = 0; x < image.width; ++x)
            row += luminance(RgbD(map.factor * image.texels[std::size_t{y} * image.width + x]));
        sum += row * std::numbers::pi / image.width * (height_squared(y) - height_squared(y + 1));
    }
    return sum;
}

}  // namespace

IlluminanceSummary summarise(std::span<const MeasuredIrradiance> measured, const SolutionError& solution_error) {
    IlluminanceSummary summary{.points = measured.size()};
    if (measured.empty()) return summary;
    double sum = 0, squared_error = 0;
    const MeasuredIrradiance* darkest = &measured.front();
    for (const MeasuredIrradiance& e : measured) {
        const auto value = static_cast<double>(e.illuminance());
        sum += value;
        squared_error += std::pow(static_cast<double>(e.illuminance_error()), 2);
        summary.max = std::max(summary.max, value);
        if (e.illuminance() < darkest->illuminance()) darkest = &e;
    }
    const auto count = static_cast<double>(measured.size());
    summary.mean = sum / count;
    summary.mean_error = std::sqrt(squared_error) / count;
    summary.min = static_cast<double>(darkest->illuminance());
    summary.min_error = static_cast<double>(darkest->illuminance_error());
    summary.mean_solution_error = solution_error.mean;
    summary.min_solution_error = solution_error.at(*darkest);
    return summary;
}

SolutionError estimate_solution_error(std::span<const MeasuredIrradiance> gathered, std::span<const std::size_t> chosen,
                                      std::span<const MeasuredIrradiance> traced) {
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    double count = 0, differences = 0, squares = 0, variances = 0, squared_variances = 0, indirect = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const MeasuredIrradiance &a = gathered[chosen[i]], &b = traced[i];
        if (!a.is_measured() || !b.is_measured()) continue;
        const auto difference = static_cast<double>(b.illuminance() - a.illuminance());
        const double variance = std::pow(static_cast<double>(a.illuminance_error()), 2) +
                                std::pow(static_cast<double>(b.illuminance_error()), 2);
        ++count;
        differences += difference;
        squares += difference * difference;
        variances += variance;
        squared_variances += variance * variance;
        indirect += std::pow(static_cast<double>(luminance(a.indirect)), 2);
    }
    if (!(count > 0)) return {unknown, unknown};
    if (!(indirect > 0)) return {};
    const double of_points = std::max(squares - variances, std::sqrt(squared_variances / 2));
    const double of_mean = std::max(differences * differences, variances / 2);
    const double not_chosen = 1 - count / static_cast<double>(gathered.size());
    return {std::sqrt(of_mean + not_chosen * of_points) / count, std::sqrt(of_points / indirect)};
}

std::optional<double> exterior_illuminance(const Scene& scene) {
    double sum = 0;
    for (const Luminaire& luminaire : scene.luminaires) {
        if (const auto* sky = std::get_if<UniformSky>(&luminaire.kind))
            sum += std::numbers::pi * luminance(RgbD(sky->radiance));
        if (const auto* dome = std::get_if<SkyDome>(&luminaire.kind)) sum += luminance(RgbD(dome->irradiance));
        if (const auto* map = std::get_if<EnvironmentMap>(&luminaire.kind)) sum += horizontal_illuminance(*map);
    }
    if (!(sum > 0)) return std::nullopt;
    return sum;
}

bool has_other_light_than_sky(const Scene& scene) {
    return !std::all_of(scene.luminaires.begin(), scene.luminaires.end(), is_sky) ||
           std::any_of(scene.patches.begin(), scene.patches.end(), [&](const Patch& patch) {
               return largest_channel(scene.materials[patch.material].exitance) > 0;
           });
}

}  // namespace interflect
