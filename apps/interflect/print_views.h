#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::command {

/// Prints one line per view.
void print_views(const std::vector<View>& views);

/// Formats three numbers with four digits each.
template <class Vector>
std::string text_of(const Vector& v) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z);
}

}  // namespace interflect::command
