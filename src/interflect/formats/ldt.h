#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/photometric_web.h"
#include "interflect/read_options.h"
#include "interflect/warnings.h"

namespace interflect::inline detail {

/// Reads a file of measured light in the EULUMDAT format (Stockmar 1990), every symmetry. Intensities are those of the
/// file, which are for 1000 lm, times its conversion factor and the flux of its first set of lamps. The opening is as
/// high as its highest side.
///
/// Tolerated with a warning, counted by kind: "ldt-decimal-comma", commas for decimal points; "ldt-lamps", more than
/// one set of lamps; "ldt-tilt", a luminaire that was tilted as it was measured; "ldt-angles", angles that end early;
/// "ldt-negative", a negative intensity, read as 0; "ldt-trailing", words after the last intensity.
/// @throws InputError with file and line, for what is not as above, and beyond the limits of `options`.
PhotometricWeb read_ldt(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// The same from memory. @param path  Name for messages.
PhotometricWeb read_ldt_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

}  // namespace interflect::inline detail
