#include "interflect/photometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/luminaires/illumination.h"

namespace interflect {

IlluminanceSummary summarise(std::span<const MeasuredIrradiance> measured) {
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
    return summary;
}

std::optional<double> exterior_illuminance(const Scene& scene) {
    const double radiance = luminance(RgbD(sky_radiance(scene)));
    if (!(radiance > 0)) return std::nullopt;
    return std::numbers::pi * radiance;  // of a uniform hemisphere
}

bool has_other_light_than_sky(const Scene& scene) {
    const auto is_no_sky = [](const Luminaire& l) { return !std::holds_alternative<UniformSky>(l.kind); };
    return std::any_of(scene.luminaires.begin(), scene.luminaires.end(), is_no_sky) ||
           std::any_of(scene.patches.begin(), scene.patches.end(), [&](const Patch& patch) {
               return largest_channel(scene.materials[patch.material].exitance) > 0;
           });
}

}  // namespace interflect
