#include "interflect/formats/rad/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "interflect/formats/rad/materials.h"
#include "interflect/formats/rad/statements/arguments.h"
#include "interflect/formats/text/number.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect::detail {

namespace {

using std::numbers::pi;

constexpr int cie_uniform = 5, cie_intermediate = 7, cie_clear = 12, cie_overcast = 16;

struct SunPlace {
    double altitude = 0;  ///< [rad]
    double azimuth = 0;   ///< Angle from south to west [rad].
};

/// Site and time of gensky and gendaylit, with their defaults.
struct SolarTime {
    int year = 0, month = 0, day = 0;  ///< Year 0: simpler formulas.
    double hour = 0;
    /// Whether `hour` is solar time.
    bool is_solar = false;
    double latitude = 0.66, west_longitude = 2.13, west_meridian = radians(120);  ///< [rad]

    SunPlace sun() const;

  private:
    int day_of_year() const {
        constexpr std::array<int, 12> before = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
        return before[static_cast<std::size_t>(month - 1)] + day;
    }
    double declination(double& solar_hour) const;
    double almanac_declination(double& solar_hour) const;
};

/// Computes the declination [rad] and the solar time [h] by the formulas of the IES Lighting Handbook.
double SolarTime::declination(double& solar_hour) const {
    const double n = day_of_year();
    solar_hour = hour + 0.170 * std::sin(4 * pi / 373 * (n - 80)) - 0.129 * std::sin(2 * pi / 355 * (n - 8)) +
                 12 / pi * (west_meridian - west_longitude);
    return 0.4093 * std::sin(2 * pi / 365 * (n - 81));
}

/// Computes the declination [rad] and the solar time [h] by the formulas of Michalsky (1988).
double SolarTime::almanac_declination(double& solar_hour) const {
    const int leap_days = (year - 1949) / 4 + (month > 2 && year % 4 == 0 ? 1 : 0);
    const double days = day_of_year() + (year - 1949) * 365 + leap_days + (hour + west_meridian * 12 / pi) / 24 +
                        (2432916.5 - 2451545.0);  // since noon of 1 January 2000
    const double mean_longitude = radians(280.460 + 0.9856474 * days), anomaly = radians(357.528 + 0.9856003 * days);
    const double longitude = mean_longitude + radians(1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly));
    const double obliquity = radians(23.439 - 4e-7 * days);
    const double ascension = std::atan2(std::sin(longitude) * std::cos(obliquity), std::cos(longitude));
    const double sidereal = 6.697375 + 0.0657098242 * days + 24 * (days - std::floor(days)) + 12;
    solar_hour = sidereal - west_longitude * 12 / pi - ascension * 12 / pi + 12;
    return std::asin(std::sin(obliquity) * std::sin(longitude));
}

SunPlace SolarTime::sun() const {
    double solar_hour = hour;
    const double decline = year ? almanac_declination(solar_hour) : declination(solar_hour);
    const double angle = (is_solar ? hour : solar_hour) * pi / 12;
    const double sine = std::sin(latitude), cosine = std::cos(latitude);
    return {std::asin(sine * std::sin(decline) - cosine * std::cos(decline) * std::cos(angle)),
            -std::atan2(std::cos(decline) * std::sin(angle),
                        -cosine * std::sin(decline) - sine * std::cos(decline) * std::cos(angle))};
}

/// Reads a time of day [h]. @return  nullopt for a named time zone.
std::optional<double> parse_hour(std::string_view text) {
    const auto colon = text.find(':');
    const auto hours = parse_number(text.substr(0, colon));
    const auto minutes = colon == text.npos ? std::optional(0.0) : parse_number(text.substr(colon + 1));
    if (!hours || !minutes) return std::nullopt;
    return *hours + *minutes / 60;
}

/// Reads `MONTH DAY HOUR` or `-ang ALTITUDE AZIMUTH`. @return  False for a named time zone.
bool parse_place(RadArguments& arguments, SolarTime& time, std::optional<SunPlace>& sun) {
    const std::string first = arguments.next();
    if (first == "-ang") {
        const double altitude = arguments.number(), azimuth = arguments.number();
        sun = SunPlace{radians(altitude), radians(azimuth)};
        return true;
    }
    const std::vector<std::string> month{"the month", first};
    time.month = RadArguments(month).whole_number(1, 12);
    time.day = arguments.whole_number(1, 31);
    std::string hour = arguments.next();
    time.is_solar = hour.starts_with('+');
    if (time.is_solar) hour.erase(0, 1);
    const auto number = parse_hour(hour);
    time.hour = number.value_or(0);
    return number.has_value();
}

/// Reads an option of the site. @return  False for other options.
bool parse_site(const std::string& option, RadArguments& arguments, SolarTime& time) {
    if (option == "-a")
        time.latitude = radians(arguments.number());
    else if (option == "-o")
        time.west_longitude = radians(arguments.number());
    else if (option == "-m")
        time.west_meridian = radians(arguments.number());
    else if (option == "-y")
        time.year = arguments.whole_number(1950, 2050);
    else
        return false;
    return true;
}

Daylight::Sun daylight_sun(const SunPlace& place) {
    return {degrees(place.azimuth) + half_turn, degrees(place.altitude)};
}

