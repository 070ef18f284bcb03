#include "apps/interflect/checkpoints.h"

#include <spdlog/spdlog.h>

#include "apps/interflect/messages.h"
#include "apps/interflect/parse.h"
#include "interflect/base/pending_file.h"
#include "interflect/core.h"

namespace interflect::command {

using namespace detail;

namespace {

/// Adds a second name, so one complete checkpoint always exists.
void keep_previous(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return;
    std::filesystem::path previous = file;
    previous.replace_extension(".previous.h5");
    std::filesystem::remove(previous, ignored);
    std::filesystem::create_hard_link(file, previous, ignored);
    if (ignored) std::filesystem::copy_file(file, previous, ignored);
}

}  // namespace

void Checkpoints::add_to(CLI::App& app, const std::string& what) {
    app.add_option("--checkpoint", file, what)->type_name("FILE")->group("Checkpoints");
    add_parsed(app, "--every", every, parse_duration, "How often to save it, such as 30s, 5m or 2h")
        ->type_name("TIME")
        ->default_str("60s")
        ->group("Checkpoints");
}

void Checkpoints::require_writable() const {
    if (file.empty()) return;
    if (file.extension() != ".h5")
        throw UsageError("--checkpoint",
                         fmt::format("a checkpoint is a solution file: expected a name that ends in .h5, found '{}'",
                                     file.string()));
    const PendingFile finds_out(file);
}

void Checkpoints::save(Solver& solver) const {
    if (file.empty()) return;
    try {
        keep_previous(file);
        solver.save(file);
    } catch (const std::bad_alloc&) {
        spdlog::warn("no checkpoint: there is not enough memory");
    } catch (const std::exception& e) {
        spdlog::warn("no checkpoint: {}", e.what());
    }
}

}  // namespace interflect::command
