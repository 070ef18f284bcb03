#include "interflect/solve.h"

#include <memory>
#include <utility>

#include "interflect/error.h"
#include "interflect/solver.h"

namespace interflect {

const Method& find_method(const std::string& name) {
    std::string known;
    for (const Method& method : methods) {
        if (name == method.name) return method;
        known += (known.empty() ? "" : ", ") + std::string(method.name);
    }
    throw InputError("there is no method '" + name + "'; there are: " + known);
}

const Method& default_method(bool has_views) { return find_method(has_views ? "ihsrr" : "hsrr"); }

Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options, const Monitor& monitor) {
    // Non-owning, because the arguments outlive the solver.
    const std::shared_ptr<const Scene> shared_scene(std::shared_ptr<void>(), &scene);
    const std::shared_ptr<const RayCaster> shared_caster(std::shared_ptr<void>(), &ray_caster);
    Solver solver(shared_scene, shared_caster, options);
    solver.advance({}, monitor);
    return std::move(solver).take_solution();
}

}  // namespace interflect
