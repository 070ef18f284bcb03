#include <array>

#include "interflect/solve.h"

namespace interflect::inline detail {

// Each is defined in the file of its method.
MakeIterationMethod make_ray_radiosity, make_well_distributed_rays, make_random_walks, make_linked_elements,
    make_global_lines, make_progressive_refinement;

}  // namespace interflect::inline detail

namespace interflect {

namespace {

constexpr const char* equal_power = "it keeps every ray, which needs rays of equal power";
constexpr const char* uniform_lines = "its lines are spread evenly, whatever they meet";

constexpr std::array method_table = {
    Method{.name = "srr",
           .source = "Neumann et al. 1995",
           .make = make_ray_radiosity,
           .separates_groups = true,
           .follows_dimming = true},
    Method{.name = "isrr",
           .source = "Neumann et al. 1996",
           .make = make_ray_radiosity,
           .importance = ImportanceUse::full,
           .separates_groups = true,
           .follows_dimming = true},
    Method{.name = "wdrs",
           .source = "Neumann, Neumann and Bekaert 1997",
           .make = make_well_distributed_rays,
           .no_importance = equal_power,
           .separates_groups = true},
    Method{.name = "hwdrs",
           .source = "Bekaert et al. 1998",
           .make = make_well_distributed_rays,
           .refines = true,
           .no_importance = equal_power,
           .separates_groups = true},
    Method{.name = "hsrr",
           .source = "srr on the hierarchy of Bekaert et al. 1998",
           .make = make_ray_radiosity,
           .refines = true,
           .follows_variance = true,
           .separates_groups = true,
           .follows_dimming = true},
    Method{.name = "ihsrr",
           .source = "Prikryl et al. 2000",
           .make = make_ray_radiosity,
           .refines = true,
           .follows_variance = true,
           .importance = ImportanceUse::full,
           .separates_groups = true,
           .follows_dimming = true},
    Method{.name = "random-walk", .source = "Pattanaik and Mudur 1992, 1995", .make = make_random_walks},
    Method{.name = "hr",
           .source = "Hanrahan et al. 1991, Smits et al. 1992",
           .make = make_linked_elements,
           .refines = true,
           .is_stochastic = false,
           .takes_luminaires = false},
    Method{.name = "global-lines",
           .source = "Sbert 1993, 1997",
           .make = make_global_lines,
           .no_importance = uniform_lines,
           .takes_luminaires = false},
    Method{.name = "pr",
           .source = "Cohen et al. 1988, Bekaert and Willems 1994, 1995",
           .make = make_progressive_refinement,
           .importance = ImportanceUse::full},
};

}  // namespace

constinit const std::span<const Method> methods = method_table;

}  // namespace interflect
