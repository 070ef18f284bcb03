#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/ply_values.h"

namespace interflect::inline detail {

/// A value of each element, or a list of values.
struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type;  ///< Of a list: the type of its length.
};

/// Such as "vertex" or "face".
struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    /// Index of the property; nothing where there is none.
    std::optional<std::size_t> find(std::string_view wanted) const;
    /// The fewest values and bytes that one takes: of a list its length alone.
    std::uint64_t fewest_values() const { return properties.size(); }
    std::uint64_t fewest_bytes() const;
};

struct PlyHeader {
    PlyValues::Form form = PlyValues::Form::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< Of the header [bytes].
};

/// @param line  Set to the line that is read: after an error the line of the fault, after a header its last.
/// @throws std::invalid_argument  with a sentence, for what is no header.
PlyHeader parse_ply_header(std::string_view bytes, std::int64_t& line);

}  // namespace interflect::inline detail
