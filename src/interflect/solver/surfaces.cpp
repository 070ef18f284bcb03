#include "interflect/solver/surfaces.h"

namespace interflect {

std::vector<Rgb> radiosity(const Surfaces& surfaces, const ElementForest& forest, const std::vector<Rgb>& irradiance) {
    std::vector<Rgb> b(irradiance.size());
    for (std::uint32_t e = 0; e < b.size(); ++e) {
        const std::uint32_t patch = forest.patch(e);
        b[e] = surfaces.exitance(patch) + surfaces.reflectance(patch) * irradiance[e];
    }
    return b;
}

RgbD integral(const ElementForest& forest, const std::vector<Rgb>& values) {
    RgbD sum(0, 0, 0);
    for (std::uint32_t e = 0; e < forest.patch_count(); ++e)
        sum += RgbD(values[e]) * static_cast<double>(forest.area(e));
    return sum;
}

}  // namespace interflect
