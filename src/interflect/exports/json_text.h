#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace interflect::inline detail {

using Json = nlohmann::ordered_json;

/// Every JSON text that leaves the program: all strings are escaped() (escapes.h), since names are bytes of unknown
/// encoding, and no number is NaN or infinite, which JSON does not have; null means a value that is not there.
/// @param indent  Spaces a level; -1: all on one line.
/// @throws std::runtime_error that names the number that is not finite.
std::string json_text(Json json, int indent = -1);

/// What json_text() was given, names with their own bytes. @throws nlohmann::json::exception
Json parse_json_text(std::string_view text);

/// A number that prints as few digits as tell `value` from its neighbours: 0.1f is 0.1, not 0.10000000149011612.
double shortest_number(float value);

/// The same of each coordinate where it is a float.
template <class Vector>
Json json_of(const Vector& v) {
    if constexpr (std::is_same_v<decltype(Vector::x), float>)
        return Json::array({shortest_number(v.x), shortest_number(v.y), shortest_number(v.z)});
    else
        return Json::array({v.x, v.y, v.z});
}

}  // namespace interflect::inline detail
