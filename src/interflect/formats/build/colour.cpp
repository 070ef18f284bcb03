#include "interflect/formats/build/colour.h"

#include <ImathMatrix.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace interflect::detail {

namespace {

using Imath::M33d;
using Imath::V3d;

constexpr double shortest_wave = 380, longest_wave = 780;  // [nm]
constexpr int table_step = 10;                             // [nm]

/// CIE 1931 2-degree colour matching functions every 10 nm, times 10^4 (CIE 15, table T.4, rounded).
constexpr std::array<std::array<int, 3>, 41> colour_matching = {{
    {14, 0, 65},        {42, 1, 201},       {143, 4, 679},      {435, 12, 2074},    {1344, 40, 6456},
    {2839, 116, 13856}, {3483, 230, 17471}, {3362, 380, 17721}, {2908, 600, 16692}, {1954, 910, 12876},
    {956, 1390, 8130},  {320, 2080, 4652},  {49, 3230, 2720},   {93, 5030, 1582},   {633, 7100, 782},
    {1655, 8620, 422},  {2904, 9540, 203},  {4334, 9950, 87},   {5945, 9950, 39},   {7621, 9520, 21},
    {9163, 8700, 17},   {10263, 7570, 11},  {10622, 6310, 8},   {10026, 5030, 3},   {8544, 3810, 2},
    {6424, 2650, 0},    {4479, 1750, 0},    {2835, 1070, 0},    {1649, 610, 0},     {874, 320, 0},
    {468, 170, 0},      {227, 82, 0},       {114, 41, 0},       {58, 21, 0},        {29, 10, 0},
    {14, 5, 0},         {7, 2, 0},          {3, 1, 0},          {2, 1, 0},          {1, 0, 0},
    {0, 0, 0},
}};

V3d colour_matching_at(double wavelength) {
    const double position = (wavelength - shortest_wave) / table_step;
    const auto i = std::min(static_cast<std::size_t>(position), colour_matching.size() - 2);
    const double t = position - static_cast<double>(i);
    const auto row = [](const std::array<int, 3>& r) { return V3d(r[0], r[1], r[2]); };
    return row(colour_matching[i]) * (1 - t) + row(colour_matching[i + 1]) * t;
}

/// Minimum of |Y| and |X + Y + Z|, relative to |X| + |Y| + |Z|. Colours with less have no chromaticity.
constexpr double min_share = 1e-6;

Chromaticity chromaticity_of(const V3d& xyz, const char* fault) {
    const double size = std::abs(xyz.x) + std::abs(xyz.y) + std::abs(xyz.z), total = xyz.x + xyz.y + xyz.z;
    if (!(std::abs(xyz.y) > min_share * size && std::abs(total) > min_share * size)) throw std::invalid_argument(fault);
    return {xyz.x / total, xyz.y / total};
}

template <class Spectrum>
Chromaticity integrate(const Spectrum& spectrum) {
    V3d sum(0), equal_energy(0);
    for (int nm = static_cast<int>(shortest_wave); nm <= static_cast<int>(longest_wave); ++nm) {
        const V3d weight = colour_matching_at(nm);
        sum += weight * spectrum(nm);
        equal_energy += weight;
    }
    return chromaticity_of(sum / equal_energy, "the spectrum has no light between 380 and 780 nm");
}

V3d xyz_of(double x, double y) { return {x / y, 1, (1 - x - y) / y}; }

/// Returns m v. Imath multiplies row vectors, so the matrix is transposed.
V3d multiply(const M33d& m, const V3d& v) { return v * m.transposed(); }

M33d diagonal(const V3d& d) { return {d.x, 0, 0, 0, d.y, 0, 0, 0, d.z}; }

M33d columns(const V3d& a, const V3d& b, const V3d& c) { return {a.x, b.x, c.x, a.y, b.y, c.y, a.z, b.z, c.z}; }

/// Returns the matrix that to_rec709() describes.
M33d make_rec709_from_xyz() {
    const V3d white = xyz_of(0.3127, 0.3290);
    const M33d bradford(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296);
    const M33d adapt = bradford.inverse() * diagonal(multiply(bradford, white) / multiply(bradford, V3d(1))) * bradford;
    const M33d primaries = columns(xyz_of(0.64, 0.33), xyz_of(0.30, 0.60), xyz_of(0.15, 0.06));
    const M33d xyz_from_rec709 = primaries * diagonal(multiply(primaries.inverse(), white));
    return xyz_from_rec709.inverse() * adapt;
}

const M33d& rec709_from_xyz() {
    static const M33d matrix = make_rec709_from_xyz();
    return matrix;
}

/// Relative excess over the limit that is ignored as rounding.
constexpr double rounding = 1e-9;

/// Returns the largest saturation (0: neutral) that keeps a channel in [0, limit] at luminance 1.
double saturation_within(double channel, double limit) {
    if (channel < -rounding) return 1 / (1 - channel);
    if (channel > limit * (1 + rounding)) return (limit - 1) / (channel - 1);
    return 1;
}

double smallest_saturation(const V3d& rgb, double limit) {
    return std::min(
        {saturation_within(rgb.x, limit), saturation_within(rgb.y, limit), saturation_within(rgb.z, limit)});
}

V3d with_saturation(const V3d& rgb, double saturation) { return V3d(1 - saturation) + rgb * saturation; }

}  // namespace

