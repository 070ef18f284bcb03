#include "interflect/scene/core/limits.h"

#include <fmt/format.h>

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "interflect/base/threads/parallel.h"
#include "interflect/scene/faces/patch_area.h"

namespace interflect::detail {

namespace {

void extend(Imath::Box3d& box, const Scene& scene, const Patch& patch) {
    for (int k = 0; k < patch.vertex_count(); ++k) {
        const std::uint32_t vertex = patch.vertices[static_cast<std::size_t>(k)];
        if (vertex < scene.vertices.size()) box.extendBy(Imath::V3d(scene.vertices[vertex]));
    }
}

}  // namespace

double scene_width(const Scene& scene) {
    constexpr std::size_t patches_per_task = 4096;
    std::vector<Imath::Box3d> parts((scene.patches.size() + patches_per_task - 1) / patches_per_task);
    parallel_for_ranges(scene.patches.size(), patches_per_task, [&](std::size_t begin, std::size_t end) {
        Imath::Box3d part;
        for (std::size_t i = begin; i < end; ++i) extend(part, scene, scene.patches[i]);
        parts[begin / patches_per_task] = part;
    });
    Imath::Box3d box;
    for (const Imath::Box3d& part : parts) box.extendBy(part);
    return box.isEmpty() ? 0 : box.size().length();
}

std::string patch_fault(const Scene& scene, const Patch& patch) {
    Imath::Box3d box;
    extend(box, scene, patch);
    const double width = box.size().length();
    if (!(width <= widest_face))
        return fmt::format("is {:.3g} m wide; at most {:g} m can be computed", width, widest_face);
    const float area = patch_area(scene, patch);
    if (!(area > 0)) return "has no area";
    if (area < smallest_face_area)
        return fmt::format("has an area of {:.3g} m2; at least {:g} m2 can be computed", area, smallest_face_area);
    return {};
}

std::string scene_width_fault(double width) {
    if (width >= narrowest_scene) return {};
    return fmt::format("is only {:.3g} m wide; at least {:g} m can be computed", width, narrowest_scene);
}

std::string exitance_fault(const Rgb& e) {
    const auto text = [&](const std::string& fault) {
        return fmt::format("exitance ({}, {}, {}) {}", e.x, e.y, e.z, fault);
    };
    if (!is_finite(e) || std::min({e.x, e.y, e.z}) < 0) return text("is negative or not finite");
    if (largest_channel(e) <= strongest_exitance) return {};
    return text(fmt::format("cannot be computed: expected at most {:g} lm/m2", strongest_exitance));
}

std::string brightness_fault(float strongest) {
    if (strongest == 0 || strongest >= weakest_exitance) return {};
    return fmt::format("emits only {:.3g} lm/m2 where it is brightest; at least {:g} lm/m2 can be computed", strongest,
                       weakest_exitance);
}

std::vector<Rgb> largest_texels(const Scene& scene) {
    std::vector<Rgb> largest;
    for (const Texture& texture : scene.textures) largest.push_back(largest_texel(texture));
    return largest;
}

Rgb largest_sum(const Material& m, const std::vector<Texture>& textures, const std::vector<Rgb>& largest) {
    const std::uint32_t r = m.reflectance_texture, t = m.transmittance_texture;
    if (r == none || t == none || textures[r].width != textures[t].width || textures[r].height != textures[t].height)
        return textured(m.reflectance, r, largest) + textured(m.transmittance, t, largest) + m.specular_reflectance;
    Rgb sum(0);
    for (std::size_t i = 0; i < textures[r].texels.size(); ++i) {
        const Rgb here = m.reflectance * textures[r].texels[i] + m.transmittance * textures[t].texels[i];
        for (int c = 0; c < 3; ++c) sum[c] = std::max(sum[c], here[c]);
    }
    return sum + m.specular_reflectance;
}

float brightest_source(const Scene& scene) {
    const std::vector<Rgb> largest = largest_texels(scene);
    float strongest = 0;
    for (const Material& m : scene.materials)
        strongest = std::max(strongest, largest_channel(textured(m.exitance, m.exitance_texture, largest)));
    for (const Luminaire& l : scene.luminaires) strongest = std::max(strongest, largest_channel(rating(l)));
    return strongest;
}

}  // namespace interflect::detail

namespace interflect {

bool is_within_reach(const Imath::V3d& point) {
    return std::abs(point.x) <= farthest_coordinate && std::abs(point.y) <= farthest_coordinate &&
           std::abs(point.z) <= farthest_coordinate;
}

bool emits_light(const Scene& scene) { return detail::brightest_source(scene) > 0; }

}  // namespace interflect
