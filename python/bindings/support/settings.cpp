#include "settings.h"

#include <cmath>

#include "argument.h"
#include "bindings.h"
#include "interflect/exports/records/solve_report.h"

namespace interflect::python {

using detail::Json;

namespace {

py::object python_of(const Json& json) {
    if (json.is_boolean()) return py::bool_(json.get<bool>());
    if (json.is_number_integer()) return py::int_(json.get<std::int64_t>());
    if (json.is_number()) return py::float_(json.get<double>());
    if (json.is_string()) return py::str(json.get<std::string>());
    return py::none();
}

/// Converts the value of a setting. @param usual  Default, which has the type of the setting; null for a number.
Json setting(const std::string& name, const py::handle& value, const Json& usual) {
    const auto refuse = [&](const char* expected) {
        throw py::type_error(name + ": expected " + expected + ", found " + found(value));
    };
    if (usual.is_boolean()) {
        if (!py::isinstance<py::bool_>(value)) refuse("True or False");
        return py::cast<bool>(value);
    }
    if (usual.is_string()) {
        if (!py::isinstance<py::str>(value)) refuse("a word");
        return argument<std::string>(value, name, "a word");
    }
    if (name == "rays" || usual.is_number_integer()) return whole_number(value, name);
    if (py::isinstance<py::bool_>(value)) refuse("a number");
    return argument<double>(value, name, "a number");
}

/// Returns text such as ", rays, time, ...".
std::string names_of(const Json& settings) {
    std::string names;
    for (const auto& [name, value] : settings.items())
        if (name != "views") names += ", " + name;
    return names;
}

WeightedView weighted_view(const Scene& scene, const py::handle& view) {
    if (py::isinstance<WeightedView>(view)) return py::cast<WeightedView>(view);
    return {view_of(scene, py::reinterpret_borrow<py::object>(view))};
}

}  // namespace

std::int64_t whole_number(const py::handle& value, const std::string& name) {
    const bool is_number = !py::isinstance<py::bool_>(value) && PyNumber_Check(value.ptr()) != 0;
    const double number = is_number ? PyFloat_AsDouble(value.ptr()) : 0;
    if (!is_number || PyErr_Occurred()) {
        PyErr_Clear();
        throw py::type_error(name + ": expected a whole number, found " + found(value));
    }
    if (!(std::abs(number) < 0x1p63) || number != std::floor(number))
        throw InputError(name + ": expected a whole number, found " + found(value));
    return py::isinstance<py::int_>(value) ? py::cast<std::int64_t>(value) : static_cast<std::int64_t>(number);
}

std::vector<WeightedView> weighted_views(const Scene& scene, const py::object& views) {
    if (views.is_none()) return {};
    if (py::isinstance<View>(views) || py::isinstance<WeightedView>(views) || py::isinstance<py::str>(views))
        return {weighted_view(scene, views)};
    if (!py::isinstance<py::iterable>(views))
        throw py::type_error("views: expected views or names of views, found " + found(views));
    std::vector<WeightedView> result;
    for (const py::handle& view : views) {
        if (view.is_none()) throw py::type_error("views: expected views or names of views, found None");
        result.push_back(weighted_view(scene, view));
    }
    return result;
}

Limits limits_of(const py::object& rays, const py::object& time, const py::object& until) {
    GivenLimits given;
    if (!rays.is_none()) given.rays = whole_number(rays, "rays");
    if (!time.is_none()) given.time = setting("time", time, nullptr).get<double>();
    if (!until.is_none()) given.until = setting("until", until, nullptr).get<double>();
    const Limits limits = given.limits();
    if (limits.rays <= 0) throw InputError("rays: expected more than 0");
    if (!(limits.time > 0)) throw InputError("time: expected more than 0");
    if (!(limits.until >= 0 && limits.until < 1))
        throw InputError("until: expected a relative error from 0 to below 1");
    return limits;
}

SolveOptions solve_options(const Scene& scene, const py::object& method, const py::object& views,
                           const py::dict& settings) {
    GivenSettings given;
    SolveOptions& options = given.others;
    options.views = weighted_views(scene, views);
    if (!method.is_none()) given.method = find_method(argument<std::string>(method, "method"));
    if (settings.contains("preset")) {
        if (!py::str("paper").equal(settings["preset"])) throw InputError("preset: expected 'paper'");
        use_published_algorithm(options);
        given.is_published = true;
    }
    Json json = detail::json_of(options);
    for (const auto& [key, value] : settings) {
        const auto name = argument<std::string>(key, "settings");
        if (name == "preset") continue;
        if (name == "seed") {
            options.seed = static_cast<std::uint64_t>(whole_number(value, name));
        } else if (name == "max_elements") {
            options.refinement.max_elements = static_cast<std::size_t>(whole_number(value, name));
        } else {
            if (!json.contains(name) || name == "views")
                throw py::type_error("unknown setting '" + name + "'; known: seed, max_elements, preset" +
                                     names_of(json));
            json[name] = setting(name, value, json[name]);
        }
    }
    json["views"] = Json::array();  // not to be read, because `options` has them in full precision
    detail::read_options(json, options, true);
    if (settings.contains("importance")) given.importance = options.method.importance;
    if (settings.contains("rays")) given.limits.rays = options.limits.rays;
    if (settings.contains("time")) given.limits.time = options.limits.time;
    if (settings.contains("until")) given.limits.until = options.limits.until;
    if (settings.contains("rays_per_iteration")) given.rays_per_iteration = options.experimental.rays_per_iteration;
    return resolved(given);
}

py::dict settings_of(const SolveOptions& options) {
    py::dict settings;
    settings["method"] = options.method.name;
    settings["seed"] = options.seed;
    const Json json = detail::json_of(options);
    for (const auto& [name, value] : json.items())
        if (name != "views") settings[py::str(name)] = python_of(value);
    settings["max_elements"] = options.refinement.max_elements;
    return settings;
}

}  // namespace interflect::python
