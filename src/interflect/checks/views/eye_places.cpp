#include "interflect/checks/views/eye_places.h"

#include <ImathBox.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "interflect/base/numbers/random.h"
#include "interflect/geometry/polygons/patch_geometry.h"
#include "interflect/scene/core/core.h"

namespace interflect::detail {

namespace {

constexpr int cells_across = 4, cells_upwards = 2;
constexpr std::size_t places_above_faces = 48, points_on_faces = 256;
constexpr std::uint64_t seed_by_area = 73, seed_by_number = 74;

/// Place above a point of a face: at the height of a standing person's eyes, or lower below a low ceiling.
struct StandingPlace {
    V3f eye;
    bool has_roof;
};

StandingPlace place_above(const V3f& x, const RayCaster& ray_caster, const V3f& up) {
    constexpr float eye_height = 1.6f;          // [m]
    constexpr float share_of_clearance = 0.6f;  // 1.5 m below a ceiling of 2.5 m
    const Ray upward{x, up};
    Hit hit;
    ray_caster.trace({&upward, 1}, {&hit, 1});
    const bool has_roof = hit.patch != none;
    return {x + (has_roof ? std::min(eye_height, share_of_clearance * hit.distance) : eye_height) * up, has_roof};
}

/// Adds the places below the centres of cells, or the centres themselves if no face is below.
void add_grid(const Imath::Box3f& box, const RayCaster& ray_caster, const V3f& up, std::vector<V3f>& places) {
    std::array<int, 3> cells{};
    for (int k = 0; k < 3; ++k) cells[static_cast<std::size_t>(k)] = up[k] == 0 ? cells_across : cells_upwards;
    const auto fraction = [&](int cell, std::size_t axis) {
        return (static_cast<float>(cell) + 0.5f) / static_cast<float>(cells[axis]);
    };
    for (int z = 0; z < cells[2]; ++z)
        for (int y = 0; y < cells[1]; ++y)
            for (int x = 0; x < cells[0]; ++x) {
                const Ray down{box.min + box.size() * V3f(fraction(x, 0), fraction(y, 1), fraction(z, 2)), -up};
                Hit hit;
                ray_caster.trace({&down, 1}, {&hit, 1});
                if (hit.patch == none) {
                    places.push_back(down.origin);
                    continue;
                }
                const V3f floor = down.origin + (ray_caster.ray_offset(hit.patch) - hit.distance) * up;
                places.push_back(place_above(floor, ray_caster, up).eye);
            }
}

/// Adds at most `count` of the points, at equal intervals.
void add_evenly(const std::vector<V3f>& points, std::size_t count, std::vector<V3f>& places) {
    const std::size_t added = std::min(count, points.size());
    for (std::size_t i = 0; i < added; ++i) places.push_back(points[i * points.size() / added]);
}

/// Adds places above patches, which are sampled in proportion to their weights, one in each of equal intervals.
void add_above(const Scene& scene, const RayCaster& ray_caster, const V3f& up, const std::vector<PatchIndex>& patches,
               std::vector<double> weights, std::uint64_t seed, std::vector<V3f>& places) {
    if (patches.empty()) return;
    std::partial_sum(weights.begin(), weights.end(), weights.begin());
    std::vector<V3f> under_roofs, in_the_open;
    for (std::uint64_t i = 0; i < points_on_faces; ++i) {
        const auto words = random_words(seed, i);
        const double target =
            weights.back() * (static_cast<double>(i) + unit_float(words[0])) / static_cast<double>(points_on_faces);
        const auto found = std::upper_bound(weights.begin(), weights.end(), target) - weights.begin();
        const PatchIndex patch = patches[std::min(static_cast<std::size_t>(found), patches.size() - 1)];
        const PatchGeometry geometry(scene, scene.patches[patch]);
        const V3f x = geometry.point(geometry.uniform_parameters(unit_float(words[1]), unit_float(words[2])));
        const StandingPlace place = place_above(x + ray_caster.ray_offset(patch) * geometry.normal(), ray_caster, up);
        (place.has_roof ? under_roofs : in_the_open).push_back(place.eye);
    }
    add_evenly(under_roofs, places_above_faces, places);
    if (under_roofs.size() < places_above_faces)
        add_evenly(in_the_open, places_above_faces - under_roofs.size(), places);
}

}  // namespace

std::vector<V3f> eye_places(const Scene& scene, const RayCaster& ray_caster, const V3f& up) {
    constexpr float least_upward = 0.9f;  // component of the normal: slopes of at most 26 degrees
    std::vector<V3f> places;
    add_grid(core_bounds(scene), ray_caster, up, places);
    std::vector<PatchIndex> upward;
    std::vector<double> areas;
    for (PatchIndex i{0}; i < scene.patches.size(); ++i) {
        if (!(patch_normal(scene, scene.patches[i]).dot(up) > least_upward)) continue;
        upward.push_back(i);
        areas.push_back(patch_area(scene, scene.patches[i]));
    }
    const std::vector<double> equal(upward.size(), 1.0);
    add_above(scene, ray_caster, up, upward, areas, seed_by_area, places);
    add_above(scene, ray_caster, up, upward, equal, seed_by_number, places);
    return places;
}

}  // namespace interflect::detail
