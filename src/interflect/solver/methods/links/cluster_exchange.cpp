#include "interflect/solver/methods/links/cluster_exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "interflect/base/numbers/points.h"
#include "interflect/base/numbers/random.h"

namespace interflect::detail {

namespace {

/// Two ends are distant if the sum of their radii is less than this share of their distance.
constexpr float largest_opening = 0.8f;
constexpr std::size_t most_lines = 16;

bool are_distant(const Sphere& a, const Sphere& b) {
    return a.radius + b.radius < largest_opening * (a.centre - b.centre).length();
}

/// Returns twice the standard deviation of the transmittance of a line, after a blocked and a free line are added to
/// the sample (Laplace). It is positive even if all lines agree, in contrast to their range. With the range, only links
/// whose few lines are free by chance would remain undivided, which overestimates light.
/// @param mean, mean_square  Mean and mean square of the transmittance of the sampled lines.
float likely_variation(double mean, double mean_square, std::size_t lines) {
    const auto n = static_cast<double>(lines);
    const double likely = (mean * n + 1) / (n + 2);
    return static_cast<float>(2 * std::sqrt(std::max(0.0, (mean_square * n + 1) / (n + 2) - likely * likely)));
}

struct Choice {
    const ClusterMember* member;
    float remainder;  // uniform number in [0, 1] within the member
};

/// Chooses members with probability w / sum, by inversion of the uniform numbers `u`.
void choose(std::span<const ClusterMember> members, const auto& weight, double sum, std::span<const float> u,
            std::array<Choice, most_lines>& chosen) {
    std::array<std::size_t, most_lines> order{};
    std::iota(order.begin(), order.begin() + std::ssize(u), std::size_t{0});
    std::sort(order.begin(), order.begin() + std::ssize(u), [&](std::size_t i, std::size_t j) { return u[i] < u[j]; });
    double below = 0;
    std::size_t next = 0;
    const ClusterMember* last = nullptr;
    for (const ClusterMember& member : members) {
        if (next == u.size()) return;
        const double w = weight(member);
        if (!(w > 0)) continue;
        last = &member;
        for (; next < u.size() && u[order[next]] * sum < below + w; ++next) {
            const auto remainder = static_cast<float>((u[order[next]] * sum - below) / w);
            chosen[order[next]] = {last, std::clamp(remainder, 0.0f, 1.0f)};
        }
        below += w;
    }
    // Rounding may leave numbers beyond the last member.
    for (; next < u.size(); ++next) chosen[order[next]] = {last, 0.5f};
}

}  // namespace

ClusterExchange::End ClusterExchange::end(ElementIndex end) const {
    if (is_cluster(end)) return {tree_.cluster(end).sphere, {}, tree_.members(end)};
    return {sphere_around(forest_, end), member_of(forest_, end), {}};
}

Sphere ClusterExchange::sphere(ElementIndex end) const {
    return is_cluster(end) ? tree_.cluster(end).sphere : sphere_around(forest_, end);
}

bool ClusterExchange::is_valid(const ElementPair& pair) const {
    const Sphere a = sphere(pair.a), b = sphere(pair.b);
    if (are_distant(a, b)) return true;
    if (is_cluster(pair.a) == is_cluster(pair.b)) return false;
    const ElementIndex element = is_cluster(pair.a) ? pair.b : pair.a, cluster = is_cluster(pair.a) ? pair.a : pair.b;
    const Sphere& around_element = is_cluster(pair.a) ? b : a;
    const PatchTree::Cluster& patches = tree_.cluster(cluster);
    const V3f line = patches.sphere.centre - around_element.centre;
    const float height = std::abs(forest_.geometry(forest_.patch(element)).normal().dot(line));
    const float distance = std::max(height, line.length() - around_element.radius) - patches.sphere.radius;
    return patches.largest_radius < largest_opening * distance;
}

double ClusterExchange::Weight::operator()(const ClusterMember& member) const {
    if (kind == Kind::one) return 1;
    if (kind == Kind::by_polygon) {
        const V3d area_vector(member.area_vector);
        const double area = area_vector.length();
        return area > 0 ? area * polygon.form_factor_from(V3d(member.centre), area_vector / area) : 0;
    }
    const V3d line(point - member.centre);
    const double distance_2 = line.length2(), height = V3d(member.area_vector).dot(line);
    return height > 0 ? height / (distance_2 * std::sqrt(distance_2)) : 0;
}

ClusterExchange::Factors::Factors(const ClusterExchange& exchange, const ElementPair& pair)
    : a(exchange.end(pair.a)), b(exchange.end(pair.b)) {
    const bool are_clusters = !a.patches.empty() && !b.patches.empty();
    if (are_clusters || are_distant(a.sphere, b.sphere)) {
        weight_a = {Weight::Kind::by_point, b.sphere.centre, {}};
        weight_b = {Weight::Kind::by_point, a.sphere.centre, {}};
        scale = static_cast<double>((a.sphere.centre - b.sphere.centre).length2()) / std::numbers::pi;
        return;
    }
    Weight& weight = a.patches.empty() ? weight_b : weight_a;
    weight.kind = Weight::Kind::by_polygon;
    weight.polygon = ConvexPolygon(exchange.forest_, a.patches.empty() ? pair.a : pair.b);
}

Exchange ClusterExchange::estimate(const ElementPair& pair, Effort effort, std::int64_t& rays) const {
    const Factors factors(*this, pair);
    const auto sum = [](const End& end, const Weight& weight) {
        double all = 0;
        for (const ClusterMember& member : end.members()) all += weight(member);
        return all;
    };
    const double sum_a = sum(factors.a, factors.weight_a), sum_b = sum(factors.b, factors.weight_b);
    Exchange exchange;
    exchange.area = static_cast<float>(factors.scale * sum_a * sum_b);
    if (!(exchange.area > 0)) return Exchange{};

    const std::size_t lines = static_cast<std::size_t>(effort) * static_cast<std::size_t>(effort);

    // Choose the ends of the lines of sight in proportion to the weights
    const auto key_of = [&](ElementIndex end) {
        return is_cluster(end) ? std::uint64_t{end} << 32 : element_key(forest_, end);
    };
    PointBlock random;
    fill_points(PointSet::sobol, mix(mix(seed_, key_of(pair.a)), key_of(pair.b)), 0, lines, random);
    std::array<Choice, most_lines> ends_a, ends_b;
    choose(factors.a.members(), factors.weight_a, sum_a, std::span(random.coordinate[0]).first(lines), ends_a);
    choose(factors.b.members(), factors.weight_b, sum_b, std::span(random.coordinate[1]).first(lines), ends_b);
    const auto point_of = [&](const Choice& choice, float second) {
        const ElementIndex e = choice.member->element;
        const PatchGeometry& geometry = forest_.geometry(forest_.patch(e));
        const Cell cell = forest_.cell(e);
        return geometry.point(geometry.uniform_parameters(choice.remainder, second, {cell.u, cell.v}, cell.size));
    };

    // Average the transmittance over the lines, weighted by the ratio of exact to approximate exchange
    double all = 0, squares = 0, least_ratio = std::numeric_limits<double>::infinity(), most_ratio = 0;
    RgbD free(0, 0, 0);
    for (std::size_t k = 0; k < lines; ++k) {
        const ClusterMember &p = *ends_a[k].member, &q = *ends_b[k].member;
        const V3f x = point_of(ends_a[k], random.coordinate[2][k]), y = point_of(ends_b[k], random.coordinate[3][k]);
        const V3d d(y - x);
        const double disk = std::max(forest_.area(p.element), forest_.area(q.element)) / static_cast<double>(lines);
        // Exchange of two points times the areas of their patches
        const double cosines =
            std::max(0.0, V3d(p.area_vector).dot(d)) * std::max(0.0, -V3d(q.area_vector).dot(d)) / d.length2();
        const double ratio = cosines / (std::numbers::pi * d.length2() + disk) /
                             (factors.scale * factors.weight_a(p) * factors.weight_b(q));
        least_ratio = std::min(least_ratio, ratio);
        most_ratio = std::max(most_ratio, ratio);
        if (!(ratio > 0)) continue;
        const Rgb line = estimator_.transmittance({p.element, x}, {q.element, y}, rays);
        all += ratio;
        free += RgbD(line) * ratio;
        squares += std::pow(static_cast<double>(largest_channel(line)), 2) * ratio;
    }
    exchange.transmittance = all > 0 ? Rgb(free / all) : Rgb(1);
    exchange.variation = all > 0 ? likely_variation(largest_channel(free) / all, squares / all, lines) : 0;
    // Weights by polygon already contain the variation over the element.
    const bool is_by_points = factors.weight_a.kind == factors.weight_b.kind;
    const double spread = is_by_points ? exchange.area * (most_ratio - least_ratio) : 0;
    exchange.spread_over_a = exchange.spread_over_b = static_cast<float>(spread);
    return exchange;
}

}  // namespace interflect::detail
