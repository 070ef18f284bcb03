"""The types of the module: mypy --strict accepts the package, the tutorial and the examples, and stubs match the module."""

import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
MODULE = Path(os.environ["PYTHONPATH"].split(os.pathsep)[0])

WRONG_USE = """
import interflect as ifl
scene = ifl.load("room.mgf", units="cm")
solution = ifl.solve(scene, rays="many")
solution.irradiance = None
solution.lux
ifl.View(eye=3)
ifl.render(solution).upper()
"""


USES = [ROOT / "docs/python/tutorial.py", *ROOT.glob("examples/*.py")]
# They have the short annotations of newcomers, such as np.ndarray. The options are for these files alone, because others
# for the package would make mypy check NumPy again.
OPTIONS = f"""[mypy-{",".join(path.stem for path in USES)}]
disallow_any_generics = False
warn_return_any = False
"""


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)  # with the cache of mypy, which all tests share
        (cls.folder / "mypy.ini").write_text("[mypy]\n" + OPTIONS)

    def run_python(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        environment = {**os.environ, "MYPYPATH": str(MODULE)}
        return subprocess.run([sys.executable, "-B", "-m", *arguments], cwd=self.folder, env=environment, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)

    def check(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        return self.run_python("mypy", "--strict", "--ignore-missing-imports", f"--cache-dir={self.folder}", *arguments)

    def test_mypy_accepts_the_package_and_its_uses(self) -> None:
        for arguments in (["-p", "interflect"], map(str, USES)):
            result = self.check(*arguments)
            self.assertEqual(result.returncode, 0, result.stdout)

    def test_mypy_finds_wrong_uses(self) -> None:
        (self.folder / "wrong.py").write_text(WRONG_USE)
        result = self.check("wrong.py")
        for line in range(3, len(WRONG_USE.splitlines()) + 1):
            self.assertIn(f"wrong.py:{line}: error", result.stdout)

    def test_stubs_are_as_the_module(self) -> None:
        allowed = self.folder / "allowed.txt"
        allowed.write_text(r"interflect\._(errors|pictures|progress|scenes|solving|view_factors)\..*")  # without stubs: types are in the files
        result = self.run_python("mypy.stubtest", "interflect", f"--allowlist={allowed}")
        self.assertEqual(result.returncode, 0, result.stdout)


if __name__ == "__main__":
    unittest.main()
