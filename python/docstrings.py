"""Writes the comments of the public headers as C++ constants: docstrings.py OUTPUT HEADER...

The comment of `Solver::advance()` becomes `docs::Solver_advance`; the docstring of `interflect.Solver.advance` repeats it.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

SCOPE = re.compile(r"^\s*(?:struct|class|enum class|namespace)\s+(\w+)[^;]*\{")
TRAILING = re.compile(r"^\s*(?P<declaration>.*?)\s*///<\s?(?P<text>.*)$")
FUNCTION = re.compile(r"(~?\w+)\s*\(")
MEMBER = re.compile(r"(\w+)(?:\s*=[^;]*|\s*\{[^;]*\})?\s*[;,]?\s*$")
COMMANDS = {"@return": "Returns", "@throws": "Raises"}


def comments(header: str) -> dict[str, str]:
    """Returns the comment of each declaration by its name with scopes: 'Solver_advance'."""
    found: dict[str, str] = {}
    scopes: list[str] = []
    pending: list[str] = []
    depths: list[int] = []
    depth = 0

    def add(names: list[str], lines: list[str]) -> None:
        inside = [scope for scope in scopes if scope not in ("interflect", "detail")]
        for name in names:
            found.setdefault("_".join([*inside, name]), text_of(lines))

    for line in header.splitlines():
        stripped = line.strip()
        if stripped.startswith("template"):
            continue
        trailing = TRAILING.match(line)
        if stripped.startswith("///") and not stripped.startswith("///<"):
            pending.append(re.sub(r"^\s*/// ?", "", line))
            continue
        if stripped.startswith("///<"):  # goes on with the comment of the line above
            continue
        scope = SCOPE.match(line)
        if scope and pending:
            add([scope.group(1)], pending)
        elif trailing and trailing.group("declaration"):
            add(names_of(trailing.group("declaration")), [*pending, trailing.group("text")])
        elif pending and stripped:
            add(names_of(stripped), pending)
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


def names_of(declaration: str) -> list[str]:
    """Returns the names that a declaration declares: one, or several members of one type."""
    declaration = re.sub(r"\{[^{}]*\}|=[^,;]*", "", declaration)
    function = FUNCTION.search(declaration)
    if function and not declaration.startswith("using"):
        return [function.group(1)]
    members = [MEMBER.search(part) for part in re.sub(r"<[^<>]*>", "", declaration.rstrip(";")).split(",")]
    return [member.group(1) for member in members if member]


def text_of(lines: list[str]) -> str:
    """Converts a comment to a docstring: @param, @return and @throws become sections as in Google's style."""
    body: list[str] = []
    sections: dict[str, list[str]] = {}
    current = body
    for line in re.sub(r"\s(@return|@throws)", r"\n\1", "\n".join(lines)).replace("::", ".").replace("nullopt", "None").splitlines():
        for part in re.split(r"\s+(?=@param\b)", line):
            command = re.match(r"(@\w+)\s+(.*)", part)
            if not command:
                indented = current is not body and part.strip()
                current.append("        " + part.strip() if indented else part)
            elif command.group(1) == "@param":
                name, text = re.split(r"\s{2,}", command.group(2), maxsplit=1)
                current = sections.setdefault("Args", [])
                current.append(f"    {name}: {text}")
            elif command.group(1) in COMMANDS:
                current = sections.setdefault(COMMANDS[command.group(1)], [])
                text = re.sub(r"^(InputError|Stopped|TooManyPatches|std\.runtime_error)[,:]?\s+(.*)", r"\1: \2", command.group(2))
                current.append("    " + text.replace("std.runtime_error", "Error"))
    text = "\n".join(body).strip()
    for title, content in sections.items():
        text += f"\n\n{title}:\n" + "\n".join(content).rstrip()
    return text.strip()


def main(output: str, headers: list[str]) -> None:
    """Writes the constants of all headers."""
    all_comments: dict[str, str] = {}
    for header in headers:
        for name, text in comments(Path(header).read_text(encoding="utf-8")).items():
            all_comments.setdefault(name, text)
    lines = ["#pragma once", "namespace interflect::python::docs {"]
    for name, text in sorted(all_comments.items()):
        lines.append(f'inline constexpr const char* {name} = R"doc({text})doc";')
    lines.append("}  // namespace interflect::python::docs")
    Path(output).write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
