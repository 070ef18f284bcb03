#include "apps/interflect/solving/setup_warnings.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <utility>

namespace interflect::command {

std::string text_of(const Finding::Place& place) {
    std::string text = place.where;
    const auto append = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
    if (!place.object.empty()) append(fmt::format("object '{}'", place.object));
    // Many programs give a light its object's name.
    if (!place.material.empty() && place.material != place.object) append(fmt::format("'{}'", place.material));
    if (place.has_position)
        append(fmt::format("at ({:.6g}, {:.6g}, {:.6g})", place.position.x, place.position.y, place.position.z));
    return text;
}

std::string remedy(const Finding& finding) {
    constexpr std::pair<const char*, const char*> options[] = {
        {"implausible-size", "--unit"},    {"probable-unit", "--unit"},
        {"probable-up-axis", "--up-axis"}, {"maintenance-factor", "maintenance=FACTOR"},
        {"mixed-photometry", "turn=90"},   {"sunk-luminaire", "mount=top; in MGF: ies FILE -top"}};
    for (const auto& entry : options)
        if (finding.kind == entry.first) return fmt::format("{} ({})", finding.advice, entry.second);
    return finding.advice;
}

void warn_of_setup(const Scene& scene, const RayCaster& ray_caster) {
    for (const Finding& finding : validate_setup(scene, ray_caster, {.places = 1})) {
        const std::string first = finding.places.empty() ? "" : text_of(finding.places.front());
        const std::string more = finding.count > 1 ? fmt::format(" and {} more", finding.count - 1) : "";
        spdlog::warn("{}{}{}{}; {}", finding.message, first.empty() ? "" : ": ", first, more, remedy(finding));
    }
}

}  // namespace interflect::command
