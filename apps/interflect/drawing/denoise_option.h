#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "interflect/denoise.h"

namespace interflect::command {

/// Adds the option --denoise. Arguments must pass complete_denoise() before they are parsed.
/// @param denoiser  Chosen filter; empty for --denoise off.
CLI::Option* add_denoiser(CLI::App& app, std::optional<Denoiser>& denoiser, const std::string& help);

/// @throws UsageError for Denoiser::oidn if its library is missing.
void require_denoiser(std::optional<Denoiser> denoiser);

/// Replaces `--denoise` without a value by `--denoise=auto`, and `--no-denoise` by `--denoise=off`. Otherwise CLI11
/// would use the next argument, such as a file name, as the value.
void complete_denoise(std::vector<std::string>& arguments);

}  // namespace interflect::command
