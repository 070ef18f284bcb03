#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "interflect/scene.h"

namespace interflect::command {

void print_views(const std::vector<View>& views);

/// Formats four digits per number.
template <class Vector>
std::string text_of(const Vector& v) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z);
}

}  // namespace interflect::command
