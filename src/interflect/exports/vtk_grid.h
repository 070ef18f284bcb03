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

/// A VTK array: rows of `components` numbers.
struct VtkArray {
    std::string name;
    std::size_t components;
    std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint32_t>, std::vector<std::uint8_t>>
        numbers;
};

/// A solved scene as VTK unstructured grid, for all of VTK's file formats. Cells are leaves; points are shared by
/// corners of leaves. Arrays are created one at a time, on request.
class VtkGrid {
  public:
    using Sink = std::function<void(const VtkArray&)>;

    /// Keeps references to both arguments. Cost: that of lit_polygons().
    VtkGrid(const Scene& scene, const Solution& solution)
        : scene_(scene), solution_(solution), polygons_(lit_polygons(scene, solution)) {}

    std::size_t point_count() const { return polygons_.vertices.size(); }
    std::size_t cell_count() const { return polygons_.size(); }
    /// World coordinates [m]; single precision if the scene's origin is 0, otherwise double.
    VtkArray points() const;
    /// Points of all cells, one cell after the other.
    std::vector<std::int64_t> connectivity() const;
    /// First index of each cell in `connectivity`, and the end of the last.
    std::vector<std::int64_t> offsets() const;
    /// VTK's numbers of the cell types.
    std::vector<std::uint8_t> types() const;

    /// Pass all arrays of the points or cells to `sink`, beginning with the default for display.
    void visit_point_data(const Sink& sink) const;
    void visit_cell_data(const Sink& sink) const;

  private:
    const Scene& scene_;
    const Solution& solution_;
    LitPolygons polygons_;
};

}  // namespace interflect::inline detail
