#include <fmt/format.h>

#include <string>

#include "interflect/elements/forest.h"
#include "interflect/exports/lit_polygons.h"
#include "interflect/exports/mesh_files.h"
#include "interflect/solver/materials.h"

namespace interflect::inline detail {

namespace {

template <class Number>
constexpr const char* vtk_type() {
    if constexpr (std::is_same_v<Number, float>) return "Float32";
    if constexpr (std::is_same_v<Number, double>) return "Float64";
    if constexpr (std::is_same_v<Number, std::int64_t>) return "Int64";
    if constexpr (std::is_same_v<Number, std::uint32_t>) return "UInt32";
    if constexpr (std::is_same_v<Number, std::uint8_t>) return "UInt8";
}

/// The elements of a VTK XML file, whose numbers are appended to it as they are.
class VtkDocument {
  public:
    void open(const std::string& tag) { xml_ += "<" + tag + ">\n"; }
    void close(const std::string& name) { xml_ += "</" + name + ">\n"; }

    /// @param value  Called with each of the indices 0 ... count - 1: a number, or a vector of three.
    template <class Value>
    void add(const char* name, std::size_t count, const Value& value) {
        using Result = decltype(value(std::size_t{0}));
        constexpr bool is_vector = !std::is_arithmetic_v<Result>;
        const std::uint64_t offset = data_.size();
        append_bytes(data_, std::uint64_t{0});  // the length, below
        for (std::size_t i = 0; i < count; ++i)
            if constexpr (is_vector)
                for (int k = 0; k < 3; ++k) append_bytes(data_, value(i)[k]);
            else
                append_bytes(data_, value(i));
        const std::uint64_t length = data_.size() - offset - sizeof length;
        data_.replace(offset, sizeof length, reinterpret_cast<const char*>(&length), sizeof length);
        if constexpr (is_vector)
            describe<std::remove_cvref_t<decltype(std::declval<Result>()[0])>>(name, 3, offset);
        else
            describe<Result>(name, 1, offset);
    }

    std::string finish() && {
        std::string file = "<?xml version=\"1.0\"?>\n" + xml_ + "<AppendedData encoding=\"raw\">\n_";
        return file + data_ + "\n</AppendedData>\n</VTKFile>\n";
    }

  private:
    template <class Number>
    void describe(const char* name, int components, std::uint64_t offset) {
        xml_ += fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
            vtk_type<Number>(), name, components, offset);
    }

    std::string xml_, data_;
};

void add_point_data(VtkDocument& file, const LitPolygons& polygons) {
    const std::size_t count = polygons.vertices.size();
    file.open("PointData Scalars=\"illuminance\"");
    file.add("illuminance", count, [&](std::size_t i) { return luminance(polygons.vertices[i].irradiance); });
    file.add("irradiance", count, [&](std::size_t i) { return polygons.vertices[i].irradiance; });
    file.add("radiosity", count, [&](std::size_t i) { return polygons.vertices[i].radiosity; });
    file.close("PointData");
}

void add_cell_data(VtkDocument& file, const Scene& scene, const Solution& solution, const LitPolygons& polygons) {
    const ElementForest& forest = *solution.forest;
    Materials materials(scene);
    materials.grow(forest);
    const std::vector<Rgb> leaving = radiosity(materials, forest, solution.irradiance);
    const auto add = [&](const char* name, const auto& of_element) {
        file.add(name, polygons.size(), [&](std::size_t i) { return of_element(polygons.leaves[i]); });
    };
    const auto add_numbers = [&](const char* name, const std::vector<float>& numbers) {
        if (!numbers.empty()) add(name, [&](std::uint32_t e) { return numbers[e]; });
    };
    file.open("CellData Scalars=\"illuminance\"");
    add("illuminance", [&](std::uint32_t e) { return luminance(solution.irradiance[e]); });
    add("irradiance", [&](std::uint32_t e) { return solution.irradiance[e]; });
    for (std::size_t g = 0; g < solution.groups.size(); ++g)
        add(fmt::format("irradiance_of_group_{}", g).c_str(), [&](std::uint32_t e) { return solution.groups[g][e]; });
    add("radiosity", [&](std::uint32_t e) { return leaving[e]; });
    add_numbers("standard_error", solution.standard_error);
    add_numbers("discretisation_error", solution.discretisation_error);
    add_numbers("rays", solution.rays);
    add_numbers("view_importance", solution.view_importance);
    add_numbers("indirect_importance", solution.indirect_importance);
    add("element", [](std::uint32_t e) { return e; });
    add("patch", [&](std::uint32_t e) { return forest.patch(e); });
    add("level", [&](std::uint32_t e) { return static_cast<std::uint8_t>(forest.level(e)); });
    add("material", [&](std::uint32_t e) { return scene.patches[forest.patch(e)].material; });
    add("object", [&](std::uint32_t e) { return scene.patches[forest.patch(e)].object; });
    file.close("CellData");
}

void add_geometry(VtkDocument& file, const Scene& scene, const LitPolygons& polygons) {
    const auto point = [&](std::size_t i) -> const V3f& { return polygons.points[polygons.vertices[i].point]; };
    file.open("Points");
    if (scene.origin == Imath::V3d(0))
        file.add("Points", polygons.vertices.size(), [&](std::size_t i) { return point(i); });
    else
        file.add("Points", polygons.vertices.size(),
                 [&](std::size_t i) { return scene.origin + Imath::V3d(point(i)); });
    file.close("Points");
    file.open("Cells");
    file.add("connectivity", polygons.corners.size(), [&](std::size_t i) { return std::int64_t{polygons.corners[i]}; });
    file.add("offsets", polygons.size(), [&](std::size_t i) { return std::int64_t{polygons.ends[i]}; });
    file.add("types", polygons.size(), [&](std::size_t i) {
        constexpr std::uint8_t triangle = 5, polygon = 7;
        return polygons.ends[i] - polygons.begin(i) == 3 ? triangle : polygon;
    });
    file.close("Cells");
}

}  // namespace

std::vector<ExportedFile> make_vtu(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions&) {
    const LitPolygons polygons = lit_polygons(scene, solution);
    VtkDocument file;
    file.open("VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"");
    file.open("UnstructuredGrid");
    file.open(
        fmt::format("Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", polygons.vertices.size(), polygons.size()));
    add_point_data(file, polygons);
    add_cell_data(file, scene, solution, polygons);
    add_geometry(file, scene, polygons);
    file.close("Piece");
    file.close("UnstructuredGrid");
    return {{path, std::move(file).finish()}};
}

}  // namespace interflect::inline detail
