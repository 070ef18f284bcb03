#include "interflect/formats/rad/generators.h"

#include <ImathVec.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "interflect/formats/rad/statements/arguments.h"
#include "interflect/formats/text/number.h"

namespace interflect::detail {

namespace {

using Imath::V3d;
using Points = std::vector<V3d>;

GeneratedSurface polygon(const std::string& name, const Points& points) {
    GeneratedSurface result{"polygon", name, {}};
    for (const V3d& p : points) result.numbers.insert(result.numbers.end(), {p.x, p.y, p.z});
    return result;
}

/// Box from the origin to `size`. Bits 0 to 2 of a corner's number select the far end along x, y and z.
struct Box {
    V3d size;
    double inset = 0;  // width of the bevel or rounding that the plane faces leave along their edges

    static bool is_far(int corner, int axis) { return (corner >> axis & 1) != 0; }
    /// Returns the corner, moved inwards along all axes but `axis`; along all axes for -1.
    V3d point(int corner, int axis) const {
        V3d result;
        for (int i = 0; i < 3; ++i) {
            const double distance = i == axis ? 0 : inset;
            result[i] = is_far(corner, i) ? size[i] - distance : distance;
        }
        return result;
    }
    /// Orders the points of a convex face counter-clockwise as seen from outside.
    Points outward(Points points) const {
        const V3d normal = (points[1] - points[0]).cross(points[2] - points[0]);
        if (normal.dot(points[0] - size / 2) < 0) std::reverse(points.begin(), points.end());
        return points;
    }
};

/// Corners of each face, which are its name in genbox.
constexpr std::array<std::string_view, 6> box_faces = {"1540", "4620", "2310", "3267", "5137", "6457"};

/// Returns the axis perpendicular to a face, along which its corners agree.
int face_axis(std::string_view corners) {
    int same = 7;
    for (const char corner : corners) same &= ~((corner - '0') ^ (corners[0] - '0'));
    return same == 1 ? 0 : same == 2 ? 1 : 2;
}

/// Adds flat pieces between the faces: one for each edge and each corner.
void add_bevels(const Box& box, const std::string& name, std::vector<GeneratedSurface>& result) {
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int corner = 0; corner < 8; ++corner) {
            if (Box::is_far(corner, axis)) continue;
            const int end = corner | 1 << axis;
            result.push_back(polygon(
                fmt::format("{}.e{}{}", name, corner, end),
                box.outward({box.point(corner, u), box.point(end, u), box.point(end, v), box.point(corner, v)})));
        }
    }
    for (int corner = 0; corner < 8; ++corner)
        result.push_back(polygon(fmt::format("{}.c{}", name, corner),
                                 box.outward({box.point(corner, 0), box.point(corner, 1), box.point(corner, 2)})));
}

/// Adds whole cylinders and spheres, as genbox does.
void add_rounds(const Box& box, const std::string& name, std::vector<GeneratedSurface>& result) {
    for (int corner = 0; corner < 8; ++corner) {
        const V3d a = box.point(corner, -1);
        for (int axis = 0; axis < 3; ++axis) {
            const V3d b = box.point(corner | 1 << axis, -1);
            if (!Box::is_far(corner, axis) && a != b)
                result.push_back({"cylinder",
                                  fmt::format("{}.e{}{}", name, corner, corner | 1 << axis),
                                  {a.x, a.y, a.z, b.x, b.y, b.z, box.inset}});
        }
        result.push_back({"sphere", fmt::format("{}.c{}", name, corner), {a.x, a.y, a.z, box.inset}});
    }
}

