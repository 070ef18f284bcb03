#include "interflect/luminaires/skies/sky_radiance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "interflect/scene.h"

namespace interflect::detail {

namespace {

/// Interval of an image's side, in [0, 1], where a cell overlaps a texel.
struct Overlap {
    std::size_t cell;
    double from, to;
};

std::vector<Overlap> overlaps(std::size_t i, std::size_t texels, std::size_t cells) {
    std::vector<Overlap> found;
    const auto count = static_cast<double>(cells);
    const double low = static_cast<double>(i) / static_cast<double>(texels),
                 high = static_cast<double>(i + 1) / static_cast<double>(texels);
    // Integers avoid rounding errors.
    const std::size_t first = i * cells / texels, last = ((i + 1) * cells - 1) / texels;
    for (std::size_t cell = first; cell <= last; ++cell)
        found.push_back({cell, std::max(low, static_cast<double>(cell) / count),
                         std::min(high, static_cast<double>(cell + 1) / count)});
    return found;
}

}  // namespace

SkyRadiance::SkyRadiance(const SkyDome& dome) : frame_(dome.zenith), model_(dome.model), sun_(dome.sun.normalized()) {
    factor_ = dome.irradiance / static_cast<float>(model_.horizontal_integral(sun_.dot(frame_.zenith)));
    ground_ = dome.irradiance * (dome.ground / std::numbers::pi_v<float>);
}

SkyRadiance::SkyRadiance(const EnvironmentMap& map)
    : frame_(map.zenith, map.north), factor_(map.factor), image_(map.image) {}

Rgb SkyRadiance::of_dome(const V3f& direction) const {
    const float zenith_cosine = direction.dot(frame_.zenith);
    if (zenith_cosine < 0) return ground_;
    return factor_ * static_cast<float>(model_.relative_luminance(zenith_cosine, direction.dot(sun_)));
}

Rgb SkyRadiance::towards(const V3f& direction) const {
    if (!image_) return of_dome(direction);
    const SkyPlace place = frame_.place(direction);
    const SkyGrid texels = grid();
    return factor_ * image_->texels[texels.row_of(place.cosine) * texels.columns + texels.column_of(place.s)];
}

SkyGrid SkyRadiance::grid() const {
    if (image_) return {image_->width, image_->height};
    return {256, 128};
}

std::vector<Rgb> SkyRadiance::cell_integrals(const SkyGrid& grid) const {
    if (image_) return texel_integrals(grid);
    constexpr float quarter = 0.25f;
    std::vector<Rgb> integrals(grid.size());
    for (std::size_t row = 0; row < grid.rows; ++row) {
        const auto upper = static_cast<float>(grid.edge_cosine(row)),
                   lower = static_cast<float>(grid.edge_cosine(row + 1));
        const auto solid_angle = static_cast<float>(grid.solid_angle(row));
        for (std::size_t column = 0; column < grid.columns; ++column) {
            Rgb sum(0);
            for (const float down : {quarter, 1 - quarter})
                for (const float across : {quarter, 1 - quarter})
                    sum += of_dome(
                        frame_.direction({(static_cast<float>(column) + across) / static_cast<float>(grid.columns),
                                          upper + (lower - upper) * down}));
            integrals[row * grid.columns + column] = sum * (solid_angle / 4);
        }
    }
    return integrals;
}

std::vector<Rgb> SkyRadiance::texel_integrals(const SkyGrid& grid) const {
    std::vector<Rgb> integrals(grid.size(), Rgb(0));
    std::vector<std::vector<Overlap>> across(image_->width);
    for (std::size_t x = 0; x < across.size(); ++x) across[x] = overlaps(x, image_->width, grid.columns);
    for (std::size_t y = 0; y < image_->height; ++y)
        for (const Overlap& row : overlaps(y, image_->height, grid.rows)) {
            const double height = std::cos(std::numbers::pi * row.from) - std::cos(std::numbers::pi * row.to);
            for (std::size_t x = 0; x < across.size(); ++x) {
                const Rgb radiance = factor_ * image_->texels[y * image_->width + x];
                for (const Overlap& column : across[x])
                    integrals[row.cell * grid.columns + column.cell] +=
                        radiance * static_cast<float>(2 * std::numbers::pi * (column.to - column.from) * height);
            }
        }
    return integrals;
}

}  // namespace interflect::detail
