#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/transform_sequence.h"

namespace interflect::detail {

/// `xform [-n name] [-m modifier] [-I] [transform] file ...`
struct RadXform {
    std::string name;      ///< Prefix of surface names, or empty.
    std::string modifier;  ///< Overrides the surfaces' own unless empty.
    bool inverts = false;  ///< Swaps front and back.
    TransformSequence transform;
    std::vector<std::string> files;

    /// Returns "name.0.2", or "a0.2" without a name; `name` without an array.
    std::string prefix(const std::vector<int>& copy) const;
};

/// @param command  Without `!`. @return  nullopt for other commands, stdin and shell syntax beyond quotes.
/// @throws std::invalid_argument if xform would reject it.
std::optional<RadXform> parse_xform(std::string_view command);

}  // namespace interflect::detail
