#include <malloc.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <string>
#include <vector>

#include "apps/interflect/commands/commands.h"
#include "apps/interflect/console/help_formatter.h"
#include "apps/interflect/console/messages.h"
#include "apps/interflect/console/standard_streams.h"
#include "apps/interflect/drawing/denoise_option.h"
#include "apps/interflect/options/shared_options.h"
#include "apps/interflect/processes/shared_run.h"
#include "apps/interflect/processes/signals.h"
#include "apps/interflect/values/faults.h"
#include "interflect/core.h"

namespace {

std::string usage_message(const CLI::App* app, const CLI::Error& error) {
    const auto chosen = app->get_subcommands();
    std::string command = app->get_name(), message = error.what();
    if (chosen.empty()) {
        const auto unknown = app->remaining();
        message = unknown.empty() ? std::string() : "'" + unknown.front() + "' is no subcommand; ";
        message += "expected one of:";
        for (const CLI::App* subcommand : app->get_subcommands({})) message += " " + subcommand->get_name();
    } else {
        command += " " + chosen.front()->get_name();
    }
    return "error: " + interflect::detail::escaped(message) + "\n`" + command + " --help-all` lists the options.\n";
}

constexpr const char* footer =
    "`interflect SUBCOMMAND --help` lists the options of each.\n"
    "Lengths are in metres, powers in lumens. Results go to stdout, messages to stderr.\n"
    "Exit codes: 0 done, 1 failed, 2 wrong usage, 3 bad input, 130 interrupted (usable results are kept).";

int run(int argc, char** argv) {
    using namespace interflect::command;
    CLI::App app("Interflect: diffuse global illumination that goes where the eye looks", "interflect");
    app.set_version_flag("--version", "interflect " INTERFLECT_VERSION);
    app.formatter(std::make_shared<HelpFormatter>(rare_groups));
    app.set_help_all_flag("--help-all", "Print all options and exit");
    app.require_subcommand(1);
    app.failure_message(usage_message);
    int exit_code = done;
    add_info(app);
    add_solve(app, exit_code);
    add_resume(app, exit_code);
    add_render(app, exit_code);
    add_probe(app, exit_code);
    add_report(app);
    add_export(app, exit_code);
    add_compare(app);
    add_validate(app, exit_code);
    add_viewfactors(app, exit_code);
    add_bench(app);
    add_make_scene(app);
    app.footer(footer);  // set after the subcommands, which would inherit it

    try {
        std::vector<std::string> arguments(argv + 1, argv + argc);
        complete_denoise(arguments);
        std::reverse(arguments.begin(), arguments.end());  // as CLI11 expects it
        app.parse(arguments);
    } catch (const CLI::ParseError& e) {
        if (app.exit(e) != 0) return wrong_usage;
    }
    flush_stdout();
    return exit_code;
}

/// Ends the other processes when the command ends.
struct Dismissal {
    Dismissal() = default;
    ~Dismissal() { interflect::command::dismiss_ranks(); }
    Dismissal(const Dismissal&) = delete;
    Dismissal& operator=(const Dismissal&) = delete;
};

/// Works for the first process until it ends. Returns the exit code.
int serve() try {
    interflect::command::serve_first_rank();
    return interflect::command::done;
} catch (const std::exception& e) {
    interflect::command::end_ranks_after_fault(e, interflect::command::failed);
    return interflect::command::failed;
}

/// Returns freed large arrays to the system. By default glibc keeps them after the first such free, and fragmentation
/// then determines the memory in use.
void return_large_arrays() {
    constexpr int large = 4 << 20;  // [bytes]
    mallopt(M_MMAP_THRESHOLD, large);
}

}  // namespace

int main(int argc, char** argv) try {
    using namespace interflect::command;
    open_missing_standard_streams();
    handle_signals();
    return_large_arrays();
    interflect::command::log_to_stderr();
    switch (connect_ranks()) {
        case Role::other:
            return serve();
        case Role::refused:
            return failed;
        case Role::first:
            break;
    }
    const Dismissal at_the_end;
    return run(argc, argv);
} catch (const interflect::InputError& e) {
    spdlog::error("{}", interflect::command::explanation(e));
    return interflect::command::bad_input;
} catch (const std::exception& e) {
    spdlog::error("{}", interflect::command::explanation(e));
    return interflect::command::failed;
}
