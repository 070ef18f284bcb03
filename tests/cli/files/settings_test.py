"""A setting of the solver has the same name in the library, on the command line, in files and in docs/guides/command-line.md."""

import json
import re
import unittest

from command import ROOT, CommandTest, room

# Structures of solve_options.h, their members in SolveOptions, and their headings in `solve --help`.
GROUPS = {
    "Limits": ("limits", "Limits"),
    "RefinementOptions": ("refinement", "Refinement"),
    "ImportanceOptions": ("importance", "Importance"),
    "ExperimentalOptions": ("experimental", "Experimental"),
}
NOT_IN_FILES = {"max_elements"}  # depends on the memory of the machine
OF_NO_GROUP = {"importance", "views", "keep_direct"}  # options in files; the first depends on the method


def members(structure: str) -> list[str]:
    """Returns the member names of a structure of solve_options.h: 'double smoothing = 0.9, exponent = 0.75;' has two."""
    text = (ROOT / "include" / "interflect" / "solve_options.h").read_text()
    body = re.search(rf"^struct {structure} {{\n(.*?)^}};", text, re.MULTILINE | re.DOTALL).group(1)
    statements = re.sub(r"//.*", "", body).split(";")
    return [name for statement in statements for name in re.findall(r"(\w+) =", statement)]


def settings(known: set[str]) -> list[tuple[str, str, str]]:
    """Returns (path in SolveOptions, external name, heading of the help) of every setting. `known` decides whether a
    name includes its group."""
    found = []
    for structure, (group, heading) in GROUPS.items():
        for member in members(structure):
            long_name = f"{group}_{member}"
            found.append((f"{group}.{member}", long_name if long_name in known else member, heading))
    return found


class Settings(CommandTest):
    def setUp(self):
        super().setUp()
        help_text = self.interflect("solve", "--help-all").stdout
        self.headings = {}  # by option
        heading = ""
        for line in help_text.splitlines():
            if match := re.match(r"(\w.*):$", line):
                heading = match.group(1)
            for flag in re.findall(r"--([\w-]+)", line[:34]):
                self.headings[flag] = heading
        self.settings = settings({flag.replace("-", "_") for flag in self.headings})

    def test_are_many(self):
        self.assertGreater(len(self.settings), 20)

    def test_have_an_option_each_in_the_group_of_that_name(self):
        for path, name, heading in self.settings:
            with self.subTest(path):
                self.assertIn(name.replace("_", "-"), self.headings)
                self.assertTrue(self.headings[name.replace("_", "-")].startswith(heading))

    def test_are_in_files_by_the_same_name(self):
        self.write("room.mgf", room())
        self.interflect("solve", "room.mgf", "-o", "out.h5", "--rays", "1k", "--stats", "stats")
        header = json.loads((self.folder / "stats").read_text().splitlines()[0])
        names = {name for _, name, _ in self.settings}
        self.assertEqual(set(header["options"]), names - NOT_IN_FILES | OF_NO_GROUP)

    def test_are_listed_in_the_documentation(self):
        rows = re.findall(r"^\| `(\w+\.\w+)` \| `--([\w-]+)` \|", (ROOT / "docs/guides/command-line.md").read_text(), re.MULTILINE)
        expected = {(path, name.replace("_", "-")) for path, name, _ in self.settings}
        self.assertEqual(set(rows), expected | {("method.importance", "importance")})


if __name__ == "__main__":
    unittest.main()
