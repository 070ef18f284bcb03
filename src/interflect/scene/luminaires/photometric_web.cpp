#include "interflect/light_sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interflect/scene/core/limits.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect {

using namespace detail;

namespace {

/// Position between the entries of a table: `index` + `share`.
struct TablePosition {
    std::size_t index;
    float share;
};

TablePosition position_in(const std::vector<float>& table, double x) {
    const auto above = std::upper_bound(table.begin() + 1, table.end() - 1, x);
    const auto index = static_cast<std::size_t>(above - table.begin()) - 1;
    return {index, static_cast<float>((x - table[index]) / (double{table[index + 1]} - table[index]))};
}

bool is_ascending(const std::vector<float>& angles) {
    return std::adjacent_find(angles.begin(), angles.end(), [](float a, float b) { return !(a < b); }) == angles.end();
}

std::string angle_fault(const std::vector<float>& angles, const char* kind, float least, float span) {
    if (angles.size() < 2) return fmt::format("has fewer than two {} angles", kind);
    if (!is_ascending(angles)) return fmt::format("has {} angles that do not ascend", kind);
    if (!(angles.front() >= least && angles.back() - angles.front() <= span) || !std::isfinite(angles.front()))
        return fmt::format("has {} angles from {} to {} degrees, which is too wide", kind, angles.front(),
                           angles.back());
    return {};
}

std::string opening_fault(const LuminousOpening& opening) {
    const V3f& size = opening.size;
    const float least = std::min({size.x, size.y, size.z});
    const bool is_solid = opening.shape == LuminousOpening::Shape::ellipsoid;
    if (!is_finite(size) || !(is_solid ? least > 0 : least >= 0) || size.length() > widest_face)
        return fmt::format(
            "has a luminous opening of {} x {} x {} m; expected sizes of 0 (an ellipsoid: above) to {:g} m", size.x,
            size.y, size.z, widest_face);
    return opening.axis >= 0 && opening.axis < 3 ? std::string() : "has an opening that is a cylinder along no axis";
}

}  // namespace

float PhotometricWeb::intensity(const V3f& direction) const {
    const WebAxes axes(pole);
    const double along = direction.dot(axes.pole), a = direction.dot(axes.zero), b = direction.dot(axes.quarter);
    const double theta = degrees(std::atan2(std::hypot(a, b), along));
    double turn = std::fmod(degrees(std::atan2(b, a)) - azimuth.front(), full_turn);
    if (turn < 0) turn += full_turn;
    const double phi = azimuth.front() + turn;
    if (theta < polar.front() || theta > polar.back() || phi > azimuth.back()) return 0;
    const TablePosition t = position_in(polar, theta), p = position_in(azimuth, phi);
    const float *left = at_azimuth(p.index) + t.index, *right = left + polar.size();
    const auto between = [](float x, float y, float share) { return x + (y - x) * share; };
    return between(between(left[0], left[1], t.share), between(right[0], right[1], t.share), p.share);
}

double PhotometricWeb::flux() const {
    double sum = 0;
    for (std::size_t j = 0; j + 1 < polar.size(); ++j) {
        const BandWeights weights(radians(polar[j]), radians(polar[j + 1]));
        for (std::size_t i = 0; i + 1 < azimuth.size(); ++i) {
            const float *left = at_azimuth(i) + j, *right = left + polar.size();
            const double mean =
                weights.at_a * (double{left[0]} + right[0]) + weights.at_b * (double{left[1]} + right[1]);
            sum += mean / 2 * radians(double{azimuth[i + 1]} - azimuth[i]);
        }
    }
    return sum;
}

float PhotometricWeb::peak() const { return *std::max_element(intensities.begin(), intensities.end()); }

std::string web_fault(const PhotometricWeb& web) {
    if (std::string fault = angle_fault(web.polar, "polar", 0, half_turn); !fault.empty()) return fault;
    if (web.polar.back() > half_turn) return "has a polar angle beyond 180 degrees";
    if (std::string fault = angle_fault(web.azimuth, "azimuthal", -full_turn, full_turn); !fault.empty()) return fault;
    if (web.intensities.size() != web.polar.size() * web.azimuth.size())
        return fmt::format("has {} intensities for {} x {} angles", web.intensities.size(), web.polar.size(),
                           web.azimuth.size());
    const auto is_intensity = [](float x) { return x >= 0 && x <= strongest_exitance; };
    const auto wrong = std::find_if_not(web.intensities.begin(), web.intensities.end(), is_intensity);
    if (wrong != web.intensities.end())
        return fmt::format("has an intensity of {}; expected 0 to {:g} cd", *wrong, strongest_exitance);
    if (!(web.flux() > 0)) return "emits nothing";
    if (!std::isfinite(web.lamp_lumens) || web.lamp_lumens < 0) return "has lamps of less than no flux";
    return opening_fault(web.opening);
}

}  // namespace interflect
