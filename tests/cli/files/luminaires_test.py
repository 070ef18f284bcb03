"""Photometry from IES LM-63 and EULUMDAT files, on the command line."""

import unittest

from command import BAD_INPUT, SMALL, VIEW, WRONG_USAGE, CommandTest, room

# 100 cd in all directions below the horizon: 200 pi lm.
LAMP = "IESNA:LM-63-2002\nTILT=NONE\n1 400 1 2 1 1 2 .2 .2 0\n1 1 30\n0 90\n0\n100 100\n"
FLUX = 628.3185


class Luminaires(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("dark.mgf", room().replace("ed 1000", "ed 0"))
        self.write("lamp.ies", LAMP)

    def info(self, *arguments):
        return self.json("info", "dark.mgf", *arguments)

    def luminaires(self, *values):
        return [word for value in values for word in ("--luminaire", value)]

    def test_info_counts_them_and_their_flux(self):
        info = self.info(*self.luminaires("lamp.ies@1,1,2", "lamp.ies@1,2,2,1,2,0,turn=45,lumens=200,maintenance=0.8"))
        self.assertEqual(info["lights"], {"measured": 2})
        self.assertEqual(info["warnings"], [])
        self.assertIn("lamp.ies", info["files"])
        for channel in info["emitted_power"]:
            self.assertAlmostEqual(channel, FLUX * (1 + 200 / 400 * 0.8), delta=0.01)

    def test_ies_in_a_scene_is_the_same_light(self):
        self.write("lit.mgf", room().replace("ed 1000", "ed 0") + "ies lamp.ies -m .5 -t 1 1 2\n")
        self.interflect("solve", "lit.mgf", "-o", "one.h5", "--rays", "100k")
        self.interflect("solve", "dark.mgf", "-o", "two.h5", "--rays", "100k", "--luminaire", "lamp.ies@1,1,2,lumens=200")
        self.interflect("render", "one.h5", "-o", "one.exr", *VIEW, *SMALL)
        self.interflect("render", "two.h5", "-o", "two.exr", *VIEW, *SMALL)
        self.assertLess(self.json("compare", "one.exr", "two.exr")["relative_mse"], 1e-8)

    def test_by_their_top_they_are_the_same_in_a_scene(self):
        """A point light has no height: it hangs 1 mm below the given place."""
        self.write("lit.mgf", room().replace("ed 1000", "ed 0") + "ies lamp.ies -top -m .5 -t 1 1 2.001\n")
        for name, scene, *lamp in (
            ("one", "lit.mgf"),
            ("two", "dark.mgf", "--luminaire", "lamp.ies@1,1,2.001,lumens=200,mount=top"),
            ("three", "dark.mgf", "--luminaire", "lamp.ies@1,1,2,lumens=200"),
        ):
            self.interflect("render", scene, "-o", f"{name}.exr", *VIEW, "--shading", "path", *SMALL, *lamp)
        for name in ("two", "three"):
            self.assertLess(self.json("compare", "one.exr", f"{name}.exr")["relative_mse"], 1e-6)

    def test_a_solution_needs_no_file(self):
        self.interflect("solve", "dark.mgf", "-o", "out.h5", "--rays", "100k", "--checkpoint", "run.h5",
                        "--luminaire", "lamp.ies@1,1,2")
        (self.folder / "lamp.ies").unlink()
        self.interflect("resume", "run.h5", "-o", "more.h5", "--rays", "200k")
        self.interflect("render", "more.h5", "-o", "flat.png", *VIEW, *SMALL)
        self.interflect("render", "more.h5", "-o", "path.png", *VIEW, "--size", "32x18", "--shading", "path")
        error = self.interflect("render", "more.h5", "-o", "no.png", *VIEW, *SMALL, "--luminaire", "lamp.ies@1,1,2",
                                exit_code=WRONG_USAGE).stderr
        self.assertIn("--luminaire: it has no effect", error)

    def test_faults_name_the_file_and_its_line(self):
        self.write("bad.ies", LAMP.replace("0 90", "90 0"))
        error = self.interflect("info", "dark.mgf", "--luminaire", "bad.ies@1,1,2", exit_code=BAD_INPUT).stderr
        self.assertIn("bad.ies:5: vertical angles must ascend", error)
        error = self.interflect("solve", "dark.mgf", "-o", "lamp.ies", "--luminaire", "lamp.ies@1,1,2",
                                exit_code=WRONG_USAGE).stderr
        self.assertIn("lamp.ies", error)
        self.assertEqual(self.bytes("lamp.ies").decode(), LAMP)

    def test_wrong_usage(self):
        for value in ("lamp.ies", "@1,2,3", "lamp.ies@1,2", "lamp.ies@1,2,3,4", "lamp.ies@1,2,3,turn", "lamp.ies@1,2,x",
                      "lamp.ies@1,2,3,lumens=-1", "lamp.ies@1,2,3,colour=2", "lamp.ies@1,2,3 ",
                      "lamp.ies@1e16,2,3", "lamp.ies@1,2,3,1,2,3", "lamp.ies@1,2,3,turn=5,turn=6"):
            with self.subTest(value=value):
                error = self.interflect("info", "dark.mgf", "--luminaire", value, exit_code=WRONG_USAGE).stderr
                self.assertIn("--luminaire", error)

    def test_oddities_warn_once(self):
        self.write("odd.ies", LAMP.replace("100 100", "-1 -1 100").replace("0 90", "0 50 80").replace("1 2 1 1", "1 3 1 1"))
        result = self.interflect("info", "dark.mgf", *self.luminaires("odd.ies@1,1,2", "odd.ies@1,2,2"))
        self.assertEqual(result.stderr.count("warning: "), 2, result.stderr)
        self.assertIn("a negative intensity is read as 0 (2 times)", result.stderr)


if __name__ == "__main__":
    unittest.main()
