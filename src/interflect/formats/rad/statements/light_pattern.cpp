#include "interflect/formats/rad/statements/light_pattern.h"

#include <ImathBox.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>
#include <utility>

#include "interflect/formats/shapes/transform_sequence.h"
#include "interflect/scene/core/web_angles.h"

namespace interflect::detail {

namespace {

using Imath::V3d;
using Coordinate = RadLightPattern::Coordinate;
using Correction = RadLightPattern::Correction;

std::optional<Correction> correction_of(std::string_view name) {
    constexpr std::pair<std::string_view, Correction> corrections[] = {
        {"noop", Correction::none},   {"corr", Correction::none},    {"flatcorr", Correction::flat},
        {"boxcorr", Correction::box}, {"lboxcorr", Correction::box}, {"cylcorr", Correction::cylinder}};
    for (const auto& [known, correction] : corrections)
        if (known == name) return correction;
    return std::nullopt;
}

std::optional<Coordinate> coordinate_of(std::string_view name) {
    constexpr std::pair<std::string_view, Coordinate> coordinates[] = {
        {"src_theta", Coordinate::theta},         {"src_phi", Coordinate::phi},
        {"src_phi2", Coordinate::phi2},           {"src_phi4", Coordinate::phi4},
        {"srcB_vert", Coordinate::b_vertical},    {"srcB_vert2", Coordinate::b_vertical2},
        {"srcB_horiz", Coordinate::b_horizontal}, {"srcB_horiz2", Coordinate::b_horizontal2}};
    for (const auto& [known, coordinate] : coordinates)
        if (known == name) return coordinate;
    return std::nullopt;
}

/// Triangle wave from 0 to `period` and back.
double folded(double x, double period) {
    const double rest = std::fmod(x, 2 * period);
    return rest > period ? 2 * period - rest : rest;
}

/// Returns a coordinate as source.cal defines it [degrees]. @param d  Unit direction of emission.
double value_of(Coordinate coordinate, const V3d& d) {
    const auto azimuth = [&] {
        const double phi = degrees(std::atan2(d.y, d.x));
        return phi < 0 ? phi + full_turn : phi;
    };
    switch (coordinate) {
        case Coordinate::theta:
            return degrees(std::acos(std::clamp(-d.z, -1.0, 1.0)));
        case Coordinate::phi:
            return azimuth();
        case Coordinate::phi2:
            return folded(azimuth(), half_turn);
        case Coordinate::phi4:
            return folded(azimuth(), right_angle);
        case Coordinate::b_vertical:
            return degrees(std::atan2(d.x, -d.z));
        case Coordinate::b_vertical2:
            return std::abs(degrees(std::atan2(d.x, -d.z)));
        case Coordinate::b_horizontal:
            return degrees(std::atan2(-d.y, -d.z));
        case Coordinate::b_horizontal2:
            return std::abs(degrees(std::atan2(-d.y, -d.z)));
    }
    return 0;
}

struct Facet {
    V3d area_normal;  // normal of the front, times the area
    V3d normal;
};

std::vector<Facet> facets_of(const RadEmitter& emitter) {
    std::vector<Facet> result;
    for (const PolygonMesh& surface : emitter.surfaces)
        for (const auto& face : surface.faces) {
            const V3d& a = surface.points[face[0]];
            V3d sum(0);
            for (std::size_t i = 2; i < face.size(); ++i)
                sum += (surface.points[face[i - 1]] - a).cross(surface.points[face[i]] - a) / 2;
            if (sum.length2() > 0) result.push_back({sum, sum.normalized()});
        }
    return result;
}

/// Returns the projected area, divided by the projected area for which the pattern corrects.
double corrected_area(const RadLightPattern& pattern, std::span<const Facet> facets, const V3d& d) {
    constexpr double edge = 1e-6;  // cosine; a flat source includes its own plane, as its table does
    const std::vector<double>& a = pattern.arguments;
    const double factor = a.empty() ? 1 : a[0];
    double area = 0;
    for (const Facet& facet : facets) {
        const double cosine = facet.normal.dot(d);
        if (pattern.correction == Correction::flat)
            area += cosine > -edge ? facet.area_normal.length() : 0;
        else
            area += std::max(0.0, facet.area_normal.dot(d));
    }
    if (pattern.correction == Correction::box)
        return factor * area /
               (std::abs(d.x) * a[2] * a[3] + std::abs(d.y) * a[1] * a[3] + std::abs(d.z) * a[1] * a[2]);
    if (pattern.correction == Correction::cylinder)
        return factor * area /
               (a[1] * a[2] * std::sqrt(std::max(0.0, 1 - d.z * d.z)) +
                std::numbers::pi / 4 * a[1] * a[1] * std::abs(d.z));
    return factor * area;
}

/// Returns angles of the web [degrees]: the table's coordinates, mirrored at their ends and divided into steps of at
/// most `step`.
std::vector<float> angles_of(const std::vector<double>* nodes, double low, double high, double step) {
    std::vector<double> all{low, high};
    if (nodes) {
        const double period = 2 * (nodes->back() - nodes->front());
        for (const double node : *nodes)
            for (const double image :
                 {node, 2 * nodes->back() - node, node + period, 2 * nodes->back() - node + period})
                if (image > low && image < high) all.push_back(image);
    }
    std::sort(all.begin(), all.end());
    std::vector<float> result;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) {
        const double width = all[i + 1] - all[i];
        const int pieces = static_cast<int>(std::ceil(width / step));
        for (int k = 0; k < pieces; ++k) {
            const auto angle = static_cast<float>(all[i] + width * k / pieces);
            if (result.empty() || angle > result.back()) result.push_back(angle);
        }
    }
    result.push_back(static_cast<float>(high));
    return result;
}

}  // namespace

