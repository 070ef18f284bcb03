#include "interflect/geometry/contacts/face_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace interflect::detail {

namespace {

using Imath::V2d;

/// Number of segments, the longest ones, that are compared as the next cut.
constexpr std::size_t candidates_per_cut = 24;

/// Directed line; height() is positive on its left.
struct Line {
    V2d origin, direction;

    explicit Line(const PlanarSegment& s) : origin(s.a), direction((s.b - s.a).normalized()) {}
    double height(const V2d& x) const { return direction.cross(x - origin); }
    double along(const V2d& x) const { return direction.dot(x - origin); }
};

int side_of(double height, double tolerance) { return (height > tolerance) - (height < -tolerance); }

struct Piece {
    PlanarPolygon polygon;
    std::vector<PlanarSegment> segments;
};

/// Sorts segments by position, so choices do not depend on their order in memory.
auto geometric_order(const PlanarSegment& s) {
    return std::make_tuple(std::min(s.a.x, s.b.x), std::min(s.a.y, s.b.y), s.a.x + s.b.x, s.a.y + s.b.y);
}

std::vector<PlanarSegment> candidates(const std::vector<PlanarSegment>& segments) {
    std::vector<PlanarSegment> longest = segments;
    const std::size_t count = std::min(candidates_per_cut, segments.size());
    std::partial_sort(longest.begin(), longest.begin() + static_cast<std::ptrdiff_t>(count), longest.end(),
                      [](const PlanarSegment& s, const PlanarSegment& t) {
                          return std::make_tuple(-s.length(), geometric_order(s)) <
                                 std::make_tuple(-t.length(), geometric_order(t));
                      });
    longest.resize(count);
    return longest;
}

double chord_length(const PlanarPolygon& polygon, const Line& line) {
    double from = std::numeric_limits<double>::infinity(), to = -from;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V2d &p = polygon[i].position, &q = polygon[(i + 1) % polygon.size()].position;
        const double hp = line.height(p), hq = line.height(q);
        if ((hp > 0) == (hq > 0)) continue;
        const double x = line.along(p + (q - p) * (hp / (hp - hq)));
        from = std::min(from, x);
        to = std::max(to, x);
    }
    return std::max(0.0, to - from);
}

/// Returns the cost of a cut: divided segments, length without contact, and unequal numbers of segments on both sides.
double cost_of(const Piece& piece, const Line& line, double tolerance) {
    constexpr double division_weight = 2, free_length_weight = 1, imbalance_weight = 0.5;
    std::size_t divided = 0;
    double covered = 0, left = 0, right = 0;
    for (const PlanarSegment& s : piece.segments) {
        const int a = side_of(line.height(s.a), tolerance), b = side_of(line.height(s.b), tolerance);
        if (a == 0 && b == 0) covered += s.length();
        divided += a * b < 0;
        left += a + b > 0;
        right += a + b < 0;
    }
    const double free_share = 1 - std::min(1.0, covered / std::max(chord_length(piece.polygon, line), tolerance));
    return division_weight * static_cast<double>(divided) + free_length_weight * free_share +
           imbalance_weight * std::abs(left - right) / static_cast<double>(piece.segments.size());
}

Line best_cut(const Piece& piece, double tolerance) {
    const std::vector<PlanarSegment> choice = candidates(piece.segments);
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < choice.size(); ++i)
        if (const double cost = cost_of(piece, Line(choice[i]), tolerance); cost < least) {
            least = cost;
            best = i;
        }
    return Line(choice[best]);
}

/// Parts of a polygon on the two sides of a line, and their common edge.
struct Halves {
    PlanarPolygon left, right;
    PlanarSegment chord;
    bool proper = false;  // whether both parts have an area
};

Halves halves_of(const PlanarPolygon& polygon, const Line& line, double tolerance) {
    Halves halves;
    std::vector<V2d> ends;
    const auto add_to_both = [&](const PlanarCorner& corner) {
        halves.left.push_back(corner);
        halves.right.push_back(corner);
        ends.push_back(corner.position);
    };
    bool has_left = false, has_right = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const PlanarCorner &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double hp = line.height(p.position), hq = line.height(q.position);
        const int p_side = side_of(hp, tolerance), q_side = side_of(hq, tolerance);
        has_left |= p_side > 0;
        has_right |= p_side < 0;
        if (p_side == 0) add_to_both(p);
        if (p_side > 0) halves.left.push_back(p);
        if (p_side < 0) halves.right.push_back(p);
        if (p_side * q_side < 0) add_to_both({p.position + (q.position - p.position) * (hp / (hp - hq)), none});
    }
    halves.proper = has_left && has_right && ends.size() == 2;
    if (halves.proper) halves.chord = {ends[0], ends[1]};
    return halves;
}

