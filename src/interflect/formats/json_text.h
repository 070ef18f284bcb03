#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string_view>

namespace interflect::detail {

/// @throws InputError with file and line for invalid JSON, or numbers beyond double precision.
nlohmann::json parse_json(std::string_view text, const std::filesystem::path& path);

}  // namespace interflect::detail
