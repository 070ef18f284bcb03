#include "apps/interflect/options/shading_options.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "apps/interflect/values/parse.h"

namespace interflect::command {

namespace {

/// Descriptions for the help, indexed by Shading. The argument is the place where light is computed.
constexpr std::array<fmt::format_string<const std::string&>, shading_labels.size()> descriptions{
    "one value an element",
    "interpolated between the elements",
    "direct light of each {}, indirect light interpolated",
    "each {} finds its own light, from the solution",
    "path tracing, without solving",
    "virtual lights, without solving"};

}  // namespace

CLI::Option* add_shading(CLI::App& app, Shading& shading, LightUse use, const std::string& place) {
    std::vector<std::pair<std::string, Shading>> choices;
    std::string help;
    for (const Shading available : available_shadings(use)) {
        choices.emplace_back(label(available), available);
        help += fmt::format("{}{}: ", help.empty() ? "" : "; ", label(available)) +
                fmt::format(descriptions[static_cast<std::size_t>(available)], place);
    }
    return add_choice<Shading>(app, "--shading", shading, choices, help)->default_str(label(shading));
}

std::string text_of_default_samples(LightUse use) {
    std::string text;
    for (const Shading shading : available_shadings(use))
        if (const int samples = require_samples(shading, use); samples > 1)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", label(shading), samples);
    return text;
}

}  // namespace interflect::command
