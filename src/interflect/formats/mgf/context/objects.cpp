#include "interflect/formats/mgf/context/objects.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace interflect::detail {

void MgfObjects::open(std::string_view name, bool is_copy, const Location& where) {
    if (open_.size() >= static_cast<std::size_t>(options_.max_nesting))
        throw std::invalid_argument(fmt::format("objects are nested more than {} deep", options_.max_nesting));
    const std::string outer = open_.empty() ? "" : open_.back().dotted_name + '.';
    if (name.size() > options_.max_name_length || outer.size() + name.size() > 4 * options_.max_name_length)
        throw std::invalid_argument(
            fmt::format("the object's name is too long: at most {} characters, {} with those around it",
                        options_.max_name_length, 4 * options_.max_name_length));
    open_.push_back({outer + std::string(name), where, is_copy, std::nullopt});
}

bool MgfObjects::close_innermost(std::size_t outer_depth) {
    if (open_.size() <= outer_depth || open_.back().is_copy) return false;
    open_.pop_back();
    return true;
}

void MgfObjects::close_copy() {
    const auto copy = std::find_if(open_.rbegin(), open_.rend(), [](const OpenObject& o) { return o.is_copy; });
    close_down_to(static_cast<std::size_t>(open_.rend() - copy) - 1);
}

void MgfObjects::close_down_to(std::size_t depth) {
    for (; open_.size() > depth; open_.pop_back())
        if (!open_.back().is_copy)
            scene_.warn("unclosed-object", "object (o) is not closed before the end of its file or array",
                        open_.back().opened);
}

std::uint32_t MgfObjects::current() {
    if (open_.empty()) return 0;
    std::optional<std::uint32_t>& index = open_.back().scene_index;
    if (!index) index = scene_.object(open_.back().dotted_name);
    return *index;
}

}  // namespace interflect::detail
