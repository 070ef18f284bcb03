#include "bindings.h"

namespace interflect::python {

namespace {

/// Refuses pickle for classes without __reduce__. pybind11 would end the process for its oldest two protocols.
void refuse_pickle(const py::module_& module) {
    for (const auto& [name, value] : module.attr("__dict__").cast<py::dict>()) {
        if (!py::isinstance<py::type>(value) || value.attr("__dict__").contains("__reduce__")) continue;
        const auto refuse = [name = py::cast<std::string>(name)](const py::object&) -> py::object {
            throw py::type_error("cannot pickle an object of interflect." + name + " (for a copy or another process)");
        };
        py::setattr(value, "__reduce__", py::cpp_function(refuse, py::name("__reduce__"), py::is_method(value)));
    }
}

}  // namespace

}  // namespace interflect::python

PYBIND11_MODULE(_core, module) {
    using namespace interflect::python;
    module.doc() = "The C++ library. Import interflect, which has the same names and more convenient arguments.";
    module.attr("version") = INTERFLECT_VERSION;
    py::options options;
    options.disable_function_signatures();  // see Documented
    // In this order, messages about wrong arguments name every class as Python does.
    bind_errors(module);
    bind_scene_parts(module);
    bind_light_sources(module);
    bind_scene(module);
    bind_files(module);
    bind_solver(module);
    bind_solution(module);
    bind_measurements(module);
    bind_pictures(module);
    bind_view_factors(module);
    refuse_pickle(module);
}
