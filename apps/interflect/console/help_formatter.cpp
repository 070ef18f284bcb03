#include "apps/interflect/console/help_formatter.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace interflect::command {

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
    if (mode != CLI::AppFormatMode::Normal) return Formatter::make_help(app, std::move(name), mode);
    return make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) + usual_groups(*app) +
           make_subcommands(app, mode) + "\n" + make_footer(app);
}

std::string HelpFormatter::usual_groups(const CLI::App& app) const {
    std::string shown, others;
    for (const std::string& group : app.get_groups()) {
        const std::vector<const CLI::Option*> options = app.get_options(
            [&](const CLI::Option* option) { return option->get_group() == group && option->nonpositional(); });
        if (options.empty()) continue;
        if (std::find(hidden_.begin(), hidden_.end(), group) == hidden_.end())
            shown += (shown.empty() ? "" : "\n") + make_group(group, false, options);
        else
            others += (others.empty() ? "" : ", ") + group;
    }
    return others.empty() ? shown : shown + "\n\nMore options with --help-all: " + others + "\n";
}

}  // namespace interflect::command
