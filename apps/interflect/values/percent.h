#pragma once

#include <string>

#include "interflect/solution.h"

namespace interflect::command {

/// 0.0123 -> "1.2%", 3.5 -> "350%": two significant digits without exponent; above, "over 9999%"; "-" if not finite.
std::string percent(double share);

/// "7.9% (noise 5.5%, mesh 5.7%)", or "5.5% (noise alone)" where the error of the mesh is not estimated.
std::string text_of_error(const IterationReport& report);

}  // namespace interflect::command
