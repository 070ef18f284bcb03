#include "interflect/exports/records/json_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "interflect/base/escapes.h"

namespace interflect::detail {

namespace {

/// @param name  Innermost key.
template <class Change>
void change_values(Json& json, const std::string& name, const Change& change) {
    if (!json.is_structured()) return change(name, json);
    for (const auto& [key, value] : json.items()) change_values(value, json.is_object() ? key : name, change);
}

}  // namespace

std::string json_text(Json json, int indent) {
    change_values(json, "", [](const std::string& name, Json& value) {
        if (value.is_string()) value = escaped(value.get_ref<const std::string&>());
        if (value.is_number_float() && !std::isfinite(value.get<double>()))
            throw std::runtime_error(fmt::format("'{}' is not finite", name));
    });
    return json.dump(indent);
}

Json parse_json_text(std::string_view text) {
    Json json = Json::parse(text);
    change_values(json, "", [](const std::string&, Json& value) {
        if (value.is_string()) value = unescaped(value.get_ref<const std::string&>());
    });
    return json;
}

double shortest_number(float value) {
    if (!std::isfinite(value)) return value;
    const std::string text = fmt::format("{}", value);
    double number = 0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

}  // namespace interflect::detail
