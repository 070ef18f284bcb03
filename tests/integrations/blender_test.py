"""The Blender add-on in a headless Blender: bakes a room, brings the light back, is cancelled, and says what went wrong."""

import json
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INSIDE = Path(__file__).with_name("inside_blender.py")


class Addon(unittest.TestCase):
    def blender(self, case: str, command: str = os.environ["INTERFLECT_COMMAND"]) -> dict:
        """What a case of inside_blender.py finds."""
        with tempfile.TemporaryDirectory() as folder:
            addons = Path(folder, "scripts", "addons")
            addons.mkdir(parents=True)
            (addons / "interflect").symlink_to(ROOT / "integrations/blender/interflect")
            out = Path(folder, "found.json")
            done = subprocess.run(
                ["blender", "-b", "--factory-startup", "--python-exit-code", "1", "--python", INSIDE, "--", case, command, out],
                # Blender takes its modules from any python3 that comes first.
                env={"HOME": folder, "PATH": "/usr/bin:/bin", "BLENDER_USER_SCRIPTS": str(Path(folder, "scripts"))},
                capture_output=True,
                text=True,
                timeout=300,
            )
            self.assertEqual(done.returncode, 0, done.stdout[-3000:] + done.stderr[-3000:])
            return json.loads(out.read_text())

    def test_vertex_colours_come_back(self):
        found = self.blender("vertex")
        self.assertEqual(found["result"], ["FINISHED"])
        self.assertGreater(found["lit_objects"], 0)
        self.assertTrue(found["has_colours"])
        self.assertTrue(found["originals_hidden"])
        self.assertTrue(found["originals_shown_again"])
        self.assertEqual(found["left_in_file"], [])

    def test_lightmaps_come_back(self):
        found = self.blender("lightmap")
        self.assertEqual(found["result"], ["FINISHED"])
        self.assertGreater(found["lit_objects"], 0)
        self.assertGreater(found["images"], 0)

    def test_area_lamps_become_panels_of_their_power(self):
        found = self.blender("panel")
        self.assertAlmostEqual(found["area"], found["expected_area"], places=5)
        self.assertAlmostEqual(found["strength"], found["expected_strength"], places=4)
        self.assertLess(found["normal"][2], -0.999)  # it shines down
        self.assertEqual(found["objects_after"], found["objects_before"])

    def test_a_plain_world_lights_the_scene(self):
        found = self.blender("world")
        self.assertEqual(found["result"], ["FINISHED"])
        for found, expected in zip(found["brightest"], (0.8 * 0.4, 0.8 * 0.8, 0.8 * 1.6)):
            self.assertAlmostEqual(found / expected, 1, delta=0.05)

    def test_cancelling_leaves_the_scene_as_it_was(self):
        found = self.blender("cancel")
        self.assertTrue(found["was_cancelled"])
        self.assertLess(found["seconds"], 30)

    def test_a_command_that_is_not_there_is_an_error_that_names_it(self):
        found = self.blender("vertex", "/not/there/interflect")
        self.assertEqual(found["result"], ["CANCELLED"])
        self.assertIn("/not/there/interflect", found["said"])


if __name__ == "__main__":
    unittest.main()
