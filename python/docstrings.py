"""Writes the comments of the public headers as C++ constants: docstrings.py OUTPUT HEADER...

The comment of `Solver::advance()` becomes `docs::Solver_advance`, a Comment of python/bindings/support/documented.h; the
comment of a type or a member, such as `View::fov`, becomes the string `docs::View_fov`. The bindings make docstrings of
them: the comment of a header is the only text of a contract. Words of C++ are converted here: `nullopt` and `null` become
None, `Scene::origin` becomes `Scene.origin`, functions have their names in Python. Paragraphs that start
with @note, and references in parentheses to code, are about C++ and are omitted.
"""

from __future__ import annotations

import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

SCOPE = re.compile(r"^\s*(?:struct|class|enum class|namespace)\s+(\w+)[^;]*\{")
TRAILING = re.compile(r"^\s*(?P<declaration>.*?)\s*///<\s?(?P<text>.*)$")
FUNCTION = re.compile(r"(~?\w+)\s*\(")
MEMBER = re.compile(r"(\w+)(?:\s*=[^;]*|\s*\{[^;]*\})?\s*[;,]?\s*$")
COMMAND = re.compile(r"(?:^|(?<=\s))@(param|return|throws|note)\b\s*")
ERROR = re.compile(r"(InputError|Stopped|std::runtime_error)\b[,:]?\s*")
# An error that follows another one: "InputError for an unknown extension; Stopped if ...".
NEXT_ERROR = re.compile(r";\s+(?=(?:InputError|Stopped|std::runtime_error)\b)")
PYTHON_NAMES = {
    "std::runtime_error": "Error",
    "nullopt": "None",
    "null": "None",
    "true": "True",
    "false": "False",
    "measure_irradiance()": "probe()",
    "tone_map()": "tonemap()",
    "write_solution()": "Solution.save()",
    "read_solution()": "Solution.open()",
    "export_solution()": "export()",
    "load_scene()": "load()",
    "Scene::patches": "Scene.faces",
    "SolveOptions::keep_direct": "the setting keep_direct",
    "max_measuring_points": "1,000,000 points",
    "max_light_groups": "32 groups",
}
PYTHON_NAME = re.compile("|".join(
    rf"(?<![\w.:\"]){re.escape(name)}(?![\w(])" for name in sorted(PYTHON_NAMES, key=len, reverse=True)))
# A reference in parentheses to code that Python does not have: "(see cut_at_contacts())", "(Method::follows_dimming)".
REFERENCE = re.compile(r"\s\((?:see )?(?:\w+\(\)|\w+::\w+)\)")


@dataclass
class Comment:
    """The parts of a comment."""

    text: str = ""
    arguments: dict[str, str] = field(default_factory=dict)
    returns: str = ""
    raises: list[str] = field(default_factory=list)
    is_function: bool = False


def comments(header: str) -> dict[str, Comment]:
    """Returns the comment of each declaration by its name with scopes: 'Solver_advance'."""
    found: dict[str, Comment] = {}
    scopes: list[str] = []
    pending: list[str] = []
    depths: list[int] = []
    depth = 0

    def add(names: list[str], lines: list[str], is_function: bool = False) -> None:
        inside = [scope for scope in scopes if scope not in ("interflect", "detail")]
        for name in names:
            found.setdefault("_".join([*inside, name]), parse(lines, is_function))

    for line in with_joined_comments(header):
        stripped = line.strip()
        if stripped.startswith("template"):
            continue
        if stripped.startswith("#"):  # ends the comment of a file
            pending = []
            continue
        trailing = TRAILING.match(line)
        if stripped.startswith("///") and not stripped.startswith("///<"):
            pending.append(re.sub(r"^\s*/// ?", "", line))
            continue
        scope = SCOPE.match(line)
        if scope and pending:
            add([scope.group(1)], pending)
        elif trailing and trailing.group("declaration"):
            declaration = trailing.group("declaration")
            add(names_of(declaration), [*pending, trailing.group("text")], is_function(declaration))
        elif pending and stripped:
            add(names_of(stripped), pending, is_function(stripped))
        if scope:
            scopes.append(scope.group(1))
            depths.append(depth)
        depth += line.count("{") - line.count("}")
        while depths and depth <= depths[-1]:
            depths.pop()
            scopes.pop()
        if stripped:
            pending = []
    return found


