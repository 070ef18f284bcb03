#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/export.h"
#include "interflect/image.h"
#include "interflect/ray_caster.h"
#include "interflect/render.h"
#include "interflect/solver/light/materials.h"

namespace interflect {

using namespace detail;

namespace {

/// Share of the reflected light from the darkest surfaces, which the exposure ignores (export_exposure()).
constexpr double dark_share = 0.01;

struct LitSurface {
    double exitance;  // reflected light [lm/m^2]
    double area;      // [m^2]
};

/// Returns the leaves that reflect light, in ascending order of exitance.
std::vector<LitSurface> lit_surfaces(const Scene& scene, const Solution& solution) {
    const ElementForest& forest = *solution.forest;
    Materials materials(scene);
    materials.grow(forest);
    std::vector<LitSurface> lit;
    for (const ElementIndex leaf : forest.leaves()) {
        const Rgb reflectance = materials.surface(forest.patch(leaf), leaf).reflectance;
        const double exitance = luminance(reflectance * solution.irradiance[leaf]);
        if (exitance > 0) lit.push_back({exitance, forest.area(leaf)});
    }
    std::sort(lit.begin(), lit.end(), [](const auto& a, const auto& b) { return a.exitance < b.exitance; });
    return lit;
}

/// Skips the darkest surfaces, which together reflect `dark_share` of the light.
std::vector<LitSurface>::const_iterator skip_dark(const std::vector<LitSurface>& surfaces) {
    double total = 0, passed = 0;
    for (const auto& [exitance, area] : surfaces) total += exitance * area;
    return std::find_if(surfaces.begin(), surfaces.end(), [&](const LitSurface& surface) {
        passed += surface.exitance * surface.area;
        return passed > dark_share * total;
    });
}

/// Returns the exposure of the geometric mean of exitance, weighted by area [stops].
float exposure_of_surfaces(const Scene& scene, const Solution& solution) {
    const std::vector<LitSurface> lit = lit_surfaces(scene, solution);
    double stops = 0, area = 0;
    for (auto surface = skip_dark(lit); surface != lit.end(); ++surface) {
        stops += surface->area * std::log2(surface->exitance);
        area += surface->area;
    }
    if (area == 0) return 0;
    Image mean(1, 1);
    mean.pixels[0] = Rgb(static_cast<float>(std::exp2(stops / area) * std::numbers::inv_pi));
    return automatic_exposure(mean);
}

}  // namespace

float export_exposure(const Scene& scene, const Solution& solution) {
    solution.forest->require_made_for(scene);
    if (scene.views.empty()) return exposure_of_surfaces(scene, solution);
    const PictureOptions options{.width = 160, .height = 90, .shading = Shading::smooth, .samples = 4};
    return automatic_exposure(render(scene, solution, RayCaster(scene), scene.views.front(), options).image);
}

}  // namespace interflect
