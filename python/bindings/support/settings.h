/// Settings of the solver from keyword arguments.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "interflect/solve_options.h"

namespace interflect::python {

/// @param method    Name of the method, or None for the default.
/// @param views     None, a View, WeightedView or name of a view of the scene, or a sequence of these.
/// @param settings  Names and values as on the command line, with underscores; also seed and preset="paper".
/// @throws InputError for unknown values; TypeError for unknown names and for wrong types.
SolveOptions solve_options(const Scene& scene, const pybind11::object& method, const pybind11::object& views,
                           const pybind11::dict& settings);

/// Inverse of solve_options(): returns all settings by name, with `method` and `seed`.
pybind11::dict settings_of(const SolveOptions& options);

/// Limits by name: rays, time [s], until; None: no limit. @throws InputError for one out of range.
Limits limits_of(const pybind11::object& rays, const pybind11::object& time, const pybind11::object& until);

std::vector<WeightedView> weighted_views(const Scene& scene, const pybind11::object& views);

/// Returns a whole number, which may be in floating point: 5e6. @throws TypeError naming the argument.
std::int64_t whole_number(const pybind11::handle& value, const std::string& name);

}  // namespace interflect::python
