#include "interflect/geometry/polygons/polygon.h"

#include <GL/glu.h>
#include <ImathBox.h>

#include <algorithm>
#include <deque>
#include <limits>
#include <memory>

#include "interflect/geometry/polygons/add_face.h"
#include "interflect/geometry/polygons/outline_crossings.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/polygons/vertex_coordinates.h"
#include "interflect/scene/core/limits.h"
#include "interflect/scene/faces/planarity.h"

namespace interflect::detail {

namespace {

using Imath::V3d;
using Loop = std::vector<std::uint32_t>;

/// Noise of heights above a plane, in float epsilons: the roundings of three vertices and of their differences.
constexpr double height_noise = 4;

V3d position(const Scene& scene, std::uint32_t vertex) { return V3d(scene.vertices[vertex]); }

bool has_repeats(const Scene& scene, const Loop& loop) {
    for (std::size_t i = 0; i < loop.size(); ++i)
        if (scene.vertices[loop[i]] == scene.vertices[loop[i + 1 == loop.size() ? 0 : i + 1]]) return true;
    return false;
}

Loop without_repeats(const Scene& scene, const Loop& loop) {
    Loop kept;
    for (const std::uint32_t v : loop)
        if (kept.empty() || scene.vertices[v] != scene.vertices[kept.back()]) kept.push_back(v);
    while (kept.size() > 1 && scene.vertices[kept.front()] == scene.vertices[kept.back()]) kept.pop_back();
    return kept;
}

/// Returns the normal times twice the area [m^2]. Vertices are taken relative to the first one, to avoid cancellation.
V3d doubled_area(const Scene& scene, const Loop& loop) {
    const V3d origin = position(scene, loop[0]);
    V3d sum(0);
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
        sum += (position(scene, loop[i]) - origin).cross(position(scene, loop[i + 1]) - origin);
    return sum;
}

struct OutlinePlane {
    V3d normal{0};        ///< Unit length; zero for a loop without area.
    double size = 0;      ///< Diagonal of the bounding box [m].
    double rounding = 0;  ///< Noise of heights [m].
    bool degenerate = true;
    bool self_crossing = false;  ///< Whether the loop is degenerate only because opposite areas cancel.

    OutlinePlane(const Scene& scene, const Loop& outline) {
        if (outline.size() < 3) return;
        Imath::Box3d box;
        double largest = 0;
        for (const std::uint32_t v : outline) {
            const V3d x = position(scene, v);
            box.extendBy(x);
            largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
        }
        size = box.size().length();
        rounding = height_noise * std::numeric_limits<float>::epsilon() * largest;
        const V3d doubled = doubled_area(scene, outline);
        degenerate = doubled.length() <= rounding * size;
        normal = doubled.normalized();
        self_crossing = degenerate && width(scene, outline) > rounding;
    }

  private:
    /// Returns the width of the loop across its longest chord from the first vertex [m].
    static double width(const Scene& scene, const Loop& outline) {
        const V3d start = position(scene, outline[0]);
        V3d chord(0);
        for (const std::uint32_t v : outline)
            if ((position(scene, v) - start).length() > chord.length()) chord = position(scene, v) - start;
        double width = 0;
        for (const std::uint32_t v : outline)
            width = std::max(width, (position(scene, v) - start).cross(chord.normalized()).length());
        return width;
    }
};

bool is_convex_planar_quadrilateral(const Scene& scene, const Loop& loop, const OutlinePlane& plane) {
    if (loop.size() != 4 || !is_planar(scene, {loop[0], loop[1], loop[2], loop[3]})) return false;
    for (std::size_t i = 0; i < 4; ++i) {
        const V3d x = position(scene, loop[i]);
        const V3d in = x - position(scene, loop[(i + 3) % 4]), out = position(scene, loop[(i + 1) % 4]) - x;
        const bool turns_left = in.cross(out).dot(plane.normal) > plane.rounding * std::max(in.length(), out.length());
        if (!turns_left) return false;
    }
    return true;
}

std::size_t corner_count(std::span<const Loop> loops) {
    std::size_t count = 0;
    for (const Loop& loop : loops) count += loop.size();
    return count;
}

class PatchAdder {
  public:
    PatchAdder(Scene& scene, std::uint32_t material, std::uint32_t object, bool two_sided)
        : scene_(scene), two_sided_(two_sided) {
        front_.material = material;
        front_.object = object;
    }

    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d = none) {
        Patch front = front_;
        front.vertices = {a, b, c, d};
        // The area is computed in single precision, as in all later computations.
        if (!(patch_area(scene_, front) >= smallest_face_area)) return;
        add_face(scene_, front, two_sided_ ? front.material : none);
        added_ = true;
    }

    PolygonResult result() const { return added_ ? PolygonResult::added : PolygonResult::degenerate; }

  private:
    Scene& scene_;
    Patch front_;
    bool two_sided_, added_ = false;
};

class Triangulation {
  public:
    Triangulation(Scene& scene, const OutlinePlane& plane, std::uint32_t origin)
        : scene_(scene), plane_(plane), origin_(position(scene, origin)) {}

    /// Returns three corners per triangle, or an empty vector if the tessellator failed.
    std::vector<std::uint32_t> operator()(std::span<const Loop> loops);

