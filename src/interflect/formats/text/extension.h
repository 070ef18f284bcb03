#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace interflect::detail {

/// Converts ASCII letters to lower case.
inline std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return result;
}

inline std::string lower_case_extension(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

}  // namespace interflect::detail
