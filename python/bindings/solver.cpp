#include <fmt/format.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <atomic>
#include <optional>

#include "bindings.h"
#include "fields.h"
#include "interflect/base/memory/machine_memory.h"
#include "interflect/prepare.h"
#include "interflect/solver.h"
#include "long_work.h"
#include "settings.h"

namespace interflect::python {

namespace {

/// A solver that can be closed, for one thread at a time.
class PythonSolver {
  public:
    PythonSolver(Solver solver, int threads) : solver_(std::move(solver)), threads_(threads) {}

    /// Reserves the solver for the duration of a call.
    class Use {
      public:
        explicit Use(PythonSolver& owner) : owner_(owner) {
            if (owner.is_used_.exchange(true))
                throw std::runtime_error("the solver is in use by another thread or by its progress function");
            if (owner.solver_) return;
            owner.is_used_ = false;
            throw std::runtime_error("the solver is closed");
        }
        ~Use() { owner_.is_used_ = false; }
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;
        Solver* operator->() const { return &*owner_.solver_; }
        Solver& operator*() const { return *owner_.solver_; }

      private:
        PythonSolver& owner_;
    };

    int threads() const { return threads_; }
    /// Returns the current solution, which is the same object until the solver changes.
    SharedLight light() {
        const Use solver(*this);
        const std::shared_ptr<const Solution> now =
            long_work(py::none(), threads_, [&](const Monitor&) { return solver->shared_solution(); });
        if (!light_ || light_->solution != now)
            light_ = std::make_shared<Light>(solver->shared_scene(), now, solver->shared_ray_caster());
        return light_;
    }
    /// Returns the current solution without a copy, and closes the solver.
    SharedLight take_light() {
        const Use solver(*this);
        const auto scene = solver->shared_scene();
        const auto ray_caster = solver->shared_ray_caster();
        auto solution = long_work(py::none(), threads_, [&](const Monitor&) {
            return std::make_shared<const Solution>(std::move(*solver).take_solution());
        });
        solver_.reset();
        light_.reset();
        return std::make_shared<Light>(scene, std::move(solution), ray_caster);
    }
    void close() {
        if (is_used_.exchange(true))
            throw std::runtime_error("the solver is in use by another thread or by its progress function");
        solver_.reset();
        light_.reset();
        is_used_ = false;
    }
    bool is_closed() const { return !solver_; }

