#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/shapes/transform_sequence.h"

namespace interflect::detail {

/// `xform [-n name] [-m modifier] [-I] [transform] file ...`
struct RadXform {
    std::string name;      ///< Prefix of surface names, or empty.
    std::string modifier;  ///< Overrides the surfaces' own unless empty.
    bool inverts = false;  ///< Swaps front and back.
    TransformSequence transform;
    std::vector<std::string> files;  ///< Empty for the standard input.

    /// Returns "name.0.2", or "a0.2" without a name; `name` without an array.
    std::string prefix(const std::vector<int>& copy) const;
};

/// Splits `command` at pipes into commands of words. @param command  Command without its `!`.
/// @return  nullopt for an empty command and for shell syntax beyond pipes and quotes.
std::optional<std::vector<std::vector<std::string>>> parse_pipeline(std::string_view command);

/// @param words  Command and arguments. @return  nullopt for commands other than xform, and for arguments in a file.
/// @throws std::invalid_argument if xform would reject it.
std::optional<RadXform> parse_xform(std::span<const std::string> words);

}  // namespace interflect::detail