/// Returns the ratio of the horizontal irradiance, divided by pi, to the zenith radiance of a clear or intermediate
/// sky.
double zenith_ratio(double altitude, bool is_intermediate) {
    constexpr double coefficients[2][5] = {{2.766521, 0.547665, -0.369832, 0.009237, 0.059229},
                                           {3.5556, -2.7152, -1.3081, 1.0660, 0.60227}};
    const double x = (altitude - pi / 4) / (pi / 4), sine = std::sin(altitude), rest = pi / 2 - altitude;
    double sum = 0;
    for (int i = 4; i >= 0; --i) sum = sum * x + coefficients[is_intermediate ? 1 : 0][i];
    const double at_zenith = is_intermediate ? (2.739 + .9891 * std::sin(.3119 + 2.6 * altitude)) *
                                                   std::exp(-rest * (.4441 + 1.48 * altitude))
                                             : 0.274 * (0.91 + 10 * std::exp(-3 * rest) + 0.45 * sine * sine);
    return sum / at_zenith / pi;
}

/// Computes the daylight of gensky by its formulas and constants.
std::optional<Daylight> gensky(RadArguments arguments) {
    constexpr double sky_efficacy = 203, sun_efficacy = 208;  // [lm/W]
    constexpr double sun_solid_angle = 6e-5;                  // [sr]
    SolarTime time;
    std::optional<SunPlace> given;
    if (!parse_place(arguments, time, given)) return std::nullopt;
    int type = cie_clear;
    bool has_sun = true;
    double turbidity = 2.45, ground = 0.2;
    // Radiances [W/(m^2 sr)] and horizontal irradiances [W/m^2]
    std::optional<double> zenith, sky_irradiance, sun_radiance, sun_irradiance;
    while (!arguments.is_at_end()) {
        const std::string option = arguments.next();
        const std::string_view name = std::string_view(option).substr(std::min<std::size_t>(1, option.size()));
        if (parse_site(option, arguments, time)) continue;
        if (name == "s" || name == "i") {
            type = name == "s" ? cie_clear : cie_intermediate;
            has_sun = option[0] == '+';
        } else if (name == "c" || name == "u") {
            type = name == "c" ? cie_overcast : cie_uniform;
        } else if (name == "t") {
            turbidity = arguments.number();
        } else if (name == "g") {
            ground = arguments.number();
        } else if (name == "b" || name == "B") {
            (name == "b" ? zenith : sky_irradiance) = arguments.number();
        } else if (name == "r" || name == "R") {
            (name == "r" ? sun_radiance : sun_irradiance) = arguments.number();
        } else {
            return std::nullopt;
        }
    }
    // Compute the position of the sun
    SunPlace sun = given ? *given : time.sun();
    const bool is_overcast = type == cie_overcast || type == cie_uniform;
    if (!is_overcast) sun.altitude = std::min(sun.altitude, radians(87));  // as gensky does
    if (!is_overcast && sun.altitude <= 0) return std::nullopt;
    // Compute the illuminance by the sky
    const double sine = std::sin(sun.altitude), overcast_zenith = 8.6 * sine + .123;  // [kcd/m^2]
    const double ratio = type == cie_uniform ? 1
                         : is_overcast       ? 7.0 / 9
                                             : zenith_ratio(sun.altitude, type == cie_intermediate);
    double zenith_luminance =
        is_overcast ? overcast_zenith : (1.376 * turbidity - 1.81) * std::tan(sun.altitude) + 0.38;
    if (type == cie_intermediate) zenith_luminance = (zenith_luminance + overcast_zenith) / 2;
    const double radiance = zenith.value_or(std::max(0.0, zenith_luminance) * 1000 / sky_efficacy);
    Daylight result;
    result.cie_sky = {type, sky_irradiance.value_or(radiance * ratio * pi) * rad_efficacy};
    result.ground_reflectance = std::clamp(ground, 0.0, 1.0);
    if (is_overcast) return result;
    // Compute the illuminance by the sun, facing it
    double direct_normal = 1.5e9 / sun_efficacy * (1.147 - .147 / std::max(sine, .16)) * sun_solid_angle;
    if (type == cie_intermediate) direct_normal *= 0.15;
    if (sun_radiance) direct_normal = *sun_radiance * sun_solid_angle;
    if (sun_irradiance) direct_normal = *sun_irradiance / sine;
    result.sun = daylight_sun(sun);
    result.sun->illuminance = has_sun ? direct_normal * rad_efficacy : 0;
    return result;
}

std::optional<Daylight> gendaylit(RadArguments arguments) {
    SolarTime time;
    std::optional<SunPlace> sun;
    if (!parse_place(arguments, time, sun)) return std::nullopt;
    Daylight result;
    result.ground_reflectance = 0.2;
    bool has_sun = true;
    while (!arguments.is_at_end()) {
        const std::string option = arguments.next();
        if (parse_site(option, arguments, time)) continue;
        if (option == "-W") {
            const double direct = arguments.number(), diffuse = arguments.number();
            result.perez_sky = Daylight::PerezSky{direct, diffuse};
        } else if (option == "-g") {
            result.ground_reflectance = std::clamp(arguments.number(), 0.0, 1.0);
        } else if (option == "-s") {
            has_sun = false;
        } else if (option != "-w") {
            return std::nullopt;
        }
    }
    if (!sun) sun = time.sun();
    if (!result.perez_sky || sun->altitude <= 0) return std::nullopt;
    result.sun = daylight_sun(*sun);
    if (!has_sun) result.sun->illuminance = 0;
    return result;
}

}  // namespace

std::optional<Daylight> parse_sky_command(std::span<const std::string> words) {
    if (words[0] == "gensky") return gensky(RadArguments(words));
    if (words[0] == "gendaylit") return gendaylit(RadArguments(words));
    return std::nullopt;
}

}  // namespace interflect::detail
