"""The pages of the Python module: Sphinx makes them without warnings, and the code on them runs."""

import inspect
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import interflect as ifl

ROOT = Path(__file__).resolve().parents[3]
PAGES = ROOT / "docs/python"


class Pages(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_python(self, *arguments: str) -> str:
        result = subprocess.run([sys.executable, "-B", *arguments], cwd=self.folder, text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, check=False)
        self.assertEqual(result.returncode, 0, result.stdout)
        return result.stdout

    def test_sphinx_has_no_warnings_and_describes_every_name(self) -> None:
        self.run_python("-m", "sphinx", "-q", "-W", "-n", "--keep-going", "-b", "html", str(PAGES), "html")
        text = "".join(page.read_text(encoding="utf-8") for page in self.folder.glob("html/api/*.html"))
        missing = [name for name in ifl.__all__ if name != "__version__" and f'id="interflect.{name}"' not in text]
        self.assertEqual(missing, [])

    def test_examples_of_errors_are_as_printed(self) -> None:
        (self.folder / "room.mgf").write_text("v a =\n\tp 0 0 0\nf a b d\n")
        self.run_python("-c", f"import doctest, interflect as ifl\n"
                              f"failed, tried = doctest.testfile('{PAGES}/api/errors.rst', False, globs={{'ifl': ifl}})\n"
                              f"assert tried and not failed")

    def test_the_options_of_the_command_have_arguments(self) -> None:
        page = (PAGES / "command.rst").read_text(encoding="utf-8")
        listed = set(re.findall(r"--([a-z][\w-]*)", page))
        commands = {name: subprocess.run([os.environ["INTERFLECT_COMMAND"], name, "--help-all"], text=True, check=True,
                                         stdout=subprocess.PIPE).stdout
                    for name in ("solve", "render", "probe", "compare", "export", "validate", "resume")}
        known = set(re.findall(r"--([a-z][\w-]*)", "".join(commands.values())))
        self.assertEqual(listed - known, set())

        solver = ifl.Solver(ROOT / "scenes/office.mgf", rays=1000)
        arguments = set(solver.options) | set(inspect.signature(ifl.Solver).parameters) | {"preset"}
        options = set(re.findall(r"^  (?:-\w,)?--([a-z][\w-]*)", commands["solve"], re.MULTILINE))
        self.assertGreater(len(options), 40)
        missing = {option for option in options - listed if option.replace("-", "_") not in arguments}
        self.assertEqual(missing, {"help", "help-all", "output"})

    def test_a_picture_of_another_size_has_the_bits_of_the_command(self) -> None:
        maze = self.folder / "maze.mgf"
        for arguments in (("make-scene", "maze", "--rooms", "2", "-o", maze),
                          ("render", maze, "--view", "room-0", "--rays", "20k", "--size", "64x36", "--samples", "2",
                           "-o", self.folder / "picture.exr")):
            subprocess.run([os.environ["INTERFLECT_COMMAND"], *arguments], check=True, stderr=subprocess.DEVNULL)
        scene = ifl.load(maze)
        (view,) = (view for view in scene.views if view.name == "room-0")
        solution = ifl.solve(scene, view=ifl.WeightedView(view, aspect=64 / 36, pixel_rows=36), rays=2e4)
        picture = ifl.render(solution, width=64, height=36, samples=2)
        self.assertTrue((picture == ifl.read_image(self.folder / "picture.exr")).all())

    def test_the_tutorial_runs(self) -> None:
        printed = self.run_python(str(PAGES / "tutorial.py"))
        self.assertRegex(printed, r"\d+ \+- \d+\.\d lx, uniformity 0\.\d\d\n$")
        for picture in ("room.png", "plan.png"):
            self.assertTrue((self.folder / picture).read_bytes().startswith(b"\x89PNG"))


if __name__ == "__main__":
    unittest.main()
