#include "apps/interflect/report/plan.h"

#include <ImathBox.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "apps/interflect/console/path_progress.h"
#include "interflect/measure.h"
#include "interflect/plots.h"

namespace interflect::command {

using namespace detail;

namespace {

using V2d = Imath::V2d;

constexpr int plan_pixels = 1400;      // of the longer side of the pictures
constexpr double plan_margin = 0.25;   // around the floor [m]
constexpr double plan_points = 6000;   // approximate number of measuring points on the floor, for isolines
constexpr double cut_above_plane = 1;  // height of the cut above the working plane [m]
const Rgb blank(1, 1, 1);

/// Pixels of a plan in world coordinates.
struct Raster {
    V2d low{0, 0}, high{0, 0};  // [m]
    int width = 0, height = 0;

    double pixel() const { return (high.x - low.x) / width; }
    V2d centre(int column, int row) const { return {low.x + (column + 0.5) * pixel(), high.y - (row + 0.5) * pixel()}; }
};

Raster raster_around(const Imath::Box2d& box) {
    Raster raster{box.min - V2d(plan_margin), box.max + V2d(plan_margin)};
    const V2d size = raster.high - raster.low;
    const double pixel = std::max(size.x, size.y) / plan_pixels;
    raster.width = std::max(1, static_cast<int>(std::lround(size.x / pixel)));
    raster.height = std::max(1, static_cast<int>(std::lround(size.y / pixel)));
    return raster;
}

std::vector<std::vector<V2d>> faces_of(const Scene& scene, const PlanarArea& floor) {
    std::vector<std::vector<V2d>> faces;
    for (const std::uint32_t i : floor.patches) {
        const Patch& patch = scene.patches[i];
        std::vector<V2d>& face = faces.emplace_back();
        for (std::size_t k = 0; k < static_cast<std::size_t>(patch.vertex_count()); ++k) {
            const Imath::V3d p = scene.origin + Imath::V3d(scene.vertices[patch.vertices[k]]);
            face.emplace_back(p.x, p.y);
        }
    }
    return faces;
}

bool is_inside(const V2d& p, const std::vector<V2d>& face) {
    for (std::size_t i = 0; i < face.size(); ++i)
        if ((face[(i + 1) % face.size()] - face[i]).cross(p - face[i]) < 0) return false;
    return true;
}

/// Returns whether pixel centres lie over the floor, [row * width + column].
std::vector<bool> floor_mask(const Raster& raster, const std::vector<std::vector<V2d>>& faces) {
    std::vector<bool> mask(static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height));
    for (const std::vector<V2d>& face : faces) {
        Imath::Box2d box;
        for (const V2d& p : face) box.extendBy(p);
        const auto column = [&](double x) {
            return std::clamp(static_cast<int>((x - raster.low.x) / raster.pixel()), 0, raster.width - 1);
        };
        const auto row = [&](double y) {
            return std::clamp(static_cast<int>((raster.high.y - y) / raster.pixel()), 0, raster.height - 1);
        };
        for (int r = row(box.max.y); r <= row(box.min.y); ++r)
            for (int c = column(box.min.x); c <= column(box.max.x); ++c)
                if (is_inside(raster.centre(c, r), face))
                    mask[static_cast<std::size_t>(r) * static_cast<std::size_t>(raster.width) +
                         static_cast<std::size_t>(c)] = true;
    }
    return mask;
}

/// Illuminance in cells of a floor. extend() fills cells beside measured ones with means, for interpolation up to the
/// walls.
class CellValues {
  public:
    explicit CellValues(const MeasuringGrid& grid)
        : grid_(grid), columns_(static_cast<std::size_t>(grid.columns)), rows_(static_cast<std::size_t>(grid.rows)) {
        values_.assign(columns_ * rows_, 0);
        is_known_.assign(columns_ * rows_, false);
    }
    void set(std::size_t point, float value) {
        values_[grid_.cells[point]] = value;
        is_known_[grid_.cells[point]] = true;
    }
    void extend() {
        const std::vector<bool> known = is_known_;
        const std::vector<float> values = values_;
        for (std::size_t cell = 0; cell < values.size(); ++cell) {
            if (known[cell]) continue;
            const std::size_t column = cell % columns_, row = cell / columns_;
            float sum = 0, count = 0;
            for (std::size_t r = row - std::min<std::size_t>(row, 1); r < std::min(rows_, row + 2); ++r)
                for (std::size_t c = column - std::min<std::size_t>(column, 1); c < std::min(columns_, column + 2); ++c)
                    if (known[r * columns_ + c]) {
                        sum += values[r * columns_ + c];
                        ++count;
                    }
            if (count > 0) {
                values_[cell] = sum / count;
                is_known_[cell] = true;
            }
        }
    }
    /// Returns the index of the cell at a position, at most half a cell outside of the grid.
    std::size_t cell_at(const Imath::V3d& p) const {
        const Imath::V3d d = p - grid_.corner;
        const auto index = [](double x, int count) {
            return static_cast<std::size_t>(std::clamp(std::floor(x), 0.0, count - 1.0));
        };
        return index(grid_.along_column.dot(d) / grid_.row_spacing, grid_.rows) * columns_ +
               index(grid_.along_row.dot(d) / grid_.column_spacing, grid_.columns);
    }
    /// Interpolates bilinearly between the centres of cells. @param p  World position.
    float at(const Imath::V3d& p) const {
        const Imath::V3d d = p - grid_.corner;
        const double x = std::clamp(grid_.along_row.dot(d) / grid_.column_spacing - 0.5, 0.0, grid_.columns - 1.0),
                     y = std::clamp(grid_.along_column.dot(d) / grid_.row_spacing - 0.5, 0.0, grid_.rows - 1.0);
        const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
        const std::size_t right = std::min(column + 1, columns_ - 1), above = std::min(row + 1, rows_ - 1);
        const auto u = static_cast<float>(x - std::floor(x)), v = static_cast<float>(y - std::floor(y));
        return (1 - v) * ((1 - u) * values_[row * columns_ + column] + u * values_[row * columns_ + right]) +
               v * ((1 - u) * values_[above * columns_ + column] + u * values_[above * columns_ + right]);
    }

