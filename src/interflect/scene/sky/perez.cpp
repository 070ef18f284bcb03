// Sky: Perez et al., Solar Energy 50 (1993). Efficacies: Perez et al., Solar Energy 44 (1990).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "interflect/core.h"
#include "interflect/light_sources.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect {

using namespace detail;

namespace {

constexpr double solar_constant = 1367;   // [W/m^2]
constexpr double precipitable_water = 2;  // [cm]

constexpr std::size_t bins = 8;
/// Upper clearness of each bin but the last.
constexpr std::array<double, bins - 1> bin_ends = {1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};

using FourNumbers = std::array<double, 4>;
/// Table 1 of 1993: a to e are x1 + x2 Z + Delta (x3 + x4 Z), except c and d of the first bin. Z is the zenith angle of
/// the sun [rad], Delta the brightness of the sky.
struct LuminanceBin {
    FourNumbers a, b, c, d, e;
};
constexpr std::array<LuminanceBin, bins> luminance_bins = {{
    {{1.3525, -0.2576, -0.2690, -1.4366},
     {-0.7670, 0.0007, 1.2734, -0.1233},
     {2.8000, 0.6004, 1.2375, 1.0000},
     {1.8734, 0.6297, 0.9738, 0.2809},
     {0.0356, -0.1246, -0.5718, 0.9938}},
    {{-1.2219, -0.7730, 1.4148, 1.1016},
     {-0.2054, 0.0367, -3.9128, 0.9156},
     {6.9750, 0.1774, 6.4477, -0.1239},
     {-1.5798, -0.5081, -1.7812, 0.1080},
     {0.2624, 0.0672, -0.2190, -0.4285}},
    {{-1.1000, -0.2515, 0.8952, 0.0156},
     {0.2782, -0.1812, -4.5000, 1.1766},
     {24.7219, -13.0812, -37.7000, 34.8438},
     {-5.0000, 1.5218, 3.9229, -2.6204},
     {-0.0156, 0.1597, 0.4199, -0.5562}},
    {{-0.5484, -0.6654, -0.2672, 0.7117},
     {0.7234, -0.6219, -5.6812, 2.6297},
     {33.3389, -18.3000, -62.2500, 52.0781},
     {-3.5000, 0.0016, 1.1477, 0.1062},
     {0.4659, -0.3296, -0.0876, -0.0329}},
    {{-0.6000, -0.3566, -2.5000, 2.3250},
     {0.2937, 0.0496, -5.6812, 1.8415},
     {21.0000, -4.7656, -21.5906, 7.2492},
     {-3.5000, -0.1554, 1.4062, 0.3988},
     {0.0032, 0.0766, -0.0656, -0.1294}},
    {{-1.0156, -0.3670, 1.0078, 1.4051},
     {0.2875, -0.5328, -3.8500, 3.3750},
     {14.0000, -0.9999, -7.1406, 7.5469},
     {-3.4000, -0.1078, -1.0750, 1.5702},
     {-0.0672, 0.4016, 0.3017, -0.4844}},
    {{-1.0000, 0.0211, 0.5025, -0.5119},
     {-0.3000, 0.1922, 0.7023, -1.6317},
     {19.0000, -5.0000, 1.2438, -1.9094},
     {-4.0000, 0.0250, 0.3844, 0.2656},
     {1.0468, -0.3788, -2.4517, 1.4656}},
    {{-1.0500, 0.0289, 0.4260, 0.3590},
     {-0.3250, 0.1156, 0.7781, 0.0025},
     {31.0625, -14.5000, -46.1148, 55.3750},
     {-7.2312, 0.4050, 13.3500, 0.6234},
     {1.5000, -0.6426, 1.8564, 0.5636}},
}};

/// Table 4 of 1990 [lm/W]: a + b W + c cos Z + d ln Delta; for direct light a + b W + c exp(5.73 Z - 5) + d Delta. W is
/// the precipitable water.
constexpr std::array<FourNumbers, bins> diffuse_efficacies = {{{97.24, -0.46, 12.00, -8.91},
                                                               {107.22, 1.15, 0.59, -3.95},
                                                               {104.97, 2.96, -5.53, -8.77},
                                                               {102.39, 5.59, -13.95, -13.90},
                                                               {100.71, 5.94, -22.75, -23.74},
                                                               {106.42, 3.83, -36.15, -28.83},
                                                               {141.88, 1.90, -53.24, -14.03},
                                                               {152.23, 0.35, -45.27, -7.98}}};
constexpr std::array<FourNumbers, bins> direct_efficacies = {{{57.20, -4.55, -2.98, 117.12},
                                                              {98.99, -3.46, -1.21, 12.38},
                                                              {109.83, -4.90, -1.71, -8.81},
                                                              {110.34, -5.84, -1.99, -4.56},
                                                              {106.36, -3.97, -1.75, -6.16},
                                                              {107.19, -1.25, -1.51, -26.73},
                                                              {105.75, 0.77, -1.26, -34.44},
                                                              {101.18, 1.58, -1.10, -8.29}}};

/// Kasten and Young 1989. @param altitude  [degrees]
double air_mass(double altitude) {
    return 1 / (std::sin(radians(altitude)) + 0.50572 * std::pow(altitude + 6.07995, -1.6364));
}

SkyModel luminance_model(std::size_t bin, double zenith_angle, double brightness) {
    const LuminanceBin& x = luminance_bins[bin];
    const auto linear = [&](const FourNumbers& k) {
        return k[0] + k[1] * zenith_angle + brightness * (k[2] + k[3] * zenith_angle);
    };
    double c = linear(x.c), d = linear(x.d);
    if (bin == 0) {
        c = std::exp(std::pow(brightness * (x.c[0] + x.c[1] * zenith_angle), x.c[2])) - x.c[3];
        d = -std::exp(brightness * (x.d[0] + x.d[1] * zenith_angle)) + x.d[2] + brightness * x.d[3];
    }
    const double all = 1 + c * std::exp(d * std::numbers::pi / 2);  // Perez et al. have this f(pi / 2), SkyModel 1
    const auto number = [](double value) { return static_cast<float>(value); };
    return {number(linear(x.a)), number(std::min(0.0, linear(x.b))), number(c / all), number(d),
            number(linear(x.e) / all)};
}

}  // namespace

