#include "interflect/prepare.h"

#include <fmt/format.h>

#include <algorithm>

#include "interflect/core.h"
#include "interflect/geometry/polygons/patch_geometry.h"

namespace interflect {

using namespace detail;

namespace {

// Three colours per element, and an index per four siblings [bytes].
constexpr std::size_t per_textured_element = 37;
// Bytes: H, unshot light and pass result, 12 each; contributions 24 or received light 12.
constexpr std::size_t per_element_and_group = 60;
// Direct light of one light group, with SolveOptions::keep_direct [bytes].
constexpr std::size_t per_element_of_direct_light = 24;

}  // namespace

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
    if (!scene.texture_coordinates.empty()) need.per_element += per_textured_element;
    need.ray_tracer = ray_caster.memory();
    need.patches = scene.patches.size() * sizeof(PatchGeometry);
    need.rest = program;
    need.per_element += source_groups(scene).size() * per_element_and_group;
    return need;
}

MemoryNeed memory_need(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options) {
    MemoryNeed need = memory_need(scene, ray_caster);
    if (options.keep_direct)
        need.per_element += per_element_of_direct_light * std::max<std::size_t>(1, source_groups(scene).size());
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

}  // namespace interflect
