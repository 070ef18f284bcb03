#include "interflect/formats/foreign_text.h"

#include <algorithm>

namespace interflect::inline detail {

std::string without_quotes(std::string_view message, std::size_t from) {
    const std::size_t first = message.find('\'', std::min(from, message.size()));
    if (first == message.npos) return std::string(message);
    const std::size_t last = message.rfind('\'');
    const std::size_t rest = last > first ? last + 1 : message.size();
    return std::string(message.substr(0, first)) + "..." + std::string(message.substr(rest));
}

}  // namespace interflect::inline detail
