#include "interflect/checks/memory_need.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect::detail {

MemoryNeed memory_need(const Scene& scene, const RayCaster& ray_caster) {
    constexpr std::size_t program = 100 << 20;
    MemoryNeed need;
    need.scene = scene.vertices.size() * sizeof(V3f) + scene.patches.size() * sizeof(Patch) +
                 scene.materials.size() * sizeof(Material) + scene.objects.size() * sizeof(std::string);
    for (const Texture& texture : scene.textures) {
        constexpr std::size_t per_texel = sizeof(Rgb) + sizeof(RgbD) / 8;  // the latter for TextureIntegral
        need.scene += texture.texels.size() * per_texel;
    }
    need.scene += (scene.texture_coordinates.size() + scene.lightmap_coordinates.size()) * sizeof(V2f);
    need.scene += scene.normals.size() * sizeof(V3f);
    if (!scene.texture_coordinates.empty()) need.per_element += MemoryNeed::per_textured_element;
    need.ray_tracer = ray_caster.memory();
    need.patches = scene.patches.size() * sizeof(PatchGeometry);
    need.rest = program;
    need.per_element += source_groups(scene).size() * MemoryNeed::per_element_and_group;
    return need;
}

MemoryNeed memory_need(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options) {
    MemoryNeed need = memory_need(scene, ray_caster);
    if (options.keep_direct)
        need.per_element +=
            MemoryNeed::per_element_of_direct_light * std::max<std::size_t>(1, source_groups(scene).size());
    return need;
}

std::size_t elements_within(const MemoryNeed& need, std::size_t bytes, const Scene& scene) {
    const std::size_t patches = scene.patches.size(), least = need.with(patches);
    if (bytes < least)
        throw InputError(scene.name, 0,
                         fmt::format("{} patches need {} MiB of memory, the limit is {} MiB", patches,
                                     (least >> 20) + 1, bytes >> 20));
    return (bytes - need.without_elements()) / need.per_element;
}

}  // namespace interflect::detail
