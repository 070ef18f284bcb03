#pragma once

#include <string>

namespace interflect::command {

/// 0.0123 -> "1.2%", 3.5 -> "350%": two significant digits without exponent; above, "over 9999%"; "-" if not finite.
std::string percent(double share);

}  // namespace interflect::command
