#include "interflect/scene/core/geometry_fingerprint.h"

#include <bit>
#include <string>

#include "interflect/base/numbers/random.h"
#include "interflect/base/threads/parallel.h"
#include "interflect/core.h"

namespace interflect::detail {

namespace {

std::uint64_t hash_of(const V3f& v) {
    const std::uint64_t xy = std::uint64_t{std::bit_cast<std::uint32_t>(v.x)} << 32 | std::bit_cast<std::uint32_t>(v.y);
    return mix(xy, std::bit_cast<std::uint32_t>(v.z));
}

std::uint64_t hash_of(const Scene& scene, std::size_t patch) {
    const Patch& p = scene.patches[patch];
    std::uint64_t hash = mix(patch, p.other_side);
    for (std::size_t k = 0; k < static_cast<std::size_t>(p.vertex_count()); ++k) {
        if (p.vertices[k] >= scene.vertices.size())
            throw InputError(scene.name, 0, "patch " + std::to_string(patch) + ": a vertex index is out of range");
        hash = mix(hash, hash_of(scene.vertices[p.vertices[k]]));
    }
    return hash;
}

}  // namespace

std::uint64_t geometry_fingerprint(const Scene& scene) {
    constexpr std::size_t patches_per_task = 4096;
    const std::uint64_t patches =
        parallel_sum(scene.patches.size(), patches_per_task, std::uint64_t{0}, [&](std::size_t begin, std::size_t end) {
            std::uint64_t sum = 0;
            for (std::size_t i = begin; i < end; ++i) sum += hash_of(scene, i);
            return sum;
        });
    std::uint64_t hash = mix(scene.patches.size(), patches);
    for (const double x : {scene.origin.x, scene.origin.y, scene.origin.z})
        hash = mix(hash, std::bit_cast<std::uint64_t>(x));
    return hash;
}

void require_made_for(const Scene& scene, std::uint64_t fingerprint, const char* what) {
    if (geometry_fingerprint(scene) != fingerprint)
        throw InputError(std::string(what) + " was made for another scene than '" + scene.name +
                         "', or the scene has changed since");
}

}  // namespace interflect::detail
