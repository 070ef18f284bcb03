#pragma once

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "interflect/core.h"
#include "interflect/export.h"
#include "interflect/load.h"
#include "interflect/measure.h"
#include "interflect/scene.h"

namespace interflect::command {

// Each function parses a whole text, or throws std::invalid_argument with the expected and the found text.

/// "20M" -> 20'000'000: a positive number, with k, M, G or T for powers of a thousand.
std::int64_t parse_count(const std::string& text);
/// Parses a count of at most 4G.
std::size_t parse_element_count(const std::string& text);
/// Parses a count of at most max_rays_per_iteration.
std::int64_t parse_iteration_size(const std::string& text);
/// "1.5G" -> 1.5 * 2^30 [bytes]: with k, M, G or T for powers of 1024.
std::size_t parse_memory(const std::string& text);
/// "90", "90s", "1.5m", "2h" -> seconds, from 0.1 to 10^9.
double parse_duration(const std::string& text);
/// "cm" -> 0.01, "0.0254" -> 0.0254: a length [m], from 1e-9 to 1e9.
double parse_unit(const std::string& text);
/// "42" -> 42: an integer of 64 bits, >= 0.
std::uint64_t parse_seed(const std::string& text);
/// "2%" or "0.02" -> 0.02, above 0 and below 1.
double parse_share(const std::string& text);
/// "1,2.5,-3" -> (1, 2.5, -3), within reach (is_within_reach()).
Imath::V3d parse_vector(const std::string& text);
/// "x=3" -> {(3, 0, 0), (1, 0, 0)}, "-z=1" -> {(0, 0, 1), (0, 0, -1)}, "1,2,3,0,1,1" -> {(1, 2, 3), (0, 1, 1)}.
struct Section {
    Imath::V3d point{0, 0, 0};      // [m]
    Imath::V3d direction{1, 0, 0};  // of view; not zero
};
Section parse_section(const std::string& text);
/// "0,0,1:2,0,1:5" -> from (0, 0, 1) to (2, 0, 1) with 5 points, from 2 to 10^6; default 11. The ends differ.
struct Line {
    Imath::V3d a{0, 0, 0}, b{0, 0, 0};  // [m]
    int count = 11;
};
Line parse_line(const std::string& text);
/// "2,1,1.2:0,1,0" -> eye and line of sight.
Observer parse_observer(const std::string& text);
/// "lamp.ies@1,2,3" -> file and position. An aim point, `turn`, `lumens`, `maintenance` and `mount=top`
/// (PlacedLuminaire) may follow, such as ",4,5,0,turn=90".
PlacedLuminaire parse_luminaire(const std::string& text);
/// "desk=lamps.desk*" -> group "desk" of the sources that match "lamps.desk*".
LightGroup parse_light_group(const std::string& text);
/// "desk=0.3" -> {"desk", 0.3}: a factor from 0 to 10^12.
struct Dimmed {
    std::string group;
    float factor = 1;
};
Dimmed parse_dimmed(const std::string& text);
/// "chair*=50" -> 50 texels per metre on objects or materials that match "chair*".
TexelDensity parse_density(const std::string& text);
/// "overcast", "clear:9000" -> CIE sky, with its horizontal illuminance [lx]; "perez:600,120" -> Perez sky with these
/// irradiances [W/m^2].
struct Sky {
    std::optional<Daylight::CieSky> cie{};
    std::optional<Daylight::PerezSky> perez{};
};
Sky parse_sky(const std::string& text);
/// "200,35", "200,35,80000" -> azimuth and altitude [degrees], illuminance [lx].
Daylight::Sun parse_sun(const std::string& text);
/// "sky.exr", "sky.exr,90", "sky.exr,90,2.5" -> file, rotation [degrees], scale.
Daylight::Environment parse_environment(const std::string& text);
/// "640x360" -> {640, 360}, each from 1 to 32768.
struct Size {
    int width = 1280, height = 720;
    std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};
Size parse_size(const std::string& text);
/// "2" -> {2, absolute}; "auto", "auto+1", "auto-0.5" -> 0, 1, -0.5 relative to the automatic exposure [stops], from
/// -100 to 100.
struct Exposure {
    float stops = 0;
    bool relative = true;
};
Exposure parse_exposure(const std::string& text);
/// "50..2000" -> {50, 2000}: rising, from 0 to 10^12.
struct Range {
    float low = 0, high = 1;
};
Range parse_range(const std::string& text);
/// "auto" -> empty, "100,300,500" -> these: numbers above 0 to 10^12.
std::vector<float> parse_isolines(const std::string& text);
/// "0.05" -> 0.05, above 0; "auto" -> automatic_mesh_size; "none" -> whole_patches.
float parse_mesh_size(const std::string& text);
inline constexpr float automatic_mesh_size = 0, whole_patches = -1;

/// Invalid combination of options (exit code 2). The message names them.
using UsageError = CLI::ValidationError;

/// Calls `check` and converts its InputError to a UsageError of option `name`.
template <class Check>
auto check_option(const std::string& name, const Check& check) {
    try {
        return check();
    } catch (const InputError& e) {
        throw UsageError(name, e.what());
    }
}

/// Accepts finite numbers. CLI::Range also accepts NaN, and prints bounds with 300 digits.
CLI::Validator number_between(double low, double high);

/// Adds an option with a function above as parser; errors name the option.
template <class Value, class Parsed>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Value& value, Parsed (*parse)(const std::string&),
                        const std::string& help) {
    const auto set = [name, &value, parse](const std::string& text) {
        try {
            value = parse(text);
        } catch (const std::invalid_argument& e) {
            throw CLI::ValidationError(name, e.what());
        }
    };
    return app.add_option_function<std::string>(name, set, help);
}

/// Adds an option that may be repeated.
template <class Value>
CLI::Option* add_each(CLI::App& app, const std::string& name, std::vector<Value>& values,
                      Value (*parse)(const std::string&), const std::string& help) {
    const auto add = [name, &values, parse](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) try {
                values.push_back(parse(text));
            } catch (const std::invalid_argument& e) {
                throw CLI::ValidationError(name, e.what());
            }
    };
    return app.add_option_function<std::vector<std::string>>(name, add, help)->allow_extra_args(false);
}

/// Adds an option with a few words, listed in the help. Target is Value or std::optional<Value>.
template <class Value, class Target>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Target& value,
                        const std::vector<std::pair<std::string, Value>>& choices, const std::string& help) {
    std::string words;
    for (const auto& [word, ignored] : choices) words += (words.empty() ? "" : "|") + word;
    const auto set = [name, &value, choices, words](const std::string& text) {
        const auto is_meant = [&](const auto& choice) { return choice.first == text; };
        const auto choice = std::find_if(choices.begin(), choices.end(), is_meant);
        if (choice == choices.end()) throw CLI::ValidationError(name, "expected " + words + ", found '" + text + "'");
        value = choice->second;
    };
    return app.add_option_function<std::string>(name, set, help)->type_name(words);
}

}  // namespace interflect::command
