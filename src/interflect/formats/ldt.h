#pragma once

#include <filesystem>
#include <string_view>

#include "interflect/core.h"
#include "interflect/light_sources.h"
#include "interflect/load.h"

namespace interflect::detail {

/// Reads an EULUMDAT file (Stockmar 1990), with any symmetry. Intensities (per 1000 lm) are multiplied by the
/// conversion factor and the flux of the first lamp set. The opening has the height of its highest side.
///
/// Warnings by kind: "ldt-decimal-comma"; "ldt-lamps", several lamp sets; "ldt-tilt", tilted during measurement;
/// "ldt-angles", angles end early; "ldt-negative", negative intensity, read as 0; "ldt-trailing", words after the last
/// intensity.
/// @throws InputError  with file and line for other invalid input and beyond the limits of `options`.
PhotometricWeb read_ldt(const std::filesystem::path& path, const ReadOptions& options, Warnings& warnings);

/// Reads from memory. @param path  Name for messages.
PhotometricWeb read_ldt_text(std::string_view text, const std::filesystem::path& path, const ReadOptions& options,
                             Warnings& warnings);

}  // namespace interflect::detail
