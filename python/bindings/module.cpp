#include "bindings.h"

PYBIND11_MODULE(_core, module) {
    using namespace interflect::python;
    module.doc() = "The C++ library. Import interflect, which has the same names and more convenient arguments.";
    module.attr("version") = INTERFLECT_VERSION;
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
}
