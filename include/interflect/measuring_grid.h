#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect {

/// Upper limit of measuring points per grid.
inline constexpr std::size_t most_measuring_points = 1'000'000;

/// Maximum point distance of a measuring grid by EN 12464-1 (formula 1): p = 0.2 * 5^(log10 d) [m], at most 10 m. d is
/// the longer side of the area, or the shorter one if the longer is at least twice that.
/// @param length, width  Sides of the area [m], > 0.
double grid_spacing(double length, double width);

/// Layout of a grid.
struct GridOptions {
    std::optional<double> spacing{};  ///< Maximum point distance [m], > 0; nullopt: grid_spacing() of the area.
    double boundary = 0;              ///< Width of the excluded strip along the border of the area [m], >= 0.
};

/// The strip along walls that EN 12464-1 excludes from an area [m].
inline constexpr double usual_boundary = 0.5;

/// Coplanar faces, on or above which light is measured.
struct PlanarArea {
    std::string name;                    ///< Name of the object that contains them.
    V3f normal{0, 0, 1};                 ///< Unit length, towards the lit side.
    std::vector<std::uint32_t> patches;  ///< Indices into Scene::patches.
    double area = 0;                     ///< [m^2]
};

/// Finds the planar surface of an object: its faces in the plane with the largest total area. Includes nested objects:
/// "desk" includes "desk.top". Two-sided faces count by their front, unless `facing` decides.
/// @param facing  Direction within 10 degrees of the surface's normal; nullopt: any.
/// @throws InputError for an unknown object, with the nearest names; if no face matches; and if several planes are
///         (nearly) equally large, with their normals.
PlanarArea find_surface(const Scene& scene, const std::string& object, const std::optional<V3f>& facing = {});

/// The largest horizontal plane of an object's upward faces, such as the top of a desk; the highest of equal ones.
/// @throws InputError as find_surface() does.
PlanarArea find_top(const Scene& scene, const std::string& object);

/// The floor at or below a height: the scene's upward faces there in the horizontal plane with the largest total area.
/// @param height  World z [m]. @throws InputError if no such face exists.
PlanarArea find_floor(const Scene& scene, double height);

/// Divides an area by the objects of its faces, ordered by size. Copies of an array ("floor.a0", "floor.a1.2" in MGF)
/// count as one object.
std::vector<PlanarArea> divide_by_object(const Scene& scene, const PlanarArea& area);

/// Points to measure at.
struct MeasuringGrid {
    std::string name;
    std::vector<Imath::V3d> points{};            ///< World coordinates [m]; for an area row by row.
    V3f normal{0, 0, 1};                         ///< Normal of the area, unit length.
    int columns = 0, rows = 0;                   ///< Cells of the rectangle around the area; 0 for lines and points.
    double column_spacing = 0, row_spacing = 0;  ///< Distances between points [m]; lines use the first.
    Imath::V3d corner{0, 0, 0};                  ///< Corner of the first cell [m].
    Imath::V3d along_row{1, 0, 0}, along_column{0, 1, 0};  ///< Unit vectors from cell to cell.
    std::vector<std::uint32_t> cells{};                    ///< row * columns + column of each point.
};

/// Creates a grid on an area, or at a given height. The smallest rectangle around the area, less the boundary strip, is
/// divided into the fewest equal cells no wider than the spacing. A cell's centre is a point of the grid if it lies
/// within the faces, at least the strip's width from their border.
/// @param height  World z of the points [m]; nullopt: on the area itself.
/// @throws InputError for options out of range, for more than most_measuring_points, and if no point remains. Cost:
///         O(points * patches), with a boundary also O(patches^2).
MeasuringGrid area_grid(const Scene& scene, const PlanarArea& area, const GridOptions& options = {},
                        const std::optional<double>& height = {});

/// `count` equidistant points from a to b, inclusive.
/// @throws InputError for fewer than 2 points, for more than most_measuring_points, and for equal ends.
MeasuringGrid line_grid(const Imath::V3d& a, const Imath::V3d& b, int count);

}  // namespace interflect
