#include "interflect/shading.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/core.h"

namespace interflect {

namespace {

int default_count(Shading shading, LightUse use) { return default_samples[static_cast<std::size_t>(shading)].*use; }

[[noreturn]] void refuse(const std::string& found, LightUse use) {
    const std::vector<Shading> available = available_shadings(use);
    std::string expected;
    for (const Shading shading : available) {
        const char* separator = shading == available.front() ? "" : shading == available.back() ? " or " : ", ";
        expected += separator + std::string(label(shading));
    }
    throw InputError(fmt::format("shading: expected {}, found '{}'", expected, found));
}

}  // namespace

std::vector<Shading> available_shadings(LightUse use) {
    std::vector<Shading> available;
    for (std::size_t i = 0; i < shading_labels.size(); ++i)
        if (const auto shading = static_cast<Shading>(i); default_count(shading, use) > 0) available.push_back(shading);
    return available;
}

int require_samples(Shading shading, LightUse use, int samples) {
    const int count = default_count(shading, use);
    if (count == 0) refuse(label(shading), use);
    return samples == 0 ? count : samples;
}

Shading find_shading(const std::string& text, LightUse use) {
    for (const Shading shading : available_shadings(use))
        if (label(shading) == text) return shading;
    refuse(text, use);
}

}  // namespace interflect