  private:
    const MeasuringGrid& grid_;
    std::size_t columns_, rows_;
    std::vector<float> values_;
    std::vector<bool> is_known_;
};

/// Computes the illuminance of pixels over the floor [lx]; 0 elsewhere. @param mask  Pixels over the floor; pixels
/// inside furniture are removed.
Image illuminance_over(const Scene& scene, const Solution& solution, const RayCaster& ray_caster,
                       const PlanarArea& floor, double height, const MeasuringOptions& options, const Raster& raster,
                       std::vector<bool>& mask) {
    // Measure a grid over the floor.
    const MeasuringGrid whole = area_grid(scene, floor, {.spacing = std::sqrt(floor.area / plan_points)}, height);
    const MeasuringGrid grid = without_enclosed_points(scene, ray_caster, whole);
    std::vector<std::uint32_t> enclosed;
    std::set_difference(whole.cells.begin(), whole.cells.end(), grid.cells.begin(), grid.cells.end(),
                        std::back_inserter(enclosed));
    std::vector<MeasuringPoint> points;
    for (const Imath::V3d& p : grid.points) points.push_back({p});
    std::vector<MeasuredIrradiance> measured;
    with_path_progress([&](const Monitor& monitor) {
        measured = measure_irradiance(scene, &solution, ray_caster, points, options, monitor);
    });
    // Interpolate it at the pixels.
    CellValues cells(grid);
    for (std::size_t i = 0; i < measured.size(); ++i) cells.set(i, measured[i].illuminance());
    cells.extend();
    Image values(raster.width, raster.height);
    for (int row = 0; row < raster.height; ++row)
        for (int column = 0; column < raster.width; ++column) {
            const V2d p = raster.centre(column, row);
            const Imath::V3d place(p.x, p.y, height);
            const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(raster.width) +
                                      static_cast<std::size_t>(column);
            if (!mask[pixel]) continue;
            if (std::binary_search(enclosed.begin(), enclosed.end(), cells.cell_at(place)))
                mask[pixel] = false;
            else
                values.at(column, row) = Rgb(cells.at(place));
        }
    return values;
}

/// Draws lines between pixels of different height or normal, as seen from above. Omits objects above `height`.
Image outlines_below(const Scene& scene, const RayCaster& ray_caster, const Raster& raster, double height) {
    struct Seen {
        float z = -1e30f;
        V3f normal{0, 0, 0};
    };
    const auto width = static_cast<std::size_t>(raster.width);
    std::vector<Seen> seen(width * static_cast<std::size_t>(raster.height));
    std::vector<Ray> rays(width);
    std::vector<Hit> hits(width);
    for (int row = 0; row < raster.height; ++row) {
        for (std::size_t c = 0; c < width; ++c) {
            const V2d p = raster.centre(static_cast<int>(c), row);
            rays[c] = {V3f(Imath::V3d(p.x, p.y, height) - scene.origin), {0, 0, -1}};
        }
        ray_caster.trace(rays, hits);
        for (std::size_t c = 0; c < width; ++c)
            if (hits[c].patch != none)
                seen[static_cast<std::size_t>(row) * width + c] = {rays[c].origin.z - hits[c].distance,
                                                                   patch_normal(scene, scene.patches[hits[c].patch])};
    }
    constexpr float step = 0.02f;   // visible difference in height [m]
    constexpr float crease = 0.9f;  // cosine between normals
    const auto differ = [](const Seen& a, const Seen& b) {
        return std::abs(a.z - b.z) > step * (1 + 4 * (1 - std::min(a.normal.z, b.normal.z))) ||
               a.normal.dot(b.normal) < crease;
    };
    Image outlines(raster.width, raster.height, blank);
    for (int row = 0; row + 1 < raster.height; ++row)
        for (int column = 0; column + 1 < raster.width; ++column) {
            const std::size_t i = static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
            if (differ(seen[i], seen[i + 1]) || differ(seen[i], seen[i + width])) outlines.at(column, row) = Rgb(0.02f);
        }
    return outlines;
}

}  // namespace

