#include <fmt/format.h>

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <string_view>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/measure.h"
#include "interflect/photometry/nearest_names.h"
#include "interflect/photometry/planar_outline.h"

namespace interflect {

using namespace detail;

namespace {

/// Minimum cosine between normals of faces in one plane: 0.8 degrees.
constexpr float same_plane_cosine = 0.9999f;
/// Maximum distance of faces from their common plane, relative to the extent of all faces.
constexpr double same_plane_distance = 1e-4;
/// Maximum number of planes of an object. Objects with more planes are curved.
constexpr std::size_t max_planes = 256;
/// Relative difference below which areas count as equal.
constexpr double equal_areas = 0.01;
/// Minimum cosine between the normal of a face and the direction that it should face: 10 degrees.
constexpr float facing_cosine = 0.98481f;

bool is_part_of(const std::string& name, const std::string& object) {
    return name == object || (name.starts_with(object) && name[object.size()] == '.');
}

std::string object_name(const Scene& scene, PatchIndex patch) {
    const std::uint32_t object = scene.patches[patch].object;
    return object < scene.objects.size() ? scene.objects[object] : std::string();
}

bool is_number(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789") == text.npos; }

/// Returns a name without the numbers of copies: "floor.a0.a12" becomes "floor".
std::string_view without_copies(std::string_view name) {
    for (std::string_view rest = name;;) {
        const std::size_t dot = rest.rfind('.');
        if (dot == rest.npos) return name;
        const std::string_view last = rest.substr(dot + 1);
        rest = rest.substr(0, dot);
        if (last.starts_with('a') && is_number(last.substr(1)))
            name = rest;
        else if (!is_number(last))
            return name;
    }
}

std::vector<PatchIndex> patches_of(const Scene& scene, const std::string& object) {
    std::vector<PatchIndex> patches;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i)
        if (!object.empty() && is_part_of(object_name(scene, i), object)) patches.push_back(i);
    if (patches.empty())
        throw InputError(
            Fault{.text = fmt::format("no object '{}' has faces; {}", object, text_of_nearest(object, scene.objects)),
                  .object = object,
                  .file = scene.name});
    return patches;
}

/// Groups patches by plane, in order of decreasing area.
std::vector<PlanarArea> planes_of(const Scene& scene, std::vector<PatchIndex> patches, const std::string& name) {
    std::vector<PatchGeometry> geometry;
    geometry.reserve(patches.size());
    for (const PatchIndex i : patches) geometry.emplace_back(scene, scene.patches[i]);
    std::vector<std::size_t> order(patches.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return geometry[a].area() > geometry[b].area(); });
    Imath::Box3f box;
    for (const PatchGeometry& g : geometry) box.extendBy(g.centre());
    const double tolerance = same_plane_distance * (static_cast<double>(box.size().length()) +
                                                    std::sqrt(static_cast<double>(geometry[order[0]].area())));
    // Add each patch, from the largest on, to the first plane that contains it.
    std::vector<PlanarArea> planes;
    std::vector<V3f> on_plane;  // a point of each plane
    for (const std::size_t k : order) {
        const V3f normal = geometry[k].normal(), centre = geometry[k].centre();
        std::size_t p = 0;
        const auto holds = [&](std::size_t plane) {
            return planes[plane].normal.dot(normal) > same_plane_cosine &&
                   std::abs(static_cast<double>(planes[plane].normal.dot(centre - on_plane[plane]))) < tolerance;
        };
        while (p < planes.size() && !holds(p)) ++p;
        if (p == max_planes) continue;
        if (p == planes.size()) {
            planes.push_back({name, normal, {}, 0});
            on_plane.push_back(centre);
        }
        planes[p].patches.push_back(patches[k]);
        planes[p].area += static_cast<double>(geometry[k].area());
    }
    for (PlanarArea& plane : planes) std::sort(plane.patches.begin(), plane.patches.end());
    std::stable_sort(planes.begin(), planes.end(),
                     [](const PlanarArea& a, const PlanarArea& b) { return a.area > b.area; });
    return planes;
}

double height_of(const Scene& scene, const PlanarArea& plane) {
    return scene.origin.z + static_cast<double>(PatchGeometry(scene, scene.patches[plane.patches.front()]).centre().z);
}

/// Returns whether all faces of an area lie within other areas of the same plane.
bool is_covered(const Scene& scene, const PlanarArea& area, std::span<const PlanarOutline> others) {
    constexpr float inwards = 0.01f;  // corners are moved by this share of the way to the centre
    const auto is_within = [&](const Imath::V3d& x) {
        return std::any_of(others.begin(), others.end(), [&](const PlanarOutline& outline) {
            const Imath::V3d d = x - outline.origin;
            return outline.holds({outline.u.dot(d), outline.v.dot(d)});
        });
    };
    return std::all_of(area.patches.begin(), area.patches.end(), [&](PatchIndex i) {
        const Patch& patch = scene.patches[i];
        const V3f centre = PatchGeometry(scene, patch).centre();
        return std::all_of(patch.vertices.begin(), patch.vertices.begin() + patch.vertex_count(), [&](std::uint32_t v) {
            const V3f& corner = scene.vertices[v];
            return is_within(scene.origin + Imath::V3d(corner + inwards * (centre - corner)));
        });
    });
}

std::string text_of_direction(const V3f& direction) {
    const V3f n = direction + V3f(0);  // changes -0 to 0
    return fmt::format("{:.3g},{:.3g},{:.3g}", n.x, n.y, n.z);
}

std::string text_of_directions(const std::vector<PlanarArea>& planes) {
    constexpr std::size_t max_reported = 6;
    std::string text;
    for (std::size_t i = 0; i < std::min(planes.size(), max_reported); ++i) {
        text += (i > 0 ? "; " : "") + text_of_direction(planes[i].normal);
    }
    return planes.size() > max_reported ? text + "; ..." : text;
}

}  // namespace

