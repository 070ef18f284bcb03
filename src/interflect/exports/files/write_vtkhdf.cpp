#include <fmt/format.h>

#include <array>

#include "interflect/exports/files/mesh_files.h"
#include "interflect/exports/files/vtk_grid.h"
#include "interflect/exports/hdf5/hdf5_arrays.h"

namespace interflect::detail {

namespace {

constexpr const char* root_group = "VTKHDF";

template <class Number>
void add_numbers(Hdf5Writer& file, const std::string& name, const std::vector<Number>& numbers,
                 std::size_t columns = 1) {
    file.write_compressed<Number>(fmt::format("{}/{}", root_group, name), numbers, columns);
}

void add_array(Hdf5Writer& file, const std::string& folder, const VtkArray& array) {
    std::visit([&](const auto& numbers) { add_numbers(file, folder + array.name, numbers, array.components); },
               array.numbers);
}

/// Writes a count as an array with one entry, because the grid has one part.
void add_count(Hdf5Writer& file, const char* name, std::size_t count) {
    const std::array number{static_cast<std::int64_t>(count)};
    file.write<std::int64_t>(fmt::format("{}/{}", root_group, name), number);
}

}  // namespace

std::vector<ExportedFile> make_vtkhdf(const std::filesystem::path& path, const Scene& scene, const Solution& solution,
                                      const ExportOptions&) {
    const VtkGrid grid(scene, solution);
    const std::vector<std::int64_t> connectivity = grid.connectivity();
    Hdf5Writer file;
    add_count(file, "NumberOfPoints", grid.point_count());
    add_count(file, "NumberOfCells", grid.cell_count());
    add_count(file, "NumberOfConnectivityIds", connectivity.size());
    file.write_attribute(root_group, "Version", std::array<std::int64_t, 2>{1, 0});
    file.write_attribute(root_group, "Type", std::string_view("UnstructuredGrid"));
    add_array(file, "", grid.points());
    add_numbers(file, "Connectivity", connectivity);
    add_numbers(file, "Offsets", grid.offsets());
    add_numbers(file, "Types", grid.types());
    grid.visit_point_data([&](const VtkArray& array) { add_array(file, "PointData/", array); });
    grid.visit_cell_data([&](const VtkArray& array) { add_array(file, "CellData/", array); });
    return {{path, file.image()}};
}

}  // namespace interflect::detail
