#pragma once

#include <cstdint>

namespace interflect {

/// A direction along an axis.
enum class Axis { x, minus_x, y, minus_y, z, minus_z };

/// Options and limits of readers. A file beyond a limit causes an InputError that names the option, before memory is
/// allocated.
struct ReadOptions {
    /// Length of the file's unit [m], in [1e-9, 1e9]: scales all coordinates, for every format. Views in a separate
    /// file (view_list_path) are in metres.
    double unit = 1;
    Axis up_axis = Axis::z;                  ///< Up axis of the file, which is rotated to z.
    int curve_divisions = 4;                 ///< Flat pieces per quarter circle of a curved surface, 1 to 1000.
    std::uint64_t max_patches = 50'000'000;  ///< Total patches, at most 4 * 10^9; also bounds the work for arrays.
    int max_include_depth = 32;              ///< Nested include files; 0 refuses every include.
    int max_nesting = 1000;                  ///< Nested transforms, and nested objects.
    std::size_t max_line_length = 1 << 16;   ///< Characters, including continuation lines.
    std::size_t max_face_vertices = 1024;    ///< Twice the limit of MGF's own parser; crossing loops cost its square.
    std::size_t max_name_length = 256;       ///< Characters of one name; four times that for a dotted object name.
    std::size_t max_photometric_bytes = 1 << 24;             ///< Size of one photometric file (.ies, .ldt).
    std::uint64_t max_model_bytes = std::uint64_t{1} << 32;  ///< Mesh file, with referenced and unpacked data.
    std::size_t max_json_bytes = 1 << 26;                    ///< Size of the text of a glTF file.
    bool outside_files = false;  ///< Whether a glTF, OBJ or Radiance file may refer to files outside its folder.
    std::size_t max_photometric_values = 1'000'000;  ///< In one file; steps of 0.1 by 1 degree give 650,000.
};

}  // namespace interflect
