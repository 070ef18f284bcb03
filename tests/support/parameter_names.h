#pragma once
/// Names of tests with parameters. tests/layers checks that each name is short and the same in every build.
///
/// A type of a test file prints its name, and its suite is named with printed_name or
/// testing::PrintToStringParamName():
///     void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <ostream>
#include <string>
#include <string_view>

#include "interflect/export.h"
#include "interflect/image.h"
#include "interflect/shading.h"
#include "interflect/solve_options.h"

namespace interflect {

inline void PrintTo(Shading shading, std::ostream* out) { *out << label(shading); }

inline void PrintTo(PointSet points, std::ostream* out) { *out << (points == PointSet::sobol ? "sobol" : "random"); }

inline void PrintTo(ImportanceUse use, std::ostream* out) {
    constexpr std::array names{"off", "direct", "full"};
    *out << names.at(static_cast<std::size_t>(use));
}

inline void PrintTo(LightmapContent content, std::ostream* out) {
    *out << (content == LightmapContent::irradiance ? "irradiance" : "radiance");
}

inline void PrintTo(Tonemap curve, std::ostream* out) {
    constexpr std::array names{"srgb", "reinhard", "filmic", "agx", "ward", "tumblin", "ferwerda"};
    *out << names.at(static_cast<std::size_t>(curve));
}

namespace testing_support {

/// Names a test after its printed parameter without quotes and brackets: Furnace.IsEvenlyLit/0_5.
inline constexpr auto printed_name = [](const auto& test) {
    std::string name = testing::PrintToString(test.param);
    std::erase_if(name, [](char c) { return std::string_view("\"(){}").find(c) != std::string_view::npos; });
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
};

}  // namespace testing_support
}  // namespace interflect
