#include "interflect/solver/light/patch_light.h"

namespace interflect::detail {

std::vector<float> patch_light(const Scene& scene, std::span<const Rgb> irradiance) {
    std::vector<float> light;
    light.reserve(scene.patches.size());
    for (std::size_t p = 0; p < scene.patches.size(); ++p)
        light.push_back(largest_channel(scene.materials[scene.patches[p].material].exitance + irradiance[p]));
    return light;
}

}  // namespace interflect::detail
