#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <exception>

#include "apps/interflect/commands.h"
#include "interflect/base/error.h"

int main(int argc, char** argv) {
    using namespace interflect::command;
    spdlog::set_default_logger(spdlog::stderr_color_st("interflect"));
    spdlog::set_pattern("%^%l%$: %v");

    CLI::App app("Interflect: diffuse global illumination that goes where the eye looks", "interflect");
    app.set_version_flag("--version", "interflect " INTERFLECT_VERSION);
    app.require_subcommand(1);
    int exit_code = done;
    add_info(app);
    add_solve(app, exit_code);
    add_render(app, exit_code);
    add_compare(app);
    add_bench(app);
    add_make_scene(app);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? done : wrong_usage;
    } catch (const interflect::InputError& e) {
        spdlog::error("{}", e.what());
        return bad_input;
    } catch (const std::exception& e) {
        spdlog::error("{}", e.what());
        return failed;
    }
    return exit_code;
}
