#include "interflect/solver/surfaces.h"

namespace interflect {

Surfaces::Surfaces(const Scene& scene) : scene_(scene) {
    geometry_.reserve(scene.patches.size());
    for (const Patch& patch : scene.patches) geometry_.emplace_back(scene, patch);
}

std::vector<Rgb> radiated_power(const Surfaces& surfaces, const std::vector<Rgb>& irradiance) {
    std::vector<Rgb> power(surfaces.size());
    for (std::size_t i = 0; i < power.size(); ++i)
        power[i] = surfaces.area(i) * (surfaces.exitance(i) + surfaces.reflectance(i) * irradiance[i]);
    return power;
}

RgbD total(const std::vector<Rgb>& values) {
    RgbD sum(0, 0, 0);
    for (const Rgb& v : values) sum += RgbD(v);
    return sum;
}

}  // namespace interflect
