#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "interflect/scene.h"

namespace interflect::detail {

/// Error whose message names the place, but not the file.
struct GltfFault : std::runtime_error {
    /// @param setting_name  Fault::setting.
    explicit GltfFault(const std::string& text, std::string setting_name = {})
        : std::runtime_error(text), setting(std::move(setting_name)) {}

    std::string setting;
};

/// JSON value with its place, such as "meshes[3] 'chair'". Absent values act as empty ones. The getters throw GltfFault
/// for wrong types and ranges.
class GltfValue {
  public:
    /// Limit of integers, which prevents the overflow of sums.
    static constexpr std::uint64_t largest_integer = std::uint64_t{1} << 40;

    /// @param json  It must outlive this object; null for an absent value.
    GltfValue(const nlohmann::json* json, std::string place) : json_(json), place_(std::move(place)) {}

    bool exists() const { return json_ != nullptr; }
    bool has(const char* key) const { return find(key) != nullptr; }
    const std::string& place() const { return place_; }
    [[noreturn]] void fail(const std::string& message, const std::string& setting = {}) const;

    GltfValue object(const char* key) const;
    GltfValue extension(const char* name) const { return object("extensions").object(name); }
    std::vector<GltfValue> objects(const char* key) const;

    std::optional<std::uint64_t> find_integer(const char* key) const;
    std::uint64_t integer(const char* key) const;
    std::uint64_t integer(const char* key, std::uint64_t otherwise) const;
    /// Returns an index below `count`, or `none` if it is absent.
    std::uint32_t index(const char* key, std::size_t count) const;
    std::uint32_t required_index(const char* key, std::size_t count) const;
    std::vector<std::uint32_t> indices(const char* key, std::size_t count) const;

    double number(const char* key, double otherwise) const;
    double number(const char* key) const;
    /// Returns a number, which may not be negative.
    double amount(const char* key, double otherwise) const;
    std::vector<double> numbers(const char* key) const;
    template <std::size_t size>
    std::array<double, size> numbers(const char* key, const std::array<double, size>& otherwise) const {
        std::array<double, size> result = otherwise;
        if (!has(key)) return result;
        const std::vector<double> values = numbers(key);
        if (values.size() != size) fail(std::string(key) + " has not " + std::to_string(size) + " numbers");
        for (std::size_t i = 0; i < size; ++i) result[i] = values[i];
        return result;
    }
    /// Returns a colour in linear Rec. 709, which may not be negative.
    Rgb colour(const char* key, const Rgb& otherwise) const;

    std::string text(const char* key, const std::string& otherwise = "") const;
    std::vector<std::string> texts(const char* key) const;
    bool flag(const char* key, bool otherwise) const;

  private:
    const nlohmann::json* find(const char* key) const;
    const nlohmann::json& array(const char* key) const;
    std::uint64_t whole_number(const nlohmann::json& value, const char* key) const;
    double finite_number(const nlohmann::json& value, const char* key) const;
    std::uint32_t index_below(std::size_t count, const nlohmann::json& value, const char* key) const;

    const nlohmann::json* json_;
    std::string place_;
};

/// Returns a place such as "nodes[3] 'chair'". Truncates long names.
std::string gltf_place(const std::string& list, std::size_t index, const std::string& name);

}  // namespace interflect::detail
