#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/mesh/ply/values.h"

namespace interflect::detail {

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type;  ///< Type of a list's length; nullopt for a single value.
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    std::optional<std::size_t> find(std::string_view wanted) const;
    /// Returns the least number of values of an element, whose lists may be empty.
    std::uint64_t fewest_values() const { return properties.size(); }
    std::uint64_t fewest_bytes() const;
};

struct PlyHeader {
    PlyValues::Form form = PlyValues::Form::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0;            ///< [bytes]
    bool has_unknown_lines = false;  ///< Lines that begin with no word of PLY, which are skipped.
};

/// @param line  Set to the last line read. @throws std::invalid_argument
PlyHeader parse_ply_header(std::string_view bytes, std::int64_t& line);

}  // namespace interflect::detail
