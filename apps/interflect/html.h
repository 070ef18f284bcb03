#pragma once

#include <string>
#include <string_view>

#include "interflect/image.h"

namespace interflect::command {

/// Text as HTML shows it, also within the quotes of an attribute; control characters are escaped().
std::string html_text(std::string_view text);

/// A picture within a page: a data URL of a PNG file. @param image  As a display shows it.
std::string data_url(const Image& image);

}  // namespace interflect::command
