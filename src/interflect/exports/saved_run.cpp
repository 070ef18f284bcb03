// Solver::save() and open() are here because the solver is independent of file formats.

#include <fmt/format.h>

#include <stdexcept>

#include "interflect/base/files/pending_file.h"
#include "interflect/base/files/state_archive.h"
#include "interflect/core.h"
#include "interflect/elements/forest.h"
#include "interflect/exports/saved_run.h"
#include "interflect/solution.h"
#include "interflect/solver.h"
#include "interflect/solver/run.h"

namespace interflect {

using namespace detail;

namespace {

/// Archives the options whose default depends on the machine.
void archive_options(StateArchive& archive, SolveOptions& options) {
    options.refinement.max_elements =
        archive.by_value("options/max_elements", std::vector{options.refinement.max_elements}).at(0);
}

/// Calls write(scene, solution, state) with the undimmed scene and the state of the run.
template <class Write>
void write_run(Run& run, Solution result, SolveOptions options, const Write& write) {
    result.dimming = run.state.light.solution.dimming;
    StateArchive state;
    archive_options(state, options);
    run.archive(state);
    write(*run.undimmed_scene, result, state);
}

}  // namespace

Solution detail::dark_solution(const Scene& scene) {
    Solution dark;
    dark.options.method = default_method(/*has_views=*/false);  // a file must name a method
    dark.forest = std::make_shared<ElementForest>(scene, scene.patches.size());
    const std::size_t elements = dark.forest->size();
    dark.irradiance.assign(elements, Rgb(0));
    for (std::vector<float>* values : {&dark.standard_error, &dark.discretisation_error, &dark.rays})
        values->assign(elements, 0);
    return dark;
}

void Solver::save(const std::filesystem::path& path) const {
    PendingFile file(path);
    write_run(*run_, solution(), options(),
              [&](const Scene& scene, const Solution& solution, const StateArchive& state) {
                  file.write_by([&](const auto& temporary) { write_solution(temporary, scene, solution, &state); });
              });
    file.commit();
}

std::string Solver::image() const {
    std::string image;
    write_run(*run_, solution(), options(),
              [&](const Scene& scene, const Solution& solution, const StateArchive& state) {
                  image = solution_image(scene, solution, &state);
              });
    return image;
}

Solver Solver::open(const std::filesystem::path& path) {
    SavedRun saved = read_saved_run(path);
    try {
        return restored(std::move(saved));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(path, 0, fmt::format("a run that cannot go on: {}", e.what()));
    }
}

Solver Solver::open_image(std::span<const char> image) { return restored(read_saved_image(image)); }

Solver Solver::restored(SavedRun&& saved) {
    auto& [solved, state] = saved;
    archive_options(state, solved.solution.options);
    Solver solver(std::move(solved.scene), solved.solution.options);
    solver.run_->archive(state);
    return solver;
}

}  // namespace interflect
