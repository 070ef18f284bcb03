#include "interflect/view_factors.h"

#include <fmt/format.h>

#include "bindings.h"
#include "long_work.h"

namespace interflect::python {

namespace {

using SharedFactors = std::shared_ptr<ViewFactors>;

FaceSides sides_of(const std::string& name) {
    if (name == "both") return FaceSides::both;
    if (name == "front") return FaceSides::front;
    if (name == "back") return FaceSides::back;
    throw InputError(fmt::format("sides: expected both, front or back, found '{}'", name));
}

/// Indices of patches of a group: integers, or one boolean per patch.
std::vector<std::uint32_t> patches_of(const py::handle& value, const std::string& name, std::size_t patches) {
    const py::array array = py::array::ensure(value);
    const char kind = array ? array.dtype().kind() : 'x';
    if (!array || array.ndim() != 1 || (kind != 'i' && kind != 'u' && kind != 'b') ||
        (kind == 'b' && array.shape(0) != static_cast<py::ssize_t>(patches))) {
        PyErr_Clear();
        throw InputError(fmt::format("groups: '{}': expected indices of faces, or {} booleans", name, patches))
            .set_object(name);
    }
    const py::array chosen = kind == 'b' ? py::array(array.attr("nonzero")().cast<py::tuple>()[0]) : array;
    std::vector<std::uint32_t> result;
    for (const py::handle& index : chosen) {
        const auto i = py::cast<std::int64_t>(index);
        if (i < 0 || i >= static_cast<std::int64_t>(patches))
            throw InputError(fmt::format("groups: '{}': there is no face {}; there are {}", name, i, patches))
                .set_object(name);
        result.push_back(static_cast<std::uint32_t>(i));
    }
    return result;
}

/// @param groups  "objects", "materials", "facets", or a dict of patterns or of indices by name.
std::vector<FaceGroup> groups_of(const Scene& scene, const py::object& groups, FaceSides sides) {
    if (py::isinstance<py::str>(groups)) {
        const auto kind = py::cast<std::string>(groups);
        if (kind == "objects") return object_groups(scene, sides);
        if (kind == "materials") return material_groups(scene, sides);
        if (kind == "facets") return facet_groups(scene, sides);
    }
    if (!py::isinstance<py::dict>(groups))
        throw InputError(fmt::format(
            "groups: expected 'objects', 'materials', 'facets', or a dict of patterns or faces by name, found {}",
            std::string(py::repr(groups))));
    std::vector<FaceGroup> result;
    std::vector<FacePattern> patterns;
    for (const auto& [key, value] : py::cast<py::dict>(groups)) {
        const auto name = py::cast<std::string>(key);
        if (py::isinstance<py::str>(value))
            patterns.push_back({name, py::cast<std::string>(value)});
        else
            result.push_back({name, patches_of(value, name, scene.patches.size())});
    }
    if (patterns.empty()) return result;
    if (!result.empty()) throw InputError("groups: expected either patterns or faces for all groups");
    return pattern_groups(scene, patterns, sides);
}

/// Changes indices of patches to those of with_opaque_backs(), where each one-sided patch is followed by its back.
void move_to_opaque(std::vector<FaceGroup>& groups, const Scene& scene) {
    std::vector<std::uint32_t> moved;
    std::uint32_t next = 0;
    for (const Patch& patch : scene.patches) {
        moved.push_back(next);
        next += patch.other_side == none ? 2 : 1;
    }
    for (FaceGroup& group : groups)
        for (std::uint32_t& patch : group.patches) patch = moved[patch];
}

SharedFactors compute(const std::shared_ptr<Scene>& scene, const py::object& groups, std::int64_t rays,
                      const std::string& sides, bool opaque_backs, std::uint64_t seed, int threads,
                      const py::object& progress) {
    std::vector<FaceGroup> chosen = groups_of(*scene, groups, sides_of(sides));
    std::shared_ptr<const Scene> traced = scene;
    if (opaque_backs) {
        traced = std::make_shared<const Scene>(with_opaque_backs(*scene));
        move_to_opaque(chosen, *scene);
    }
    return long_work(progress, threads, [&](const Monitor& monitor) {
        const RayCaster ray_caster(*traced);
        return std::make_shared<ViewFactors>(
            view_factors(*traced, ray_caster, chosen, {.rays = rays, .seed = seed}, monitor));
    });
}

template <class Number>
auto array(std::vector<Number> ViewFactors::*member) {
    return [member](const SharedFactors& factors) { return rows<Number>(factors, (*factors).*member); };
}

void bind_consistency(py::module_& m) {
    py::class_<Deviation>(m, "Deviation", docs::Deviation)
        .def_readonly("largest", &Deviation::largest, "Largest deviation.")
        .def_readonly("rms", &Deviation::rms, "Root mean square.")
        .def_readonly("largest_in_errors", &Deviation::largest_in_errors, "Largest, in standard errors.")
        .def_readonly("rms_in_errors", &Deviation::rms_in_errors, "Root mean square, in standard errors.")
        .def("__repr__", [](const Deviation& d) {
            return fmt::format("<Deviation: largest {:.3g}, rms {:.3g}>", d.largest, d.rms);
        });
    py::class_<Consistency>(m, "Consistency", "How far view factors are from closure and reciprocity.")
        .def_readonly("closure", &Consistency::closure, docs::Consistency_closure)
        .def_readonly("reciprocity", &Consistency::reciprocity, docs::Consistency_reciprocity)
        .def("__repr__", [](const Consistency& c) {
            return fmt::format("<Consistency: closure within {:.3g}, reciprocity within {:.3g}>", c.closure.largest,
                               c.reciprocity.largest);
        });
    py::class_<Reconciliation>(m, "Reconciliation", "Result of ViewFactors.reconcile().")
        .def_readonly("before", &Reconciliation::before, "Consistency of the estimate.")
        .def_readonly("after", &Reconciliation::after, "Consistency of the fit.");
}

}  // namespace

void bind_view_factors(py::module_& m) {
    bind_consistency(m);
    py::class_<ViewFactors, SharedFactors>(m, "ViewFactors", docs::ViewFactors)
        .def_readonly("names", &ViewFactors::names, docs::ViewFactors_names)
        .def_property_readonly("areas", array(&ViewFactors::areas), docs::ViewFactors_areas)
        .def_property_readonly("row_offsets", array(&ViewFactors::row_offsets), docs::ViewFactors_row_offsets)
        .def_property_readonly("columns", array(&ViewFactors::columns), docs::ViewFactors_columns)
        .def_property_readonly("values", array(&ViewFactors::values), docs::ViewFactors_values)
        .def_property_readonly("errors", array(&ViewFactors::errors), docs::ViewFactors_errors)
        .def_property_readonly("sky", array(&ViewFactors::sky), docs::ViewFactors_sky)
        .def_property_readonly("sky_errors", array(&ViewFactors::sky_errors), docs::ViewFactors_sky)
        .def_property_readonly("ground", array(&ViewFactors::ground), docs::ViewFactors_sky)
        .def_property_readonly("ground_errors", array(&ViewFactors::ground_errors), docs::ViewFactors_sky)
        .def_property_readonly("blocked", array(&ViewFactors::blocked), docs::ViewFactors_blocked)
        .def_property_readonly("blocked_errors", array(&ViewFactors::blocked_errors), docs::ViewFactors_blocked)
        .def_readonly("rays_per_group", &ViewFactors::rays_per_group, "Number of rays of each group.")
        .def(
            "consistency", [](const SharedFactors& f) { return consistency(*f); }, docs::consistency)
        .def(
            "reconciled",
            [](const SharedFactors& f, bool closure, bool reciprocity, int threads, const py::object& progress) {
                return long_work(progress, threads, [&](const Monitor& monitor) {
                    auto fitted = std::make_shared<ViewFactors>(*f);
                    const Reconciliation report = reconcile(*fitted, {closure, reciprocity}, monitor);
                    return std::pair(fitted, report);
                });
            },
            py::arg("closure") = true, py::arg("reciprocity") = true, py::kw_only(), py::arg("threads") = 0,
            py::arg("progress") = py::none(), docs::reconcile)
        .def("__len__", &ViewFactors::size)
        .def("__repr__", [](const ViewFactors& f) {
            return fmt::format("<ViewFactors of {} groups, {} non-zero, {} rays each>", f.size(), f.values.size(),
                               f.rays_per_group);
        });
    m.def("view_factors", &compute, py::arg("scene"), py::arg("groups"), py::arg("rays"), py::arg("sides"),
          py::arg("opaque_backs"), py::arg("seed"), py::arg("threads"), py::arg("progress"), docs::view_factors);
}

}  // namespace interflect::python
