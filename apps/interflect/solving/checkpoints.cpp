#include "apps/interflect/solving/checkpoints.h"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <utility>

#include "apps/interflect/console/messages.h"
#include "apps/interflect/values/parse.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/core.h"
#include "interflect/exports/saved_run.h"

namespace interflect::command {

using namespace detail;

namespace {

namespace fs = std::filesystem;

/// Keeps a checkpoint under a second name, so one complete checkpoint always exists.
void keep(const fs::path& file, const fs::path& previous) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return;
    fs::remove(previous, error);
    fs::create_hard_link(fs::canonical(file), previous, error);
    if (!error) return;
    PendingFile copy(previous);
    fs::copy_file(file, copy.temporary_path());
    copy.commit();
}

bool is_saved_run_of(const Scene& scene, const fs::path& file) {
    const fs::path name = scene_of_saved_run(file);
    return !name.empty() && name.lexically_normal() == fs::path(scene.name).lexically_normal();
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
    if (std::error_code unknown; fs::exists(file, unknown) && !fs::is_regular_file(file, unknown))
        throw UsageError("--checkpoint",
                         fmt::format("'{}' is not a regular file, which a checkpoint must be to be read "
                                     "again: expected another name",
                                     file.string()));
    const PendingFile writable(file);  // throws otherwise
}

fs::path Checkpoints::previous() const {
    return file.empty() ? file : fs::path(file).replace_extension(".previous.h5");
}

void Checkpoints::require_own_previous(const Scene& scene) {
    if (file.empty()) return;
    const auto is_other = [&](const fs::path& path) {
        std::error_code unknown;
        return fs::exists(fs::symlink_status(path, unknown)) && !is_saved_run_of(scene, path);
    };
    replaces_other_ = is_other(file);
    if (is_other(previous()))
        throw UsageError(
            "--checkpoint",
            fmt::format("'{}' is to keep the last checkpoint but one, but it exists and is no saved run of "
                        "{}: expected another name for the checkpoint, or move that file",
                        previous().string(), scene.name));
}

void Checkpoints::save(Solver& solver) {
    if (file.empty()) return;
    try {
        if (!std::exchange(replaces_other_, false)) keep(file, previous());
        solver.save(file);
    } catch (const std::bad_alloc&) {
        spdlog::warn("no checkpoint: not enough memory");
    } catch (const std::exception& e) {
        spdlog::warn("no checkpoint: {}", e.what());
    }
}

}  // namespace interflect::command