  private:
    std::optional<Solver> solver_;
    int threads_;
    SharedLight light_;  // solution of the last request
    std::atomic<bool> is_used_{false};
};

using Use = PythonSolver::Use;

Scene prepared(const Scene& scene, bool contact_cuts, const std::optional<float>& mesh_size, bool refines) {
    Scene result = contact_cuts
                       ? cut_at_contacts(scene, {.min_extent = static_cast<float>(2 * default_element_size(scene))})
                       : scene;
    if (!mesh_size && refines) return result;
    return split_patches(result, mesh_size.value_or(default_mesh_size(result)), ReadOptions().max_patches);
}

/// Limits the elements, and the rays of methods that keep them, to the memory of the machine, as the command does.
SolveOptions within_memory(const Scene& scene, const RayCaster& ray_caster, SolveOptions options) {
    const MemoryNeed need = memory_need(scene, ray_caster, options);
    const std::size_t bytes = detail::usable_memory();
    options.refinement.max_elements = std::min(options.refinement.max_elements, elements_within(need, bytes, scene));
    if (options.method.bytes_per_ray > 0) {
        constexpr std::size_t share = 2;  // the other half is for elements
        const auto most = static_cast<std::int64_t>(bytes / share / options.method.bytes_per_ray);
        if (options.limits.rays == Limits().rays) options.limits.rays = most;
        if (options.limits.rays > most)
            throw InputError("rays: " + std::string(options.method.name) + " keeps every ray, expected at most " +
                             std::to_string(most) + "; the memory suffices for no more");
    }
    return options;
}

std::unique_ptr<PythonSolver> make_solver(const std::shared_ptr<Scene>& scene, const py::object& method,
                                          const py::object& views, int threads, bool contact_cuts,
                                          const std::optional<float>& mesh_size, const py::dict& settings) {
    const SolveOptions options = solve_options(*scene, method, views, settings);
    require_no_faults(scene_faults(*scene), "cannot solve", *scene);
    return pure_work(threads, [&] {
        const auto ready =
            std::make_shared<const Scene>(prepared(*scene, contact_cuts, mesh_size, options.method.refines));
        const auto ray_caster = std::make_shared<const RayCaster>(*ready);
        const SolveOptions limited = within_memory(*ready, *ray_caster, options);
        return std::make_unique<PythonSolver>(Solver(ready, limited, ray_caster), threads);
    });
}

AdvanceReport advance(PythonSolver& self, const py::object& rays, const py::object& time, const py::object& until,
                      const py::object& progress) {
    const Use solver(self);
    const Limits limits = limits_of(rays, time, until);
    return long_work(progress, self.threads(),
                     [&](const Monitor& monitor) { return solver->advance(limits, monitor); });
}

void save_run(PythonSolver& self, const std::filesystem::path& path) {
    const Use solver(self);
    long_work(py::none(), self.threads(), [&](const Monitor&) { return solver->save(path), true; });
}

std::unique_ptr<PythonSolver> open_run(const std::filesystem::path& path, int threads) {
    return pure_work(threads, [&] { return std::make_unique<PythonSolver>(Solver::open(path), threads); });
}

}  // namespace

void bind_solver(py::module_& m) {
    Fields<WeightedView>(m, "WeightedView", docs::WeightedView)
        .field("view", &WeightedView::view, "View.")
        .field("weight", &WeightedView::weight, docs::WeightedView_weight)
        .field("aspect", &WeightedView::aspect, docs::WeightedView_aspect)
        .field("pixel_rows", &WeightedView::pixel_rows, docs::WeightedView_pixel_rows)
        .finish();
    py::class_<Progress>(m, "Progress", docs::Progress)
        .def_readonly("rays", &Progress::rays, docs::Progress_rays)
        .def_readonly("fraction", &Progress::fraction, docs::Progress_fraction)
        .def_readonly("relative_error", &Progress::relative_error, docs::Progress_relative_error)
        .def("__repr__", [](const Progress& p) {
            return fmt::format("<Progress: {:.0f}%, {} rays, error {:.3g}>", 100 * p.fraction, p.rays,
                               p.relative_error);
        });
    py::class_<AdvanceReport>(m, "AdvanceReport", docs::AdvanceReport)
        .def_readonly("error", &AdvanceReport::error, docs::AdvanceReport_error)
        .def_readonly("rays", &AdvanceReport::rays, docs::AdvanceReport_rays)
        .def_readonly("seconds", &AdvanceReport::seconds, docs::AdvanceReport_seconds)
        .def_readonly("is_finished", &AdvanceReport::is_finished, docs::AdvanceReport_is_finished)
        .def("__repr__", [](const AdvanceReport& r) {
            return fmt::format("<AdvanceReport: {} rays, error {:.3g}, {}>", r.rays, r.error,
                               r.is_finished ? "finished" : "not finished");
        });
    py::class_<PythonSolver>(m, "Solver", docs::Solver)
        .def(py::init(&make_solver), py::arg("scene"), py::arg("method"), py::arg("views"), py::arg("threads"),
             py::arg("contact_cuts"), py::arg("mesh_size"), py::arg("settings"), Documented("For interflect.Solver."))
        .def("advance", &advance, py::arg("rays") = py::none(), py::arg("time") = py::none(),
             py::arg("until") = py::none(), py::arg("progress") = py::none(),
             Documented(docs::Solver_advance,
                        {{"rays", "Number of rays to add; None: no limit."},
                         {"time", "Duration of this call [s]; None: no limit."},
                         {"until", "Target of the estimated relative error, in [0, 1); None: none."}})
                 .raises("InputError: for a limit out of range.\n"
                         "KeyboardInterrupt: at Ctrl-C; an exception of `progress` likewise. Completed iterations are "
                         "kept, and the solver can continue."))
        .def(
            "set_views",
            [](PythonSolver& self, const py::object& views) {
                const Use solver(self);
                solver->set_views(weighted_views(solver->scene(), views));
            },
            py::arg("views"), Documented(docs::Solver_set_views, {{"views", "As of Solver."}}))
        .def(
            "set_dimming",
            [](PythonSolver& self, const std::string& group, float factor) { Use(self)->set_dimming(group, factor); },
            py::arg("group"), py::arg("factor"),
            Documented(docs::Solver_set_dimming,
                       {{"group", "Name of a light group."}, {"factor", "Relative to the original emission; >= 0."}}))
        .def(
            "set_plan",
            [](PythonSolver& self, const py::object& rays, const py::object& time, const py::object& until) {
                Use(self)->set_plan(limits_of(rays, time, until));
            },
            py::arg("rays") = py::none(), py::arg("time") = py::none(), py::arg("until") = py::none(),
            Documented(docs::Solver_set_plan, {{"rays", "Total number of rays; None: no limit."},
                                               {"time", "Time spent on solving [s]; None: no limit."},
                                               {"until", "Target of the estimated relative error, in [0, 1)."}}))
        .def_property_readonly("solution", &PythonSolver::light, docs::Solver_solution.text)
        .def("take_solution", &PythonSolver::take_light,
             Documented("Current solution without a copy. Closes the solver."))
        .def_property_readonly(
            "scene", [](PythonSolver& self) { return without_const(Use(self)->shared_scene()); },
            docs::Solver_scene.text)
        .def_property_readonly(
            "options", [](PythonSolver& self) { return settings_of(Use(self)->options()); }, "Settings by name.")
        .def_property_readonly(
            "views", [](PythonSolver& self) { return Use(self)->options().views; }, "Views that define importance.")
        .def("save", &save_run, py::arg("path"), Documented(docs::Solver_save))
        .def_static("open", &open_run, py::arg("path"), py::arg("threads") = 0, Documented(docs::Solver_open))
        .def("close", &PythonSolver::close,
             Documented("Frees the memory of the run. Solutions and their arrays stay valid; other calls raise Error."))
        .def_property_readonly("is_closed", &PythonSolver::is_closed, "Whether close() was called.");
}

}  // namespace interflect::python
