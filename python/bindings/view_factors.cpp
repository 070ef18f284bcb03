#include "interflect/view_factors.h"

#include <fmt/format.h>

#include <algorithm>

#include "argument.h"
#include "bindings.h"
#include "documented.h"
#include "interflect/base/files/pending_file.h"
#include "interflect/view_factors/write_npz.h"
#include "long_work.h"
#include "settings.h"

namespace interflect::python {

namespace {

using SharedFactors = std::shared_ptr<ViewFactors>;

FaceSides sides_of(const std::string& name) {
    if (name == "both") return FaceSides::both;
    if (name == "front") return FaceSides::front;
    if (name == "back") return FaceSides::back;
    throw InputError(fmt::format("sides: expected both, front or back, found '{}'", name));
}

/// Returns the indices of a group's patches. @param value  Integers, or one boolean per patch.
std::vector<PatchIndex> patches_of(const py::handle& value, const std::string& name, std::size_t patches) {
    const py::array array = py::array::ensure(value);
    const char kind = array ? array.dtype().kind() : 'x';
    if (!array || array.ndim() != 1 || (kind != 'i' && kind != 'u' && kind != 'b') ||
        (kind == 'b' && array.shape(0) != static_cast<py::ssize_t>(patches))) {
        PyErr_Clear();
        throw InputError(
            Fault{.text = fmt::format("groups: '{}': expected indices of faces, or {} booleans", name, patches),
                  .object = name,
                  .setting = "groups"});
    }
    const py::array chosen = kind == 'b' ? py::array(array.attr("nonzero")().cast<py::tuple>()[0]) : array;
    std::vector<PatchIndex> result;
    for (const py::handle& index : chosen) {
        const auto i = argument<std::int64_t>(index, "groups", "indices of faces");
        if (i < 0 || i >= static_cast<std::int64_t>(patches))
            throw InputError(
                Fault{.text = fmt::format("groups: '{}': face {} does not exist; expected below {}", name, i, patches),
                      .object = name,
                      .setting = "groups"});
        result.emplace_back(i);
    }
    return result;
}

/// @param groups  None, "objects", "materials", "facets", or a dict by name: patterns or indices.
std::vector<FaceGroup> groups_of(const Scene& scene, const py::object& groups, FaceSides sides) {
    if (groups.is_none()) return named_groups(scene, sides);
    if (py::isinstance<py::str>(groups)) {
        const auto kind = argument<std::string>(groups, "groups", "a str");
        if (kind == "objects") return object_groups(scene, sides);
        if (kind == "materials") return material_groups(scene, sides);
        if (kind == "facets") return facet_groups(scene, sides);
    }
    if (!py::isinstance<py::dict>(groups))
        throw InputError(fmt::format(
            "groups: expected 'objects', 'materials', 'facets', or a dict of patterns or faces by name, found {}",
            found(groups)));
    std::vector<FaceGroup> result;
    std::vector<FacePattern> patterns;
    for (const auto& [key, value] : py::cast<py::dict>(groups)) {
        const auto name = argument<std::string>(key, "groups", "names of groups that are str");
        if (py::isinstance<py::str>(value))
            patterns.push_back({name, argument<std::string>(value, "groups", "a pattern that is a str")});
        else
            result.push_back({name, patches_of(value, name, scene.patches.size())});
    }
    if (patterns.empty()) return result;
    if (!result.empty()) throw InputError("groups: expected either patterns or faces for all groups");
    return pattern_groups(scene, patterns, sides);
}

SharedFactors compute(const std::shared_ptr<Scene>& scene, const py::object& groups, const py::object& rays,
                      const std::string& sides, bool opaque_backs, std::uint64_t seed, int threads,
                      const py::object& progress) {
    const std::vector<FaceGroup> chosen = groups_of(*scene, groups, sides_of(sides));
    const ViewFactorOptions options{.rays = whole_number(rays, "rays"), .seed = seed};
    const auto work = [&](const Monitor& monitor) {
        return std::make_shared<ViewFactors>(opaque_backs
                                                 ? view_factors(*scene, chosen, options, monitor)
                                                 : view_factors(*scene, RayCaster(*scene), chosen, options, monitor));
    };
    return long_work(progress, threads, work, Ending::cancelled);
}

template <class Number>
auto array(std::vector<Number> ViewFactors::*member) {
    return [member](const SharedFactors& factors) { return rows<Number>(factors, (*factors).*member); };
}

/// Calls use(i, j, entry) for each entry of the rows.
template <class Use>
void for_each_entry(const ViewFactors& f, const Use& use) {
    for (std::size_t i = 0; i < f.size(); ++i)
        for (std::int64_t e = f.row_offsets[i]; e < f.row_offsets[i + 1]; ++e)
            use(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(f.columns[static_cast<std::size_t>(e)]),
                static_cast<std::size_t>(e));
}

/// Returns an array (n, n), with `absent` in place of missing entries.
py::array_t<double> dense(const ViewFactors& f, const std::vector<float>& entries, double absent) {
    const auto n = static_cast<py::ssize_t>(f.size());
    py::array_t<double> result({n, n});
    std::fill_n(result.mutable_data(), result.size(), absent);
    for_each_entry(f, [&](py::ssize_t i, py::ssize_t j, std::size_t e) {
        result.mutable_at(i, j) = static_cast<double>(entries[e]);
    });
    return result;
}

/// Returns a matrix of SciPy that shares the entries and the columns.
py::object sparse(const SharedFactors& f, const std::vector<float>& entries) {
    const py::tuple arrays = py::make_tuple(rows<float>(f, entries), rows<std::int32_t>(f, f->columns),
                                            rows<std::int64_t>(f, f->row_offsets));
    return py::module_::import("scipy.sparse")
        .attr("csr_matrix")(arrays, py::arg("shape") = py::make_tuple(f->size(), f->size()), py::arg("copy") = false);
}

py::array_t<double> closures(const ViewFactors& f) {
    py::array_t<double> result(static_cast<py::ssize_t>(f.size()));
    for (std::size_t i = 0; i < f.size(); ++i) result.mutable_at(static_cast<py::ssize_t>(i)) = f.closure(i);
    return result;
}

void save_npz(const ViewFactors& f, const std::filesystem::path& path) {
    detail::PendingFile file(path);
    detail::write_npz(file, f);
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
    py::class_<Reconciliation>(m, "Reconciliation", "Result of ViewFactors.reconciled().")
        .def_readonly("before", &Reconciliation::before, "Consistency of the estimate.")
        .def_readonly("after", &Reconciliation::after, "Consistency of the fit.");
}

}  // namespace

void bind_view_factors(py::module_& m) {
    bind_consistency(m);
    py::class_<ViewFactors, SharedFactors>(m, "ViewFactors", docs::ViewFactors)
        .def_readonly("names", &ViewFactors::names, docs::ViewFactors_names)
        .def_property_readonly("areas", array(&ViewFactors::areas),
                               array_text("(n,) float64", docs::ViewFactors_areas).c_str())
        .def_property_readonly("row_offsets", array(&ViewFactors::row_offsets),
                               array_text("(n + 1,) int64", docs::ViewFactors_row_offsets).c_str())
        .def_property_readonly("columns", array(&ViewFactors::columns),
                               array_text("(nnz,) int32", docs::ViewFactors_columns).c_str())
        .def_property_readonly("values", array(&ViewFactors::values),
                               array_text("(nnz,) float32", docs::ViewFactors_values).c_str())
        .def_property_readonly("errors", array(&ViewFactors::errors),
                               array_text("(nnz,) float32", docs::ViewFactors_errors).c_str())
        .def_property_readonly("sky", array(&ViewFactors::sky),
                               array_text("(n,) float32", docs::ViewFactors_sky).c_str())
        .def_property_readonly("sky_errors", array(&ViewFactors::sky_errors),
                               array_text("(n,) float32", docs::ViewFactors_sky).c_str())
        .def_property_readonly("ground", array(&ViewFactors::ground),
                               array_text("(n,) float32", docs::ViewFactors_sky).c_str())
        .def_property_readonly("ground_errors", array(&ViewFactors::ground_errors),
                               array_text("(n,) float32", docs::ViewFactors_sky).c_str())
        .def_property_readonly("blocked", array(&ViewFactors::blocked),
                               array_text("(n,) float32", docs::ViewFactors_blocked).c_str())
        .def_property_readonly("blocked_errors", array(&ViewFactors::blocked_errors),
                               array_text("(n,) float32", docs::ViewFactors_blocked).c_str())
        .def_readonly("rays_per_group", &ViewFactors::rays_per_group, "Number of rays of each group.")
        .def(
            "consistency", [](const SharedFactors& f) { return consistency(*f); }, Documented(docs::consistency))
        .def_property_readonly(
            "matrix", [](const SharedFactors& f) { return sparse(f, f->values); },
            "The factors as a sparse matrix of SciPy (n, n), which shares `values` and `columns`.")
        .def_property_readonly(
            "error_matrix", [](const SharedFactors& f) { return sparse(f, f->errors); },
            "Standard errors of the non-zero factors as a sparse matrix of SciPy (n, n).")
        .def(
            "dense", [](const ViewFactors& f) { return dense(f, f.values, 0); },
            Documented("Returns the factors as an array (n, n), float64."))
        .def(
            "dense_errors", [](const ViewFactors& f) { return dense(f, f.errors, f.smallest_error()); },
            Documented("Returns the standard errors as an array (n, n), float64. Those of absent factors are the "
                       "resolution, 1 / rays_per_group."))
        .def("closure", &closures,
             Documented("Returns the sum of each row with sky, ground and blocked, (n,) float64: 1, "
                        "unless the group has no uncovered area."))
        .def("save", &save_npz, py::arg("path"),
             Documented("Writes the arrays to a .npz file, named as here, which numpy.load reads.",
                        {{"path", "File to write."}}))
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
            py::arg("progress") = py::none(),
            Documented(docs::reconcile, {{"closure", "Whether rows sum to 1, with sky, ground and blocked."},
                                         {"reciprocity", "Whether A_i F_ij = A_j F_ji."}})
                .returns("The fitted copy, and a report of the consistency before and after."))
        .def("__len__", &ViewFactors::size)
        .def("__repr__", [](const ViewFactors& f) {
            return fmt::format("<ViewFactors of {} groups, {} non-zero, {} rays each>", f.size(), f.values.size(),
                               f.rays_per_group);
        });
    m.def("view_factors", &compute, py::arg("scene"), py::arg("groups"), py::arg("rays"), py::arg("sides"),
          py::arg("opaque_backs"), py::arg("seed"), py::arg("threads"), py::arg("progress"),
          Documented(docs::view_factors));
}

}  // namespace interflect::python