ModelledDaylight perez_daylight(double direct_normal, double diffuse_horizontal, double sun_altitude) {
    if (!(sun_altitude > 0 && sun_altitude <= right_angle))
        throw InputError(fmt::format("a sun at {} degrees; expected one above the horizon", sun_altitude));
    const bool is_possible = direct_normal >= 0 && direct_normal <= solar_constant && diffuse_horizontal > 0 &&
                             diffuse_horizontal <= solar_constant;
    if (!is_possible)
        throw InputError(
            fmt::format("irradiances of {} W/m2 (direct normal) and {} W/m2 (diffuse horizontal); "
                        "expected 0 to {} and above 0 to {}",
                        direct_normal, diffuse_horizontal, solar_constant, solar_constant));
    const double zenith_angle = radians(right_angle - sun_altitude);
    const double cubed = 1.041 * zenith_angle * zenith_angle * zenith_angle;
    const double clearness = ((diffuse_horizontal + direct_normal) / diffuse_horizontal + cubed) / (1 + cubed);
    const double brightness = diffuse_horizontal * air_mass(sun_altitude) / solar_constant;
    const auto bin =
        static_cast<std::size_t>(std::upper_bound(bin_ends.begin(), bin_ends.end(), clearness) - bin_ends.begin());
    // Intermediate skies have a minimum brightness, as in Radiance's gendaylit.
    constexpr double clearer = 1.065, clear = 2.8, min_brightness = 0.2;
    const bool is_between = clearness > clearer && clearness < clear;
    ModelledDaylight result{
        luminance_model(bin, zenith_angle, is_between ? std::max(brightness, min_brightness) : brightness)};
    const FourNumbers &sky = diffuse_efficacies[bin], &sun = direct_efficacies[bin];
    result.sky_illuminance =
        diffuse_horizontal * std::max(0.0, sky[0] + sky[1] * precipitable_water + sky[2] * std::cos(zenith_angle) +
                                               sky[3] * std::log(brightness));
    result.sun_illuminance =
        direct_normal * std::max(0.0, sun[0] + sun[1] * precipitable_water +
                                          sun[2] * std::exp(5.73 * zenith_angle - 5) + sun[3] * brightness);
    return result;
}

}  // namespace interflect
