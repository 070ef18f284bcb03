/// Classes of plain data for Python: one argument and one attribute per member.
#pragma once

#include <fmt/format.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "argument.h"
#include "vectors.h"

namespace interflect::python {

/// A class whose constructor takes its fields in this order or by name. Objects have replace(**fields), ==, copies,
/// pickle, and a repr() that creates them again: it has the fields that differ from their defaults.
template <class T>
class Fields {
  public:
    Fields(pybind11::module_& module, const char* name, const char* doc)
        : class_(module, name, doc), class_name_(name) {}

    template <class Member>
    Fields& field(const char* name, Member T::*member, const char* doc) {
        const auto get = [member](const T& object) -> const Member& { return object.*member; };
        const auto set = [member](T& object, const Member& value) { object.*member = value; };
        class_.def_property(name, get, set, doc);
        fields_.push_back({name, type_name<Member>(),
                           [name, member](const T& object) { return text_of(object.*member, object, name); }});
        return *this;
    }

    /// Adds a field whose type in Python differs from that in C++.
    template <class Get, class Set>
    Fields& field(const char* name, const Get& get, const Set& set, const char* doc) {
        class_.def_property(name, get, set, doc);
        using Value = typename SecondArgument<pybind11::detail::function_signature_t<Set>>::Type;
        fields_.push_back(
            {name, type_name<Value>(), [name](const T& object) { return text_of(nullptr, object, name); }});
        return *this;
    }

    /// Adds the constructor and the other methods, after all fields.
    void finish() {
        namespace py = pybind11;
        const auto set_field = [type = class_name_](const py::object& object, const Field& field,
                                                    const py::handle& value) {
            try {
                py::setattr(object, field.name.c_str(), value);
            } catch (py::error_already_set& e) {
                if (!e.matches(PyExc_TypeError)) throw;
                throw py::type_error(type + "." + field.name + ": expected " + field.type + ", found " + found(value));
            }
        };
        const auto set_named = [fields = fields_, type = class_name_, set_field](const py::object& object,
                                                                                 const py::kwargs& values) {
            for (const auto& [key, value] : values) {
                const auto name = argument<std::string>(key, type);
                const auto field =
                    std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; });
                if (field == fields.end()) throw py::type_error(type + " has no field '" + name + "'");
                set_field(object, *field, value);
            }
        };
        // The constructor takes fields in their order, then by name.
        class_.def(py::init([fields = fields_, type = class_name_, set_field, set_named](const py::args& args,
                                                                                         const py::kwargs& values) {
                       if (args.size() > fields.size()) throw py::type_error(type + ": too many arguments");
                       const py::object object = py::cast(T());
                       for (std::size_t i = 0; i < args.size(); ++i) {
                           if (values.contains(fields[i].name.c_str()))
                               throw py::type_error(type + ": " + fields[i].name + " is given twice");
                           set_field(object, fields[i], args[i]);
                       }
                       set_named(object, values);
                       return py::cast<T>(object);
                   }),
                   signature().c_str());
        class_.def(
            "replace",
            [set_named](const T& object, const py::kwargs& values) {
                py::object copy = py::cast(T(object));
                set_named(copy, values);
                return copy;
            },
            "replace(self, **fields)\n--\n\nCopies the object, with other values of these fields.\n\nArgs:\n"
            "    fields: Values by name.");
        // Copies, pickle, text and comparison
        class_.def("__reduce__", [fields = fields_](const py::object& object) {  // pickle calls this
            py::tuple values(fields.size());
            for (std::size_t i = 0; i < fields.size(); ++i) values[i] = object.attr(fields[i].name.c_str());
            return py::make_tuple(py::type::of(object), values);
        });
        class_.def("__copy__", [](const T& object) { return T(object); });
        class_.def("__deepcopy__", [](const T& object, const py::dict&) { return T(object); });
        class_.def("__repr__", [fields = fields_, type = class_name_](const T& object) {
            const T usual{};
            std::string text;
            for (const Field& field : fields)
                if (const std::string value = field.text(object); value != field.text(usual))
                    text += (text.empty() ? "" : ", ") + field.name + "=" + value;
            return type + "(" + text + ")";
        });
        class_.def("__eq__", [fields = fields_](const py::object& a, const py::object& b) {
            if (!py::isinstance<T>(b)) return false;
            for (const Field& field : fields)
                if (!a.attr(field.name.c_str()).equal(b.attr(field.name.c_str()))) return false;
            return true;
        });
        class_.attr("__hash__") = py::none();
    }

  private:
    struct Field {
        std::string name;
        std::string type;                           ///< Name of the type in Python.
        std::function<std::string(const T&)> text;  ///< Returns the text for repr().
    };

    template <class Function>
    struct SecondArgument;
    template <class Result, class First, class Second>
    struct SecondArgument<Result(First, Second)> {
        using Type = std::decay_t<Second>;
    };

    /// Returns a field's text for repr(). Numbers of single precision have the fewest digits that distinguish them.
    template <class Member>
    static std::string text_of(const Member& member, const T& object, const char* name) {
        if constexpr (std::is_same_v<Member, float>) {
            return fmt::format("{}", member);
        } else if constexpr (std::is_base_of_v<Imath::Vec3<float>, Member>) {
            return fmt::format("({}, {}, {})", member.x, member.y, member.z);
        } else {
            return std::string(pybind11::repr(pybind11::cast(object).attr(name)));
        }
    }

    /// Docstring of the constructor, see Documented. Defaults that are objects are shown as "...".
    std::string signature() const {
        const T usual{};
        std::string arguments;
        for (const Field& field : fields_) {
            const std::string value = field.text(usual);
            const bool is_object = value.find_first_of("<=(") != std::string::npos && value.front() != '(';
            arguments += ", " + field.name + "=" + (is_object ? "..." : value);
        }
        return "__init__(self" + arguments + ")\n--\n\n";
    }

    pybind11::class_<T, std::shared_ptr<T>> class_;
    std::string class_name_;
    std::vector<Field> fields_;
};

}  // namespace interflect::python
