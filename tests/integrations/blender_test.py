"""The Blender add-on in a headless Blender: bakes rooms repeatedly, imports their light, cancels, and reports errors.
INTERFLECT_BPY: a Python with the package bpy, which is used in place of the program blender."""

import json
import math
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INSIDE = Path(__file__).with_name("inside_blender.py")
BPY = os.environ.get("INTERFLECT_BPY")
BLENDER = [BPY] if BPY else ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python"]

CASES = (
    *("vertex", "lightmap", "sheets_vertex", "sheets_lightmap", "sheets_magnified", "moves", "three_vertex", "three_lightmaps"),
    *("visibility", "user", "scenes", "instances", "panels", "plain_world", "hdri_world", "warnings", "failures", "authored"),
    *("objects", "selected", "preview", "cancel", "disable"),
)


class Addon(unittest.TestCase):
    together: dict = {}  # results of the cases that share a Blender

    def blender(self, case: str) -> dict:
        """Returns the results of a case. All share one Blender, because each start takes a second."""
        if not self.together:
            self.together.update(self.run_blender(*CASES))
        found = self.together[case]
        self.assertNotIn("error", found, found.get("error"))
        return found

    def run_blender(self, *cases: str, command: str = os.environ["INTERFLECT_COMMAND"]) -> dict:
        """Runs cases of inside_blender.py in one Blender and returns their results."""
        with tempfile.TemporaryDirectory() as folder:
            addons, temporary = Path(folder, "scripts", "addons"), Path(folder, "temporary")
            addons.mkdir(parents=True)
            temporary.mkdir()
            (addons / "interflect").symlink_to(ROOT / "integrations/blender/interflect")
            out = Path(folder, "found.json")
            done = subprocess.run(
                [*BLENDER, INSIDE, "--", command, out, *cases],
                # Blender takes its modules from any python3 that comes first.
                env={
                    "HOME": folder,
                    "PATH": "/usr/bin:/bin",
                    "BLENDER_USER_SCRIPTS": str(Path(folder, "scripts")),
                    "TMPDIR": str(temporary),
                },
                capture_output=True,
                text=True,
                timeout=500,
            )
            self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
            self.assertEqual(list(temporary.glob("interflect-*")), [])
            return json.loads(out.read_text())

    @unittest.skipUnless(BPY, "extensions need Blender 4.2")
    def test_installs_as_an_extension(self):
        """The archive is made as the guide says."""
        with tempfile.TemporaryDirectory() as folder:
            archive = shutil.make_archive(str(Path(folder, "interflect")), "zip", ROOT / "integrations/blender", "interflect")
            done = subprocess.run(
                [*BLENDER, INSIDE.with_name("install_extension.py"), "--", os.environ["INTERFLECT_COMMAND"], archive],
                env={"HOME": folder, "PATH": "/usr/bin:/bin", "BLENDER_USER_RESOURCES": folder},
                capture_output=True,
                text=True,
                timeout=500,
            )
            self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])

    def test_vertex_colours_come_back(self):
        found = self.blender("vertex")
        self.assertEqual(found["result"], ["FINISHED"])
        self.assertGreater(found["lit_objects"], 0)
        self.assertTrue(found["has_colours"])
        self.assertTrue(found["originals_hidden"])
        self.assertTrue(found["originals_shown_again"])

    def test_lightmaps_come_back(self):
        found = self.blender("lightmap")
        self.assertEqual(found["result"], ["FINISHED"])
        self.assertGreater(found["lit_objects"], 0)
        self.assertGreater(found["images"], 0)

    def test_imported_files_of_authors_keep_their_metals(self):
        """A lamp of 1 cd is 2 m above the middle of a plate of reflectance 0.5; a metal of 0.8 reflects it at x = 0.4."""
        found = self.blender("authored")
        radiance = 0.5 / math.pi / 2**2
        self.assertAlmostEqual(found["plate"] / radiance, 1, delta=0.03)
        beside = 0.5 / math.pi * 2 / (2**2 + 0.4**2) ** 1.5
        self.assertAlmostEqual(found["mirror"] / (0.8 * beside), 1, delta=0.05)
        self.assertEqual(found["lamps"], 0)

    def test_objects_show_light_themselves(self):
        """A lamp of 1 cd is 2 m above x = 0. Plates have a reflectance of 0.5; `bare`, without a material, has 0.8."""
        found = self.blender("objects")
        for bake in ("first", "second"):
            self.assertEqual(found[bake], ["FINISHED"])
        for step in ("undone", "redone", "same"):
            self.assertTrue(found[step], step)
        self.assertEqual(found["lit"], ["bare", "bent", "drawn", "plain"])
        self.assertEqual(found["copies"], ["first", "leaf", "leaf", "row", "second"])
        self.assertEqual(found["hidden"], ["first", "left", "right", "row", "second"])
        warned = sorted(warning.split(": ")[-1] for warning in found["warnings"])
        self.assertEqual(warned, ["first, second", "left, right", "named", "row"])
        for x, y, radiance in found["radiance"]:
            reflectance = 0.8 if (x, y) == (1.2, 0) else 0.5
            expected = reflectance / math.pi * 2 / (x**2 + y**2 + 2**2) ** 1.5
            self.assertAlmostEqual(radiance / expected, 1, delta=0.03, msg=f"at ({x}, {y})")
        self.assertEqual(found["after"], found["before"])

    def test_light_of_selected_objects(self):
        found = self.blender("selected")
        self.assertIn("No object that renders is selected", found["nothing"])
        self.assertEqual(found["lit"], ["plain"])
        for kind in ("LIGHTMAP", "VERTEX"):
            lit, hidden = found[kind]
            self.assertEqual([name for name in lit if name != "scene"], ["plain"])
            self.assertEqual(hidden, ["plain"])

    def test_a_preview_comes_first(self):
        found = self.blender("preview")
        self.assertEqual(found["result"], ["FINISHED"])
        self.assertEqual(found["files"], ["preview.glb", "lit.glb"])

    def test_sheets_lit_on_both_sides_are_opaque_in_cycles(self):
        """Both sides of a sheet are in one place in the file, where Cycles skips one of them."""
        for kind in ("sheets_vertex", "sheets_lightmap", "sheets_magnified"):
            with self.subTest(kind):
                found = self.blender(kind)
                self.assertEqual(found["result"], ["FINISHED"])
                self.assertLess(found["sky"], 1e-6)
                self.assertEqual(found["through_corners"], 0)

    def test_faces_move_straight_forward(self):
        found = self.blender("moves")
        self.assertEqual(found["result"], ["FINISHED"])
        for forward in found["forward"]:
            self.assertAlmostEqual(forward, 1, delta=0.1)  # rounding of coordinates
        self.assertLess(found["within"], 9)

    def test_three_bakes_leave_what_one_leaves(self):
        for kind in ("three_vertex", "three_lightmaps"):
            with self.subTest(kind):
                found = self.blender(kind)
                self.assertEqual(found["results"], [["FINISHED"]] * 3)
                self.assertEqual(found["files"][1], found["files"][0])
                self.assertEqual(found["files"][2], found["files"][0])
                self.assertTrue(found["light_is_the_same"])
                self.assertEqual(found["after"], found["before"])

    def test_what_renders_is_baked(self):
        found = self.blender("visibility")
        self.assertEqual(found["result"], ["FINISHED"])
        shown_elsewhere = {f"cube {name}": [0.2, 0.1, 0.1] for name in ("eye", "alone", "monitor")}  # with their modifier
        room = {"room": [4, 3, 2.5], "table": [1, 0.6, 0.7], "lamp": [1, 0.5, 0]}
        self.assertEqual(found["baked"], room | shown_elsewhere)
        self.assertEqual(found["after"], found["before"])

    def test_edits_deletion_undo_and_saving_between_bakes(self):
        found = self.blender("user")
        for bake in ("grey", "dark", "deleted", "opened"):
            self.assertEqual(found[bake][0], ["FINISHED"])
        self.assertTrue(found["undone"])
        self.assertTrue(found["redone"])
        self.assertLess(found["dark"][1], 0.5 * found["grey"][1])
        self.assertEqual(found["deleted"][1], found["dark"][1])
        self.assertEqual(found["opened"][1], found["dark"][1])
        self.assertEqual(found["after"], found["before"])

    def test_scenes_of_a_file_are_apart(self):
        found = self.blender("scenes")
        self.assertEqual([found["first"], found["second"]], [["FINISHED"]] * 2)
        self.assertEqual(found["second_lit"], 1)
        self.assertAlmostEqual(found["size"], 3, places=4)
        self.assertEqual(found["engine"], "BLENDER_WORKBENCH")
        self.assertEqual(found["scenes"], ["Scene", "second"])
        self.assertTrue(found["active"])
        self.assertEqual(found["results"], [1, 1])
        self.assertEqual(found["results_after"], [1, 0])

    def test_instances_of_area_lamps(self):
        found = self.blender("instances")
        self.assertEqual(found["result"], ["FINISHED"])
        self.assertEqual(found["lamps_at"], [-1, 1])
        self.assertTrue(found["instances_hidden"])

    def test_area_lamps_become_panels_of_their_light(self):
        found = self.blender("panels")
        for by_panel, by_lamp in zip(found["panels"], found["lamps"]):
            self.assertGreater(by_lamp, 0.05)
            self.assertAlmostEqual(by_panel / by_lamp, 1, delta=0.01)
        self.assertEqual(len(found["normals"]), 4)
        for normal in found["normals"]:
            self.assertLess(normal[2], -0.999)  # it shines down
        self.assertEqual(found["warnings"], [])
        self.assertEqual(*found["left"])

    def test_a_plain_world_lights_the_scene(self):
        found = self.blender("plain_world")
        self.assertEqual(found["result"], ["FINISHED"])
        red, *others = found["brightest"]
        self.assertEqual(red, 0)  # negative in the world
        for brightest, expected in zip(others, (0.8 * 0.8, 0.8 * 1.6)):
            self.assertAlmostEqual(brightest / expected, 1, delta=0.05)

    def test_an_image_lights_the_side_that_it_is_turned_to(self):
        found = self.blender("hdri_world")
        self.assertEqual(found["result"], ["FINISHED"])
        half = math.pi / 8  # half angle of the bright part, which is as wide as high
        irradiance = 8 * 2 * math.sin(half) * (half + math.sin(2 * half) / 2)
        sides = found["sides"]
        self.assertAlmostEqual(sides.pop("-y") / (irradiance * 0.8 / math.pi), 1, delta=0.02)
        self.assertLess(max(sides.values()), 0.2)  # light at grazing angles
        self.assertEqual(sides["+y"], 0)
        self.assertEqual(*found["left"])

    def test_warnings_of_the_add_on_and_of_the_command(self):
        found = self.blender("warnings")
        spread, ball, metals, outside, sky = found["warnings"]
        self.assertIn("The spread of the area lamp 'lamp'", spread)
        self.assertIn("left out: ball", ball)
        self.assertFalse(found["ball_hidden"])
        self.assertIn("'metal': specular reflection of metals is left out", metals)
        self.assertTrue(metals.startswith("scene.glb: "), metals)
        self.assertIn(": object 'outer', at (40, -70, 30); ", outside)
        self.assertIn(": the world; ", sky)

    def test_failures_leave_the_scene_as_it_was(self):
        found = self.blender("failures")
        for name in ("export_scene", "import_scene"):
            self.assertIn(f"{name} is broken", found[name])
            self.assertEqual(*found[f"{name}_left"])
        self.assertEqual(found["result"], ["FINISHED"])

    def test_cancelling_leaves_the_scene_as_it_was(self):
        found = self.blender("cancel")
        self.assertTrue(found["was_cancelled"])
        self.assertLess(found["seconds"], 5)

    def test_one_bake_at_a_time_which_ends_with_the_add_on(self):
        found = self.blender("disable")
        self.assertEqual(found, {"may_bake": False, "may_clear": False, "is_running": False, "was_cancelled": True})

    def test_a_command_that_is_not_there_is_an_error_that_names_it(self):
        found = self.run_blender("vertex", command="/not/there/interflect")["vertex"]
        self.assertEqual(found["result"], ["CANCELLED"])
        self.assertIn("/not/there/interflect", found["said"])


if __name__ == "__main__":
    unittest.main()
