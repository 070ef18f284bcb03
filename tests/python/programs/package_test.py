"""The commands of the README, from the installation to a plot, and the code below them."""

import os
import re
import subprocess
import tempfile
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
FEW_RAYS = "2e5"
LESS_WORK = {"cornell_box": "--size 128", "office_plan": "--samples 64 --spacing 0.6"}  # of examples


def section() -> str:
    return re.search(r"^## In Python$(.*?)^## ", (ROOT / "README.md").read_text(), re.MULTILINE | re.DOTALL)[1]


class FromTheReadme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        cls.commands = re.findall(r"^    \$ ([^#\n]*)", section(), re.MULTILINE)
        # Another Python comes first, which the commands must not use; the module is packed from this build; PYTHONPATH would hide a
        # faulty installation.
        other = cls.folder / "bin/python3"
        other.parent.mkdir()
        other.write_text("#!/bin/sh\necho 'not the Python of Debian' >&2\nexit 1\n")
        other.chmod(0o755)
        cls.environment = {**os.environ, "PATH": f"{other.parent}:/usr/bin:/bin:{os.environ['PATH']}"}
        del cls.environment["PYTHONPATH"]
        for command in cls.commands:
            command = command.strip().replace(".venv", str(cls.folder / "venv"))
            if "examples/" in command:
                command += f" --rays {FEW_RAYS} --output {cls.folder} {LESS_WORK[Path(command.split()[1]).stem]}"
            subprocess.run(command, shell=True, cwd=ROOT, env=cls.environment, check=True, timeout=300,
                           stdout=subprocess.DEVNULL)
        cls.python = cls.folder / "venv/bin/python"

    def test_there_are_five_commands(self):
        self.assertEqual(len(self.commands), 5)

    def test_the_plots_are_there(self):
        for name in ("cornell-box.png", "office-plan.png"):
            self.assertGreater((self.folder / name).stat().st_size, 10_000, name)

    def test_the_code_runs(self):
        code = re.search(r"```python\n(.*?)```", section(), re.DOTALL)[1].replace("5e6", FEW_RAYS)
        code = code.replace("render(solution)", "render(solution, width=64, height=36)")
        code = code.replace('"materials")', f'"materials", rays={FEW_RAYS})')
        code += "\nassert picture.shape == (36, 64, 3) and lux[0] > 0\nprint(ifl.__file__)"
        printed = subprocess.run([self.python, "-c", code], cwd=ROOT, env=self.environment, check=True, text=True,
                                 capture_output=True).stdout
        self.assertIn(str(self.folder), printed)  # the installed module, not another one

    def test_the_metadata_are_complete(self):
        shown = subprocess.run([self.python, "-m", "pip", "show", "interflect"], env=self.environment, check=True, text=True,
                               capture_output=True).stdout
        for line in ("Name: interflect", "License: Apache-2.0", "Requires: numpy"):
            self.assertIn(line, shown)

    def test_equal_builds_give_equal_wheels(self):
        for name in ("a", "b"):
            subprocess.run([self.python, "-m", "pip", "wheel", "--no-deps", "-w", self.folder / name, "."], cwd=ROOT,
                           env=self.environment, check=True, stdout=subprocess.DEVNULL)
        (wheel,) = (self.folder / "a").iterdir()
        self.assertEqual(wheel.read_bytes(), (self.folder / "b" / wheel.name).read_bytes())
        with zipfile.ZipFile(wheel) as archive:
            names = archive.namelist()
        for name in ("interflect/py.typed", "interflect/_core.pyi", "interflect/__init__.py"):
            self.assertIn(name, names)

    def test_importing_loads_nothing_heavy(self):
        """Matplotlib, SciPy, pandas or IPython would take longer than the module itself."""
        code = "import sys, interflect; print(*{m.split('.')[0] for m in sys.modules})"
        loaded = subprocess.run([self.python, "-c", code], env=self.environment, check=True, text=True,
                                capture_output=True).stdout.split()
        self.assertIn("numpy", loaded)
        self.assertFalse({"scipy", "matplotlib", "pandas", "IPython", "tqdm"} & set(loaded))


if __name__ == "__main__":
    unittest.main()
