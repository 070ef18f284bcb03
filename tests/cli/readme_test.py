"""The README's examples run, and what it quotes of their output is what they say.

They run as they stand but for the amount of work, which is cut to seconds: an option that has gone, a renamed view or
subcommand, an output that has changed are found alike.
"""

import re
import shlex
import unittest

from command import ROOT, CommandTest

SMALL = "--size 160x90"
LESS_WORK = {r"--rays \d+M": "--rays 300k", r"--time \d+": "--time 1", r"--until \d+%": "--until 20%", r"--size \d+x\d+": SMALL}


def examples():
    """(command, quoted lines of output) of each indented line that begins with `interflect`, perhaps after a prompt."""
    found = []
    for line in (ROOT / "README.md").read_text().splitlines():
        command = re.match(r" {4}(?:\$ )?interflect (.*)", line)
        if command:
            found.append((command[1], []))
        elif line.startswith("    ") and found:
            found[-1][1].append(line[4:])
        elif not line.startswith("    ") and found and line:
            found.append((None, []))  # what is indented after this text belongs to no example
    return [example for example in found if example[0]]


class Readme(CommandTest):
    def test_examples(self):
        (self.folder / "scenes").symlink_to(ROOT / "scenes")
        subcommands = set()
        for example, output in examples():
            for amount, less in LESS_WORK.items():
                example = re.sub(amount, less, example)
            arguments = shlex.split(example)
            if arguments[0] == "bench":
                arguments += ["--rays", "100k", "--rounds", "1"]
            if arguments[0] == "report":
                arguments += ["--samples", "32"]
            if arguments[0] in ("render", "report") and "--size" not in arguments:
                arguments += shlex.split(SMALL)
            subcommands.add(arguments[0])
            printed = self.interflect(*arguments, timeout=120).stdout.splitlines()
            for line in output:
                if line.strip() != "...":
                    self.assertIn(line, printed, example)
        self.assertEqual(subcommands, {"info", "solve", "resume", "render", "probe", "report", "compare", "bench", "make-scene", "export"})


if __name__ == "__main__":
    unittest.main()
