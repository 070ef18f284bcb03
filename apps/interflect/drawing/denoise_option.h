#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "interflect/denoise.h"

namespace interflect::command {

/// Adds --denoise, for a command line with complete_denoise().
/// @param denoiser  Empty: off.
CLI::Option* add_denoiser(CLI::App& app, std::optional<Denoiser>& denoiser, const std::string& help);

/// @throws UsageError for Denoiser::oidn without its library.
void require_denoiser(std::optional<Denoiser> denoiser);

/// Gives --denoise a value: `--denoise` alone becomes `--denoise=auto`, `--no-denoise` becomes `--denoise=off`. CLI11
/// would take a file name that follows as the value.
void complete_denoise(std::vector<std::string>& arguments);

}  // namespace interflect::command
