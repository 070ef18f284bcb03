#include "interflect/checks/faces/up_axis.h"

#include <ImathBox.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/geometry/search/disjoint_sets.h"
#include "interflect/prepare.h"
#include "interflect/scene/core/core.h"

namespace interflect {

using namespace detail;

namespace {

/// Minimum cosine between a sum of vectors and an axis, and minimum length of the sum relative to parallel vectors.
constexpr double min_cosine = 0.9, min_agreement = 0.5;

constexpr const char* axis_names[3][2] = {{"x", "-x"}, {"y", "-y"}, {"z", "-z"}};

/// Returns the axis nearest to a sum of vectors; null if they disagree. @param total  Length of `sum` for parallel
/// vectors.
const char* axis_of(const Imath::V3d& sum, double total) {
    const double length = sum.length();
    if (!(length > min_agreement * total)) return nullptr;
    for (int i = 0; i < 3; ++i)
        if (std::abs(sum[i]) > min_cosine * length) return axis_names[i][sum[i] < 0];
    return nullptr;
}

const char* axis_of_views(const Scene& scene) {
    Imath::V3d sum(0);
    for (const View& v : scene.views) sum += Imath::V3d(v.up).normalized();
    return axis_of(sum, static_cast<double>(scene.views.size()));
}

const char* axis_of_light(const Scene& scene) {
    Imath::V3d sum(0);
    double total = 0;
    for (const Patch& patch : scene.patches) {
        const double power = channel_sum(scene.materials[patch.material].exitance) * patch_area(scene, patch);
        sum -= power * Imath::V3d(PatchGeometry(scene, patch).normal());
        total += power;
    }
    return axis_of(sum, total);
}

template <class PartOf>
std::vector<Imath::Box3f> boxes_of_parts(const Scene& scene, std::size_t parts, const PartOf& part_of) {
    std::vector<Imath::Box3f> boxes(parts);
    for (const Patch& patch : scene.patches)
        for (int k = 0; k < patch.vertex_count(); ++k)
            boxes[part_of(patch)].extendBy(scene.vertices[patch.vertices[k]]);
    std::erase_if(boxes, [](const Imath::Box3f& box) { return box.isEmpty(); });
    return boxes;
}

constexpr std::size_t min_objects = 4;

/// Returns the bounding boxes of the objects. Fewer than four objects are divided into connected faces.
std::vector<Imath::Box3f> boxes_of_objects(const Scene& scene) {
    std::vector<Imath::Box3f> boxes =
        boxes_of_parts(scene, scene.objects.size(), [](const Patch& patch) { return patch.object; });
    if (boxes.size() >= min_objects) return boxes;
    DisjointSets connected(scene.vertices.size());
    for (const Patch& patch : scene.patches)
        for (int k = 1; k < patch.vertex_count(); ++k) connected.unite(patch.vertices[0], patch.vertices[k]);
    return boxes_of_parts(scene, scene.vertices.size(),
                          [&](const Patch& patch) { return connected.find(patch.vertices[0]); });
}

bool is_thin(const Imath::Box3f& box, int axis) {
    constexpr float thin = 0.25f;  // pictures and radiators; tables and beds are higher
    const V3f size = box.size();
    return size[axis] < thin * std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]);
}

/// Returns, for each axis and sign, the share of objects that stand on the lower end of the scene; thin ones do not.
std::array<std::array<double, 2>, 3> standing_objects(const Scene& scene) {
    const std::vector<Imath::Box3f> boxes = boxes_of_objects(scene);
    std::array<std::array<double, 2>, 3> shares{};
    if (boxes.size() < min_objects) return shares;
    Imath::Box3f all;
    for (const Imath::Box3f& box : boxes) all.extendBy(box);
    constexpr float min_distance = 0.01f;  // of the scene's diagonal
    const float distance = min_distance * all.size().length();
    for (const Imath::Box3f& box : boxes)
        for (int axis = 0; axis < 3; ++axis) {
            if (is_thin(box, axis)) continue;
            shares[axis][0] += box.min[axis] - all.min[axis] < distance;
            shares[axis][1] += all.max[axis] - box.max[axis] < distance;
        }
    for (auto& of_axis : shares)
        for (double& share : of_axis) share /= static_cast<double>(boxes.size());
    return shares;
}

/// Whether a scene is low along an axis. Corridors may be narrower than high, so elongated scenes must be flatter.
bool is_flat(const V3f& extent, int axis) {
    constexpr float flat = 0.8f, elongated_flat = 0.5f;  // rooms of 4 x 5 x 3 m; corridors of 30 x 2.2 x 3 m
    constexpr float elongated = 4;
    const float a = extent[(axis + 1) % 3], b = extent[(axis + 2) % 3];
    const bool is_elongated = std::max(a, b) > elongated * std::min(a, b);
    return extent[axis] < (is_elongated ? elongated_flat : flat) * std::min(a, b);
}

}  // namespace

const char* detail::find_other_up_axis(const Scene& scene) {
    constexpr double min_standing = 0.5, min_advantage = 0.25;  // share of the objects, and its advantage over z
    if (scene.patches.empty() || axis_of_views(scene)) return nullptr;
    const char* const of_light = axis_of_light(scene);
    const auto standing = standing_objects(scene);
    const V3f extent = core_bounds(scene).size();
    for (int axis = 0; axis < 2; ++axis)
        for (int sign = 0; sign < 2; ++sign) {
            const std::string_view name = axis_names[axis][sign];
            const bool shines = of_light && name == of_light;
            const bool stands = standing[axis][sign] >= min_standing &&
                                standing[axis][sign] >= standing[2][0] + min_advantage &&
                                standing[axis][sign] > standing[axis][1 - sign];
            if (shines + stands + is_flat(extent, axis) >= 2) return axis_names[axis][sign];
        }
    return nullptr;
}

V3f UpAxis::direction() const {
    const std::string_view name = axis;
    V3f direction(0);
    direction[name.back() - 'x'] = name.front() == '-' ? -1.0f : 1.0f;
    return direction;
}

std::optional<UpAxis> find_up_axis(const Scene& scene) {
    if (const char* axis = axis_of_views(scene)) return UpAxis{axis, "views"};
    if (const char* axis = axis_of_light(scene)) return UpAxis{axis, "light"};
    return std::nullopt;
}

}  // namespace interflect
