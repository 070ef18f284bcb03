"""Bad input: exit code 3 at once, a message that names file and line, no output.

tests/formats and tests/fuzz cover the faults in files; this file has one of each kind.
"""

import json
import os
import pathlib
import unittest

from command import BAD_INPUT, DONE, LAMP, PAINT, SMALL, VIEWS, WRONG_USAGE, CommandTest, room, vertices

TRIANGLE = vertices((0, 0, 0), (1, 0, 0), (1, 1, 0))  # six lines
AT_ONCE = 20  # [s]: far shorter than the solve, far longer than a refusal takes on any machine


class BadInput(CommandTest):
    def assert_refused(self, *words, scene="bad.mgf", options=(), output="out.h5"):
        """Each subcommand that reads a scene refuses it, with these words."""
        before = self.files()
        for arguments in (
            ("info", scene),
            ("solve", scene, "-o", output, "--rays", "10G", "--stats", "stats.json"),
            ("render", scene, "-o", "out.png", "--rays", "10G"),
        ):
            with self.subTest(arguments=arguments):
                result = self.interflect(*arguments, *options, exit_code=BAD_INPUT, timeout=AT_ONCE)
                for word in ("error: ", *words):
                    self.assertIn(word, result.stderr)
                self.assertEqual(result.stdout, "")
                self.assertEqual(self.files(), before)

    def assert_bad_scene(self, text, *words, options=()):
        self.write("bad.mgf", text)
        self.assert_refused(*words, options=options)


class BadScene(BadInput):
    def test_missing_file(self):
        self.assert_refused("bad.mgf: no such file")

    def test_folder(self):
        (self.folder / "bad.mgf").mkdir()
        self.assert_refused("bad.mgf: this is a folder")

    def test_pipes_and_devices(self):
        self.write("room.mgf", room())
        for make in (os.mkfifo, lambda path: path.symlink_to("/dev/zero")):
            for name, arguments in (
                ("bad.mgf", ("solve", "bad.mgf", "-o", "out.h5")),
                ("bad.h5", ("info", "bad.h5")),
                ("bad.h5", ("render", "bad.h5", "-o", "out.png")),
                ("bad.h5", ("resume", "bad.h5", "-o", "out.h5")),
                ("bad.png", ("compare", "bad.png", "bad.png")),
                ("bad.hdr", ("info", "room.mgf", "--environment", "bad.hdr")),
            ):
                path = self.folder / name
                path.unlink(missing_ok=True)
                make(path)
                with self.subTest(arguments=arguments):
                    error = self.interflect(*arguments, exit_code=BAD_INPUT, timeout=AT_ONCE).stderr
                    self.assertIn(f"{name}: this is not a regular file", error)
        os.mkfifo(self.folder / "run.h5")
        error = self.interflect("solve", "room.mgf", "-o", "out.h5", "--checkpoint", "run.h5", exit_code=WRONG_USAGE).stderr
        self.assertIn("'run.h5' is not a regular file", error)
        self.assertFalse((self.folder / "out.h5").exists())

    def test_another_format(self):
        self.write("bad.txt", room())
        self.assert_refused("bad.txt", "'.txt'", ".mgf", scene="bad.txt")

    def test_a_fault_in_a_line(self):
        self.assert_bad_scene("m lamp =\n\ted -5\n", "bad.mgf:2: '-5' must not be negative")

    def test_a_fault_in_an_included_file(self):
        self.write("parts/lamp.mgf", "m lamp =\n\ted -5\n")
        self.assert_bad_scene("i parts/lamp.mgf\n", "parts/lamp.mgf:2: ")

    def test_array_of_a_billion_copies(self):
        scene = TRIANGLE + "xf -a 1000000000 -t 1 0 0\nf v0 v1 v2\nxf\n"
        self.assert_bad_scene(scene, "bad.mgf:7: ", "1000000000 copies", "--max-patches")


