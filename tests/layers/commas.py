"""Finds C++ statements that are joined by commas, such as `x = 1, y = 2;`."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

OPAQUE = re.compile(r"""//[^\n]*|/\*.*?\*/|'(?:\\.|[^'\\\n])'|"(?:[^"\\\n]|\\.)*\"""", re.DOTALL)
CONTROL = re.compile(r"\s*(?:else\b(?!\s*if\b)|(?:else\s+)?(?:if|for|while)\s*(?:constexpr\s*)?(?=\())")
# An assignment or an increment; a declaration has a type before the name.
ASSIGNMENT = re.compile(
    r"\s*(?:\*|\+\+|--)?[A-Za-z_][\w:]*(?:(?:\.|->)\w+|\[[^\]]*\]|\([^()]*\))*\s*(?:[-+*/|&^]?=(?!=)|<<=|>>=|\+\+|--|;|,)"
)


@dataclass
class Joined:
    """Offsets in the text."""

    begin: int
    end: int  # the semicolon
    commas: list[int]
    is_controlled: bool  # the body of an `if` or a loop without braces


def joined_statements(text: str) -> Iterator[Joined]:
    code = OPAQUE.sub(lambda found: " " * len(found[0]) if found[0][0] == "/" else "0" * len(found[0]), text)
    start, depth, commas = 0, 0, []
    outer = []  # what surrounds a block or an initialiser in braces
    for i, c in enumerate(code):
        if c in "([":
            depth += 1
        elif c in ")]":
            depth -= 1
        elif c == "{":
            outer.append((start, depth, commas))
            start, depth, commas = i + 1, 0, []
        elif c == "}":
            start, depth, commas = outer.pop() if outer else (0, 0, [])
            if depth == 0:
                start, commas = i + 1, []
        elif c == "," and depth == 0:
            commas.append(i)
        elif c == ";" and depth == 0:
            if commas:
                begin, is_controlled = after_controls(code, start)
                if ASSIGNMENT.match(code, begin):
                    begin += len(code[begin:i]) - len(code[begin:i].lstrip())
                    yield Joined(begin, i, commas, is_controlled)
            start, commas = i + 1, []


def after_controls(code: str, start: int) -> tuple[int, bool]:
    """Returns the place after the heads of `if` and loops, and whether there was one."""
    begin = start
    while control := CONTROL.match(code, begin):
        begin = control.end()
        if code[begin : begin + 1] == "(":
            begin = after_brackets(code, begin)
    return begin, begin > start


def after_brackets(code: str, begin: int) -> int:
    depth = 0
    for i in range(begin, len(code)):
        depth += {"(": 1, ")": -1}.get(code[i], 0)
        if depth == 0:
            return i + 1
    return len(code)
