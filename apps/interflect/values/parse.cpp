#include "apps/interflect/values/parse.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <set>

#include "interflect/scene.h"
#include "interflect/solve_options.h"

namespace interflect::command {

using namespace detail;

namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& expected) {
    throw std::invalid_argument("expected " + expected + ", found '" + text + "'");
}

/// Reads and removes a finite number; returns whether it succeeds.
bool take_number(std::string_view& text, double& number) {
    if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || !std::isfinite(number)) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

bool take(std::string_view& text, char c) {
    if (!text.starts_with(c)) return false;
    text.remove_prefix(1);
    return true;
}

/// Reads three numbers within reach.
bool take_vector(std::string_view& text, Imath::V3d& v) {
    return take_number(text, v.x) && take(text, ',') && take_number(text, v.y) && take(text, ',') &&
           take_number(text, v.z) && is_within_reach(v);
}

/// Reads a number from 1 to 10^18 that may end in k, M, G or T for powers of `thousand`.
std::int64_t parse_with_suffix(const std::string& text, double thousand, const char* expected) {
    std::string_view rest = text;
    double number = 0;
    if (!take_number(rest, number)) refuse(text, expected);
    // npos + 1 is 0: an unknown suffix.
    const std::size_t power = rest.empty() ? 0 : std::string_view("kMGT").find(rest.front()) + 1;
    if (rest.size() > 1 || (power == 0 && !rest.empty())) refuse(text, expected);
    number *= std::pow(thousand, static_cast<double>(power));
    if (!(number >= 1) || number > 1e18) refuse(text, expected);
    return std::llround(number);
}

/// Splits "name=value" at the last '='.
std::pair<std::string, std::string> name_and_value(const std::string& text, const char* expected) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) refuse(text, expected);
    return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

std::int64_t parse_count(const std::string& text) {
    return parse_with_suffix(text, 1000, "a number above 0, such as 500000, 20M or 1.5G");
}

std::size_t parse_memory(const std::string& text) {
    return static_cast<std::size_t>(parse_with_suffix(text, 1024, "a number of bytes above 0, such as 800M or 16G"));
}

std::size_t parse_element_count(const std::string& text) {
    const std::int64_t count = parse_count(text);
    if (count > 4'000'000'000) refuse(text, "a number of at most 4G");
    return static_cast<std::size_t>(count);
}

std::int64_t parse_iteration_size(const std::string& text) {
    const std::int64_t count = parse_count(text);
    if (count > max_rays_per_iteration) refuse(text, "a number of at most 100G");
    return count;
}

double parse_unit(const std::string& text) {
    constexpr std::pair<std::string_view, double> units[] = {{"m", 1},     {"cm", 0.01},   {"mm", 0.001},
                                                             {"km", 1000}, {"in", 0.0254}, {"ft", 0.3048}};
    for (const auto& [name, metres] : units)
        if (text == name) return metres;
    double metres = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, metres);
    if (error != std::errc() || stop != end || !(metres >= 1e-9 && metres <= 1e9))
        refuse(text, "m, cm, mm, km, in, ft or a length in metres from 1e-9 to 1e9");
    return metres;
}

double parse_duration(const std::string& text) {
    double number = 0;
    const char* const end = text.data() + text.size();
    const auto [unit, error] = std::from_chars(text.data(), end, number);
    const std::string_view word(unit, static_cast<std::size_t>(end - unit));
    const double seconds = number * (word == "h" ? 3600 : word == "m" ? 60 : 1);
    const bool is_known = word.empty() || word == "s" || word == "m" || word == "h";
    if (error != std::errc() || !is_known || !(seconds >= 0.1 && seconds <= 1e9))
        refuse(text, "a time of 0.1 s or more, such as 30s, 5m or 2h");
    return seconds;
}

std::uint64_t parse_seed(const std::string& text) {
    std::uint64_t seed = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
    if (error != std::errc() || end != text.data() + text.size()) refuse(text, "a whole number from 0 to 2^64 - 1");
    return seed;
}

double parse_share(const std::string& text) {
    std::string_view rest = text;
    double number = 0;
    bool parsed = take_number(rest, number);
    if (parsed && take(rest, '%')) number /= 100;
    if (!parsed || !rest.empty() || !(number > 0 && number < 1))
        refuse(text, "a share between 0 and 1, such as 2% or 0.02");
    return number;
}

