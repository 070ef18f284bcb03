#pragma once

#include <string>

namespace interflect::command {

/// 0.0123 -> "1.2%", 3.5 -> "350%": two digits that count, never with an exponent; "over 9999%" from there on, "-" for
/// what is not known.
std::string percent(double share);

}  // namespace interflect::command
