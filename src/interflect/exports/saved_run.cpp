// Solver::save() and open() are here because the solver is independent of file formats.

#include <fmt/format.h>

#include <stdexcept>

#include "interflect/base/pending_file.h"
#include "interflect/base/state_archive.h"
#include "interflect/core.h"
#include "interflect/exports/saved_run.h"
#include "interflect/solution.h"
#include "interflect/solver.h"
#include "interflect/solver/run.h"

namespace interflect {

using namespace detail;

namespace {

/// Archives options that depend on the machine.
void archive_options(StateArchive& archive, SolveOptions& options) {
    options.refinement.max_elements =
        archive.by_value("options/max_elements", std::vector{options.refinement.max_elements}).at(0);
}

}  // namespace

void Solver::save(const std::filesystem::path& path) const {
    PendingFile file(path);
    Solution result = solution();  // before the archive refers to the solver's data
    result.dimming = run_->state.solution.dimming;
    StateArchive state;
    SolveOptions saved = options();
    archive_options(state, saved);
    run_->archive(state);
    write_solution(file.temporary_path(), *run_->undimmed_scene, result, &state);
    file.commit();
}

Solver Solver::open(const std::filesystem::path& path) {
    auto [solved, state] = read_saved_run(path);
    try {
        archive_options(state, solved.solution.options);
        Solver solver(std::move(solved.scene), solved.solution.options);
        solver.run_->archive(state);
        return solver;
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(path, 0, fmt::format("a run that cannot go on: {}", e.what()));
    }
}

}  // namespace interflect
