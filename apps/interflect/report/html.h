#pragma once

#include <string>
#include <string_view>

#include "interflect/image.h"

namespace interflect::command {

/// Escapes text for HTML and quoted attributes; control characters are escaped().
std::string html_text(std::string_view text);

/// Returns a data URL of a PNG. @param image  Display values.
std::string data_url(const Image& image);

}  // namespace interflect::command
