/// Arguments whose types pybind11 does not check, because the signature has py::object or py::kwargs.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>

namespace interflect::python {

/// Returns repr() for a message, shortened if it is long.
inline std::string found(const pybind11::handle& value) {
    constexpr std::size_t longest = 200;  // a line or two; arrays have thousands of characters
    std::string text = pybind11::repr(value);
    return text.size() > longest ? text.substr(0, text.find_first_of(",\n ", longest)) + " ..." : text;
}

/// Returns the name of a type in Python, such as "float", "Optional[View]" or "tuple[float, float, float]".
template <class T>
std::string type_name() {
    namespace py = pybind11;
    const auto name = py::detail::make_caster<T>::name;
    const auto classes = name.types();
    std::string text;
    std::size_t next = 0;
    for (const char* c = name.text; *c != '\0'; ++c) {
        if (*c != '%')
            text += *c;
        else if (const py::handle known = py::detail::get_type_handle(*classes[next++], false))
            text += py::cast<std::string>(known.attr("__name__"));
    }
    return text;
}

/// Returns the value as a `T`. @throws TypeError with the name, the expected type and the value found.
template <class T>
T argument(const pybind11::handle& value, const std::string& name, const std::string& expected = type_name<T>()) {
    try {
        return pybind11::cast<T>(value);
    } catch (const pybind11::cast_error&) {
        throw pybind11::type_error(name + ": expected " + expected + ", found " + found(value));
    }
}

}  // namespace interflect::python
