#include "interflect/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/base/error.h"
#include "interflect/scene/patch_geometry.h"

namespace interflect {

namespace {

constexpr std::size_t listed_faults = 20;

bool is_reflectance(const Rgb& c) { return is_finite(c) && std::min({c.x, c.y, c.z}) >= 0 && largest_channel(c) < 1; }

}  // namespace

std::vector<std::string> scene_faults(const Scene& scene) {
    std::vector<std::string> faults;
    const auto check = [&](bool holds, const auto& describe) {
        if (!holds && faults.size() < listed_faults) faults.push_back(describe());
    };
    check(is_finite(scene.origin), [] { return std::string("the origin is not finite"); });
    for (std::size_t i = 0; i < scene.vertices.size(); ++i)
        check(is_finite(scene.vertices[i]), [&] { return fmt::format("vertex {} is not finite", i); });
    for (std::size_t i = 0; i < scene.contacts.size(); ++i)
        check(is_finite(scene.contacts[i].a) && is_finite(scene.contacts[i].b),
              [&] { return fmt::format("contact {} is not finite", i); });
    for (const Material& m : scene.materials) {
        const Rgb &r = m.reflectance, &e = m.exitance;
        check(is_reflectance(r), [&] {
            return fmt::format("material '{}': reflectance ({}, {}, {}) is not in [0, 1)", m.name, r.x, r.y, r.z);
        });
        check(is_finite(e) && std::min({e.x, e.y, e.z}) >= 0, [&] {
            return fmt::format("material '{}': exitance ({}, {}, {}) is negative or not finite", m.name, e.x, e.y, e.z);
        });
    }
    for (std::uint32_t i = 0; i < scene.patches.size(); ++i) {
        const Patch& p = scene.patches[i];
        const bool vertices_exist = std::all_of(p.vertices.begin(), p.vertices.begin() + p.vertex_count(),
                                                [&](std::uint32_t v) { return v < scene.vertices.size(); });
        check(vertices_exist, [&] { return fmt::format("patch {}: a vertex index is out of range", i); });
        check(!vertices_exist || patch_area(scene, p) > 0, [&] { return fmt::format("patch {} has no area", i); });
        check(p.material < scene.materials.size(),
              [&] { return fmt::format("patch {}: there is no material {}", i, p.material); });
        check(p.object < scene.objects.size(),
              [&] { return fmt::format("patch {}: there is no object {}", i, p.object); });
        const bool are_neighbours = p.other_side == i + 1 || p.other_side + 1 == i;
        check(p.other_side == none || (are_neighbours && p.other_side < scene.patches.size() &&
                                       scene.patches[p.other_side].other_side == i),
              [&] {
                  return fmt::format("patch {}: its other side {} is no neighbour that points back", i, p.other_side);
              });
    }
    for (const View& v : scene.views)
        check(is_finite(v.eye) && is_finite(v.look_at) && is_finite(v.up) && v.fov > 0 && v.fov < 180, [&] {
            return fmt::format("view '{}' is not finite, or its field of view not between 0 and 180 degrees", v.name);
        });
    return faults;
}

void require_no_faults(const std::vector<std::string>& faults, const std::string& purpose, const Scene& scene) {
    if (faults.empty()) return;
    std::string message = purpose + " '" + scene.name + "':";
    for (const std::string& fault : faults) message += "\n  " + fault;
    throw InputError(message);
}

}  // namespace interflect
