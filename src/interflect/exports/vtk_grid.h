#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "interflect/exports/lit_polygons.h"
#include "interflect/scene.h"
#include "interflect/solve.h"

namespace interflect::inline detail {

/// An array of VTK: rows of `components` numbers each.
struct VtkArray {
    std::string name;
    std::size_t components;
    std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint32_t>, std::vector<std::uint8_t>>
        numbers;
};

/// A solved scene as VTK's unstructured grid, which its files have in common: a cell is a leaf, a point what leaves
/// share of their corners. Arrays are made one at a time, when they are asked for.
class VtkGrid {
  public:
    using Sink = std::function<void(const VtkArray&)>;

    /// Both arguments have to outlive it. Cost: as lit_polygons().
    VtkGrid(const Scene& scene, const Solution& solution)
        : scene_(scene), solution_(solution), polygons_(lit_polygons(scene, solution)) {}

    std::size_t point_count() const { return polygons_.vertices.size(); }
    std::size_t cell_count() const { return polygons_.size(); }
    /// World coordinates [m]: in single precision where the scene lies at the world's origin, else in double.
    VtkArray points() const;
    /// The points of all cells, one cell after the other.
    std::vector<std::int64_t> connectivity() const;
    /// Where each cell begins in `connectivity`, then where the last one ends.
    std::vector<std::int64_t> offsets() const;
    /// VTK's numbers of the cells' types.
    std::vector<std::uint8_t> types() const;

    /// Hands on every array of the points, or of the cells; the first is the one to be looked at.
    void visit_point_data(const Sink& sink) const;
    void visit_cell_data(const Sink& sink) const;

  private:
    const Scene& scene_;
    const Solution& solution_;
    LitPolygons polygons_;
};

}  // namespace interflect::inline detail
