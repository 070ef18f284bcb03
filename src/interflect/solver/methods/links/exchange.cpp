#include "interflect/solver/methods/links/exchange.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"
#include "interflect/elements/forest.h"

namespace interflect::detail {

namespace {

/// Clips a polygon to the half-space above the plane through the origin (Sutherland and Hodgman 1974).
ConvexPolygon clip_to_horizon(std::span<const V3d> polygon, const V3d& normal) {
    ConvexPolygon above;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V3d &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const double from_height = normal.dot(from), to_height = normal.dot(to);
        if (from_height >= 0) above.add(from);
        if ((from_height > 0 && to_height < 0) || (from_height < 0 && to_height > 0))
            above.add(from + (to - from) * (from_height / (from_height - to_height)));
    }
    return above;
}

/// Gauss rule on [0, 1] with 2 or 4 points.
struct GaussRule {
    std::array<double, 4> node, weight;
};
constexpr GaussRule gauss_2{{0.2113248654051871, 0.7886751345948129, 0, 0}, {0.5, 0.5, 0, 0}};
constexpr GaussRule gauss_4{{0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263},
                            {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269}};

/// Points on an element and their weights, as a product of two Gauss rules.
struct Quadrature {
    static constexpr std::size_t capacity = 16;

    double span;  // distance between the first and last node, relative to the side of the element
    std::array<V3f, capacity> point;
    std::array<double, capacity> weight;  // weights of the points; their sum is 1
    std::size_t count = 0;

    Quadrature(const ElementForest& forest, ElementIndex e, Effort effort) {
        const PatchGeometry& geometry = forest.geometry(forest.patch(e));
        const Cell cell = forest.cell(e);
        const auto side = static_cast<std::size_t>(effort);
        const GaussRule& rule = effort == Effort::quick ? gauss_2 : gauss_4;
        span = rule.node[side - 1] - rule.node[0];
        double sum = 0;
        for (std::size_t i = 0; i < side; ++i)
            for (std::size_t j = 0; j < side; ++j) {
                // A triangle is treated as a square with one collapsed side (Duffy 1982).
                const double width = geometry.is_triangle() ? 1 - rule.node[i] : 1;
                const Parameters p =
                    cell.at(static_cast<float>(rule.node[i]), static_cast<float>(width * rule.node[j]));
                point[count] = geometry.point(p);
                weight[count] = rule.weight[i] * rule.weight[j] * width * static_cast<double>(geometry.jacobian(p));
                sum += weight[count++];
            }
        for (std::size_t k = 0; k < count; ++k) weight[k] /= sum;
    }
};

struct FormFactors {
    double mean = 0;
    double spread = 0;  // largest minus smallest form factor, extrapolated to the edges
};

FormFactors form_factors(const ElementForest& forest, const Quadrature& points, ElementIndex from, ElementIndex to) {
    const V3d normal(forest.geometry(forest.patch(from)).normal());
    const ConvexPolygon polygon(forest, to);
    FormFactors result;
    double least = 1, most = 0;
    for (std::size_t k = 0; k < points.count; ++k) {
        const double f = polygon.form_factor_from(V3d(points.point[k]), normal);
        result.mean += points.weight[k] * f;
        least = std::min(least, f);
        most = std::max(most, f);
    }
    result.spread = (most - least) / points.span;
    return result;
}

struct LinesOfSight {
    const ElementForest& forest;
    const ExchangeEstimator& estimator;
    std::uint64_t seed;
    std::int64_t& rays;

    /// Samples the transmittance of lines of sight, weighted by their unoccluded light.
    void sample(ElementIndex small, ElementIndex large, const Quadrature& points, Exchange& exchange) {
        const PatchGeometry& geometry = forest.geometry(forest.patch(large));
        const V3f normal_x = forest.geometry(forest.patch(small)).normal(), normal_y = geometry.normal();
        const Cell cell = forest.cell(large);
        const float disk = forest.area(large) / static_cast<float>(points.count);  // area represented by y [m^2]
        PointBlock random;
        fill_points(PointSet::sobol, mix(mix(seed, element_key(forest, small)), element_key(forest, large)), 0,
                    points.count, random);
        double all = 0;
        RgbD free(0, 0, 0);
        Rgb least(1), most(0);
        for (std::size_t k = 0; k < points.count; ++k) {
            const V3f x = points.point[k];
            const V3f y = geometry.point(geometry.uniform_parameters(random.coordinate[0][k], random.coordinate[1][k],
                                                                     {cell.u, cell.v}, cell.size));
            const V3f d = y - x;
            const float cosines = std::max(0.0f, normal_x.dot(d)) * std::max(0.0f, -normal_y.dot(d)) / d.length2();
            if (!(cosines > 0)) continue;
            const float kernel = cosines / (std::numbers::pi_v<float> * d.length2() + disk);
            const double along_line = points.weight[k] * static_cast<double>(kernel);
            all += along_line;
            const Rgb line = estimator.transmittance({small, x}, {large, y}, rays);
            free += RgbD(line) * along_line;
            least = smaller(least, line);
            most = larger(most, line);
        }
        // The transmittance is 1 if no sampled line joins the two fronts.
        exchange.transmittance = all > 0 ? Rgb(free / all) : Rgb(1);
        exchange.variation = all > 0 ? largest_channel(most - least) : 0;
    }
};

}  // namespace