class SameFiles(CommandTest):
    def assert_refused(self, *arguments):
        before = {name: self.bytes(name) for name in self.files()}
        result = self.interflect(*arguments, exit_code=WRONG_USAGE)
        self.assertIn("are the same file", result.stderr)
        self.assertRegex(result.stderr, "^error: --")
        self.assertEqual({name: self.bytes(name) for name in self.files()}, before)

    def test_outputs_and_inputs(self):
        self.write("room.mgf", room())
        (self.folder / "link.mgf").symlink_to("room.mgf")
        self.assert_refused("solve", "room.mgf", "-o", "out.h5", "--stats", "room.mgf")
        self.assert_refused("solve", "room.mgf", "-o", "out.h5", "--stats", "./out.h5")
        self.assert_refused("solve", "link.mgf", "-o", "out.h5", "--stats", "room.mgf")
        self.write("room.views.json", json.dumps(VIEWS))
        self.write("door.vf", "rview -vtv -vp 0.3 0.2 1.6 -vd 1 3 0\n")
        self.assert_refused("solve", "room.mgf", "-o", "out.h5", "--stats", "room.views.json")
        self.assert_refused("solve", "room.mgf", "-o", "out.h5", "--view-file", "door.vf", "--stats", "door.vf")

    def test_outputs_and_files_that_the_scene_names(self):
        self.write("wall.txt", PAINT)
        self.write("two.mgf", "i wall.txt\n" + room())
        self.assert_refused("solve", "two.mgf", "-o", "out.h5", "--stats", "wall.txt")
        self.assert_refused("probe", "two.mgf", "--point", "1,1,1", "-o", "wall.txt")
        (self.folder / "wall.png").symlink_to("wall.txt")
        self.assert_refused("render", "two.mgf", "-o", "wall.png", *SMALL)
        self.assert_refused("render", "two.mgf", "-o", "wall.png", *SMALL, "--shading", "path")

    def test_outputs_and_files_that_a_solution_came_from(self):
        self.write("room.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
        self.interflect("solve", "room.obj", "-o", "room.h5", "--rays", "1k")
        self.assert_refused("export", "room.h5", "-o", "room.obj")

    def test_but_not_the_same_device(self):
        self.write("room.mgf", room())
        self.interflect("solve", "room.mgf", "-o", "out.h5", "--rays", "1k", "--stats", "/dev/null")
        self.assertTrue(pathlib.Path("/dev/null").is_char_device())


class TextFiles(CommandTest):
    def test_may_begin_with_a_byte_order_mark(self):
        self.write("room.mgf", "\ufeff" + room())
        self.interflect("info", "room.mgf")

    def test_behind_a_loop_of_links(self):
        (self.folder / "a.mgf").symlink_to("b.mgf")
        (self.folder / "b.mgf").symlink_to("a.mgf")
        self.assertIn("in a circle", self.interflect("info", "a.mgf", exit_code=BAD_INPUT).stderr)


class Limits(CommandTest):
    def test_an_option_raises_the_limit_on_patches(self):
        self.write("row.mgf", TRIANGLE + "xf -a 1000 -t 1 0 0\nf v0 v1 v2\nxf\n")
        result = self.interflect("info", "row.mgf", "--max-patches", "1999", exit_code=BAD_INPUT)
        self.assertIn("--max-patches", result.stderr)
        self.assertEqual(self.json("info", "row.mgf", "--max-patches", "2k")["patches"], 2000)

    def test_a_mesh_that_is_too_fine_is_refused_at_once(self):
        self.write("room.mgf", room())
        for size in ("1e-6", "1e-45"):
            result = self.interflect(
                "solve", "room.mgf", "-o", "out.h5", "--mesh-size", size, exit_code=BAD_INPUT, timeout=AT_ONCE
            )
            self.assertIn("--mesh-size", result.stderr)
        self.assertEqual(self.files(), ["room.mgf"])


class Clamped(CommandTest):
    def test_reflectance_above_one(self):
        """Real files have such values: they are reduced with a warning, and the light stays finite."""
        self.write("white.mgf", room().replace("rd .6", "rd 1.5"))
        report = self.json("info", "white.mgf")
        self.assertTrue(any("0.99" in warning["message"] for warning in report["warnings"]), report["warnings"])
        solved = self.interflect("solve", "white.mgf", "-o", "out.h5", "--rays", "20k", "--mesh-size", "none")
        self.assertIn("warning: ", solved.stderr)
        self.assertNotIn("finite", solved.stderr)


class BadOutput(BadInput):
    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def test_is_found_before_the_solve(self):
        (self.folder / "folder.h5").mkdir()
        (self.folder / "folder.png").mkdir()
        (self.folder / "folder.json").mkdir()
        for path, words in {
            "nowhere/out": "there is no folder 'nowhere'",
            "/proc/out": "cannot write '/proc/out",  # where not even root can write
            "folder": "names a folder",
        }.items():
            for arguments in (
                ("solve", "room.mgf", "-o", path + ".h5", "--rays", "10G"),
                ("render", "room.mgf", "-o", path + ".png", "--rays", "10G"),
                ("solve", "room.mgf", "-o", "out.h5", "--rays", "10G", "--stats", path + ".json"),
            ):
                with self.subTest(arguments=arguments):
                    result = self.interflect(*arguments, exit_code=BAD_INPUT, timeout=AT_ONCE)
                    self.assertIn(words, result.stderr)
                    self.assertEqual(self.files(), ["room.mgf"])


class BadView(BadInput):
    """Faults in views are also found before the solve; usage_test.py has those of --eye."""

    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def assert_view_refused(self, options, *words):
        for output in ("out.h5", "out.png"):
            subcommand = "solve" if output == "out.h5" else "render"
            arguments = (subcommand, "room.mgf", "-o", output, "--rays", "10G", *options)
            result = self.interflect(*arguments, exit_code=BAD_INPUT, timeout=AT_ONCE)
            for word in words:
                self.assertIn(word, result.stderr)
        self.assertEqual([name for name in self.files() if name.startswith(("out", "."))], [])

    def test_of_an_unknown_name(self):
        self.assert_view_refused(("--view", "desk"), "there is no view 'desk'", "--eye")
        views = [{"name": name, "eye": [1, 1, 1], "look_at": [1, 2, 1]} for name in ("door", "lamp")]
        self.write("room.views.json", json.dumps({"views": views}))
        self.assert_view_refused(("--view", "desk"), "there is no view 'desk'", "door, lamp")

    def test_files(self):
        self.assert_view_refused(("--view-file", "view.vf"), "view.vf: no such file")
        self.write("view.vf", "rvu -vtv -vp 1 1\n")
        self.assert_view_refused(("--view-file", "view.vf"), "view.vf:1: ")
        self.write("room.views.json", '{"views": [{"name": 7}]}')
        self.assert_view_refused((), "room.views.json")

    def test_two_views_are_no_picture(self):
        self.write("a.vf", "rvu -vp 1 1 1 -vd 0 1 0 -vu 0 0 1\n")
        options = ("--view-file", "a.vf", "--eye", "1,1,1", "--look-at", "1,2,1")
        result = self.interflect(
            "render", "room.mgf", "-o", "out.png", "--rays", "10G", *options, exit_code=WRONG_USAGE, timeout=AT_ONCE
        )
        self.assertIn("one view", result.stderr)


class BadPictureOrSolution(CommandTest):
    def test_solution(self):
        self.write("room.mgf", room())
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "10k", "--mesh-size", "none")
        whole = self.bytes("room.h5")
        (self.folder / "cut.h5").write_bytes(whole[: len(whole) // 2])
        (self.folder / "junk.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(1000))
        before = self.files()
        for name in ("cut.h5", "junk.h5", "missing.h5"):
            result = self.interflect("render", name, "-o", "out.png", exit_code=BAD_INPUT, timeout=AT_ONCE)
            self.assertIn(name, result.stderr)
        self.assertEqual(self.files(), before)

    def test_picture(self):
        self.write("text.exr", "no picture")
        for name in ("missing.exr", "text.exr", "room.txt"):
            for pair in ((name, "text.exr"), ("text.exr", name)):
                self.interflect("compare", *pair, exit_code=BAD_INPUT, timeout=AT_ONCE)
        self.assertIn("missing.exr: no such file", self.interflect(
            "compare", "missing.exr", "text.exr", exit_code=BAD_INPUT).stderr)


class GoodScene(CommandTest):
    def test_the_pieces_of_the_bad_ones_are_sound(self):
        """Ensures that each scene above is refused for its fault alone."""
        self.write("good.mgf", TRIANGLE + PAINT + LAMP + "xf -a 10 -t 1 0 0\nf v0 v1 v2\nxf\n")
        self.interflect("info", "good.mgf", exit_code=DONE)


if __name__ == "__main__":
    unittest.main()
