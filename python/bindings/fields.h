/// Classes of plain data for Python: one argument and one attribute per member.
#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace interflect::python {

/// A class whose constructor takes its fields in this order or by name. Objects have replace(**fields), ==, copies and
/// a repr() that creates them again.
template <class T>
class Fields {
  public:
    Fields(pybind11::module_& module, const char* name, const char* doc)
        : class_(module, name, doc), class_name_(name) {}

    template <class Member>
    Fields& field(const char* name, Member T::*member, const char* doc) {
        return field(
            name, [member](const T& object) -> const Member& { return object.*member; },
            [member](T& object, const Member& value) { object.*member = value; }, doc);
    }

    /// A field that Python shows in another form than C++.
    template <class Get, class Set>
    Fields& field(const char* name, const Get& get, const Set& set, const char* doc) {
        class_.def_property(name, get, set, doc);
        names_.emplace_back(name);
        return *this;
    }

    void finish() {
        namespace py = pybind11;
        const auto set_field = [type = class_name_](const py::object& object, const std::string& name,
                                                    const py::handle& value) {
            try {
                py::setattr(object, name.c_str(), value);
            } catch (py::error_already_set& e) {
                if (!e.matches(PyExc_TypeError)) throw;
                throw py::type_error(type + "." + name + ": cannot take " + std::string(py::repr(value)));
            }
        };
        const auto set_named = [names = names_, type = class_name_, set_field](const py::object& object,
                                                                               const py::kwargs& values) {
            for (const auto& [key, value] : values) {
                const auto name = py::cast<std::string>(key);
                if (std::find(names.begin(), names.end(), name) == names.end())
                    throw py::type_error(type + " has no field '" + name + "'");
                set_field(object, name, value);
            }
        };
        class_.def(py::init(
            [names = names_, type = class_name_, set_field, set_named](const py::args& args, const py::kwargs& values) {
                if (args.size() > names.size()) throw py::type_error(type + ": too many arguments");
                const py::object object = py::cast(T());
                for (std::size_t i = 0; i < args.size(); ++i) {
                    if (values.contains(names[i].c_str()))
                        throw py::type_error(type + ": " + names[i] + " is given twice");
                    set_field(object, names[i], args[i]);
                }
                set_named(object, values);
                return py::cast<T>(object);
            }));
        class_.def(
            "replace",
            [set_named](const T& object, const py::kwargs& values) {
                py::object copy = py::cast(T(object));
                set_named(copy, values);
                return copy;
            },
            "A copy with other values of these fields.");
        class_.def("__copy__", [](const T& object) { return T(object); });
        class_.def("__deepcopy__", [](const T& object, const py::dict&) { return T(object); });
        class_.def("__repr__", [names = names_, type = class_name_](const py::object& object) {
            std::string text;
            for (const std::string& name : names)
                text += (text.empty() ? "" : ", ") + name + "=" + std::string(py::repr(object.attr(name.c_str())));
            return type + "(" + text + ")";
        });
        class_.def("__eq__", [names = names_, type = class_name_](const py::object& a, const py::object& b) {
            if (!py::isinstance<T>(b)) return false;
            for (const std::string& name : names)
                if (!a.attr(name.c_str()).equal(b.attr(name.c_str()))) return false;
            return true;
        });
        class_.attr("__hash__") = py::none();
    }

  private:
    pybind11::class_<T, std::shared_ptr<T>> class_;
    std::string class_name_;
    std::vector<std::string> names_;
};

}  // namespace interflect::python