/// Projects `s` onto `edge`.
PlanarSegment moved_onto(const PlanarSegment& edge, const PlanarSegment& s) {
    const Line line(edge);
    const auto moved = [&](const V2d& x) {
        return edge.a + line.direction * std::clamp(line.along(x), 0.0, edge.length());
    };
    return {moved(s.a), moved(s.b)};
}

/// Assigns segments to the pieces on both sides of a cut. Segments along the cut become contacts.
void distribute(const std::vector<PlanarSegment>& segments, const Line& line, const PlanarSegment& chord,
                double tolerance, Piece& left, Piece& right, std::vector<PlanarSegment>& contacts) {
    const auto add_to = [&](Piece& piece, PlanarSegment s) {
        if (clip_to_interior(piece.polygon, tolerance, s)) piece.segments.push_back(s);
    };
    for (const PlanarSegment& s : segments) {
        const double ha = line.height(s.a), hb = line.height(s.b);
        const int a = side_of(ha, tolerance), b = side_of(hb, tolerance);
        if (a == 0 && b == 0) {
            contacts.push_back(moved_onto(chord, s));
        } else if (a * b < 0) {
            const V2d crossing = s.a + (s.b - s.a) * (ha / (ha - hb));
            add_to(a > 0 ? left : right, {s.a, crossing});
            add_to(b > 0 ? left : right, {crossing, s.b});
        } else {
            add_to(a + b > 0 ? left : right, s);
        }
    }
}

double compactness(const PlanarPolygon& polygon) {
    const double border = perimeter(polygon);
    return doubled_area(polygon) / (border * border);
}

/// Returns the part with the corners from `first` to `last`, inclusive.
PlanarPolygon part_of(const PlanarPolygon& polygon, std::size_t first, std::size_t last) {
    PlanarPolygon part;
    for (std::size_t i = first;; i = (i + 1) % polygon.size()) {
        part.push_back(polygon[i]);
        if (i == last) return part;
    }
}

void divide_across(PlanarPolygon quadrilateral, const PieceShape& shape, std::vector<PlanarPolygon>& patches) {
    constexpr double max_parts = 16;
    const auto edge = [&](std::size_t i) {
        return (quadrilateral[(i + 1) % 4].position - quadrilateral[i].position).length();
    };
    if (edge(0) + edge(2) < edge(1) + edge(3))  // makes edges 0 and 2 the longer pair
        std::rotate(quadrilateral.begin(), quadrilateral.begin() + 1, quadrilateral.end());
    const double length = (edge(0) + edge(2)) / 2, width = doubled_area(quadrilateral) / 2 / length;
    const bool is_long = length > shape.largest_aspect * width && width >= shape.min_width;
    const double parts = is_long ? std::min(max_parts, std::ceil(length / (shape.largest_aspect * width))) : 1;
    const auto between = [&](std::size_t from, std::size_t to, double share) -> PlanarCorner {
        const PlanarCorner &a = quadrilateral[from], &b = quadrilateral[to];
        return share == 0 ? a : share == 1 ? b : PlanarCorner{a.position + (b.position - a.position) * share, none};
    };
    for (double i = 0; i < parts; ++i)
        patches.push_back({between(0, 1, i / parts), between(0, 1, (i + 1) / parts), between(3, 2, (i + 1) / parts),
                           between(3, 2, i / parts)});
}