PlanarArea find_surface(const Scene& scene, const std::string& object, const std::optional<V3f>& facing) {
    std::vector<PatchIndex> patches = patches_of(scene, object);
    if (facing) {
        const V3f direction = facing->normalized();
        std::erase_if(patches, [&](PatchIndex i) {
            return !(PatchGeometry(scene, scene.patches[i]).normal().dot(direction) > facing_cosine);
        });
        if (patches.empty())
            throw InputError(scene.name, 0,
                             fmt::format("no face of '{}' faces {}, but {}", object, text_of_direction(direction),
                                         text_of_directions(planes_of(scene, patches_of(scene, object), object))));
    } else {
        std::erase_if(patches, [&](PatchIndex i) { return scene.patches[i].other_side < i; });
    }
    std::vector<PlanarArea> planes = planes_of(scene, std::move(patches), object);
    if (planes.size() > 1 && planes[1].area > (1 - equal_areas) * planes[0].area)
        throw InputError(scene.name, 0,
                         fmt::format("'{}' has several planar surfaces of {:.3g} m2: expected the direction that the "
                                     "measured one faces: {}",
                                     object, planes[0].area, text_of_directions(planes)));
    return std::move(planes.front());
}

PlanarArea find_top(const Scene& scene, const std::string& object) {
    std::vector<PatchIndex> patches = patches_of(scene, object);
    std::erase_if(patches, [&](PatchIndex i) {
        return !(PatchGeometry(scene, scene.patches[i]).normal().z > same_plane_cosine);
    });
    if (patches.empty())
        throw InputError(scene.name, 0, fmt::format("'{}' has no horizontal face that faces up (z)", object));
    std::vector<PlanarArea> planes = planes_of(scene, std::move(patches), object);
    std::size_t best = 0;
    for (std::size_t i = 1; i < planes.size() && planes[i].area > (1 - equal_areas) * planes[0].area; ++i)
        if (height_of(scene, planes[i]) > height_of(scene, planes[best])) best = i;
    return std::move(planes[best]);
}

PlanarArea find_floor(const Scene& scene, double height) {
    constexpr double height_rounding = 1e-6;
    const double highest = height + height_rounding * std::max(std::abs(height), std::abs(scene.origin.z));
    std::vector<PatchIndex> patches;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        const PatchGeometry geometry(scene, scene.patches[i]);
        if (geometry.normal().z > same_plane_cosine &&
            scene.origin.z + static_cast<double>(geometry.centre().z) <= highest)
            patches.push_back(i);
    }
    if (patches.empty())
        throw InputError(scene.name, 0,
                         fmt::format("the scene has no floor: no face at or below z = {:.4g} m faces up", height));
    return std::move(planes_of(scene, std::move(patches), "floor").front());
}

std::vector<PlanarArea> divide_by_object(const Scene& scene, const PlanarArea& area) {
    std::map<std::string, PlanarArea> parts;
    for (const PatchIndex i : area.patches) {
        const std::string name(without_copies(object_name(scene, i)));
        PlanarArea& part = parts[name];
        part.name = name.empty() ? area.name : name;
        part.normal = area.normal;
        part.patches.push_back(i);
        part.area += static_cast<double>(patch_area(scene, scene.patches[i]));
    }
    std::vector<PlanarArea> sorted;
    sorted.reserve(parts.size());
    for (auto& [name, part] : parts) sorted.push_back(std::move(part));
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const PlanarArea& a, const PlanarArea& b) { return a.area > b.area; });
    std::vector<PlanarOutline> larger;
    std::erase_if(sorted, [&](const PlanarArea& part) {
        if (is_covered(scene, part, larger)) return true;
        larger.push_back(outline_of(scene, part));
        return false;
    });
    return sorted;
}

}  // namespace interflect