/// genbox material name xsize ysize zsize [-i] [-b bevel | -r round [-n segments] [-s]] [-o]
std::optional<GeneratedSurfaces> genbox(RadArguments arguments) {
    GeneratedSurfaces result;
    result.modifier = arguments.next("a material");
    const std::string name = arguments.next("a name");
    // Read the options
    Box box{arguments.vector("one of three sizes")};
    bool is_inward = false, is_round = false;
    while (!arguments.is_at_end()) {
        const std::string option = arguments.next("an option");
        if (option == "-i") {
            is_inward = true;
        } else if (option == "-b" || option == "-r") {
            box.inset = arguments.number("a radius");
            is_round = option == "-r";
        } else if (option == "-n") {
            arguments.number("the number of segments");
        } else if (option == "-o") {
            return std::nullopt;
        } else if (option != "-s") {
            throw std::invalid_argument(fmt::format("'{}' is no option of genbox", option));
        }
    }
    const double least = std::min({box.size.x, box.size.y, box.size.z});
    if (!(least > 0) || box.inset < 0 || 2 * box.inset > least)
        throw std::invalid_argument("genbox needs sizes above 0, and a bevel or rounding of at most half of each");
    // Add the faces, then the edges and corners
    for (const std::string_view face : box_faces) {
        Points points;
        for (const char corner : face) points.push_back(box.point(corner - '0', face_axis(face)));
        if (2 * box.inset < least) result.surfaces.push_back(polygon(fmt::format("{}.{}", name, face), points));
    }
    if (box.inset > 0) is_round ? add_rounds(box, name, result.surfaces) : add_bevels(box, name, result.surfaces);
    // Reverse polygons that face inwards
    for (GeneratedSurface& surface : result.surfaces) {
        if (!is_inward || surface.type != "polygon") continue;
        std::reverse(surface.numbers.begin(), surface.numbers.end());
        for (std::size_t i = 0; i < surface.numbers.size(); i += 3)
            std::swap(surface.numbers[i], surface.numbers[i + 2]);
    }
    return result;
}

/// genprism material name N x1 y1 .. xN yN [-l x y z] [-r radius] [-c] [-e]. The outline is seen from its front.
std::optional<GeneratedSurfaces> genprism(RadArguments arguments) {
    GeneratedSurfaces result;
    result.modifier = arguments.next("a material");
    const std::string name = arguments.next("a name");
    const auto count = parse_integer(arguments.next("the number of vertices"));
    if (!count) return std::nullopt;  // the outline is in a file or in the standard input
    constexpr int most = 1024;        // limit of the corners of a face
    if (*count < 3 || *count > most)
        throw std::invalid_argument(fmt::format("genprism needs 3 to {} vertices, not {}", most, *count));
    Points low;
    for (int i = 0; i < *count; ++i) {
        const double x = arguments.number("a coordinate"), y = arguments.number("a coordinate");
        low.emplace_back(x, y, 0);
    }
    V3d along(0, 0, 1);
    bool has_ends = true, is_closed = true;
    while (!arguments.is_at_end()) {
        const std::string option = arguments.next("an option");
        if (option == "-l") {
            along = arguments.vector("a vector");
        } else if (option == "-r") {
            if (arguments.number("a radius") != 0) result.omission = "the rounding of genprism (-r)";
        } else if (option == "-c") {
            is_closed = false;
        } else if (option == "-e") {
            has_ends = false;
        } else {
            throw std::invalid_argument(fmt::format("'{}' is no option of genprism", option));
        }
    }
    Points high;
    for (const V3d& p : low) high.push_back(p + along);
    if (has_ends) {
        result.surfaces.push_back(polygon(name + ".b", low));
        result.surfaces.push_back(polygon(name + ".t", {high.rbegin(), high.rend()}));
    }
    for (std::size_t i = 0; i + (is_closed ? 0 : 1) < low.size(); ++i) {
        const std::size_t j = (i + 1) % low.size();
        result.surfaces.push_back(polygon(fmt::format("{}.{}", name, i + 1), {low[i], high[i], high[j], low[j]}));
    }
    return result;
}

}  // namespace

std::optional<GeneratedSurfaces> generate_surfaces(std::span<const std::string> words) {
    if (words[0] == "genbox") return genbox(RadArguments(words));
    if (words[0] == "genprism") return genprism(RadArguments(words));
    return std::nullopt;
}

}  // namespace interflect::detail
