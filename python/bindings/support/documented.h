/// Docstrings of functions in Google's style, from the comments of the C++ functions and from the arguments in Python.
#pragma once

#include <pybind11/pybind11.h>

#include <initializer_list>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace interflect::python {

/// Description of an argument.
struct Argument {
    const char* name;
    const char* text;
};

/// Comment of a function, as docstrings.py writes it from a header.
struct Comment {
    const char* text = "";
    std::span<const Argument> arguments = {};
    const char* returns = "";
    const char* raises = "";  ///< A line for each exception: "InputError: for an unknown name".
};

/// Docstring of an array: its shape and type before the comment of a member.
inline std::string array_text(const char* shape_and_type, const char* comment) {
    return std::string(shape_and_type) + ": " + comment;
}

/// Docstring of a function or method, the last argument of pybind11's def(). It starts with the signature, from which
/// Python makes `__text_signature__` for inspect.signature() and help(). The section "Args" has the arguments of the
/// Python function in their order; other parameters of the comment are omitted.
class Documented {
  public:
    /// @param own  Arguments that the comment does not describe, or describes otherwise. Common arguments, such as
    ///             `threads`, have a description already.
    explicit Documented(const Comment& comment, std::initializer_list<Argument> own = {})
        : comment_(comment), own_(own) {}
    /// A function that is in Python only, without exceptions of its own.
    explicit Documented(const char* text, std::initializer_list<Argument> own = {})
        : Documented(Comment{.text = text}, own) {}

    /// Replaces a section of the comment.
    Documented&& returns(const char* text) && { return comment_.returns = text, std::move(*this); }
    Documented&& raises(const char* text) && { return comment_.raises = text, std::move(*this); }

    /// Sets the docstring of a function whose arguments are complete.
    void apply(pybind11::detail::function_record& function) const;

  private:
    std::string description_of(const std::string& argument) const;

    Comment comment_;
    std::vector<Argument> own_;
    mutable std::string docstring_;  // pybind11 copies it before this object is destroyed
};

}  // namespace interflect::python

template <>
struct pybind11::detail::process_attribute<interflect::python::Documented>
    : process_attribute_default<interflect::python::Documented> {
    static void init(const interflect::python::Documented& documented, function_record* function) {
        documented.apply(*function);
    }
};
