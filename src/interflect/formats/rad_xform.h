#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/transform_sequence.h"

namespace interflect::inline detail {

/// Arguments of the command `xform [-n name] [-m modifier] [-I] [transform] file ...`. The command itself is never run.
struct RadXform {
    std::string name;      ///< Prefix of surface names; may be empty.
    std::string modifier;  ///< Replaces the modifier of all surfaces unless empty.
    bool inverts = false;  ///< Whether front and back are swapped.
    TransformSequence transform;
    std::vector<std::string> files;

    /// Returns the name prefix of a copy: "name.0.2", or "a0.2" without a name; `name` if there is no array.
    std::string prefix(const std::vector<int>& copy) const;
};

/// @param command  Without the `!`.
/// @return  nullopt for commands other than xform and for shell syntax beyond quotes, such as pipes and variables.
/// @throws std::invalid_argument  if xform itself would reject the command.
std::optional<RadXform> parse_xform(std::string_view command);

}  // namespace interflect::inline detail
