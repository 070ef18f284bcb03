#include <fmt/format.h>

#include "bindings.h"

namespace interflect::python {

namespace {

py::object class_of(const char* name) { return py::module_::import("interflect._errors").attr(name); }

void raise_input_error(const char* name, const InputError& e) {
    const py::object type = class_of(name);
    const py::object error = type(e.what(), e.file().string(), e.line(), e.object(), py::tuple(py::cast(e.faults())));
    PyErr_SetObject(type.ptr(), error.ptr());
}

}  // namespace

std::vector<std::string> sentences(const Warnings& warnings) {
    std::vector<std::string> result;
    for (const Warnings::Entry& w : warnings.entries()) {
        const std::string times = w.count > 1 ? fmt::format(" ({} times)", w.count) : "";
        result.push_back(fmt::format("{}{}{}", w.where.empty() ? "" : w.where + ": ", w.message, times));
    }
    return result;
}

void warn(const Warnings& warnings, int stack_level) {
    for (const std::string& sentence : sentences(warnings))
        if (PyErr_WarnEx(class_of("Warning").ptr(), sentence.c_str(), stack_level) != 0) throw py::error_already_set();
}

void bind_errors(py::module_&) {
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            std::rethrow_exception(thrown);
        } catch (const py::builtin_exception&) {
            throw;  // such as py::type_error; for pybind11's own translator
        } catch (const TooManyPatches& e) {
            raise_input_error("TooManyPatches", e);
        } catch (const InputError& e) {
            raise_input_error("InputError", e);
        } catch (const Stopped& e) {
            PyErr_SetString(class_of("Stopped").ptr(), e.what());
        } catch (const std::runtime_error& e) {
            PyErr_SetString(class_of("Error").ptr(), e.what());
        }
    });
}

}  // namespace interflect::python