std::optional<RadLightPattern> parse_light_pattern(const RadPrimitive& primitive) {
    const auto& strings = primitive.strings;
    if (primitive.type != "brightdata" || strings.size() < 4) return std::nullopt;
    const auto correction = correction_of(strings[0]);
    if (!correction || !strings[2].ends_with("source.cal")) return std::nullopt;
    RadLightPattern result;
    result.correction = *correction;
    result.data_file = strings[1];
    std::size_t i = 3;
    for (; i < strings.size() && !strings[i].starts_with('-'); ++i) {
        const auto coordinate = coordinate_of(strings[i]);
        if (!coordinate) return std::nullopt;
        result.coordinates.push_back(*coordinate);
    }
    const TransformSequence transform{std::span(strings).subspan(i)};
    if (transform.is_array()) return std::nullopt;
    result.to_file = transform.matrix({});
    result.arguments = primitive.numbers;
    const std::size_t needed = *correction == Correction::box ? 4 : *correction == Correction::cylinder ? 3 : 0;
    if (result.arguments.size() < needed ||
        std::any_of(result.arguments.begin(), result.arguments.end(), [](double x) { return !(x > 0); }))
        throw std::invalid_argument(fmt::format("{} needs {} numbers above 0", strings[0], std::max(needed, 1ul)));
    if (strings[0] == "noop") result.arguments.clear();
    return result;
}

Imath::Box3d RadEmitter::bounds() const {
    Imath::Box3d box;
    for (const PolygonMesh& surface : surfaces)
        for (const V3d& point : surface.points) box.extendBy(point);
    return box;
}

PhotometricWeb make_light_web(const RadLightPattern& pattern, const RadData& data, const RadEmitter& emitter) {
    // A table with fewer dimensions than coordinates keeps theta.
    std::vector<Coordinate> coordinates = pattern.coordinates;
    if (data.axes.size() < coordinates.size())
        std::stable_partition(coordinates.begin(), coordinates.end(),
                              [](Coordinate c) { return c == Coordinate::theta; });
    if (coordinates.size() < data.axes.size())
        throw std::invalid_argument(
            fmt::format("{} coordinates for a table of {} dimensions", coordinates.size(), data.axes.size()));
    coordinates.resize(data.axes.size());
    // Choose the angles of the web
    const std::vector<double>* theta = nullptr;
    const std::vector<double>* phi = nullptr;
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
        if (coordinates[k] == Coordinate::theta) theta = &data.axes[k];
        if (coordinates[k] == Coordinate::phi || coordinates[k] == Coordinate::phi2 ||
            coordinates[k] == Coordinate::phi4)
            phi = &data.axes[k];
    }
    constexpr double theta_step = 2.5, phi_step = 7.5;  // [degrees]; the flux of a cosine is exact to 0.02%
    PhotometricWeb web;
    const double low = theta ? std::max(0.0, theta->front()) : 0;
    const double high = theta ? std::min(half_turn, theta->back()) : half_turn;
    web.polar = angles_of(theta, low, high, theta_step);
    web.azimuth = angles_of(phi, 0, full_turn, phi_step);
    if (web.polar.size() < 2) throw std::invalid_argument("its polar angles are not from 0 to 180 degrees");
    // Compute the intensity in each direction
    const std::vector<Facet> facets = facets_of(emitter);
    std::vector<double> at(coordinates.size());
    for (const float azimuth : web.azimuth)
        for (const float polar : web.polar) {
            const double sine = std::sin(radians(polar));
            const V3d d(sine * std::cos(radians(azimuth)), sine * std::sin(radians(azimuth)),
                        -std::cos(radians(polar)));
            for (std::size_t k = 0; k < at.size(); ++k) {
                // Rounding must not leave the table at its ends.
                constexpr double rounding = 1e-4;  // [degrees]
                const std::vector<double>& axis = data.axes[k];
                at[k] = value_of(coordinates[k], d);
                if (at[k] > axis.front() - rounding && at[k] < axis.back() + rounding)
                    at[k] = std::clamp(at[k], axis.front(), axis.back());
            }
            web.intensities.push_back(
                static_cast<float>(std::max(0.0, data.at(at)) * corrected_area(pattern, facets, d)));
        }
    web.opening = {emitter.shape, V3f(emitter.bounds().size()), 2};
    return web;
}

}  // namespace interflect::detail