/// Cuts a sliver across its longest edge into slices of at most `longest` [m]. Returns other polygons whole.
std::vector<PlanarPolygon> slices_of(const PlanarPolygon& polygon, double longest) {
    constexpr double max_parts = 64, sliver_aspect = 16;
    PlanarSegment edge{polygon[0].position, polygon[0].position};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const PlanarSegment next{polygon[i].position, polygon[(i + 1) % polygon.size()].position};
        if (next.length() > edge.length()) edge = next;
    }
    const double length = edge.length(), width = doubled_area(polygon) / 2 / length;
    if (!(length > longest) || length < sliver_aspect * width) return {polygon};
    const double parts = std::min(max_parts, std::ceil(length / longest));
    const V2d along = (edge.b - edge.a) / parts, across(-along.y, along.x);
    const double rounding = length * std::numeric_limits<float>::epsilon();
    std::vector<PlanarPolygon> slices;
    PlanarPolygon rest = polygon;
    for (double i = 1; i < parts; ++i) {
        const V2d at = edge.a + along * i;
        Halves halves = halves_of(rest, Line({at, at + across}), rounding);
        if (!halves.proper) continue;
        slices.push_back(std::move(halves.left));
        rest = std::move(halves.right);
    }
    slices.push_back(std::move(rest));
    return slices;
}

}  // namespace

bool clip_to_interior(const PlanarPolygon& polygon, double tolerance, PlanarSegment& segment) {
    const V2d d = segment.b - segment.a;
    double from = 0, to = 1;
    const auto inward_line = [&](std::size_t i) {
        return Line({polygon[i].position, polygon[(i + 1) % polygon.size()].position});
    };
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Line edge = inward_line(i);
        const double ha = edge.height(segment.a), hb = edge.height(segment.b);
        if (ha < 0 && hb < 0) return false;
        if (ha < 0) from = std::max(from, ha / (ha - hb));
        if (hb < 0) to = std::min(to, ha / (ha - hb));
    }
    if ((to - from) * d.length() <= tolerance) return false;
    const PlanarSegment inside{segment.a + d * from, segment.a + d * to};
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Line edge = inward_line(i);
        if (edge.height(inside.a) <= tolerance && edge.height(inside.b) <= tolerance) return false;
    }
    segment = inside;
    return true;
}

CutPolygon cut_polygon(PlanarPolygon polygon, std::vector<PlanarSegment> segments, double tolerance,
                       std::size_t max_pieces) {
    CutPolygon result;
    std::vector<Piece> to_do;
    to_do.push_back({std::move(polygon), std::move(segments)});
    while (!to_do.empty()) {
        Piece piece = std::move(to_do.back());
        to_do.pop_back();
        if (!piece.segments.empty() && result.pieces.size() + to_do.size() + 1 >= max_pieces) {
            result.reached_limit = true;
            piece.segments.clear();
        }
        if (piece.segments.empty()) {
            result.pieces.push_back(std::move(piece.polygon));
            continue;
        }
        const Line line = best_cut(piece, tolerance);
        Halves halves = halves_of(piece.polygon, line, tolerance);
        if (!halves.proper) {  // because the line runs along the border
            std::erase_if(piece.segments, [&](const PlanarSegment& s) {
                return side_of(line.height(s.a), tolerance) == 0 && side_of(line.height(s.b), tolerance) == 0;
            });
            to_do.push_back(std::move(piece));
            continue;
        }
        Piece left{std::move(halves.left), {}}, right{std::move(halves.right), {}};
        distribute(piece.segments, line, halves.chord, tolerance, left, right, result.contacts);
        to_do.push_back(std::move(right));
        to_do.push_back(std::move(left));
    }
    return result;
}

void divide_into_patches(const PlanarPolygon& polygon, const PieceShape& shape, std::vector<PlanarPolygon>& patches) {
    if (const std::vector<PlanarPolygon> slices = slices_of(polygon, shape.longest_sliver); slices.size() > 1) {
        for (const PlanarPolygon& slice : slices)
            divide_into_patches(slice, {shape.largest_aspect, shape.min_width}, patches);
        return;
    }
    const std::size_t n = polygon.size();
    if (n == 3) patches.push_back(polygon);
    if (n == 4) divide_across(polygon, shape, patches);
    if (n <= 4) return;
    // Cut off the triangle or quadrilateral for which the less compact part is the most compact
    std::array<PlanarPolygon, 2> best;
    double most = -1;
    for (std::size_t first = 0; first < n; ++first)
        for (const std::size_t step : {2, 3}) {
            std::array<PlanarPolygon, 2> parts{part_of(polygon, first, (first + step) % n),
                                               part_of(polygon, (first + step) % n, first)};
            const double worse = std::min(compactness(parts[0]), compactness(parts[1]));
            if (worse <= most) continue;
            most = worse;
            best = std::move(parts);
        }
    for (const PlanarPolygon& part : best) divide_into_patches(part, shape, patches);
}

}  // namespace interflect::detail
