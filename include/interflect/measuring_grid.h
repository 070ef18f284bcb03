#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect {

/// More measuring points are made in one grid by nothing.
inline constexpr std::size_t most_measuring_points = 1'000'000;

/// Largest distance between the points of a measuring grid by EN 12464-1 (formula 1): p = 0.2 * 5^(log10 d) [m], at
/// most 10 m. d is the longer side of the area, or the shorter one where the longer is at least twice as long.
/// @param length, width  Sides of the area [m], > 0.
double grid_spacing(double length, double width);

/// How the points of a grid lie.
struct GridOptions {
    std::optional<double> spacing{};  ///< Largest distance between points [m], > 0; none: grid_spacing() of the area.
    double boundary = 0;              ///< Width of a strip along the border of the area that is left out [m], >= 0.
};

/// The strip along walls that EN 12464-1 leaves out of an area [m].
inline constexpr double usual_boundary = 0.5;

/// Faces of a scene in one plane, which light is measured on or over.
struct PlanarArea {
    std::string name;                    ///< Of the object that they belong to.
    V3f normal{0, 0, 1};                 ///< Of unit length, towards the lit side.
    std::vector<std::uint32_t> patches;  ///< Indices into Scene::patches.
    double area = 0;                     ///< [m^2]
};

/// The planar surface of an object: all its faces in the plane that holds most of them. Objects within it count as
/// parts: "desk" has the faces of "desk.top" too. Of two-sided faces the front counts, unless `facing` tells.
/// @param facing  The surface's normal is within 10 degrees of this; none: any.
/// @throws InputError for an object that does not exist, with the nearest names; where there is no such face; and where
/// several planes hold equally much, with their normals.
PlanarArea find_surface(const Scene& scene, const std::string& object, const std::optional<V3f>& facing = {});

/// The largest horizontal plane of an object's faces that face up: the top of a desk, the floor of a room; of equal
/// ones the highest. @throws InputError as find_surface() does.
PlanarArea find_top(const Scene& scene, const std::string& object);

/// The floor at or below a height: of all faces of the scene that face up there, those in the horizontal plane that
/// holds most of them. @param height  z in the world [m]. @throws InputError where there is none.
PlanarArea find_floor(const Scene& scene, double height);

/// An area divided by the objects that its faces belong to, in the order of their sizes: the floors of rooms. Copies of
/// an array (MGF names them "floor.a0", "floor.a1.2") are one object.
std::vector<PlanarArea> divide_by_object(const Scene& scene, const PlanarArea& area);

/// Points to measure at.
struct MeasuringGrid {
    std::string name;
    std::vector<Imath::V3d> points{};            ///< World coordinates [m]; of an area row by row.
    V3f normal{0, 0, 1};                         ///< Of the area, of unit length.
    int columns = 0, rows = 0;                   ///< Cells of the rectangle around the area; 0 of lines and points.
    double column_spacing = 0, row_spacing = 0;  ///< Distances between points [m]; of lines the first.
    Imath::V3d corner{0, 0, 0};                  ///< Of the first cell [m].
    Imath::V3d along_row{1, 0, 0}, along_column{0, 1, 0};  ///< Unit vectors from cell to cell.
    std::vector<std::uint32_t> cells{};                    ///< row * columns + column of each point.
};

/// A grid on an area, or at a height over it: the smallest rectangle around the area, less the boundary strip, is
/// divided into equal cells no wider than the spacing, as few as there can be; a point is the middle of a cell, where
/// that lies within the faces and no nearer to their border than the strip is wide.
/// @param height  z of the points in the world [m]; none: on the area itself.
/// @throws InputError for options out of range, for more than most_measuring_points, where the strip leaves nothing and
/// where no point lies within the faces. Cost: O(points * patches), with a boundary O(patches^2) too.
MeasuringGrid area_grid(const Scene& scene, const PlanarArea& area, const GridOptions& options = {},
                        const std::optional<double>& height = {});

/// `count` points at equal distances from a to b, both included.
/// @throws InputError for fewer than 2 points, for more than most_measuring_points, and for equal ends.
MeasuringGrid line_grid(const Imath::V3d& a, const Imath::V3d& b, int count);

}  // namespace interflect
