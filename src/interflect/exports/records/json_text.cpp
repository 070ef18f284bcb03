#include "interflect/exports/records/json_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <vector>

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

Json parse_json(std::string_view text) {
    // The description of a solution has 20 levels and 30 members at most.
    constexpr int most_levels = 100;
    constexpr std::size_t most_members = 1000;
    std::vector<std::size_t> members;  // of the open objects
    return Json::parse(text, [&](int level, Json::parse_event_t event, const Json&) {
        if (event == Json::parse_event_t::object_start) members.push_back(0);
        if (event == Json::parse_event_t::object_end) members.pop_back();
        if (level > most_levels || (event == Json::parse_event_t::key && ++members.back() > most_members))
            throw std::runtime_error(fmt::format(
                "its JSON has more than {} levels, or an object of more than {} members", most_levels, most_members));
        return true;
    });
}

Json parse_json_text(std::string_view text) {
    Json json = parse_json(text);
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
