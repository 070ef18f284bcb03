#include "interflect/solve.h"

#include <algorithm>
#include <limits>
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

void use_published_algorithm(SolveOptions& options) {
    options.refinement.criterion = RefinementCriterion::power;
    options.importance.smoothing = 0;
    options.importance.exponent = 1;
    ExperimentalOptions& o = options.experimental;
    o.one_bounce = true;
    o.warm_up = 10;
    o.iterations = 100;
    const bool is_finite = options.limits.rays < std::numeric_limits<std::int64_t>::max();
    o.rays_per_iteration = is_finite ? std::max<std::int64_t>(1, options.limits.rays / (o.warm_up + o.iterations)) : 0;
    o.shrinkage = false;
    o.epsilon_decay = 0;
    o.inherited_weight = 1;
}

Solution solve(const Scene& scene, const RayCaster& ray_caster, const SolveOptions& options, const Monitor& monitor) {
    // Non-owning, because the arguments outlive the solver.
    const std::shared_ptr<const Scene> shared_scene(std::shared_ptr<void>(), &scene);
    const std::shared_ptr<const RayCaster> shared_caster(std::shared_ptr<void>(), &ray_caster);
    Solver solver(shared_scene, shared_caster, options);
    solver.advance({}, monitor);
    return std::move(solver).take_solution();
}

}  // namespace interflect
