#include "interflect/scene/faces/patch_area.h"

#include <array>

namespace interflect {

float patch_area(const Scene& scene, const Patch& patch) {
    std::array<V3f, 4> corners;
    const auto count = static_cast<std::size_t>(patch.vertex_count());
    for (std::size_t i = 0; i < count; ++i) corners[i] = scene.vertices[patch.vertices[i]];
    return (0.5f * detail::doubled_area_vector<float>({corners.data(), count})).length();
}

}  // namespace interflect
