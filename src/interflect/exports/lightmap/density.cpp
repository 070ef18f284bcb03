#include "interflect/exports/lightmap/density.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "interflect/plots.h"

namespace interflect::detail {

std::vector<ObjectDensity> densities_of(std::span<const LightmapChart> charts, const Scene& scene) {
    std::map<std::uint32_t, ObjectDensity> lowest;
    for (const LightmapChart& chart : charts) {
        const auto obtained = static_cast<float>(chart.density()), requested = chart.requested_density;
        const auto [entry, is_new] =
            lowest.try_emplace(chart.object, ObjectDensity{scene.objects[chart.object], requested, obtained});
        ObjectDensity& object = entry->second;
        if (obtained / requested < object.obtained / object.requested) object = {object.object, requested, obtained};
    }
    std::vector<ObjectDensity> densities;
    densities.reserve(lowest.size());
    for (auto& [object, density] : lowest) densities.push_back(std::move(density));
    return densities;
}

void draw_density(std::span<const LightmapChart> charts, const LightmapOptions& options, std::vector<Image>& images) {
    constexpr int side = 8;                    // of a square [texels]
    constexpr float dark = 0.5f, octaves = 4;  // factor of every other square; range of the colours
    const int gutter = options.gutter;
    for (const LightmapChart& chart : charts) {
        const float ratio = static_cast<float>(chart.density()) / options.texels_per_metre;
        const Rgb colour = false_colour(0.5f + std::log2(ratio) / octaves);
        Image& image = images[static_cast<std::size_t>(chart.page)];
        for (int row = -gutter; row < chart.rows + gutter; ++row)
            for (int column = -gutter; column < chart.columns + gutter; ++column) {
                const bool is_dark = ((column + gutter) / side + (row + gutter) / side) % 2 == 1;
                image.at(chart.left + column, chart.top + row) = is_dark ? colour * dark : colour;
            }
    }
}

void warn_of_reduced_density(std::span<const ObjectDensity> densities, Warnings& warnings) {
    constexpr float rounding = 1e-3f;
    for (const auto& [object, requested, obtained] : densities)
        if (obtained < (1 - rounding) * requested)
            warnings.add(
                "lightmap-density",
                fmt::format(
                    "the object has {:.3g} of {:g} texels per metre, to fit into an image of the lightmap (max_size)",
                    obtained, requested),
                object);
}

}  // namespace interflect::detail
