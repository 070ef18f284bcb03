#pragma once

#include <CLI/CLI.hpp>

#include "apps/interflect/render/render_arguments.h"

namespace interflect::command {

/// Checks the options and sets the members that depend on other options. Warns about options without effect.
/// @throws UsageError for invalid options; std::runtime_error for a picture that does not fit into memory.
void complete_options(RenderArguments& options, const CLI::App& command);

}  // namespace interflect::command
