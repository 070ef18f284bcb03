#include "interflect/formats/gltf/data/value.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "interflect/base/files/escapes.h"

namespace interflect::detail {

using nlohmann::json;

namespace {

const json empty_array = json::array();

}  // namespace

std::string gltf_place(const std::string& list, std::size_t index, const std::string& name) {
    constexpr std::size_t longest = 64;
    std::string place = fmt::format("{}[{}]", list, index);
    if (name.empty()) return place;
    return fmt::format("{} '{}{}'", place, escaped(std::string_view(name).substr(0, longest)),
                       name.size() > longest ? "..." : "");
}

void GltfValue::fail(const std::string& message, const std::string& setting) const {
    throw GltfFault(place_.empty() ? message : place_ + ": " + message, setting);
}

const json* GltfValue::find(const char* key) const {
    if (!json_) return nullptr;
    const auto found = json_->find(key);
    return found == json_->end() ? nullptr : &*found;
}

GltfValue GltfValue::object(const char* key) const {
    const json* value = find(key);
    if (value && !value->is_object()) fail(fmt::format("{} is not an object", key));
    return {value, place_.empty() ? key : place_ + '.' + key};
}

const json& GltfValue::array(const char* key) const {
    const json* value = find(key);
    if (!value) return empty_array;
    if (!value->is_array()) fail(fmt::format("{} is not an array", key));
    return *value;
}

std::vector<GltfValue> GltfValue::objects(const char* key) const {
    const json& values = array(key);
    std::vector<GltfValue> result;
    result.reserve(values.size());
    const std::string list = place_.empty() ? key : place_ + '.' + key;
    for (const json& value : values) {
        const std::string place = gltf_place(list, result.size(), "");
        if (!value.is_object()) throw GltfFault(place + " is not an object");
        const GltfValue unnamed(&value, place);
        result.emplace_back(&value, gltf_place(list, result.size(), unnamed.text("name")));
    }
    return result;
}

std::uint64_t GltfValue::whole_number(const json& value, const char* key) const {
    constexpr auto largest = static_cast<double>(largest_integer);
    const double number = value.is_number() ? value.get<double>() : -1;
    if (!(number >= 0) || number > largest || number != std::floor(number))
        fail(fmt::format("{} is not a whole number from 0 to {}", key, largest_integer));
    return static_cast<std::uint64_t>(number);
}

std::optional<std::uint64_t> GltfValue::find_integer(const char* key) const {
    const json* value = find(key);
    return value ? std::optional(whole_number(*value, key)) : std::nullopt;
}

std::uint64_t GltfValue::integer(const char* key) const {
    const auto found = find_integer(key);
    if (!found) fail(fmt::format("{} is missing", key));
    return *found;
}

std::uint64_t GltfValue::integer(const char* key, std::uint64_t otherwise) const {
    return find_integer(key).value_or(otherwise);
}

std::uint32_t GltfValue::index_below(std::size_t count, const json& value, const char* key) const {
    const std::uint64_t index = whole_number(value, key);
    if (index >= count) fail(fmt::format("{} is {}, but there are {}", key, index, count));
    return static_cast<std::uint32_t>(index);
}

std::uint32_t GltfValue::index(const char* key, std::size_t count) const {
    const json* value = find(key);
    return value ? index_below(count, *value, key) : none;
}

std::uint32_t GltfValue::required_index(const char* key, std::size_t count) const {
    if (!has(key)) fail(fmt::format("{} is missing", key));
    return index(key, count);
}

std::vector<std::uint32_t> GltfValue::indices(const char* key, std::size_t count) const {
    std::vector<std::uint32_t> result;
    for (const json& value : array(key)) result.push_back(index_below(count, value, key));
    return result;
}

double GltfValue::finite_number(const json& value, const char* key) const {
    const double number = value.is_number() ? value.get<double>() : std::numeric_limits<double>::infinity();
    if (!(std::abs(number) <= std::numeric_limits<float>::max()))
        fail(fmt::format("{} is not a number that single precision holds", key));
    return number;
}

double GltfValue::number(const char* key, double otherwise) const {
    const json* value = find(key);
    return value ? finite_number(*value, key) : otherwise;
}

double GltfValue::number(const char* key) const {
    if (!has(key)) fail(fmt::format("{} is missing", key));
    return number(key, 0);
}

double GltfValue::amount(const char* key, double otherwise) const {
    const double value = number(key, otherwise);
    if (value < 0) fail(fmt::format("{} is {}, expected at least 0", key, value));
    return value;
}

std::vector<double> GltfValue::numbers(const char* key) const {
    std::vector<double> result;
    for (const json& value : array(key)) result.push_back(finite_number(value, key));
    return result;
}

Rgb GltfValue::colour(const char* key, const Rgb& otherwise) const {
    const auto values = numbers<3>(key, {otherwise.x, otherwise.y, otherwise.z});
    Rgb result;
    for (int c = 0; c < 3; ++c) {
        const double value = values[static_cast<std::size_t>(c)];
        if (value < 0) fail(fmt::format("{} has the channel {}, expected at least 0", key, value));
        result[c] = static_cast<float>(value);
    }
    return result;
}

std::string GltfValue::text(const char* key, const std::string& otherwise) const {
    const json* value = find(key);
    if (!value) return otherwise;
    if (!value->is_string()) fail(fmt::format("{} is not a string", key));
    return value->get<std::string>();
}

std::vector<std::string> GltfValue::texts(const char* key) const {
    std::vector<std::string> result;
    for (const json& value : array(key)) {
        if (!value.is_string()) fail(fmt::format("{} is not an array of strings", key));
        result.push_back(value.get<std::string>());
    }
    return result;
}

bool GltfValue::flag(const char* key, bool otherwise) const {
    const json* value = find(key);
    if (!value) return otherwise;
    if (!value->is_boolean()) fail(fmt::format("{} is neither true nor false", key));
    return value->get<bool>();
}

}  // namespace interflect::detail
