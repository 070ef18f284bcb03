#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace interflect::detail {

using Json = nlohmann::ordered_json;

/// Returns JSON as text. Strings are encoded by escaped(), because names are bytes of unknown encoding.
/// @param indent  Number of blanks per level; -1 for a single line.
/// @throws std::runtime_error naming a number that is not finite.
std::string json_text(Json json, int indent = -1);

/// Parses JSON. Refuses deep nesting, and objects with many members, because an ordered object searches them one by
/// one.
/// @throws Json::exception, std::runtime_error
Json parse_json(std::string_view text);

/// Inverse of json_text(). Throws as parse_json() does.
Json parse_json_text(std::string_view text);

/// Returns the double with the fewest digits that identify `value`.
double shortest_number(float value);

template <class Vector>
Json json_of(const Vector& v) {
    if constexpr (std::is_same_v<decltype(Vector::x), float>)
        return Json::array({shortest_number(v.x), shortest_number(v.y), shortest_number(v.z)});
    else
        return Json::array({v.x, v.y, v.z});
}

}  // namespace interflect::detail
