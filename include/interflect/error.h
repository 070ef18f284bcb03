#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace interflect {

/// Invalid user input: a file, an argument, a scene. The message contains the location, the expected and the found
/// value. The command line tool exits with code 3.
class InputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
    /// @param line  1-based; 0 if no line applies. The message becomes "file:line: message".
    InputError(const std::filesystem::path& file, std::int64_t line, const std::string& message)
        : std::runtime_error(file.string() + (line > 0 ? ":" + std::to_string(line) : std::string()) + ": " + message) {
    }
};

/// A scene would exceed a limit of patches (ReadOptions::max_patches, which the message names).
class TooManyPatches : public InputError {
  public:
    using InputError::InputError;
};

}  // namespace interflect
