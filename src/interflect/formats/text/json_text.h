#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

namespace interflect::detail {

/// @throws InputError for invalid JSON and numbers beyond double precision.
nlohmann::json parse_json(std::string_view text, const std::filesystem::path& path);

}  // namespace interflect::detail
