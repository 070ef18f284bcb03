"""The README's examples run, and the output quoted there matches.

Only the amount of work is reduced, to seconds. Removed options, renamed views or subcommands, and changed output all
fail.
"""

import json
import re
import shlex
import unittest

from command import ROOT, SOLVED, VIEWS, CommandTest, room

SMALL = "--size 32x18"
LESS_WORK = {
    r"--rays \d+M": "--rays 20k",
    r"--time \d+": "--time 0.2",
    r"--until \d+%": "--until 50%",
    r"--size \d+x\d+": SMALL,
    r"--texels-per-metre \d+": "--texels-per-metre 2",
}
MORE_OPTIONS = {"bench": "--rays 20k --rounds 1", "report": "--samples 2", "probe": "--samples 16"}


def examples():
    """(command, quoted output lines) of each indented line with `interflect`, with or without a prompt."""
    found = []
    for line in (ROOT / "README.md").read_text().splitlines():
        command = re.match(r" {4}(?:\$ )?interflect (.*)", line)
        if command:
            found.append((command[1], []))
        elif line.startswith("    ") and found:
            found[-1][1].append(line[4:])
        elif not line.startswith("    ") and found and line:
            found.append((None, []))  # indented lines after this text belong to no example
    return [example for example in found if example[0]]


class Readme(CommandTest):
    def test_examples(self):
        (self.folder / "scenes").symlink_to(ROOT / "scenes")
        self.write("room.mgf", room())
        self.write("room.views.json", json.dumps(VIEWS))
        self.interflect("solve", "room.mgf", "-o", "room.h5", *SOLVED)
        subcommands = set()
        for example, output in examples():
            for amount, less in LESS_WORK.items():
                example = re.sub(amount, less, example)
            arguments = shlex.split(example)
            arguments += shlex.split(MORE_OPTIONS.get(arguments[0], ""))
            if "--lightmap" in arguments and "--texels-per-metre" not in arguments:
                arguments += ["--texels-per-metre", "2"]
            # Reports and exports of the office's 19,000 small faces take long: one is of the office, others of a room.
            if arguments[1] == "groups.h5" and arguments[0] == "export":
                arguments += ["--shading", "smooth"]
            elif arguments[0] in ("report", "export"):
                arguments[1] = "room.h5"
            if arguments[0] in ("render", "report") and "--size" not in arguments:
                arguments += shlex.split(SMALL)
            subcommands.add(arguments[0])
            printed = self.interflect(*arguments, timeout=120).stdout.splitlines()
            for line in output:
                if line.strip() != "...":
                    self.assertIn(line, printed, example)
        self.assertEqual(subcommands, {"info", "solve", "resume", "render", "probe", "report", "compare", "bench", "make-scene", "export", "viewfactors"})


if __name__ == "__main__":
    unittest.main()
