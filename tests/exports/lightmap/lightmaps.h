#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "interflect/base/numbers/random.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/lightmap/lightmap.h"
#include "interflect/solve.h"

namespace interflect::lightmap_testing {

/// Sets the irradiance to `field(x)` at the centre x of each element of a forest whose patches are subdivided `levels`
/// times.
template <class Field>
Solution solution_of(const Scene& scene, int levels, const Field& field) {
    const auto forest = std::make_shared<detail::ElementForest>(scene, scene.patches.size() << (2 * levels + 1));
    for (ElementIndex e{0}; e < forest->size(); ++e)
        if (forest->level(e) < levels) forest->subdivide(e);
    forest->put_in_order(forest->patch_count());
    Solution solution;
    for (ElementIndex e{0}; e < forest->size(); ++e) {
        const detail::PatchGeometry& geometry = forest->geometry(forest->patch(e));
        solution.irradiance.push_back(field(geometry.point(forest->cell(e).centre(geometry.is_triangle()))));
    }
    solution.forest = forest;
    return solution;
}

inline Solution uniform(const Scene& scene, float irradiance) {
    return solution_of(scene, 0, [&](const V3f&) { return Rgb(irradiance); });
}

/// With smooth shading.
inline ExportOptions at(float texels_per_metre) {
    ExportOptions options;
    options.lightmap.emplace();
    options.bake.shading = Shading::smooth;
    options.lightmap->texels_per_metre = texels_per_metre;
    return options;
}

/// Computes the bilinear interpolation from the centres of the four nearest texels, as on a graphics card.
inline Rgb sample(const detail::Lightmap& lightmap, PatchIndex patch, detail::Parameters place) {
    const Image& image = lightmap.images[static_cast<std::size_t>(lightmap.page(patch))];
    const V2f at = lightmap.coordinate(patch, place);
    const float column = at.x * static_cast<float>(image.width) - 0.5f;
    const float row = at.y * static_cast<float>(image.height) - 0.5f;
    const int i = static_cast<int>(std::floor(column)), j = static_cast<int>(std::floor(row));
    const float s = column - static_cast<float>(i), t = row - static_cast<float>(j);
    return (image.at(i, j) * (1 - s) + image.at(i + 1, j) * s) * (1 - t) +
           (image.at(i, j + 1) * (1 - s) + image.at(i + 1, j + 1) * s) * t;
}

/// Returns parameters of random points of a patch, every other one on its border.
inline detail::Parameters random_place(const detail::PatchGeometry& geometry, std::uint64_t index) {
    detail::Parameters p = geometry.uniform_parameters(static_cast<float>(detail::random_double(1, index)),
                                                       static_cast<float>(detail::random_double(2, index)));
    if (index % 4 == 1) p.u = 0;
    if (index % 4 == 3) p.v = 0;
    return p;
}

}  // namespace interflect::lightmap_testing
