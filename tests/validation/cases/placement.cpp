#include "tests/validation/cases/placement.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "interflect/elements/forest.h"
#include "interflect/solve.h"

namespace interflect::testing_support {

using namespace detail;

const std::vector<Placement> placements{{"as it is"},
                                        {"aslant", 50, 1, {0, 0, 0}},
                                        {"1000 km away", 0, 1, {6e5, -8e5, 120}},
                                        {"a thousandth of the size", 20, 1e-3, {1, 2, 3}}};

V3d Placement::direction(const V3d& d) const {
    const V3d axis = V3d(1, 2, 3).normalized();
    const double angle = turn * std::numbers::pi / 180;  // Rodrigues' formula
    return d * std::cos(angle) + axis.cross(d) * std::sin(angle) + axis * axis.dot(d) * (1 - std::cos(angle));
}

Scene Placement::scene(Scene s) const {
    s.origin = origin;
    for (V3f& vertex : s.vertices) vertex = V3f(direction(V3d(vertex)) * scale);
    for (Luminaire& luminaire : s.luminaires) {
        auto& light = std::get<PointLight>(luminaire.kind);
        light.position = V3f(direction(V3d(light.position)) * scale);
    }
    return s;
}

MeasuringPoint Placement::measuring_point(const V3d& position, const V3d& normal) const {
    return {point(position), V3f(direction(normal))};
}

std::vector<Estimate> measured(const Scene& scene, const std::vector<MeasuringPoint>& points, std::int64_t rays,
                               int samples) {
    const RayCaster ray_caster(scene);
    return means_of_runs(points.size(), [&](std::uint64_t seed) {
        const Solution solution =
            solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = rays}, .seed = seed});
        std::vector<double> illuminances;
        for (const MeasuredIrradiance& e :
             measure_irradiance(scene, &solution, ray_caster, points, {.samples = samples, .seed = seed}))
            illuminances.push_back(static_cast<double>(e.illuminance()));
        return illuminances;
    });
}

/// Runs are repeated points of one measurement with separate random numbers, so the tables of skies are made once.
std::vector<Estimate> traced(const Scene& scene, const std::vector<MeasuringPoint>& points, int samples) {
    std::vector<MeasuringPoint> repeated;
    for (int run = 0; run < runs; ++run) repeated.insert(repeated.end(), points.begin(), points.end());
    const auto found =
        measure_irradiance(scene, nullptr, RayCaster(scene), repeated, {.shading = Shading::path, .samples = samples});
    return means_of_runs(points.size(), [&](std::uint64_t seed) {
        std::vector<double> illuminances;
        for (std::size_t i = 0; i < points.size(); ++i)
            illuminances.push_back(static_cast<double>(found[(seed - 1) * points.size() + i].illuminance()));
        return illuminances;
    });
}

Estimate solved(const Scene& scene, std::uint32_t first_patch, std::uint32_t patches, std::int64_t rays) {
    const RayCaster ray_caster(scene);
    return mean_of_runs([&](std::uint64_t seed) {
        const Solution solution =
            solve(scene, ray_caster, {.method = find_method("hsrr"), .limits = {.rays = rays}, .seed = seed});
        double sum = 0, area = 0;
        for (PatchIndex i(first_patch); i < first_patch + patches; ++i) {
            sum += luminance(RgbD(solution.irradiance[i])) * solution.forest->area(i);
            area += solution.forest->area(i);
        }
        return sum / area;
    });
}

}  // namespace interflect::testing_support
