#include <fmt/format.h>

#include <cmath>
#include <map>
#include <optional>

#include "argument.h"
#include "bindings.h"
#include "interflect/base/files/pending_file.h"
#include "long_work.h"
#include "settings.h"

namespace interflect::python {

namespace {

/// Arrays with one row per element, including inner elements.
struct Elements {
    SharedLight light;
};

template <class Number, class Member>
auto leaf_column(Member Leaf::*member, py::ssize_t columns = 0) {
    return
        [member, columns](const SharedLight& light) { return column<Number>(light, light->mesh(), member, columns); };
}

py::array vertices_of(const SharedLight& light) {
    static const Leaf nothing{};
    const std::vector<Leaf>& mesh = light->mesh();
    const Leaf& first = mesh.empty() ? nothing : mesh.front();
    return read_only(light, &first.vertices[0].x, {static_cast<py::ssize_t>(mesh.size()), 4, 3},
                     {sizeof(Leaf), sizeof(Imath::V3d), sizeof(double)});
}

py::array_t<float> total_error(const SharedLight& light) {
    const std::vector<Leaf>& mesh = light->mesh();
    py::array_t<float> result(static_cast<py::ssize_t>(mesh.size()));
    for (std::size_t i = 0; i < mesh.size(); ++i)
        result.mutable_at(static_cast<py::ssize_t>(i)) =
            std::hypot(mesh[i].standard_error, mesh[i].discretisation_error);
    return result;
}

template <class T>
auto element_array(std::vector<T> Solution::*member) {
    return [member](const Elements& elements) -> py::object {
        const std::vector<T>& values = (*elements.light->solution).*member;
        if (values.empty()) return py::none();
        return rows<float>(elements.light, values);
    };
}

auto element_arrays(std::vector<std::vector<Rgb>> Solution::*member) {
    return [member](const Elements& elements) {
        py::list arrays;
        for (const std::vector<Rgb>& values : (*elements.light->solution).*member)
            arrays.append(rows<float>(elements.light, values));
        return arrays;
    };
}

py::list iterations_of(const Light& light) {
    py::list result;
    for (const IterationReport& r : light.solution->iterations) {
        py::dict values;
        values["iteration"] = r.iteration;
        values["seconds"] = r.seconds;
        values["rays"] = r.rays;
        values["power_rays"] = r.power_rays;
        values["importance_rays"] = r.importance_rays;
        values["escaped_rays"] = r.escaped_rays;
        values["elements"] = r.elements;
        values["leaves"] = r.leaves;
        values["total_power"] = luminance(r.total_power);
        values["escaped_power"] = luminance(r.escaped_power);
        values["error_estimate"] = r.error_estimate;
        values["noise_estimate"] = r.noise_estimate;
        values["discretisation_estimate"] = r.discretisation_estimate;
        values["largest_payload"] = r.largest_payload;
        values["high_payload"] = r.high_payload;
        result.append(values);
    }
    return result;
}

/// @param group  Name of a group; or, without `factor`, the factors by name.
SharedLight dimmed_light(const Light& light, const py::object& group, const std::optional<float>& factor) {
    if (py::isinstance<py::dict>(group) == factor.has_value())
        throw py::type_error("dim: expected the name of a group and a factor, or a dict of factors by name");
    const auto factors = factor ? std::map<std::string, float>{{argument<std::string>(group, "group"), *factor}}
                                : argument<std::map<std::string, float>>(group, "dim");
    auto scene = std::make_shared<Scene>(*light.scene);
    auto solution = std::make_shared<Solution>(*light.solution);
    for (const auto& [name, scale] : factors) dim(*scene, *solution, name, scale);
    return std::make_shared<Light>(std::move(scene), std::move(solution), light.ray_caster);
}

void save(const Light& light, const std::filesystem::path& path) {
    long_work(py::none(), 0, [&](const Monitor&) {
        detail::PendingFile file(path);
        file.write_by([&](const auto& temporary) { write_solution(temporary, *light.scene, *light.solution); });
        file.commit();
        return true;
    });
}

SharedLight open_light(const std::filesystem::path& path) {
    return pure_work(0, [&] {
        SolvedScene solved = read_solution(path);
        auto scene = std::make_shared<const Scene>(std::move(solved.scene));
        auto ray_caster = std::make_shared<const RayCaster>(*scene);
        return std::make_shared<Light>(std::move(scene), std::make_shared<const Solution>(std::move(solved.solution)),
                                       std::move(ray_caster));
    });
}

double error_of(const Light& light) {
    const auto& iterations = light.solution->iterations;
    return iterations.empty() ? std::numeric_limits<double>::infinity() : iterations.back().error_estimate;
}

std::string describe_light(const Light& light) {
    const auto& iterations = light.solution->iterations;
    return fmt::format("<Solution of '{}': {} leaves, {} rays, error {:.3g}>", light.scene->name,
                       iterations.empty() ? light.scene->patches.size() : iterations.back().leaves,
                       iterations.empty() ? 0 : iterations.back().rays, error_of(light));
}

void bind_elements(py::module_& m) {
    py::class_<Elements>(m, "Elements",
                         "Arrays with one row per element of the quadtrees, read-only, without copies; inner elements "
                         "hold the mean of their children. Solution.element selects the leaves.")
        .def_property_readonly("irradiance", element_array(&Solution::irradiance),
                               array_text("(n, 3) float32", docs::Solution_irradiance).c_str())
        .def_property_readonly("unreduced_irradiance", element_array(&Solution::unreduced_irradiance),
                               "(n, 3) float32: irradiance before noise reduction, for hybrid shading and final "
                               "gathering [as H]. Without a difference from `irradiance`: None.")
        .def_property_readonly(
            "groups", element_arrays(&Solution::groups),
            "List of (n, 3) float32: parts of `irradiance`, one per name of Solution.group_names, whose "
            "sum it is. Empty without light groups.")
        .def_property_readonly(
            "direct", element_arrays(&Solution::direct),
            "List of (n, 3) float32: parts of `irradiance` that come straight from sources, one per light "
            "group, or one without groups. Empty without the setting keep_direct.")
        .def_property_readonly("view_importance", element_array(&Solution::view_importance),
                               "(n,) float32: importance directly from the views, v [1/m^2]. None without a view.")
        .def_property_readonly("indirect_importance", element_array(&Solution::indirect_importance),
                               "(n,) float32: the rest of importance, psi - v [1/m^2]. None without a view.")
        .def_property_readonly("standard_error", element_array(&Solution::standard_error),
                               array_text("(n,) float32", docs::Solution_standard_error).c_str())
        .def_property_readonly("discretisation_error", element_array(&Solution::discretisation_error),
                               array_text("(n,) float32", docs::Solution_discretisation_error).c_str())
        .def_property_readonly("rays", element_array(&Solution::rays),
                               array_text("(n,) float32", docs::Solution_rays).c_str())
        .def("__repr__", [](const Elements& e) {
            return fmt::format("<Elements: {} of '{}'>", e.light->solution->irradiance.size(), e.light->scene->name);
        });
}

void bind_leaks(py::module_& m) {
    py::class_<Escapes>(m, "Escapes", docs::Escapes)
        .def_readonly("rays", &Escapes::rays, docs::Escapes_rays)
        .def_readonly("escaped", &Escapes::escaped, docs::Escapes_escaped)
        .def_readonly("through_gaps", &Escapes::through_gaps, docs::Escapes_through_gaps)
        .def_property_readonly("share", &Escapes::share, docs::Escapes_share.text)
        .def_property_readonly("is_leak", &Escapes::is_leak, docs::Escapes_is_leak.text)
        .def("__repr__", [](const Escapes& e) {
            return fmt::format("<Escapes: {} of {} rays, {} through gaps>", e.escaped, e.rays, e.through_gaps);
        });
    py::class_<OneWayLight>(m, "OneWayLight", docs::OneWayLight)
        .def_readonly("share", &OneWayLight::share, docs::OneWayLight_share)
        .def_readonly("reflected_share", &OneWayLight::reflected_share, docs::OneWayLight_reflected_share)
        .def_readonly("object", &OneWayLight::object, docs::OneWayLight_object)
        .def_readonly("material", &OneWayLight::material, docs::OneWayLight_material)
        .def("__repr__", [](const OneWayLight& l) {
            return fmt::format("<OneWayLight: {:.3g}, reflected {:.3g}>", l.share, l.reflected_share);
        });
}

}  // namespace

void bind_solution(py::module_& m) {
    bind_elements(m);
    py::class_<PowerBalance>(m, "PowerBalance", docs::PowerBalance)
        .def_readonly("emitted", &PowerBalance::emitted, docs::PowerBalance_emitted)
        .def_readonly("absorbed", &PowerBalance::absorbed, docs::PowerBalance_absorbed)
        .def_readonly("escaped", &PowerBalance::escaped, docs::PowerBalance_escaped)
        .def_property_readonly("relative_difference", &PowerBalance::relative_difference,
                               docs::PowerBalance_relative_difference.text)
        .def("__repr__", [](const PowerBalance& b) {
            return fmt::format("<PowerBalance: emitted {:.4g}, absorbed {:.4g}, escaped {:.4g}>", luminance(b.emitted),
                               luminance(b.absorbed), luminance(b.escaped));
        });
    bind_leaks(m);
    py::class_<Light, SharedLight>(
        m, "Solution",
        "Light of a scene. Its arrays have one row per leaf of the mesh, a patch or a piece of one. They are read-only "
        "views of one array of structures, which the first request makes (152 bytes a leaf); they stay valid when the "
        "solver and this object are gone.")
        .def_property_readonly("irradiance", leaf_column<float>(&Leaf::irradiance, 3),
                               array_text("(n, 3) float32", docs::Leaf_irradiance).c_str())
        .def_property_readonly("direct", leaf_column<float>(&Leaf::direct, 3),
                               array_text("(n, 3) float32", docs::Leaf_direct).c_str())
        .def_property_readonly("importance", leaf_column<float>(&Leaf::importance),
                               array_text("(n,) float32", docs::Leaf_importance).c_str())
        .def_property_readonly("standard_error", leaf_column<float>(&Leaf::standard_error),
                               array_text("(n,) float32", docs::Solution_standard_error).c_str())
        .def_property_readonly("discretisation_error", leaf_column<float>(&Leaf::discretisation_error),
                               array_text("(n,) float32", docs::Solution_discretisation_error).c_str())
        .def_property_readonly("error", &total_error,
                               "(n,) float32: root of the sum of the squares of `standard_error` and "
                               "`discretisation_error`, computed on request.")
        .def_property_readonly("level", leaf_column<std::int32_t>(&Leaf::level),
                               array_text("(n,) int32", docs::Leaf_level).c_str())
        .def_property_readonly("area", leaf_column<float>(&Leaf::area),
                               array_text("(n,) float32", docs::Leaf_area).c_str())
        .def_property_readonly("patch", leaf_column<std::uint32_t>(&Leaf::patch),
                               "(n,) uint32: the patch of the leaf, an index into Scene.faces of `scene`.")
        .def_property_readonly("element", leaf_column<std::uint32_t>(&Leaf::element),
                               "(n,) uint32: the element of the leaf, an index into the arrays of `elements`.")
        .def_property_readonly("vertices", &vertices_of,
                               "(n, 4, 3) float64: world coordinates [m], counter-clockwise seen from the lit side. A "
                               "triangle repeats the last.")
        .def_property_readonly("vertex_count", leaf_column<std::int32_t>(&Leaf::vertex_count),
                               array_text("(n,) int32", docs::Leaf_vertex_count).c_str())
        .def_property_readonly(
            "elements", [](const SharedLight& light) { return Elements{light}; },
            "Arrays of all elements, inner ones included.")
        .def_property_readonly(
            "scene", [](const Light& light) { return without_const(light.scene); },
            "The scene as it was solved: faces are cut where others meet them.")
        .def_property_readonly(
            "views", [](const Light& light) { return light.solution->options.views; }, "Views that defined importance.")
        .def_property_readonly(
            "options", [](const Light& light) { return settings_of(light.solution->options); },
            "Settings by name: a dict.")
        .def_property_readonly("iterations", &iterations_of,
                               "List of a dict per iteration, with counts since the start, and powers weighted to one "
                               "number as luminance is [lm or W]. "
                               "pandas.DataFrame takes the list.")
        .def_property_readonly(
            "group_names", [](const Light& light) { return light.solution->group_names; }, docs::SourceGroups_names)
        .def_property_readonly(
            "emitted_power", [](const Light& light) { return light.solution->emitted_power; },
            docs::Solution_emitted_power)
        .def_property_readonly(
            "non_finite", [](const Light& light) { return light.solution->non_finite; }, docs::Solution_non_finite)
        .def_property_readonly(
            "is_interrupted", [](const Light& light) { return light.solution->interrupted; },
            docs::Solution_interrupted)
        .def_property_readonly("relative_error", &error_of, docs::IterationReport_error_estimate)
        .def(
            "power_balance", [](const Light& light) { return power_balance(*light.scene, *light.solution); },
            Documented(docs::power_balance))
        .def(
            "find_escapes",
            [](const Light& light) {
                return pure_work(0, [&] { return find_escapes(*light.scene, *light.ray_caster, *light.solution); });
            },
            Documented(docs::find_escapes).raises(""))
        .def(
            "find_one_way_light",
            [](const Light& light) {
                return pure_work(0,
                                 [&] { return find_one_way_light(*light.scene, *light.ray_caster, *light.solution); });
            },
            Documented(docs::find_one_way_light).raises(""))
        .def(
            "dim", &dimmed_light, py::arg("group"), py::arg("factor") = py::none(),
            Documented("Copies the solution, with the sources of light groups and all of their light scaled, without "
                       "tracing rays.",
                       {{"group", "Name of a light group, or a dict of factors by name."},
                        {"factor", "Relative to the current emission; >= 0. None for a dict."}})
                .raises("InputError: for an unknown group, with the names of all; for a factor that is negative or not "
                        "finite."))
        .def("save", &save, py::arg("path"), Documented(docs::write_solution))
        .def_static("open", &open_light, py::arg("path"), Documented(docs::read_solution))
        .def("__len__", [](const Light& light) { return light.mesh().size(); })
        .def("__copy__", [](const SharedLight& light) { return light; })  // it does not change
        .def("__deepcopy__", [](const SharedLight& light, const py::dict&) { return light; })
        .def("__repr__", &describe_light);
}

}  // namespace interflect::python
