#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "interflect/load.h"

namespace interflect::detail {

/// Invalid input that an option of ReadOptions would allow. The reader adds its location.
struct ReadFault : std::invalid_argument {
    /// @param setting_name  Name of the option.
    ReadFault(const std::string& text, std::string setting_name)
        : std::invalid_argument(text), setting(std::move(setting_name)) {}

    std::string setting;
};

inline std::string setting_of(const std::invalid_argument& fault) {
    const auto* read_fault = dynamic_cast<const ReadFault*>(&fault);
    return read_fault ? read_fault->setting : "";
}

/// @param subject  Start of the message: "the texture 'wood.png'".
/// @throws ReadFault if `path` is outside `folder`, unless options.outside_files allows it.
void require_within(const std::filesystem::path& path, const std::filesystem::path& folder, const ReadOptions& options,
                    const std::string& subject);

}  // namespace interflect::detail