Imath::V3d parse_vector(const std::string& text) {
    std::string_view rest = text;
    Imath::V3d v(0);
    if (!take_vector(rest, v) || !rest.empty())
        refuse(text, "three numbers with commas between, from -1e15 to 1e15, such as 1,2.5,-3");
    return v;
}

Line parse_line(const std::string& text) {
    constexpr double max_points = 1e6;
    std::string_view rest = text;
    Line line;
    double count = line.count;
    const bool parsed = take_vector(rest, line.a) && take(rest, ':') && take_vector(rest, line.b) &&
                        (rest.empty() || (take(rest, ':') && take_number(rest, count) && rest.empty()));
    if (!parsed || line.a == line.b || !(count >= 2 && count <= max_points && count == std::floor(count)))
        refuse(text, "two different ends and perhaps a number of points from 2 to 1e6, such as 0,1,0.75:4,1,0.75:9");
    line.count = static_cast<int>(count);
    return line;
}

Observer parse_observer(const std::string& text) {
    std::string_view rest = text;
    Imath::V3d eye, direction;
    const bool parsed = take_vector(rest, eye) && take(rest, ':') && take_vector(rest, direction) && rest.empty();
    if (!parsed || direction == Imath::V3d(0)) refuse(text, "an eye and the way that it looks, such as 2,1,1.2:0,1,0");
    return {eye, V3f(direction)};
}

Section parse_section(const std::string& text) {
    constexpr const char* expected = "a plane such as x=3 or -y=2.5, or a point on it and a direction, X,Y,Z,DX,DY,DZ";
    std::string_view rest = text;
    Section section;
    const double sign = take(rest, '-') ? -1 : 1;
    for (int axis = 0; axis < 3; ++axis) {
        if (!take(rest, "xyz"[axis])) continue;
        double value = 0;
        if (!take(rest, '=') || !take_number(rest, value) || !rest.empty() || !(std::abs(value) <= farthest_coordinate))
            refuse(text, expected);
        section.direction = Imath::V3d(0);
        section.point[axis] = value;
        section.direction[axis] = sign;
        return section;
    }
    rest = text;
    for (int i = 0; i < 6; ++i) {
        double& number = i < 3 ? section.point[i] : section.direction[i - 3];
        if ((i > 0 && !take(rest, ',')) || !take_number(rest, number)) refuse(text, expected);
    }
    if (!rest.empty() || !is_within_reach(section.point) || !is_within_reach(section.direction) ||
        !(section.direction.length() > 0))
        refuse(text, expected);
    return section;
}

PlacedLuminaire parse_luminaire(const std::string& text) {
    constexpr const char* expected =
        "FILE@X,Y,Z[,AX,AY,AZ][,turn=DEGREES][,lumens=LM][,maintenance=FACTOR][,mount=top], such as lamp.ies@2,1.5,2.7";
    const std::size_t at = text.rfind('@');
    if (at == 0 || at == text.npos) refuse(text, expected);
    PlacedLuminaire placed{.file = text.substr(0, at)};
    std::string_view rest = std::string_view(text).substr(at);
    std::vector<double> places;
    for (double number = 0; !rest.empty(); places.push_back(number)) {
        std::string_view after = rest.substr(1);
        if (rest.front() != (places.empty() ? '@' : ',') || !take_number(after, number)) break;
        rest = after;
    }
    constexpr std::size_t position_alone = 3, with_aim = 6;
    if (places.size() != position_alone && places.size() != with_aim) refuse(text, expected);
    placed.position = {places[0], places[1], places[2]};
    if (places.size() == with_aim) placed.aim = Imath::V3d(places[3], places[4], places[5]);
    if (!is_within_reach(placed.position) || !is_within_reach(placed.aim.value_or(placed.position)))
        refuse(text, "coordinates from -1e15 to 1e15");
    if (placed.aim == placed.position) refuse(text, "an aim AX,AY,AZ apart from the position X,Y,Z");
    std::set<std::string_view> given;
    const auto take_value = [&](std::string_view name, double& value) {
        if (!rest.starts_with(name)) return false;
        rest.remove_prefix(name.size());
        if (!take_number(rest, value)) refuse(text, expected);
        if (!given.insert(name).second) refuse(text, "turn, lumens and maintenance once each");
        return true;
    };
    while (!rest.empty()) {
        double lumens = 0;
        constexpr std::string_view mount = ",mount=top";
        if (rest.starts_with(mount) && !placed.by_top) {
            placed.by_top = true;
            rest.remove_prefix(mount.size());
        } else if (take_value(",lumens=", lumens)) {
            placed.lumens = lumens;
        } else if (!take_value(",turn=", placed.turn) && !take_value(",maintenance=", placed.maintenance)) {
            refuse(text, expected);
        }
    }
    if (placed.lumens.value_or(0) < 0 || placed.maintenance < 0) refuse(text, "lumens and maintenance of at least 0");
    return placed;
}

