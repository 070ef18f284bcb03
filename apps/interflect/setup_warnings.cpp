#include "apps/interflect/setup_warnings.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace interflect::command {

std::string text_of(const Finding::Place& place) {
    std::string text = place.where;
    const auto append = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (!place.object.empty()) append(fmt::format("object '{}'", place.object));
    if (!place.material.empty()) append(fmt::format("'{}'", place.material));
    if (place.has_position)
        append(fmt::format("at ({:.6g}, {:.6g}, {:.6g})", place.position.x, place.position.y, place.position.z));
    return text;
}

void warn_of_setup(const Scene& scene, const RayCaster& ray_caster) {
    for (const Finding& finding : validate_setup(scene, ray_caster, {.places = 1})) {
        const std::string first = finding.places.empty() ? "" : text_of(finding.places.front());
        const std::string more = finding.count > 1 ? fmt::format(" and {} more", finding.count - 1) : "";
        spdlog::warn("{}{}{}{}; {}", finding.message, first.empty() ? "" : ": ", first, more, finding.advice);
    }
}

}  // namespace interflect::command
