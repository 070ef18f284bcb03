"""A notebook shows solutions as pictures, objects by their contents, and progress by a bar."""

import base64
import os
import struct
import subprocess
import tempfile
import unittest

import nbformat
from nbclient import NotebookClient

CELLS = [
    """
import interflect as ifl
scene = ifl.load("MAZE")
view = scene.views[0]
solution = ifl.solve(scene, view=view, rays=2e5, progress=True)
""",
    "solution",
    "[view, ifl.Material('white', reflectance=0.8)]",
]


def outputs_of(cell: nbformat.NotebookNode, mime: str) -> list[str]:
    return [output["data"][mime] for output in cell.outputs if mime in output.get("data", {})]


class Notebook(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        maze = f"{folder.name}/maze.mgf"
        subprocess.run([os.environ["INTERFLECT_COMMAND"], "make-scene", "maze", "--rooms", "2", "-o", maze], check=True)
        cells = [nbformat.v4.new_code_cell(cell.replace("MAZE", maze)) for cell in CELLS]
        notebook = nbformat.v4.new_notebook(cells=cells)
        os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # no warning of the debugger
        NotebookClient(notebook, timeout=300, kernel_name="python3").execute()
        cls.solving, cls.solution, cls.list = notebook.cells

    def test_a_solution_is_a_picture_of_its_view(self) -> None:
        (encoded,) = outputs_of(self.solution, "image/png")
        picture = base64.b64decode(encoded)
        self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", picture[16:24]), (480, 270))
        self.assertGreater(len(picture), 10_000)  # a black picture has some hundreds of bytes

    def test_a_list_has_the_fields_that_differ_from_their_defaults(self) -> None:
        (text,) = outputs_of(self.list, "text/plain")
        self.assertIn("[View(name='", text)
        self.assertIn("Material(name='white', reflectance=(0.8, 0.8, 0.8))]", text)

    def test_progress_is_a_bar_that_ends_full(self) -> None:
        texts = [output.get("text", "") for output in self.solving.outputs] + outputs_of(self.solving, "text/plain")
        self.assertRegex("".join(texts), r"solving.*100%|100%.*solving")


if __name__ == "__main__":
    unittest.main()
