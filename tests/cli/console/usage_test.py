"""Wrong usage: exit code 2, a message that names the option, no output; and the help."""

import re
import unittest

from command import WRONG_USAGE, CommandTest, room

SUBCOMMANDS = ("info", "solve", "render", "compare", "bench", "make-scene")
SOLVE = ("solve", "room.mgf", "-o", "out.h5")
RENDER = ("render", "room.mgf", "-o", "out.png")


class WrongUsage(CommandTest):
    def assert_wrong(self, arguments, *words):
        with self.subTest(arguments=arguments):
            result = self.interflect(*arguments, exit_code=WRONG_USAGE, timeout=20)
            for word in ("error: ", "--help", *words):
                self.assertIn(word, result.stderr)
            self.assertEqual(result.stdout, "")
            self.assertEqual(self.files(), self.inputs)

    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())
        self.inputs = ["room.mgf"]

    def test_subcommands(self):
        self.assert_wrong([], "expected one of", *SUBCOMMANDS)
        self.assert_wrong(["paint"], "'paint' is no subcommand", *SUBCOMMANDS)
        self.assert_wrong(["--loud"], "--loud")

    def test_unknown_and_missing_arguments(self):
        self.assert_wrong([*SOLVE, "--loud"], "--loud", "interflect solve --help")
        self.assert_wrong([*SOLVE, "another.mgf"], "another.mgf")
        self.assert_wrong(["solve", "room.mgf"], "--output")
        self.assert_wrong(["solve", "-o", "out.h5"], "SCENE")
        self.assert_wrong([*SOLVE, "--rays"], "--rays")
        self.assert_wrong([*SOLVE, "--threads", "1", "--threads", "2"], "--threads")

    def test_numbers(self):
        """One parser reads all counts, shares and sizes; each option has a value beyond its own range."""
        for option, values in {
            "--rays": ("0", "many", "5X", "1e30", "nan", ""),
            "--rays-per-iteration": ("0",),
            "--max-patches": ("-1",),
            "--seed": ("-1", "1.5", "18446744073709551616"),
            "--time": ("0", "nan", "inf"),
            "--until": ("-1%", "100%"),
            "--threads": ("-1", "100000"),
            "--mesh-size": ("0", "nan", "fine"),
            "--curve-divisions": ("0",),
            "--unit": ("0", "1e10", "yard", "2m", ""),
            "--warm-up": ("-1",),
            "--epsilon": ("0", "nan"),
            "--epsilon-decay": ("-1", "1.5"),
            "--importance-smoothing": ("-0.1", "1.1"),
            "--importance-exponent": ("1.1",),
            "--min-area": ("-1",),
            "--max-elements": ("0", "5G"),
            "--memory": ("0", "1X"),
            "--inherited-weight": ("1.1",),
            "--alpha": ("-0.1", "nan"),
            "--beta": ("1.1",),
            "--camera-rays": ("0",),
        }.items():
            for value in values:
                self.assert_wrong([*SOLVE, f"{option}={value}"], option)

    def test_words(self):
        self.assert_wrong([*SOLVE, "--method", "guess"], "--method", "srr")
        self.assert_wrong([*SOLVE, "--importance", "some"], "--importance", "off", "direct", "full")
        self.assert_wrong([*SOLVE, "--refinement-criterion", "taste"], "--refinement-criterion", "variance", "perceptual", "power")
        self.assert_wrong([*RENDER, "--show", "all"], "--show", "importance", "level", "mesh")
        self.assert_wrong([*SOLVE, "--up-axis", "up"], "--up-axis", "-y")
        self.assert_wrong([*SOLVE, "--points", "grid"], "--points", "sobol", "random")
        self.assert_wrong([*RENDER, "--shading", "phong"], "--shading", "flat", "smooth")
        self.assert_wrong([*RENDER, "--false-colour", "candela"], "--false-colour", "lux", "cd/m2")
        self.assert_wrong([*RENDER, "--tonemap", "1"], "--tonemap", "srgb", "filmic", "agx", "ferwerda")

    def test_pictures(self):
        for option, values in {
            "--size": ("64", "0x9", "1.5x9", "99999x9", "64x36x3"),
            "--samples": ("0",),
            "--exposure": ("nan", "1000", "auto1", "auto+x", "auto+1000", "1 auto", ""),
            "--display-luminance": ("0", "bright"),
            "--scale": ("5", "5..", "..5", "5..5", "-1..2", "0..1e30", "1..2..3"),
            "--isolines": ("", "0", "100,", "1,nan", "automatic"),
            "--plan": ("low", "nan"),
            "--section": ("x=", "w=3", "1,2,3", "1,2,3,0,0,0", "x=nan", "+x=3"),
            "--extent": ("0", "nan"),
            "--centre": ("1,2",),
            "--fov": ("0", "180"),
            "--up": ("1,2", "x,y,z", "0,0,nan"),
            "--eye": ("1e16,0,0", "1e30,0,0"),
        }.items():
            for value in values:
                self.assert_wrong([*RENDER, f"{option}={value}"], option)
        for value in ("x=1e30", "1e16,0,0,1,0,0"):
            self.assert_wrong([*RENDER, "--section", value], "--section")

    def test_views(self):
        for subcommand in (SOLVE, RENDER, ("bench", "room.mgf"), ("report", "room.h5", "-o", "out.html")):
            self.assert_wrong([*subcommand, "--eye", "1,1,1", "--look-at", "1,1,1"], "--eye", "same point")
            self.assert_wrong([*subcommand, "--eye", "1,1,1", "--look-at", "2,2,2", "--up", "0,0,0"], "--up")
            self.assert_wrong([*subcommand, "--eye", "1,1,1", "--look-at", "1,1,2"], "--eye", "parallel")
        self.assert_wrong([*RENDER, "--view", "door", "--view", "floor"], "--view", "one view")

    def test_places(self):
        probe = ("probe", "room.mgf")
        for value in ("1,1", "1e30,1,1", "1e16,1,1"):
            self.assert_wrong([*probe, "--point", value], "--point")
        for value in ("0,0,1", "0,0,1:0,0,1", "0,0,1:0,0,1e30", "0,0,1:1,0,1:1"):
            self.assert_wrong([*probe, "--line", value], "--line")

    def test_light_groups_and_skies(self):
        for text in ("desk", "=lamp", "desk="):
            self.assert_wrong([*SOLVE, "--group", text], "--group", "NAME=PATTERN")
        for text in ("desk", "desk=", "=1", "desk=bright", "desk=-1", "desk=nan"):
            for subcommand in (RENDER, ("probe", "room.mgf", "--point", "1,1,1")):
                self.assert_wrong([*subcommand, "--dim", text], "--dim", "GROUP=FACTOR")
        twice = [*SOLVE, "--group", "a=lamp", "--group", "a=desk"]
        self.assert_wrong(twice, "--group", "two light groups are called 'a'")
        many = [word for k in range(300) for word in ("--group", f"g{k}=lamp")]
        self.assert_wrong([*SOLVE, *many], "--group", "300 light groups")
        for text in ("perez:-1,5", "perez:5,-1", "clear:-1"):
            self.assert_wrong([*SOLVE, "--sky", text], "--sky", "perez:DIRECT,DIFFUSE")

    def test_exports(self):
        for option, values in {
            "--pixel-samples": ("-1", "0", "1e18"),
            "--probe-rays": ("1e18", "7", "2000000", "-1"),
            "--probe-spacing": ("0", "-1", "nan", "1e99"),
        }.items():
            for value in values:
                self.assert_wrong(["export", "room.mgf", "-o", "out.json", f"{option}={value}"], option)
        self.assert_wrong(["export", "room.h5", "-o", "out.glb", "--up", "0,0,0"], "--up")
        self.assert_wrong(
            ["export", "room.mgf", "-o", "out.glb", "--lightmap", "--lightmap-max-size", "65"],
            "--lightmap-max-size", "multiple of 4",
        )

    def test_names_of_outputs(self):
        for arguments, option, expected in (
            (("solve", "room.mgf", "-o", "out.png"), "--output", ".h5"),
            ((*SOLVE, "--checkpoint", "out"), "--checkpoint", ".h5"),
            (("resume", "room.h5", "-o", "out.png"), "--output", ".h5"),
            (("render", "room.mgf", "-o", "out.gif"), "--output", ".png .jpg .jpeg .exr .hdr"),
            ((*RENDER, "--shading", "path", "--error-image", "out.jpg"), "--error-image", ".exr"),
            ((*RENDER, "--shading", "path", "--error-image", "out"), "--error-image", ".exr"),
            ((*RENDER, "--shading", "path", "--layers"), "--layers", ".exr"),
            (("report", "room.mgf", "-o", "r.txt"), "--output", ".html"),
            (("export", "room.mgf", "-o", "out.xyz"), "--output", ".glb"),
            (("make-scene", "maze", "-o", "out.obj"), "--output", ".mgf"),
            (("render", "room.mgf", "-o", "out.exr", "--show", "mesh"), "--show", ".png"),
            (("compare", "a.exr", "b.exr", "--difference", "out.exr"), "--difference", ".png"),
            (("compare", "a.exr", "b.exr", "--difference", "a.exr"), "--difference", "same file"),
            (("solve", "room.mgf", "-o", "out.h5", "--stats", "room.mgf"), "--stats", "same file"),
            (("solve", "room.mgf", "-o", "out.h5", "--stats", "out.h5"), "--stats", "same file"),
        ):
            self.assert_wrong(arguments, option, expected)

    def test_text_under_the_name_of_another_kind_of_file(self):
        """Seen to replace scenes by tables. The help names the extensions that the command reads and writes."""
        subcommands = ("solve", "render", "export", "report")
        help_texts = [self.interflect(subcommand, "--help").stdout for subcommand in subcommands]
        extensions = set(re.findall(r"(?<!\w)\.[a-z]\w+", "".join(help_texts))) - {".json"}
        self.assertLessEqual({".mgf", ".obj", ".h5", ".png", ".exr", ".glb", ".rad", ".ies", ".html"}, extensions)
        probe = ["probe", "room.mgf", "--point", "1,1,1"]
        resume = ["resume", "run.h5", "-o", "out.h5"]
        for extension in sorted(extensions | {".MGF", ".mtl"}):
            self.assert_wrong([*SOLVE, "--stats", "other" + extension], "--stats", extension.lower())
        for subcommand, option in ((RENDER, "--stats"), (resume, "--stats"), (probe, "--output")):
            self.assert_wrong([*subcommand, option, "other.mgf"], option, ".mgf")

    def test_options_that_the_format_of_an_export_does_not_use(self):
        for scene, output, *options in (
            ("room.mgf", "out.rad", "--lightmap"),
            ("room.mgf", "out.rad", "--lightmap", "--texels-per-metre", "5"),
            ("room.mgf", "out.rad", "--probe-spacing", "3"),
            ("room.mgf", "out.rad", "--exposure", "4"),
            ("room.mgf", "out.rad", "--up", "0,1,0"),
            ("room.mgf", "out.rad", "--pixel-samples", "4"),
            ("room.h5", "out.ply", "--lightmap"),
            ("room.h5", "out.exr", "--lightmap"),
            ("room.h5", "out.obj", "--up", "0,1,0"),
            ("room.h5", "out.vtu", "--exposure", "1"),
            ("room.h5", "out.glb", "--probe-rays", "100"),
            ("room.h5", "out.glb", "--size", "8x8"),
            ("room.h5", "out.json", "--pixel-samples", "5"),
        ):
            self.assert_wrong(["export", scene, "-o", output, *options], options[0], "it is for .")
        self.assert_wrong(["export", "room.h5", "-o", "out.glb", "--lightmap", "--shading", "smooth", "--samples", "9"], "--samples", "smooth")
        self.assert_wrong(["export", "room.h5", "-o", "out.glb", "--lightmap", "--shading", "smooth", "--seed", "9"], "--seed", "smooth")

    def test_options_without_effect_on_a_solution(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "1k")
        self.inputs = ["room.h5", "room.mgf"]
        outputs = (("export", "-o", "out.rad"), ("render", "-o", "out.png"))
        for subcommand in (("info",), ("probe", "--point", "1,1,1"), *outputs):
            self.assert_wrong([*subcommand, "room.h5", "--sky", "overcast"], "--sky", "solved already")
        for option, *value in (
            ("--luminaire", "none.ies@1,1,1"),
            ("--unit", "cm"),
            ("--curve-divisions", "7"),
            ("--outside-files",),
        ):
            self.assert_wrong(["info", "room.h5", option, *value], option, "solved already")

    def test_options_without_effect(self):
        for arguments, option in (
            ((*RENDER, "--extent", "3"), "--extent"),
            ((*RENDER, "--fov", "30"), "--fov"),
            ((*SOLVE, "--up", "1,0,0"), "--up"),
            ((*SOLVE, "--every", "5s"), "--every"),
            ((*SOLVE, "--zenith", "1,0,0"), "--zenith"),
            (("report", "room.h5", "-o", "out.html", "--eye-height", "1"), "--eye-height"),
            (("probe", "room.mgf", "--point", "1,1,1", "--quantity", "ugr", "--exterior", "9"), "--exterior"),
            (("probe", "room.mgf", "--seat", "1,1,1:1,0,0"), "--seat"),
            (("probe", "room.mgf", "--quantity", "ugr", "--seat", "1,1,1:0,0,0"), "--seat"),
            (("probe", "room.mgf", "--quantity", "ugr", "--seat", "1,1,1"), "--seat"),
            ((*RENDER, "--scale", "1..2"), "--scale"),
            ((*RENDER, "--display-luminance", "90"), "--display-luminance"),
            ((*RENDER, "--shading", "path", "--rays", "1k"), "--rays"),
            ((*RENDER, "--shading", "smooth", "--denoise"), "--denoise"),
            ((*RENDER, "--denoise", "bad"), "--denoise"),
            ((*RENDER, "--size", "30000x30000"), "--size"),
            ((*RENDER, "--samples", "1"), "--samples"),
            ((*RENDER, "--until", "5%", "--samples", "64", "--max-samples", "8"), "--max-samples"),
            ((*RENDER, "--max-samples", "8"), "--max-samples"),
            (("probe", "room.mgf", "--point", "1,1,1", "--until", "5%", "--max-samples", "8"), "--max-samples"),
            ((*RENDER, "--dim", "desk=1"), "--dim"),
            (("probe", "room.mgf", "--point", "1,1,1", "--dim", "desk=1"), "--dim"),
            (("export", "room.mgf", "-o", "out.glb", "--dim", "desk=1"), "--dim"),
            (("probe", "room.mgf"), "--grid"),
            (("probe", "room.mgf", "--point", "1,1,1", "--direction", "1,0,0"), "--direction"),
            (("probe", "room.mgf", "--point", "1,1,1", "--quantity", "vertical"), "--direction"),
            (("probe", "room.mgf", "--point", "1,1,1", "--quantity", "ugr", "--direction", "0,0,0"), "--direction"),
        ):
            self.assert_wrong(arguments, option)

    def test_an_eye_needs_something_to_look_at(self):
        self.assert_wrong([*RENDER, "--eye", "1,1,1"], "--eye", "--look-at")
        self.assert_wrong([*RENDER, "--look-at", "1,1,1"], "--eye", "--look-at")


