#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "interflect/core.h"
#include "interflect/solve_options.h"
#include "interflect/solver/iteration/iteration_method.h"

namespace interflect {

namespace detail {

std::unique_ptr<IterationMethod> make_ray_radiosity(SolverState& state);
std::unique_ptr<IterationMethod> make_well_distributed_rays(SolverState& state);
std::unique_ptr<IterationMethod> make_kept_rays(SolverState& state);
std::unique_ptr<IterationMethod> make_random_walks(SolverState& state);
std::unique_ptr<IterationMethod> make_photon_mesh(SolverState& state);
std::unique_ptr<IterationMethod> make_linked_elements(SolverState& state);
std::unique_ptr<IterationMethod> make_global_lines(SolverState& state);
std::unique_ptr<IterationMethod> make_progressive_refinement(SolverState& state);

}  // namespace detail

using namespace detail;

namespace {

constexpr const char* equal_power = "it keeps every ray, which needs rays of equal power";
// Memory of a ray: 17 bytes, up to three times while the arrays grow, and more for rays that have crossed panes.
constexpr std::size_t bytes_of_kept_ray = 60;
constexpr const char* counted_particles = "it counts particles, which need equal power";
constexpr const char* uniform_lines = "its lines are spread evenly, whatever they meet";

using Make = std::unique_ptr<IterationMethod>(SolverState& state);

struct Row {
    Method method;
    Make* make;
};

constexpr std::array rows = {
    Row{{.name = "srr",
         .source = "Neumann et al. 1995",
         .separates_groups = true,
         .separates_direct = true,
         .shares_rays = true,
         .follows_dimming = true},
        make_ray_radiosity},
    Row{{.name = "isrr",
         .source = "Neumann et al. 1996",
         .importance = ImportanceUse::full,
         .separates_groups = true,
         .separates_direct = true,
         .shares_rays = true,
         .follows_dimming = true},
        make_ray_radiosity},
    Row{{.name = "wdrs",
         .source = "Neumann, Neumann and Bekaert 1997",
         .no_importance = equal_power,
         .separates_groups = true,
         .shares_rays = true},
        make_well_distributed_rays},
    Row{{.name = "hwdrs",
         .source = "Bekaert et al. 1998",
         .refines = true,
         .no_importance = equal_power,
         .separates_groups = true,
         .shares_rays = true},
        make_well_distributed_rays},
    Row{{.name = "hsrr",
         .source = "srr on the hierarchy of Bekaert et al. 1998",
         .refines = true,
         .follows_variance = true,
         .separates_groups = true,
         .separates_direct = true,
         .shares_rays = true,
         .follows_dimming = true},
        make_ray_radiosity},
    Row{{.name = "ihsrr",
         .source = "Prikryl et al. 2000",
         .refines = true,
         .follows_variance = true,
         .importance = ImportanceUse::full,
         .separates_groups = true,
         .separates_direct = true,
         .shares_rays = true,
         .follows_dimming = true},
        make_ray_radiosity},
    Row{{.name = "iwdrs",
         .source = "wdrs with the importance of Prikryl et al. 2000",
         .importance = ImportanceUse::full,
         .bytes_per_ray = bytes_of_kept_ray},
        make_kept_rays},
    Row{{.name = "ihwdrs",
         .source = "hwdrs with the importance of Prikryl et al. 2000",
         .refines = true,
         .follows_variance = true,
         .importance = ImportanceUse::full,
         .bytes_per_ray = bytes_of_kept_ray},
        make_kept_rays},
    Row{{.name = "random-walk", .source = "Pattanaik and Mudur 1992, 1995"}, make_random_walks},
    Row{{.name = "photon-mesh",
         .source = "Heckbert 1990, Tobler et al. 1997",
         .refines = true,
         .follows_variance = true,
         .no_importance = counted_particles},
        make_photon_mesh},
    Row{{.name = "hr",
         .source = "Hanrahan et al. 1991, Smits et al. 1992",
         .refines = true,
         .is_stochastic = false,
         .takes_luminaires = false},
        make_linked_elements},
    Row{{.name = "global-lines",
         .source = "Sbert 1993, 1997",
         .no_importance = uniform_lines,
         .takes_luminaires = false},
        make_global_lines},
    Row{{.name = "pr",
         .source = "Cohen et al. 1988, Bekaert and Willems 1994, 1995",
         .importance = ImportanceUse::full},
        make_progressive_refinement},
};

constexpr auto method_table = [] {
    std::array<Method, rows.size()> table{};
    for (std::size_t i = 0; i < rows.size(); ++i) table[i] = rows[i].method;
    return table;
}();

}  // namespace

constinit const std::span<const Method> methods = method_table;

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

Limits GivenLimits::limits() const {
    const Limits endless;
    return {rays.value_or(endless.rays), time.value_or(endless.time), until.value_or(endless.until)};
}

SolveOptions resolved(const GivenSettings& given) {
    SolveOptions options = given.others;
    options.method = given.method ? *given.method : default_method(!options.views.empty());
    options.method.importance = given.importance.value_or(options.method.importance);
    options.limits = given.limits.any() ? given.limits.limits() : SolveOptions().limits;
    SolveOptions preset;
    preset.limits = options.limits;
    if (given.is_published) use_published_algorithm(preset);
    options.experimental.rays_per_iteration = given.rays_per_iteration.value_or(preset.experimental.rays_per_iteration);
    return options;
}

namespace detail {

std::unique_ptr<IterationMethod> make_iteration_method(SolverState& state) {
    const std::string_view name = find_method(state.light.options().method.name).name;
    return std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.method.name == name; })->make(state);
}

}  // namespace detail

}  // namespace interflect
