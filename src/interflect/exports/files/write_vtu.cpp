#include <fmt/format.h>

#include <span>
#include <string>

#include "interflect/exports/files/mesh_files.h"
#include "interflect/exports/files/vtk_grid.h"

namespace interflect::detail {

namespace {

template <class Number>
constexpr const char* vtk_type() {
    if constexpr (std::is_same_v<Number, float>) return "Float32";
    if constexpr (std::is_same_v<Number, double>) return "Float64";
    if constexpr (std::is_same_v<Number, std::int64_t>) return "Int64";
    if constexpr (std::is_same_v<Number, std::uint32_t>) return "UInt32";
    if constexpr (std::is_same_v<Number, std::uint8_t>) return "UInt8";
}

class VtkDocument {
  public:
    void open(const std::string& tag) { xml_ += "<" + tag + ">\n"; }
    void close(const std::string& name) { xml_ += "</" + name + ">\n"; }

    template <class Number>
    void add(const std::string& name, std::span<const Number> numbers, std::size_t components = 1) {
        xml_ += fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
            vtk_type<Number>(), name, components, data_.size());
        append_bytes(data_, std::uint64_t{numbers.size_bytes()});
        data_.append(reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes());
    }
    void add(const VtkArray& array) {
        std::visit([&](const auto& numbers) { add(array.name, std::span(numbers), array.components); }, array.numbers);
    }

    std::string finish() && {
        std::string file = "<?xml version=\"1.0\"?>\n" + xml_ + "<AppendedData encoding=\"raw\">\n_";
        return file + data_ + "\n</AppendedData>\n</VTKFile>\n";
    }

  private:
    std::string xml_, data_;
};

void add_geometry(VtkDocument& file, const VtkGrid& grid) {
    file.open("Points");
    file.add(grid.points());
    file.close("Points");
    file.open("Cells");
    const std::vector<std::int64_t> offsets = grid.offsets();
    file.add<std::int64_t>("connectivity", grid.connectivity());
    file.add("offsets", std::span(offsets).subspan(1));  // the format stores the end of each cell only
    file.add<std::uint8_t>("types", grid.types());
    file.close("Cells");
}

}  // namespace

std::vector<ExportedFile> make_vtu(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                   const ExportOptions&) {
    const VtkGrid grid(scene, solution);
    VtkDocument file;
    file.open("VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"");
    file.open("UnstructuredGrid");
    file.open(fmt::format("Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"", grid.point_count(), grid.cell_count()));
    const auto add = [&](const VtkArray& array) { file.add(array); };
    file.open("PointData Scalars=\"illuminance\"");
    grid.visit_point_data(add);
    file.close("PointData");
    file.open("CellData Scalars=\"illuminance\"");
    grid.visit_cell_data(add);
    file.close("CellData");
    add_geometry(file, grid);
    file.close("Piece");
    file.close("UnstructuredGrid");
    return {{path, std::move(file).finish()}};
}

}  // namespace interflect::detail