Chromaticity chromaticity_of_spectrum(double first, double last, std::span<const double> values) {
    if (!(first < last)) throw std::invalid_argument("the shortest wavelength must come before the longest");
    if (values.size() < 2) throw std::invalid_argument("a spectrum needs at least two values");
    return integrate([&](double wavelength) {
        const double position = (wavelength - first) / (last - first) * static_cast<double>(values.size() - 1);
        if (position < 0 || position > static_cast<double>(values.size() - 1)) return 0.0;
        const auto i = std::min(static_cast<std::size_t>(position), values.size() - 2);
        const double t = position - static_cast<double>(i);
        return values[i] * (1 - t) + values[i + 1] * t;
    });
}

Chromaticity chromaticity_of_black_body(double kelvin) {
    if (!(kelvin >= 1000)) throw std::invalid_argument("a colour temperature must be at least 1000 K");
    constexpr double second_radiation_constant = 1.438777e7;  // [nm K]
    const auto planck = [&](double nm) {
        return std::pow(nm, -5) / std::expm1(second_radiation_constant / (nm * kelvin));
    };
    return integrate([&, scale = planck(560)](double nm) { return planck(nm) / scale; });
}

Chromaticity mix(std::span<const MixedColour> parts) {
    V3d xyz(0);
    for (const auto& [weight, colour] : parts) xyz += xyz_of(colour.x, colour.y) * weight;
    if (!(xyz.y > 0)) throw std::invalid_argument("the weights must have a positive sum");
    return chromaticity_of(xyz, "the mixed colours leave nothing of each other");
}

Rec709Colour to_rec709(const Chromaticity& colour, double luminance, double largest) {
    Rec709Colour result;
    if (luminance > largest) {
        result.too_bright = true;
        luminance = largest;
    }
    V3d rgb = multiply(rec709_from_xyz(), xyz_of(colour.x, colour.y));
    constexpr double min_channel = 1e-15;  // relative to white; smaller ones count as 0
    // Adaptation changes Y, so the luminance is set later.
    const double in_gamut = smallest_saturation(rgb, std::numeric_limits<double>::infinity());
    result.out_of_gamut = in_gamut < 1;
    rgb = with_saturation(rgb, in_gamut);
    for (int c = 0; c < 3; ++c)
        if (rgb[c] < min_channel) rgb[c] = 0;  // the colour is on the border of the gamut
    rgb /= interflect::luminance(RgbD(rgb));
    if (luminance > 0) {
        const double under_bound = smallest_saturation(rgb, largest / luminance);
        result.too_bright |= under_bound < 1;
        rgb = with_saturation(rgb, under_bound);
    }
    const auto channel = [&](double value) { return static_cast<float>(std::clamp(value * luminance, 0.0, largest)); };
    result.rgb = Rgb(channel(rgb.x), channel(rgb.y), channel(rgb.z));
    return result;
}

LuminousColour from_rec709(const RgbD& rgb) {
    static const M33d xyz_from_rec709 = rec709_from_xyz().inverse();
    if (!(largest_channel(rgb) > 0)) return {};
    const V3d xyz = multiply(xyz_from_rec709, V3d(rgb));
    const double total = xyz.x + xyz.y + xyz.z;
    return {{xyz.x / total, xyz.y / total}, luminance(rgb)};
}

}  // namespace interflect::detail
