#include "interflect/exports/authored/moved_texels.h"

#include <ImathBoxAlgo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "interflect/base/threads/parallel.h"

namespace interflect::detail {

namespace {

using Imath::V3d;

/// Returns the parameters (a, b) for which a edge_u + b edge_v is nearest to a vector.
Parameters along(const PatchGeometry::Shape& shape, const V3d& vector) {
    const V3d u(shape.edge_u), v(shape.edge_v);
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), determinant = uu * vv - uv * uv;
    const double x = vector.dot(u), y = vector.dot(v);
    return {static_cast<float>((x * vv - y * uv) / determinant), static_cast<float>((y * uu - x * uv) / determinant)};
}

/// Returns the number of a face, which is the smaller index of its patches.
std::uint32_t face_of(std::uint32_t index, const Patch& patch) { return std::min(index, patch.other_side.value); }

bool is_inside(const PatchGeometry& geometry, Parameters p) {
    constexpr float margin = 1e-3f;  // points on a common border are in neither face
    const float most = geometry.is_triangle() ? p.u + p.v : std::max(p.u, p.v);
    return std::min(p.u, p.v) > margin && most < 1 - margin;
}

/// Returns the distance by which rounding of positions or merging of nearly coplanar triangles may move a face [m].
float rounding_of(const Scene& scene) {
    constexpr float relative = 1e-5f;
    float largest = 0;
    for (const V3f& x : scene.vertices) largest = std::max({largest, std::abs(x.x), std::abs(x.y), std::abs(x.z)});
    return relative * largest;
}

/// Returns the normal of a triangle's front. A mirrored mesh keeps its front.
V3f front_of(const AuthoredObject& object, const V3d& u, const V3d& v) {
    return V3f(u.cross(v).normalized() * (object.to_world.determinant() < 0 ? -1 : 1));
}

}  // namespace

TexelMover::TexelMover(const AuthoredCharts& authored, const Scene& solved, const PatchVisibility& visibility)
    : authored_(authored),
      solved_(solved),
      visibility_(visibility),
      reach_(rounding_of(solved)),
      sides_(authored.objects.size()) {
    for (std::uint32_t i = 0; i < authored.objects.size(); ++i)
        object_of_chart_.insert(object_of_chart_.end(), authored.shapes[authored.objects[i].shape].charts.size(), i);
    geometries_.reserve(solved.patches.size());
    for (PatchIndex p{0}; p < solved.patches.size(); ++p) {
        const Patch& patch = solved.patches[p];
        geometries_.emplace_back(solved, patch);
        Imath::Box3f box;
        for (int c = 0; c < patch.vertex_count(); ++c) box.extendBy(solved.vertices[patch.vertices[c]]);
        tree_.push_back({box, p});
    }
    arrange_box_tree(tree_);
    for (const AuthoredObject& object : authored.objects) find_inverted_parts(object);
}

void TexelMover::find_inverted_parts(const AuthoredObject& object) {
    const AuthoredShape& shape = authored_.shapes[object.shape];
    std::vector<double> areas(shape.parts.size());
    std::vector<char> encased(shape.parts.size());  // not bool, because threads write to neighbouring entries
    constexpr std::size_t patches_per_task = 1 << 8;
    parallel_for_ranges(areas.size(), patches_per_task, [&](std::size_t begin, std::size_t end) {
        for (PatchIndex p(static_cast<std::uint32_t>(begin)); p < end; ++p) {
            const auto& [u, v, x] = surface_of(object, p, {1 / 3.0f, 1 / 3.0f});
            areas[p] = u.cross(v).length();
            const PatchIndex front = find(x, front_of(object, u, v), object.object).front;
            encased[p] = front != none && visibility_.encased[front] ? 1 : 0;
        }
    });
    std::map<std::uint32_t, double> excess;  // area in solids minus other area, of each part
    for (PatchIndex p{0}; p < areas.size(); ++p) excess[shape.parts[p]] += encased[p] != 0 ? areas[p] : -areas[p];
    for (const LightmapChart& chart : shape.charts)
        is_inverted_.push_back(excess[shape.parts[chart.patches.front().patch]] > 0);
}

