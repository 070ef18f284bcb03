#include "interflect/exports/records/json_text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "interflect/base/files/escapes.h"
#include "interflect/formats/text/json_events.h"

namespace interflect::detail {

namespace {

/// Calls change(name, value) for all numbers and texts. @param name  Key of `json`.
template <class Change>
void change_values(Json& json, const std::string& name, const Change& change) {
    if (!json.is_structured()) return change(name, json);
    for (const auto& [key, value] : json.items()) change_values(value, json.is_object() ? key : name, change);
}

/// Stops parsing at a structure that is too large for Json. A callback of Json::parse() could do the same, but would
/// visit all earlier values for each object of an array.
class JsonLimits : public JsonEvents<Json> {
  public:
    bool are_exceeded() const { return exceeded_; }
    static std::string text() {
        return fmt::format("its JSON has more than {} levels, or an object of more than {} members", most_levels,
                           most_members);
    }

    bool start_object(std::size_t) override { return open(); }
    bool key(std::string&) override { return !(exceeded_ = ++members_.back() > most_members); }
    bool end_object() override { return close(); }
    bool start_array(std::size_t) override { return open(); }
    bool end_array() override { return close(); }

  private:
    // The description of a solution has 20 levels and 30 members at most.
    static constexpr std::size_t most_levels = 100, most_members = 1000;

    bool open() {
        members_.push_back(0);
        return !(exceeded_ = members_.size() > most_levels);
    }
    bool close() {
        members_.pop_back();
        return true;
    }

    std::vector<std::size_t> members_;  // number of members of each open object; 0 for arrays
    bool exceeded_ = false;
};

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
    JsonLimits limits;
    if (!Json::sax_parse(text, &limits) && limits.are_exceeded()) throw std::runtime_error(limits.text());
    return Json::parse(text);
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
