#pragma once

#include <optional>
#include <span>
#include <string>

#include "interflect/load.h"

namespace interflect::detail {

/// Daylight of `gensky`, or of `gendaylit` with -W, without running a program. The position of the sun follows
/// Radiance's formulas. Radiances of sun and sky are converted at 179 lm/W.
/// @param words  Command and arguments. @return  nullopt for other commands and options, time zones by name, and a
/// clear sky before sunrise. @throws std::invalid_argument for invalid arguments.
std::optional<Daylight> parse_sky_command(std::span<const std::string> words);

}  // namespace interflect::detail