TexelMover::Faces TexelMover::find(const V3f& x, const V3f& normal, std::uint32_t object) const {
    constexpr float parallel = 0.9f;  // cosine, for triangles that are too thin for an exact normal
    const auto is_near = [&](const Imath::Box3f& box) {
        return (Imath::closestPointInBox(x, box) - x).length2() <= reach_ * reach_;
    };
    using Match = std::tuple<bool, bool, std::uint32_t>;  // is hidden, is another object's, patch
    Match front{true, true, none}, back = front;
    Faces result{};
    // Faces with the point inside their border: the texel's own, and touching ones.
    std::array<std::uint32_t, 4> around{};
    std::size_t count = 0;
    visit_box_tree(std::span<const Boxed>(tree_), is_near, [&](std::uint32_t i) {
        const PatchGeometry& geometry = geometries_[i];
        const float cosine = geometry.normal().dot(normal);
        const Parameters at = geometry.parameters_of(x);
        if (std::abs(cosine) < parallel || !is_near({geometry.point(at)})) return;
        const Patch& patch = solved_.patches[PatchIndex(i)];
        Match& best = cosine > 0 ? front : back;
        best = std::min(best, Match(visibility_.hidden[i], patch.object != object, i));
        if (is_inside(geometry, at) && count < around.size()) around[count++] = face_of(i, patch);
        if (const bool is_front = face_of(i, patch) == i; is_front && patch.object != object)
            (cosine > 0 ? result.meets_back : result.meets_front) = true;
    });
    result.front = PatchIndex(std::get<2>(front));
    result.back = PatchIndex(std::get<2>(back));
    for (const std::uint32_t face : std::span(around).first(count))
        result.touches |= result.front != none && face != face_of(result.front, solved_.patches[result.front]);
    return result;
}

TexelMover::Surface TexelMover::surface_of(const AuthoredObject& object, PatchIndex patch, Parameters at) const {
    const std::array<V3d, 3> corners = authored_.corners(object, patch);
    const V3d u = corners[1] - corners[0], v = corners[2] - corners[0];
    return {u, v, V3f(corners[0] + u * at.u + v * at.v - solved_.origin)};
}

void TexelMover::move(std::size_t chart, std::span<TexelPlace> places) {
    const std::uint32_t number = object_of_chart_[chart];
    const AuthoredObject& object = authored_.objects[number];
    for (TexelPlace& place : places)
        if (!place.is_evaluated) place.patch = no_patch;
    std::vector<Faces> faces(places.size());
    const auto for_each_evaluated = [&](const auto& use) {
        constexpr std::size_t texels_per_task = 1 << 10;
        parallel_for_ranges(places.size(), texels_per_task, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (places[i].is_evaluated) use(i);
        });
    };
    // Find the patches at each texel
    for_each_evaluated([&](std::size_t i) {
        const auto& [u, v, x] = surface_of(object, places[i].patch, places[i].at);
        faces[i] = find(x, front_of(object, u, v), object.object);
    });
    // Choose the side whose light the chart shows
    const auto count = [&](const auto& is_counted) { return std::count_if(faces.begin(), faces.end(), is_counted); };
    const auto fronts = count([&](const Faces& f) { return shows(f.front); });
    const auto backs = count([&](const Faces& f) { return shows(f.back); });
    const bool takes_back = backs > 0 && (fronts == 0 || is_inverted_[chart]), is_unlit = fronts == 0 && backs == 0;
    // Move the texels to the patches of this side
    for_each_evaluated([&](std::size_t i) {
        TexelPlace& place = places[i];
        const auto& [u, v, x] = surface_of(object, place.patch, place.at);
        const PatchIndex patch = takes_back ? faces[i].back : faces[i].front;
        const bool is_covered =
            (!takes_back && faces[i].meets_front) || ((takes_back || is_unlit) && faces[i].meets_back);
        const bool is_open = patch != none && (visibility_.lit[patch] || !faces[i].touches);
        place.is_evaluated = is_open && !is_covered && !visibility_.hidden[patch];
        place.patch = patch;
        if (patch == none) return;
        const PatchGeometry& geometry = geometries_[patch];
        place.at = geometry.parameters_of(x);
        for (Parameters& side : place.sides) side = along(geometry.shape(), u * side.u + v * side.v);
    });
    count_sides(faces, sides_[number]);
}

void TexelMover::count_sides(std::span<const Faces> faces, LitSides& sides) const {
    constexpr float noticed = 0.25f;  // share of the front's light; weaker light may come through seams of a solid
    for (const Faces& one : faces) {
        if (!shows(one.front)) continue;
        ++sides.front;
        sides.both += shows(one.back) && visibility_.light[one.back] > noticed * visibility_.light[one.front];
    }
}

}  // namespace interflect::detail
