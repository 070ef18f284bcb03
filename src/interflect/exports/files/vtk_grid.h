#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "interflect/exports/vertices/lit_polygons.h"
#include "interflect/scene.h"
#include "interflect/solution.h"

namespace interflect::detail {

/// An array of rows, each of which has `components` numbers.
struct VtkArray {
    std::string name;
    std::size_t components;
    std::variant<std::vector<float>, std::vector<double>, std::vector<std::uint32_t>, std::vector<std::uint8_t>>
        numbers;
};

/// The leaves of a solution as an unstructured grid of VTK.
class VtkGrid {
  public:
    using Sink = std::function<void(const VtkArray&)>;

    /// Refers to its arguments.
    VtkGrid(const Scene& scene, const Solution& solution)
        : scene_(scene), solution_(solution), polygons_(lit_polygons(scene, solution)) {}

    std::size_t point_count() const { return polygons_.vertices.size(); }
    std::size_t cell_count() const { return polygons_.size(); }
    /// Returns world coordinates [m], in double precision if the scene's origin is not 0.
    VtkArray points() const;
    std::vector<std::int64_t> connectivity() const;
    /// Returns cell_count() + 1 bounds in connectivity().
    std::vector<std::int64_t> offsets() const;
    std::vector<std::uint8_t> types() const;

    /// Pass each array of data to the sink. Programs display the first array by default.
    void visit_point_data(const Sink& sink) const;
    void visit_cell_data(const Sink& sink) const;

  private:
    const Scene& scene_;
    const Solution& solution_;
    LitPolygons polygons_;
};

}  // namespace interflect::detail
