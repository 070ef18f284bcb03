#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace interflect::detail {

struct GeneratedSurface {
    std::string_view type;  ///< Radiance type.
    std::string name;
    std::vector<double> numbers;
};

/// Output of a generator.
struct GeneratedSurfaces {
    std::string modifier;
    std::vector<GeneratedSurface> surfaces;
    std::string omission;  ///< Option that is ignored, or empty.
};

/// Performs `genbox` and `genprism` without running a program, with the names and orientations of their output.
/// @param words  Command and arguments. @return  nullopt for other commands and for input and output by files.
/// @throws std::invalid_argument for arguments that the command would reject.
std::optional<GeneratedSurfaces> generate_surfaces(std::span<const std::string> words);

}  // namespace interflect::detail
