#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/transform_sequence.h"

namespace interflect::inline detail {

/// What the command `xform [-n name] [-m modifier] [-I] [transform] file ...` of a Radiance scene asks for. Commands
/// are never run.
struct RadXform {
    std::string name;             ///< That goes before the names of surfaces; may be empty.
    std::string modifier;         ///< That all surfaces get; empty: their own.
    bool inverts = false;         ///< Whether fronts become backs.
    TransformSequence transform;  ///< With arrays.
    std::vector<std::string> files;

    /// What goes before the names in a copy: "name.0.2", or "a0.2" without a name; `name` where there is no array.
    std::string prefix(const std::vector<int>& copy) const;
};

/// @param command  Without the `!`.
/// @return  Nothing for another command than xform, and where it asks for more of a shell than quotes: pipes,
/// variables.
/// @throws std::invalid_argument  where xform itself would refuse it.
std::optional<RadXform> parse_xform(std::string_view command);

}  // namespace interflect::inline detail
