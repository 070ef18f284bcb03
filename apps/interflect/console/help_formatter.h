#pragma once

#include <CLI/CLI.hpp>

#include <span>
#include <string>
#include <string_view>

namespace interflect::command {

/// Shows the common options with --help, and all options with --help-all.
class HelpFormatter : public CLI::Formatter {
  public:
    /// @param hidden  Groups of options that only --help-all shows. They must outlive this object.
    explicit HelpFormatter(std::span<const std::string_view> hidden) : hidden_(hidden) {}

    std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;

  private:
    std::string usual_groups(const CLI::App& app) const;

    std::span<const std::string_view> hidden_;
};

}  // namespace interflect::command