LightGroup parse_light_group(const std::string& text) {
    auto [name, pattern] = name_and_value(text, "NAME=PATTERN, such as desk=lamps.desk*");
    return {std::move(name), std::move(pattern)};
}

Dimmed parse_dimmed(const std::string& text) {
    constexpr const char* expected = "GROUP=FACTOR, such as desk=0.3, with a factor from 0 to 1e12";
    auto [group, value] = name_and_value(text, expected);
    std::string_view rest = value;
    double factor = 0;
    if (!take_number(rest, factor) || !rest.empty() || !(factor >= 0 && factor <= 1e12)) refuse(text, expected);
    return {std::move(group), static_cast<float>(factor)};
}

TexelDensity parse_density(const std::string& text) {
    constexpr const char* expected =
        "PATTERN=N, such as chair*=50, with 1e-6 to 1e6 texels per metre, or 0 for no lightmap";
    auto [pattern, value] = name_and_value(text, expected);
    std::string_view rest = value;
    double density = 0;
    if (!take_number(rest, density) || !rest.empty() || !(density == 0 || (density >= 1e-6 && density <= 1e6)))
        refuse(text, expected);
    return {std::move(pattern), static_cast<float>(density)};
}

Sky parse_sky(const std::string& text) {
    constexpr const char* expected =
        "overcast, intermediate, clear, uniform or cie-1 to cie-16, each with :LUX or without, or "
        "perez:DIRECT,DIFFUSE, such as clear:12000; no number below 0";
    const std::size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    std::string_view rest = std::string_view(text).substr(std::min(colon, text.size()));
    double first = 0, second = 0;
    if (name == "perez") {
        if (!take(rest, ':') || !take_number(rest, first) || !take(rest, ',') || !take_number(rest, second) ||
            !rest.empty() || first < 0 || second < 0)
            refuse(text, expected);
        return {.perez = Daylight::PerezSky{first, second}};
    }
    Daylight::CieSky sky{.type = cie_sky_type(name)};
    if (sky.type == 0) refuse(text, expected);
    if (take(rest, ':')) {
        if (!take_number(rest, first) || first < 0) refuse(text, expected);
        sky.illuminance = first;
    }
    if (!rest.empty()) refuse(text, expected);
    return {.cie = sky};
}

Daylight::Sun parse_sun(const std::string& text) {
    constexpr const char* expected = "AZIMUTH,ALTITUDE[,LUX], such as 200,35: degrees, the altitude above 0 to 90";
    std::string_view rest = text;
    Daylight::Sun sun;
    double lux = 0;
    const bool parsed = take_number(rest, sun.azimuth) && take(rest, ',') && take_number(rest, sun.altitude);
    if (!parsed || !(sun.altitude > 0 && sun.altitude <= 90)) refuse(text, expected);
    if (take(rest, ',')) {
        if (!take_number(rest, lux) || lux < 0) refuse(text, expected);
        sun.illuminance = lux;
    }
    if (!rest.empty()) refuse(text, expected);
    return sun;
}

