#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "interflect/shading.h"

namespace interflect::command {

/// Adds --shading with the shadings of a use.
/// @param place  Place where light is computed, such as "pixel", for the help.
CLI::Option* add_shading(CLI::App& app, Shading& shading, LightUse use, const std::string& place);

/// Returns the default numbers of samples of a use, for the help: "hybrid 16, gather 64".
std::string text_of_default_samples(LightUse use);

}  // namespace interflect::command
