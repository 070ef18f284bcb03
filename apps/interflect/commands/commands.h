#pragma once

#include <CLI/CLI.hpp>

namespace interflect::command {

enum ExitCode { done = 0, failed = 1, wrong_usage = 2, bad_input = 3, interrupted = 130 };

// Each function adds a subcommand, which sets `exit_code` unless it ends with `done` or an exception.
void add_info(CLI::App& app);
void add_solve(CLI::App& app, int& exit_code);
void add_resume(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);
void add_probe(CLI::App& app, int& exit_code);
void add_report(CLI::App& app);
void add_export(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app);
void add_bench(CLI::App& app);
void add_validate(CLI::App& app, int& exit_code);
void add_viewfactors(CLI::App& app, int& exit_code);
void add_make_scene(CLI::App& app);

}  // namespace interflect::command
