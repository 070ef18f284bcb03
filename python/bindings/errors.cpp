#include <fmt/format.h>

#include "bindings.h"

namespace interflect::python {

namespace {

py::object class_of(const char* name) { return py::module_::import("interflect._errors").attr(name); }

void raise_input_error(const InputError& e) {
    py::list faults;
    for (const Fault& fault : e.faults())
        faults.append(class_of("Fault")(fault.text, fault.object, fault.setting, fault.file.string(), fault.line));
    const py::object type = class_of(e.fault().setting == "max_patches" ? "TooManyPatches" : "InputError");
    PyErr_SetObject(type.ptr(), type(e.what(), faults).ptr());
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
            throw;  // an exception such as py::type_error, which pybind11's own translator handles
        } catch (const InputError& e) {
            raise_input_error(e);
        } catch (const Stopped& e) {
            PyErr_SetString(class_of("Stopped").ptr(), e.what());
        } catch (const std::runtime_error& e) {
            PyErr_SetString(class_of("Error").ptr(), e.what());
        }
    });
}

}  // namespace interflect::python
