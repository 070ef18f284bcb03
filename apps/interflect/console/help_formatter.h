#pragma once

#include <CLI/CLI.hpp>

#include <span>
#include <string>
#include <string_view>

namespace interflect::command {

/// Shows the options that people use with --help, and all with --help-all.
class HelpFormatter : public CLI::Formatter {
  public:
    /// @param hidden  Groups of options for --help-all alone; must outlive this.
    explicit HelpFormatter(std::span<const std::string_view> hidden) : hidden_(hidden) {}

    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;

  private:
    std::string usual_groups(const CLI::App& app) const;

    std::span<const std::string_view> hidden_;
};

}  // namespace interflect::command
