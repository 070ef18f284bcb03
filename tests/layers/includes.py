"""Finds headers of this project that a file includes without using a name from them."""

import re
from pathlib import Path

TEXT = re.compile(r"""//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*\"""", re.DOTALL)
INCLUDE = re.compile(r'^#include "(interflect/[^"]+)"', re.MULTILINE)
WORD = re.compile(r"\b[A-Za-z_]\w+\b")
DECLARED = re.compile(
    r"\b(?:class|struct|enum class|using|concept|namespace)\s+(\w+)"  # types
    r"|\b(\w+)\s*\("  # functions and members
    r"|\b(\w+)\s*(?:\[\w*\]\s*)?(?:=[^;()]*|\{[^;{}]*\})?[;,](?!\w)"  # variables and fields
    r"|^#define (\w+)",
    re.MULTILINE,
)
KEYWORDS = {"if", "for", "while", "return", "operator", "sizeof", "static_cast", "default", "delete", "const", "noexcept", "interflect", "detail"}
FACADE = "interflect.h"  # includes all public headers, for its users


def unused_includes(root: Path) -> list[str]:
    """Returns the faults below `root`, as 'file: problem'."""
    headers = {str(header.relative_to(base)): header for base in (root / "include", root / "src") for header in base.rglob("*.h")}
    declared = {name: declared_names(header) for name, header in headers.items()}
    found = []
    for folder in ("include", "src", "apps", "bench", "tests", "python"):
        for file in sorted([*(root / folder).rglob("*.h"), *(root / folder).rglob("*.cpp")]):
            text = file.read_text()
            words = set(WORD.findall(TEXT.sub("", text)))
            for name in INCLUDE.findall(text):
                is_expected = Path(name).stem == file.stem or FACADE in (file.name, Path(name).name)
                if name in declared and not is_expected and words.isdisjoint(declared[name]):
                    found.append(f"{file}: uses nothing that {name} declares")
    return found


def declared_names(header: Path) -> set[str]:
    code = TEXT.sub("", header.read_text())
    return {name for match in DECLARED.findall(code) for name in match if name} - KEYWORDS