def options_of(help_text):
    return set(re.findall(r"^  (?:-\w,)?(--[\w-]+)", help_text, re.MULTILINE))


class Help(CommandTest):
    def test_names_every_subcommand(self):
        text = self.interflect("--help").stdout
        for word in (*SUBCOMMANDS, "--version", "Exit codes"):
            self.assertIn(word, text)

    def test_of_each_subcommand_tells_units_and_defaults(self):
        expected = {
            "info": ("SCENE", "--json"),
            "solve": ("--rays COUNT", "20M", "--time SECONDS", "--seed NUMBER=1", "--threads", "--stats FILE", "[m]"),
            "render": ("--view NAME", "--eye X,Y,Z", "[degrees]", "--size WxH=1280x720", "flat|smooth|hybrid|gather|path|instant=hybrid", "STOPS"),
            "compare": ("IMAGE", "REFERENCE", "--scale"),
            "bench": ("--rays COUNT=4M", "--rounds", "--picture", "hybrid|gather|path|instant=hybrid"),
            "make-scene": ("maze", "office", "boxes", "two-rooms"),
        }
        self.assertEqual(tuple(expected), SUBCOMMANDS)
        for subcommand, words in expected.items():
            text = self.interflect(subcommand, "--help-all").stdout
            for word in words:
                self.assertIn(word, text, subcommand)

    def test_shows_rare_options_on_request(self):
        for subcommand in ("solve", "render", "probe", "export", "validate", "info"):
            usual, all_of_it = (self.interflect(subcommand, option).stdout for option in ("--help", "--help-all"))
            self.assertLess(len(options_of(usual)), 50, subcommand)
            self.assertLess(options_of(usual), options_of(all_of_it), subcommand)
            self.assertIn("More options with --help-all: Reading the scene", usual)
            self.assertNotIn("--alpha", usual)
        self.assertLessEqual({"--alpha", "--min-area", "--importance"}, options_of(self.interflect("solve", "--help-all").stdout))

    def test_version(self):
        self.assertRegex(self.interflect("--version").stdout, r"^interflect \d+\.\d+\.\d+\n$")


if __name__ == "__main__":
    unittest.main()
