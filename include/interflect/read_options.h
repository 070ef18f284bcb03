#pragma once

#include <cstdint>

namespace interflect {

/// A direction along an axis.
enum class Axis { x, minus_x, y, minus_y, z, minus_z };

/// How a scene is read, and how much a file may ask for: whatever goes beyond a limit is an InputError that names the
/// option, found before the memory is taken.
struct ReadOptions {
    /// Length of the file's unit [m], in [1e-9, 1e9]: what all coordinates in it are multiplied by, whatever its
    /// format. Views that are kept beside the file (view_list_path) are in metres.
    double unit = 1;
    Axis up_axis = Axis::z;   ///< What is up in the file: the scene is turned so that it becomes z. z: as it is.
    int curve_divisions = 4;  ///< Flat pieces per quarter circle of a curved surface, 1 to 1000.
    std::uint64_t max_patches = 50'000'000;  ///< Patches in all, at most 4 * 10^9; also bounds the work of arrays.
    int max_include_depth = 32;              ///< Files that include files; 0 refuses every include.
    int max_nesting = 1000;                  ///< Open transforms, and open objects.
    std::size_t max_line_length = 1 << 16;   ///< Characters, continued lines together.
    std::size_t max_face_vertices = 1024;    ///< Twice what MGF's own parser takes; loops that cross cost its square.
    std::size_t max_name_length = 256;       ///< Characters of one name; four times that for a dotted object name.
    std::size_t max_photometric_bytes = 1 << 24;             ///< Of one file with measured light (.ies, .ldt).
    std::uint64_t max_model_bytes = std::uint64_t{1} << 32;  ///< Of a file of meshes, with what it names and unpacks.
    std::size_t max_json_bytes = 1 << 26;                    ///< Of the text of a glTF file.
    bool outside_files = false;  ///< Whether a glTF, OBJ or Radiance file may name files outside of its folder.
    std::size_t max_photometric_values = 1'000'000;  ///< Intensities in it: each 0.1 degrees by each degree is 650,000.
};

}  // namespace interflect