  private:
    // Returns coordinates for the tessellator, which are relative to the first vertex and to the size.
    V3d local(const V3d& x) const { return (x - origin_) / plane_.size; }
    V3d global(const V3d& x) const { return origin_ + x * plane_.size; }

    std::uint32_t combined_vertex(const V3d& x, void* const* neighbours, const GLfloat* weights);

    static void emit(void* vertex, void* self) {
        static_cast<Triangulation*>(self)->corners_.push_back(*static_cast<std::uint32_t*>(vertex));
    }
    static void combine(const GLdouble* x, void* const* neighbours, const GLfloat* weights, void** out,
                        void* self_pointer) {
        auto* self = static_cast<Triangulation*>(self_pointer);
        self->handles_.push_back(self->combined_vertex(self->global(V3d(x[0], x[1], x[2])), neighbours, weights));
        *out = &self->handles_.back();
    }
    static void fail(GLenum, void* self) { static_cast<Triangulation*>(self)->failed_ = true; }
    static void ignore_edge_flag(GLboolean, void*) {}

    Scene& scene_;
    const OutlinePlane& plane_;
    V3d origin_;
    std::deque<std::uint32_t> handles_;  // a deque, because GLU keeps pointers to its members
    std::vector<std::uint32_t> corners_;
    bool failed_ = false;
};

std::uint32_t Triangulation::combined_vertex(const V3d& x, void* const* neighbours, const GLfloat* weights) {
    std::vector<std::uint32_t> vertices;
    std::vector<float> weights_of_vertices;
    for (int i = 0; i < 4; ++i) {
        if (!neighbours[i]) continue;
        vertices.push_back(*static_cast<std::uint32_t*>(neighbours[i]));
        weights_of_vertices.push_back(weights[i]);
        if ((position(scene_, vertices.back()) - x).length() <= plane_.rounding) return vertices.back();
    }
    return add_vertex(scene_, V3f(x), interpolated(scene_, vertices, weights_of_vertices));
}

std::vector<std::uint32_t> Triangulation::operator()(std::span<const Loop> loops) {
    const auto callback = [](auto* function) { return reinterpret_cast<_GLUfuncptr>(function); };
    const std::unique_ptr<GLUtesselator, decltype(&gluDeleteTess)> tessellator(gluNewTess(), gluDeleteTess);
    if (!tessellator) throw std::bad_alloc();
    GLUtesselator* const t = tessellator.get();
    gluTessProperty(t, GLU_TESS_WINDING_RULE, GLU_TESS_WINDING_ODD);
    gluTessNormal(t, plane_.normal.x, plane_.normal.y, plane_.normal.z);
    gluTessCallback(t, GLU_TESS_VERTEX_DATA, callback(&emit));
    gluTessCallback(t, GLU_TESS_COMBINE_DATA, callback(&combine));
    gluTessCallback(t, GLU_TESS_ERROR_DATA, callback(&fail));
    // A callback for edge flags makes GLU emit separate triangles.
    gluTessCallback(t, GLU_TESS_EDGE_FLAG_DATA, callback(&ignore_edge_flag));

    gluTessBeginPolygon(t, this);
    for (const Loop& loop : loops) {
        gluTessBeginContour(t);
        for (const std::uint32_t v : loop) {
            V3d x = local(position(scene_, v));
            handles_.push_back(v);
            gluTessVertex(t, &x.x, &handles_.back());
        }
        gluTessEndContour(t);
    }
    gluTessEndPolygon(t);
    if (failed_) corners_.clear();
    return std::move(corners_);
}

}  // namespace

PolygonResult add_polygon(Scene& scene, std::span<const std::vector<std::uint32_t>> loops, std::uint32_t material,
                          std::uint32_t object, bool two_sided) {
    std::vector<Loop> changed;
    if (std::any_of(loops.begin(), loops.end(), [&](const Loop& loop) { return has_repeats(scene, loop); }))
        for (const Loop& loop : loops) changed.push_back(without_repeats(scene, loop));
    const std::span<const Loop> clean = changed.empty() ? loops : std::span<const Loop>(changed);
    if (clean.empty()) return PolygonResult::degenerate;
    const Loop& outline = clean[0];
    const OutlinePlane plane(scene, outline);
    if (plane.degenerate) return plane.self_crossing ? PolygonResult::self_crossing : PolygonResult::degenerate;

    PatchAdder patches(scene, material, object, two_sided);
    if (clean.size() == 1 && outline.size() == 3) {
        patches.add(outline[0], outline[1], outline[2]);
    } else if (clean.size() == 1 && is_convex_planar_quadrilateral(scene, outline, plane)) {
        patches.add(outline[0], outline[1], outline[2], outline[3]);
    } else if (has_more_crossings(scene, clean, V3f(plane.normal), max_crossings_per_corner * corner_count(clean))) {
        return PolygonResult::self_crossing;
    } else {
        const std::vector<std::uint32_t> corners = Triangulation(scene, plane, outline[0])(clean);
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const Loop triangle(corners.begin() + static_cast<std::ptrdiff_t>(i),
                                corners.begin() + static_cast<std::ptrdiff_t>(i + 3));
            if (!OutlinePlane(scene, triangle).degenerate) patches.add(triangle[0], triangle[1], triangle[2]);
        }
    }
    return patches.result();
}

}  // namespace interflect::detail
