#include "documented.h"

#include <string_view>

namespace interflect::python {

namespace py = pybind11;

namespace {

constexpr Argument described_once[] = {
    {"scene", "Scene, which stays as it is."},
    {"solution", "Result of solve(), of Solver.solution or of Solution.open()."},
    {"path", "Path of the file: a str or os.PathLike."},
    {"seed", "The same seed gives the same bits for any number of threads."},
    {"threads", "Maximum number of threads; 0: all of the machine."},
    {"progress",
     "True: a bar of tqdm; False: nothing; a function that is called with a Progress; None: a bar in notebooks, if "
     "tqdm is "
     "installed."},
};

const char* find(std::span<const Argument> arguments, std::string_view name) {
    for (const Argument& argument : arguments)
        if (name == argument.name) return argument.text;
    return nullptr;
}

/// Wraps a paragraph of a section to lines of 112 characters, with a hanging indent.
void append_wrapped(std::string& text, std::string_view paragraph) {
    constexpr std::size_t width = 112;  // 120, the columns of the code, less the 8 by which help() indents methods
    std::size_t column = 4;
    text += "\n    ";
    for (std::size_t begin = 0; begin < paragraph.size();) {
        const std::size_t end = std::min(paragraph.find(' ', begin), paragraph.size());
        const std::string_view word = paragraph.substr(begin, end - begin);
        if (begin > 0) {
            const bool fits = column + 1 + word.size() <= width;
            text += fits ? " " : "\n        ";
            column = fits ? column + 1 : 8;
        }
        text += word;
        column += word.size();
        begin = end + 1;
    }
}

/// Returns the signature as inspect.signature() reads it: "(scene, object, facing=None)". Defaults must be literals of
/// Python.
std::string signature_of(const py::detail::function_record& function) {
    std::string text;
    const auto add = [&](const std::string& argument) { text += (text.empty() ? "" : ", ") + argument; };
    if (function.is_method && function.args.empty()) add("self");
    for (std::size_t i = 0; i < function.args.size(); ++i) {
        if (i == function.nargs_pos && !function.has_args) add("*");
        const py::detail::argument_record& argument = function.args[i];
        add(argument.value ? std::string(argument.name) + "=" + std::string(py::repr(argument.value)) : argument.name);
    }
    if (function.has_args) add("*args");
    if (function.has_kwargs) add("**options");
    return "(" + text + ")";
}

}  // namespace

std::string Documented::description_of(const std::string& argument) const {
    for (const std::span<const Argument> known :
         {std::span<const Argument>(own_), comment_.arguments, std::span<const Argument>(described_once)})
        if (const char* text = find(known, argument)) return text;
    return {};
}

void Documented::apply(py::detail::function_record& function) const {
    docstring_ = std::string(function.name) + signature_of(function) + "\n--\n\n" + comment_.text;
    std::string arguments;
    const auto describe = [&](const std::string& name) {
        if (const std::string text = description_of(name); !text.empty()) append_wrapped(arguments, name + ": " + text);
    };
    for (const py::detail::argument_record& argument : function.args) describe(argument.name);
    if (function.has_kwargs) describe("options");
    if (!arguments.empty()) docstring_ += "\n\nArgs:" + arguments;
    const auto add_section = [&](const char* title, std::string_view lines) {
        if (lines.empty()) return;
        docstring_ += std::string("\n\n") + title + ":";
        while (!lines.empty()) {
            const std::size_t end = std::min(lines.find('\n'), lines.size());
            append_wrapped(docstring_, lines.substr(0, end));
            lines.remove_prefix(std::min(end + 1, lines.size()));
        }
    };
    add_section("Returns", comment_.returns);
    add_section("Raises", comment_.raises);
    function.doc = docstring_.data();
}

}  // namespace interflect::python
