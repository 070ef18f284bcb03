#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/photometric_web.h"
#include "interflect/read_options.h"
#include "interflect/warnings.h"

namespace interflect::inline detail {

/// Reads a photometric file in the EULUMDAT format (Stockmar 1990), every symmetry. The file's intensities per 1000 lm
/// are multiplied by its conversion factor and the flux of its first set of lamps. The height of the opening is its
/// greatest height.
///
/// Warnings, counted by kind: "ldt-decimal-comma", decimal commas; "ldt-lamps", more than one set of lamps; "ldt-tilt",
/// a luminaire tilted during measurement; "ldt-angles", angles that end early; "ldt-negative", a negative intensity,
/// read as 0; "ldt-trailing", words after the last intensity.
/// @throws InputError  with file and line for any other deviation from the format, and beyond the limits of `options`.
PhotometricWeb read_ldt(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// Reads from memory. @param path  Name for messages.
PhotometricWeb read_ldt_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

}  // namespace interflect::inline detail