Daylight::Environment parse_environment(const std::string& text) {
    constexpr const char* expected = "FILE[,ROTATION[,SCALE]], such as sky.exr,90: degrees, and a factor of at least 0";
    constexpr std::size_t max_numbers = 2;
    std::vector<double> numbers;
    std::size_t end = text.size();
    for (std::size_t comma = text.rfind(','); comma != text.npos && numbers.size() < max_numbers;
         comma = text.rfind(',', comma - 1)) {
        std::string_view part = std::string_view(text).substr(comma + 1, end - comma - 1);
        double number = 0;
        if (!take_number(part, number) || !part.empty()) break;
        numbers.insert(numbers.begin(), number);
        end = comma;
        if (comma == 0) break;
    }
    if (end == 0) refuse(text, expected);
    Daylight::Environment environment{.file = text.substr(0, end)};
    if (!numbers.empty()) environment.rotation = numbers[0];
    if (numbers.size() == max_numbers) environment.scale = numbers[1];
    if (environment.scale < 0) refuse(text, expected);
    return environment;
}

Size parse_size(const std::string& text) {
    std::string_view rest = text;
    double width = 0, height = 0;
    const bool parsed = take_number(rest, width) && take(rest, 'x') && take_number(rest, height) && rest.empty();
    const auto is_valid_extent = [](double n) { return n >= 1 && n <= 32768 && n == std::floor(n); };
    if (!parsed || !is_valid_extent(width) || !is_valid_extent(height))
        refuse(text, "WIDTHxHEIGHT, such as 640x360, each from 1 to 32768");
    return {static_cast<int>(width), static_cast<int>(height)};
}

Exposure parse_exposure(const std::string& text) {
    constexpr double most = 100;
    constexpr std::string_view automatic = "auto";
    std::string_view rest = text;
    Exposure exposure{.relative = rest.starts_with(automatic)};
    if (exposure.relative) rest.remove_prefix(automatic.size());
    if (exposure.relative && rest.empty()) return exposure;
    const bool has_sign = rest.starts_with('+') || rest.starts_with('-');
    double stops = 0;
    const bool parsed = (has_sign || !exposure.relative) && take_number(rest, stops) && rest.empty();
    if (!parsed || std::abs(stops) > most)
        refuse(text, "stops from -100 to 100, such as 2, or auto, or stops from there, such as auto+1");
    exposure.stops = static_cast<float>(stops);
    return exposure;
}

Range parse_range(const std::string& text) {
    constexpr double highest = 1e12;
    const std::size_t dots = text.find("..");
    std::string_view low_text = std::string_view(text).substr(0, dots);
    std::string_view high_text = dots == text.npos ? "" : std::string_view(text).substr(dots + 2);
    double low = 0, high = 0;
    const bool parsed =
        take_number(low_text, low) && low_text.empty() && take_number(high_text, high) && high_text.empty();
    const Range range{static_cast<float>(low), static_cast<float>(high)};
    if (!parsed || low < 0 || high > highest || !(range.low < range.high))
        refuse(text, "LOW..HIGH, such as 50..2000: two rising numbers from 0 to 1e12");
    return range;
}

std::vector<float> parse_isolines(const std::string& text) {
    if (text == "auto") return {};
    constexpr std::size_t most = 100;
    std::vector<float> values;
    std::string_view rest = text;
    double value = 0;
    do {
        if (!take_number(rest, value) || !(value > 0 && value <= 1e12) || values.size() == most)
            refuse(text, "auto, or up to 100 numbers above 0 to 1e12 with commas between, such as 100,300,500");
        values.push_back(static_cast<float>(value));
    } while (take(rest, ','));
    if (!rest.empty()) refuse(text, "auto, or numbers above 0 with commas between, such as 100,300,500");
    return values;
}

float parse_mesh_size(const std::string& text) {
    if (text == "auto") return automatic_mesh_size;
    if (text == "none") return whole_patches;
    std::string_view rest = text;
    double number = 0;
    const bool parsed = take_number(rest, number) && rest.empty();
    const auto size = static_cast<float>(number);
    if (!parsed || !(size > 0) || !std::isfinite(size)) refuse(text, "a length in metres above 0, auto or none");
    return size;
}

CLI::Validator number_between(double low, double high) {
    const auto check = [low, high](std::string& text) {
        std::string_view rest = text;
        double number = 0;
        if (take_number(rest, number) && rest.empty() && number >= low && number <= high) return std::string();
        return fmt::format("expected a number from {} to {}, found '{}'", low, high, text);
    };
    return CLI::Validator(check, "");
}

}  // namespace interflect::command