def with_joined_comments(header: str) -> list[str]:
    """Returns the lines of a header, with each comment `///<` that fills several lines on its first line."""
    lines: list[str] = []
    for line in header.splitlines():
        if line.strip().startswith("///<") and lines and "///<" in lines[-1]:
            lines[-1] += " " + line.strip().removeprefix("///<").strip()
        else:
            lines.append(line)
    return lines


def without_initialisers(declaration: str) -> str:
    while (inner := re.sub(r"\{[^{}]*\}", "", declaration)) != declaration:
        declaration = inner
    return re.sub(r"=[^,;]*", "", declaration)


def is_function(declaration: str) -> bool:
    """Whether a declaration declares a function."""
    return not declaration.startswith("using") and FUNCTION.search(without_initialisers(declaration)) is not None


def names_of(declaration: str) -> list[str]:
    """Returns the names that a declaration declares: one, or several members of one type."""
    declaration = without_initialisers(declaration)
    function = FUNCTION.search(declaration)
    if function and not declaration.startswith("using"):
        return [function.group(1)]
    members = [MEMBER.search(part) for part in re.sub(r"<[^<>]*>", "", declaration.rstrip(";")).split(",")]
    return [member.group(1) for member in members if member]


def in_python(text: str) -> str:
    """Replaces names of C++ by names of Python."""
    text = REFERENCE.sub("", text)
    return PYTHON_NAME.sub(lambda name: PYTHON_NAMES[name.group(0)], text).replace("::", ".")


def one_line(text: str) -> str:
    return " ".join(text.split())


def parse(lines: list[str], is_function: bool) -> Comment:
    """Divides a comment at its commands @param, @return, @throws and @note. A cost after a command belongs to the text."""
    first, *rest = COMMAND.split("\n".join(lines))
    result = Comment(first.strip(), is_function=is_function)
    for command, content in zip(rest[::2], rest[1::2]):
        content, separator, cost = re.sub(r"\s+(?=Cost:)", "\0", content).partition("\0")
        if separator:
            result.text += "\n\n" + one_line(cost)
        if command == "param":
            names, text = re.split(r"\s{2,}", content, maxsplit=1)
            result.arguments.update({name: in_python(one_line(text)) for name in names.split(", ")})
        elif command == "return":
            result.returns = in_python(one_line(content))
        elif command == "throws":
            for part in NEXT_ERROR.split(one_line(content)):
                error = ERROR.match(part)
                if error is None:
                    raise ValueError(f"@throws: expected the name of an error, found {part!r}")
                result.raises.append(f"{in_python(error.group(1))}: {in_python(part[error.end():])}")
    result.text = with_quoted_blocks(in_python(result.text))
    return result


def with_quoted_blocks(text: str) -> str:
    """Puts an empty line before and after indented lines, such as formulas, as reStructuredText needs it."""
    lines: list[str] = []
    for line in text.splitlines():
        if lines and lines[-1].strip() and line.strip() and line.startswith(" ") != lines[-1].startswith(" "):
            lines.append("")
        lines.append(line)
    return "\n".join(lines)


def quoted(text: str) -> str:
    return f'R"doc({text})doc"'


def constant(name: str, comment: Comment) -> str:
    """Returns the definition of a comment in C++."""
    if not comment.is_function:
        return f"inline constexpr const char* {name} = {quoted(comment.text)};"
    arguments = [f"{{{quoted(argument)}, {quoted(text)}}}" for argument, text in comment.arguments.items()]
    lines = [f"inline constexpr Argument arguments_of_{name}[] = {{{', '.join(arguments)}}};"] if arguments else []
    fields = [quoted(comment.text), f"arguments_of_{name}" if arguments else "{}", quoted(comment.returns),
              quoted("\n".join(comment.raises))]
    lines.append(f"inline constexpr Comment {name}{{{', '.join(fields)}}};")
    return "\n".join(lines)


def main(output: str, headers: list[str]) -> None:
    """Writes the constants of all headers."""
    all_comments: dict[str, Comment] = {}
    for header in headers:
        for name, comment in comments(Path(header).read_text(encoding="utf-8")).items():
            all_comments.setdefault(name, comment)
    lines = ["#pragma once", '#include "documented.h"', "namespace interflect::python::docs {"]
    lines += [constant(name, comment) for name, comment in sorted(all_comments.items())]
    lines.append("}  // namespace interflect::python::docs")
    Path(output).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