ReportPlan draw_plan(const Scene& scene, const Solution& solution, const RayCaster& ray_caster, const PlanarArea& floor,
                     double height, const MeasuringOptions& options) {
    const std::vector<std::vector<V2d>> faces = faces_of(scene, floor);
    Imath::Box2d box;
    for (const std::vector<V2d>& face : faces)
        for (const V2d& p : face) box.extendBy(p);
    const Raster raster = raster_around(box);
    std::vector<bool> mask = floor_mask(raster, faces);
    const Image values = illuminance_over(scene, solution, ray_caster, floor, height, options, raster, mask);

    ReportPlan plan{raster.low, raster.high, box.size(), {}, {}, {}};
    plan.outlines = outlines_below(scene, ray_caster, raster, height + cut_above_plane);
    std::vector<float> numbers;
    for (const Rgb& value : values.pixels) numbers.push_back(value.x);
    plan.scale = fit_round_scale(std::move(numbers));
    constexpr int max_isolines = 10;
    std::vector<float> levels = round_values(plan.scale, max_isolines);
    std::erase_if(levels, [&](float v) { return v <= plan.scale.low; });
    plan.illuminance = with_isolines(false_colours(values, plan.scale), values, levels, plan.scale);
    for (std::size_t i = 0; i < mask.size(); ++i) {
        Rgb& pixel = plan.illuminance.pixels[i];
        if (!mask[i]) pixel = blank;
        pixel *= plan.outlines.pixels[i];
    }
    return plan;
}

}  // namespace interflect::command