std::uint64_t element_key(const ElementForest& forest, ElementIndex e) {
    return std::uint64_t{forest.patch(e)} << 32 | forest.path(e);
}

double form_factor_to_polygon(const V3d& x, const V3d& normal, std::span<const V3d> polygon) {
    ConvexPolygon seen;
    for (const V3d& corner : polygon) seen.add(corner - x);
    seen = clip_to_horizon(seen.corners(), normal);
    double sum = 0;
    for (std::size_t i = 0; i < seen.corners().size(); ++i) {
        const V3d &r = seen.corners()[i], &s = seen.corners()[(i + 1) % seen.corners().size()];
        const V3d across = s.cross(r);  // a polygon that faces x is counter-clockwise as seen from x
        const double length = across.length();
        if (length > 0) sum += std::atan2(length, r.dot(s)) * normal.dot(across) / length;
    }
    return std::max(0.0, sum / (2 * std::numbers::pi));
}

ConvexPolygon::ConvexPolygon(const ElementForest& forest, ElementIndex e)
    : normal_(forest.geometry(forest.patch(e)).normal()) {
    const PatchGeometry& geometry = forest.geometry(forest.patch(e));
    const Cell cell = forest.cell(e);
    add(V3d(geometry.point(cell.at(0, 0))));
    add(V3d(geometry.point(cell.at(1, 0))));
    if (!geometry.is_triangle()) add(V3d(geometry.point(cell.at(1, 1))));
    add(V3d(geometry.point(cell.at(0, 1))));
}

double ConvexPolygon::form_factor_from(const V3d& x, const V3d& normal) const {
    return normal_.dot(x - corner_[0]) > 0 ? form_factor_to_polygon(x, normal, corners()) : 0;
}

bool ExchangeEstimator::face_each_other(const ElementPair& pair) const {
    const auto reaches_above = [&](ElementIndex e, ElementIndex ground) {
        const V3d normal(forest_.geometry(forest_.patch(ground)).normal());
        const double height = normal.dot(ConvexPolygon(forest_, ground).corners()[0]) +
                              static_cast<double>(ray_caster_.ray_offset(forest_.patch(ground)));
        const ConvexPolygon polygon(forest_, e);
        return std::any_of(polygon.corners().begin(), polygon.corners().end(),
                           [&](const V3d& corner) { return normal.dot(corner) > height; });
    };
    return reaches_above(pair.a, pair.b) && reaches_above(pair.b, pair.a);
}

Exchange ExchangeEstimator::estimate(const ElementPair& pair, Effort effort, std::int64_t& rays) const {
    const Quadrature points_of_a(forest_, pair.a, effort), points_of_b(forest_, pair.b, effort);
    const FormFactors from_a = form_factors(forest_, points_of_a, pair.a, pair.b);
    const FormFactors from_b = form_factors(forest_, points_of_b, pair.b, pair.a);
    const double area_a = forest_.area(pair.a), area_b = forest_.area(pair.b);
    const bool a_is_smaller = area_a <= area_b;
    Exchange exchange;
    exchange.area = static_cast<float>(a_is_smaller ? area_a * from_a.mean : area_b * from_b.mean);
    if (exchange.area == 0) return exchange;
    exchange.spread_over_a = static_cast<float>(area_a * from_a.spread);
    exchange.spread_over_b = static_cast<float>(area_b * from_b.spread);
    LinesOfSight lines{forest_, *this, seed_, rays};
    if (a_is_smaller)
        lines.sample(pair.a, pair.b, points_of_a, exchange);
    else
        lines.sample(pair.b, pair.a, points_of_b, exchange);
    return exchange;
}

Rgb ExchangeEstimator::transmittance(const PointOfElement& x, const PointOfElement& y, std::int64_t& rays) const {
    // Trace both directions, because rays pass the back of a one-sided face and hit only one of two coincident faces.
    const Rgb line = one_way(x, y, rays);
    return line != Rgb(0) ? smaller(line, one_way(y, x, rays)) : line;
}

Rgb ExchangeEstimator::one_way(const PointOfElement& from, const PointOfElement& to, std::int64_t& rays) const {
    const PatchIndex source = forest_.patch(from.element), target = forest_.patch(to.element);
    const V3f origin = from.position + forest_.geometry(source).normal() * ray_caster_.ray_offset(source);
    const Ray ray{origin, (to.position - origin).normalized()};
    Hit hit;
    ray_caster_.trace(std::span(&ray, 1), std::span(&hit, 1));
    ++rays;
    if (hit.patch == target) return Rgb(1);
    std::vector<Panes::HitBehind> behind;
    panes_.trace(std::span(&ray, 1), std::span(&hit, 1), behind);
    const auto found = std::find_if(behind.begin(), behind.end(), [&](const auto& b) { return b.hit.patch == target; });
    return found == behind.end() ? Rgb(0) : found->transmittance;
}

}  // namespace interflect::detail
