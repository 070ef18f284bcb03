#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "interflect/formats/ply_values.h"

namespace interflect::inline detail {

/// Single value per element, or list of values.
struct PlyProperty {
    std::string name;
    PlyType type = PlyType::float32;
    std::optional<PlyType> count_type;  ///< Type of the list length; set for lists only.
};

/// Element type such as "vertex" or "face".
struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    std::optional<std::size_t> find(std::string_view wanted) const;
    /// Minimum number of values and bytes per element. A list counts as its length alone.
    std::uint64_t fewest_values() const { return properties.size(); }
    std::uint64_t fewest_bytes() const;
};

struct PlyHeader {
    PlyValues::Form form = PlyValues::Form::ascii;
    std::vector<PlyElement> elements;
    std::size_t size = 0;  ///< Size of the header [bytes].
};

/// @param line  Set to the line read last: the line of the error, or the last line of the header.
/// @throws std::invalid_argument  with a sentence for an invalid header.
PlyHeader parse_ply_header(std::string_view bytes, std::int64_t& line);

}  // namespace interflect::inline detail
