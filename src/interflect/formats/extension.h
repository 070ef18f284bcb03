#pragma once

#include <filesystem>
#include <string>

namespace interflect::detail {

inline std::string lower_case_extension(const std::filesystem::path& path) {
    std::string text = path.extension().string();
    for (char& c : text)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
}

}  // namespace interflect::detail
