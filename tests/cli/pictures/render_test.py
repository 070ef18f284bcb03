"""Pictures: reproducible, of the requested view, and labelled with their origin."""

import math
import os
import re
import struct
import unittest
import unittest.mock

from command import BAD_INPUT, LARGE, PAINT, SMALL, SOLVED, VIEW, WRONG_USAGE, CommandTest, RenderTest, room, vertices


def exr_attributes(content):
    """Returns the header of a single-part OpenEXR file: name -> (type, bytes)."""
    magic, version = struct.unpack_from("<ii", content)
    assert (magic, version) == (20000630, 2), "not a plain OpenEXR file"

    def text(start):
        end = content.index(b"\0", start)
        return content[start:end].decode(), end + 1

    attributes, position = {}, 8
    while content[position] != 0:
        name, position = text(position)
        kind, position = text(position)
        (size,) = struct.unpack_from("<i", content, position)
        position += 4
        attributes[name] = (kind, content[position : position + size])
        position += size
    return attributes


class Reproducibility(RenderTest):
    def test_same_bytes_on_any_number_of_threads(self):
        for kind in ("png", "exr", "hdr", "jpg"):
            one = self.render(f"one.{kind}", "--threads", "1")
            self.assertEqual(self.render(f"two.{kind}", "--threads", "2"), one, kind)

    def test_another_seed_other_bytes(self):
        self.assertNotEqual(self.render("one.hdr"), self.render("two.hdr", "--seed", "2"))

    def test_of_a_solution_and_of_its_scene_are_the_same(self):
        smallest = ("--min-area", "0.001")  # else by the pixels of the picture, which `solve` does not know
        self.solve("--view", "door", *smallest)  # the first view is the default of `render`
        for kind in ("png", "exr"):
            from_scene = self.render(f"scene.{kind}", *smallest)
            self.assertEqual(self.render(f"solution.{kind}", source="room.h5"), from_scene, kind)


class Views(RenderTest):
    def picture(self, *options, source="room.mgf"):
        return self.render("picture.hdr", *options, source=source)

    def test_all_ways_to_name_a_view_agree(self):
        self.write("door.vf", "rvu -vtv -vp .3 .2 1.6 -vd .9 2.8 -.6 -vu 0 0 1 -vh 73.7 -vv 45\n")
        by_name = self.picture("--view", "door")
        self.assertEqual(self.picture(), by_name)
        self.assertEqual(self.picture(*VIEW), by_name)
        self.assertEqual(self.picture(*VIEW, "--fov", "45", "--up", "0,0,2"), by_name)
        # A view file has a direction instead of a point: the same picture except for rounding.
        self.render("eye.exr", "--view", "door")
        self.render("file.exr", "--view-file", "door.vf")
        self.assertLess(self.json("compare", "file.exr", "eye.exr")["blocks"][1]["relative_rmse"], 0.02)

    def test_other_views_are_other_pictures(self):
        pictures = [
            self.picture("--view", "door"),
            self.picture("--view", "floor"),
            self.picture(*VIEW, "--fov", "60"),
            self.picture(*VIEW, "--up", "1,0,0"),
        ]
        self.assertEqual(len(set(pictures)), len(pictures))

    def test_a_solution_remembers_the_view_that_was_asked_for(self):
        self.solve("--view", "floor")
        floor = self.picture("--view", "floor", source="room.h5")
        self.assertEqual(self.picture(source="room.h5"), floor)
        self.assertNotEqual(self.picture("--view", "door", source="room.h5"), floor)

    def test_a_view_finer_than_the_directions_of_rays_is_refused_before_work(self):
        for shading in ("hybrid", "path"):
            narrow = (*VIEW, "--fov", "0.01", "--size", "32x32768", "--shading", shading)
            said = self.interflect("render", "room.mgf", "-o", "out.png", *narrow, exit_code=BAD_INPUT).stderr
            self.assertIn("finer than the directions of rays", said)
            self.assertNotIn("info:", said)

    def test_without_any_view_there_is_an_overview_and_a_warning(self):
        (self.folder / "room.views.json").unlink()
        result = self.interflect("render", "room.mgf", "-o", "out.png", *SMALL, *SOLVED)
        self.assertIn("warning: room.mgf names no view", result.stderr)
        self.assertIn("--eye", result.stderr)


class Shown(RenderTest):
    QUANTITIES = ("irradiance", "importance", "direct-importance", "level", "rays", "error")

    def test_each_quantity_and_the_mesh_is_a_picture_of_its_own(self):
        self.solve("--view", "door")
        pictures = [self.render("out.png", "--show", shown, source="room.h5") for shown in (*self.QUANTITIES, "light", "mesh")]
        self.assertEqual(len(set(pictures)), len(pictures))

    def test_exr_has_the_numbers(self):
        self.solve("--view", "door")
        attributes = exr_attributes(self.render("out.exr", "--show", "importance", source="room.h5"))
        self.assertEqual(attributes["interflect.quantity"][1], b"importance [1/m^2]")

    def test_a_legend_is_within_the_size_that_was_asked_for(self):
        self.solve()

        def draw(width, height):
            size = ("--size", f"{width}x{height}", "--samples", "1")
            said = self.interflect("render", "room.h5", "-o", "out.png", "--show", "irradiance", *size).stderr
            self.assertEqual(struct.unpack_from(">II", self.bytes("out.png"), 16), (width, height))
            return said

        for size in ((640, 360), (240, 135), (204, 86)):
            self.assertNotIn("legend", draw(*size))
        for size in ((203, 135), (240, 85), (32, 18)):  # too narrow for numbers, too low
            self.assertIn(f"warning: {size[0]} x {size[1]} pixels have no room for a legend", draw(*size))

    def test_what_is_not_there_is_refused(self):
        self.solve()
        result = self.interflect("render", "room.h5", "-o", "out.png", "--show", "importance", exit_code=BAD_INPUT)
        self.assertIn("without a view", result.stderr)
        result = self.interflect("render", "room.h5", "-o", "out.exr", "--show", "mesh", exit_code=WRONG_USAGE)
        self.assertIn(".png", result.stderr)
        self.assertEqual(self.files(), ["room.h5", "room.mgf", "room.views.json"])

    def test_elements_have_flat_or_smooth_shading(self):
        def said(*options):
            render = ("render", "room.mgf", "-o", "out.png", *SMALL)
            return self.interflect(*render, *options, exit_code=WRONG_USAGE).stderr

        for shading in ("hybrid", "gather"):
            for more in ((), ("--denoise", "own")):
                text = said("--shading", shading, "--show", "mesh", *more)
                for word in ("--shading", "--show", shading):
                    self.assertIn(word, text, (shading, more))
        self.assertIn("--show draws", said("--show", "mesh", "--denoise", "own"))


class FalseColours(RenderTest):
    def test_exr_has_the_numbers(self):
        self.solve()
        for name, quantity in (("lux", b"illuminance [lx]"), ("cd/m2", b"luminance [cd/m^2]")):
            attributes = exr_attributes(self.render("out.exr", "--false-colour", name, source="room.h5"))
            self.assertEqual(attributes["interflect.quantity"][1], quantity)

    def test_illuminance_is_the_irradiance_of_the_elements(self):
        """If all visible surfaces are equal and emit no light, luminance is rho / pi times illuminance. It is slightly
        higher here, because the paint and the light in the room are warm."""
        self.solve()
        floor = ("--view", "floor", "--shading", "flat")
        self.render("lux.exr", "--false-colour", "lux", *floor, source="room.h5")
        self.render("elements.exr", "--show", "irradiance", *floor, source="room.h5")
        self.assertAlmostEqual(self.json("compare", "lux.exr", "elements.exr")["ratio_of_means"], 1, places=6)
        self.render("luminance.exr", "--false-colour", "cd/m2", *floor, source="room.h5")
        ratio = self.json("compare", "luminance.exr", "lux.exr")["ratio_of_means"]
        self.assertAlmostEqual(ratio, 0.6 / math.pi, delta=0.01)

    def test_pictures_differ_by_scale_and_lines(self):
        self.solve()
        lux = ("--false-colour", "lux")
        size = ("--size", "240x160", "--samples", "4", "--shading", "flat")
        choices = ((), ("--logarithmic",), ("--scale", "10..2000"), ("--scale", "10..2000", "--logarithmic"),
                   ("--isolines", "auto"), ("--isolines", "60,100"))
        pictures = [self.render("out.png", *lux, *more, source="room.h5", size=size) for more in choices]
        self.assertEqual(len(set(pictures)), len(pictures))
        for picture in pictures:
            self.assertEqual(struct.unpack_from(">II", picture, 16), (240, 160))

    def test_what_has_no_effect_is_refused_or_told(self):
        self.solve()

        def said(*options, exit_code=WRONG_USAGE, name="out.png"):
            return self.interflect("render", "room.h5", "-o", name, *SMALL, *options, exit_code=exit_code).stderr

        for options in (("--scale", "1..2"), ("--logarithmic",), ("--isolines", "auto")):
            self.assertIn("--false-colour", said(*options))
        lux = ("--false-colour", "lux")
        for word in ("--false-colour", "--show"):
            self.assertIn(word, said(*lux, "--show", "mesh"))
        self.assertIn("logarithmic", said(*lux, "--scale", "0..5", "--logarithmic"))
        self.assertIn("--isolines", said(*lux, "--isolines", "5", exit_code=0, name="out.exr"))
        self.assertIn("--tonemap has no effect", said(*lux, "--tonemap", "agx", exit_code=0))


class PlansAndSections(RenderTest):
    """The room is 2 x 3 m and 2.5 m high; its lamp hangs at 2.4 m."""

    LUX = ("--false-colour", "lux")

    def said(self, name, *options, source="room.h5", exit_code=0):
        return self.interflect("render", source, "-o", name, *options, exit_code=exit_code).stderr

    def ratio(self, image, reference):
        return self.json("compare", image, reference)["ratio_of_means"]

    def test_are_to_scale(self):
        self.solve()
        flat = ("--shading", "flat", *self.LUX, "--samples", "4")
        self.assertIn("plan: 2 x 3 m, a pixel is 50 mm",
                      self.said("near.exr", "--plan", "1", "--extent", "3", "--size", "40x60", *flat))
        self.said("far.exr", "--plan", "1", "--extent", "6", "--size", "40x60", *flat)
        self.assertAlmostEqual(self.ratio("near.exr", "far.exr"), 4, delta=0.02)
        self.said("half.exr", "--plan", "1", "--extent", "3", "--centre", "2,1.5,9", "--size", "40x60", *flat)
        self.assertAlmostEqual(self.ratio("near.exr", "half.exr"), 2, delta=0.2)

    def test_ways_to_name_a_cut_agree(self):
        self.solve()
        size = ("--size", "32x32", "--shading", "flat")
        self.said("plan.hdr", "--plan", "1", *size)
        self.said("section.hdr", "--section", "-z=1", *size)
        self.said("general.hdr", "--section", "7,8,1,0,0,-3", *size)
        self.said("up.hdr", "--section", "z=1", *size)
        self.assertEqual(self.bytes("section.hdr"), self.bytes("plan.hdr"))
        self.assertEqual(self.bytes("general.hdr"), self.bytes("plan.hdr"))
        self.assertNotEqual(self.bytes("up.hdr"), self.bytes("plan.hdr"))

    def test_a_scene_is_solved_without_importance(self):
        said = self.said("out.png", "--plan", "1", *SMALL, *SOLVED, source="room.mgf")
        self.assertIn("hsrr:", said)
        self.assertNotIn("ihsrr", said)
        self.assertNotIn("warning", said)

    def test_what_makes_no_sense_is_refused(self):
        self.solve()
        for other in (("--view", "door"), VIEW, ("--section", "x=1")):
            self.assertIn("--plan", self.said("out.png", "--plan", "1", *other, exit_code=WRONG_USAGE))
        for option in (("--extent", "3"), ("--centre", "1,1,1")):
            self.assertIn("--plan", self.said("out.png", *option, exit_code=WRONG_USAGE))

    def test_a_cut_beyond_the_scene(self):
        self.solve()
        said = self.said("out.exr", "--plan", "-3", *SMALL)
        self.assertIn("warning: plan: the whole scene lies in front of the cut", said)
        self.assertIn("warning: the view shows no light: it meets no surface", said)

    def test_exr_has_the_extent(self):
        self.solve()
        attributes = exr_attributes(self.render("out.exr", "--plan", "1", "--extent", "5", source="room.h5"))
        self.assertEqual(attributes["interflect.extent"], ("float", struct.pack("<f", 5)))
        self.assertNotIn("interflect.fov", attributes)


class Methods(RenderTest):

    def test_importance_where_every_ray_is_kept_is_refused(self):
        arguments = ("render", "room.mgf", "-o", "out.png", "--method", "wdrs", "--importance", "full")
        self.assertIn("importance", self.interflect(*arguments, exit_code=BAD_INPUT).stderr)


class OptionsWithoutEffect(RenderTest):
    """Options without effect are refused, or reported as ignored if a script may well pass them for all formats."""

    def refused(self, *options):
        before = self.files()
        result = self.interflect("render", "room.h5", "-o", "out.png", *SMALL, *options, exit_code=WRONG_USAGE)
        self.assertEqual(self.files(), before)
        return result.stderr

    def test_progressive_pictures_need_time_a_file_and_light(self):
        os.mkfifo(self.folder / "pipe.png")
        for options in (("-o", "a.png", "--time", "5"), ("-o", "a.png", "--show", "level"), ("-o", "pipe.png")):
            result = self.interflect("render", "room.mgf", "--progressive", *options, exit_code=WRONG_USAGE)
            self.assertIn("--progressive", result.stderr)

    def test_a_solution_is_not_solved_again(self):
        self.solve()
        for option, value in {
            "--rays": "5M",
            "--time": "10",
            "--until": "5%",
            "--method": "srr",
            "--seed": "2",
            "--min-area": "0.1",
            "--mesh-size": "0.1",
            "--epsilon": "1e-6",
            "--importance": "off",
            "--curve-divisions": "3",
            "--unit": "cm",
            "--up-axis": "y",
            "--max-patches": "1M",
            "--stats": "stats.json",
        }.items():
            self.assertIn(
                f"{option}: it has no effect on room.h5, which is solved already: expected a scene",
                self.refused("--shading", "smooth", option, value),
            )
        self.assertIn("--contact-cuts: it has no effect", self.refused("--contact-cuts"))
        self.assertIn("--no-contact-cuts: it has no effect", self.refused("--no-contact-cuts"))
        self.assertIn("--mirrors: only --shading", self.refused("--shading", "flat", "--mirrors"))
        self.assertIn("--no-mirrors: only --shading", self.refused("--shading", "flat", "--no-mirrors"))
        self.assertIn("--rays", self.refused("--shading", "path", "--rays", "5M"))
        self.assertIn("--max-patches", self.refused("--shading", "path", "--max-patches", "1M"))
        for shading in ("path", "gather"):
            path = ("--shading", shading, "--samples", "2", "--seed", "3", "--until", "50%", "--threads", "1")
            self.interflect("render", "room.h5", "-o", "out.png", "--size", "8x4", *path)

    def test_linear_formats_are_not_exposed_and_quantities_not_tone_mapped(self):
        self.solve()

        def said(name, *options):
            return self.interflect("render", "room.h5", "-o", name, *SMALL, *options).stderr

        for name in ("a.hdr", "a.exr"):
            self.assertIn("warning: --exposure does not change linear values", said(name, "--exposure", "3"))
            self.assertNotIn("exposure", said(name))
        self.assertIn("warning: --tonemap does not change linear values", said("a.hdr", "--tonemap", "srgb"))
        self.assertIn("warning: --exposure has no effect", said("a.png", "--exposure", "3", "--show", "level"))
        self.assertNotIn("warning", said("a.png", "--exposure", "3", "--tonemap", "srgb"))


class Pictures(RenderTest):
    def test_exr_tells_how_it_came_to_be(self):
        content = self.render("out.exr", "--view", "floor", "--seed", "7")
        attributes = exr_attributes(content)
        expected = {
            "interflect.view": "floor",
            "interflect.seed": "7",
            "interflect.quantity": "radiance [cd/m^2]",
            "interflect.scene": "room.mgf",
            "interflect.version": self.interflect("--version").stdout.split()[1],
        }
        for name, value in expected.items():
            self.assertEqual(attributes[name], ("string", value.encode()), name)
        for name, vector in (("eye", (1, 0.1, 2.2)), ("look_at", (1, 2, 0)), ("up", (0, 0, 1))):
            kind, layout = ("v3f", "<3f") if name == "up" else ("v3d", "<3d")
            self.assertEqual(attributes["interflect." + name], (kind, struct.pack(layout, *vector)))
        self.assertEqual(attributes["interflect.fov"], ("float", struct.pack("<f", 60)))
        self.assertEqual(attributes["dataWindow"], ("box2i", struct.pack("<4i", 0, 0, 31, 17)))

    def test_png_has_the_size_that_was_asked_for(self):
        content = self.render("out.png", size=LARGE)
        self.assertEqual(content[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack_from(">II", content, 16), (96, 54))

    def test_exposure_is_in_stops(self):
        for stops in (-9, -8):
            self.render(f"{stops + 9}.png", "--tonemap", "srgb", "--exposure", stops)
        # PNG is read back as linear values: one more stop doubles the brightness, up to 8-bit rounding.
        self.assertAlmostEqual(self.json("compare", "1.png", "0.png")["ratio_of_means"], 2, delta=0.05)

    def test_exposure_relative_to_the_automatic_one(self):
        self.solve()

        def exposure(*options):
            said = self.interflect("render", "room.h5", "-o", "out.png", *SMALL, *options).stderr
            return float(re.search(r"exposure ([+-][\d.]+)", said)[1])

        automatic = exposure()
        self.assertEqual(exposure("--exposure", "auto"), automatic)
        self.assertAlmostEqual(exposure("--exposure", "auto+1"), automatic + 1, delta=0.011)
        self.assertAlmostEqual(exposure("--exposure", "auto-0.5"), automatic - 0.5, delta=0.011)
        self.assertEqual(exposure("--exposure", "+1.5"), 1.5)

    def test_operators_make_pictures_of_their_own(self):
        self.solve()
        names = ("srgb", "reinhard", "filmic", "agx", "ward", "tumblin", "ferwerda")
        pictures = [self.render("out.png", "--tonemap", name, source="room.h5") for name in names]
        self.assertEqual(len(set(pictures)), len(pictures))
        self.assertEqual(self.render("out.png", source="room.h5"), pictures[0], "srgb is the default")

    def test_operators_of_absolute_luminance_choose_the_brightness(self):
        self.solve()

        def draw(*options):
            arguments = ("render", "room.h5", "-o", "out.png", *SMALL, *options)
            return self.interflect(*arguments).stderr, self.bytes("out.png")

        ward = ("--tonemap", "ward")
        said, plain = draw(*ward)
        self.assertIn("exposure +0.00", said)
        self.assertEqual(draw(*ward, "--exposure", "0")[1], plain)
        self.assertEqual(draw(*ward, "--exposure", "auto-1")[1], draw(*ward, "--exposure", "-1")[1])
        self.assertEqual(draw(*ward, "--display-luminance", "100")[1], plain)
        self.assertNotEqual(draw(*ward, "--display-luminance", "500")[1], plain)
        refused = ("render", "room.h5", "-o", "no.png", "--display-luminance", "500")
        self.assertIn("--tonemap ward", self.interflect(*refused, exit_code=WRONG_USAGE).stderr)

    def test_exposure_does_not_touch_linear_pictures(self):
        self.assertEqual(self.render("a.hdr"), self.render("b.hdr", "--exposure", "3"))

    def test_shading(self):
        self.assertNotEqual(self.render("flat.hdr", "--shading", "flat"), self.render("smooth.hdr"))

    def test_without_light_it_is_black(self):
        self.write("dark.mgf", room().replace("ed 1000", "ed 0"))
        self.render("dark.exr", *VIEW, source="dark.mgf")
        self.render("dark.png", *VIEW, source="dark.mgf")
        self.render("lit.exr", *VIEW)
        self.render("lit.png", *VIEW)
        for kind in ("exr", "png"):
            difference = self.json("compare", f"dark.{kind}", f"lit.{kind}")
            self.assertEqual(difference["ratio_of_means"], 0)
            self.assertEqual(difference["non_finite_pixels"], 0)


class SampledLight(RenderTest):
    def setUp(self):
        super().setUp()
        self.solve()

    def gathered(self, name, *options):
        return self.interflect("render", "room.h5", "-o", name, *SMALL, *VIEW, *options).stderr

    def test_pictures_for_people_are_filtered_unless_refused(self):
        for kind, filtered in (("png", True), ("exr", False)):
            pictures = {}
            for option in ("", "--denoise", "--no-denoise"):
                self.gathered(f"out.{kind}", *filter(None, [option]))
                pictures[option] = self.bytes(f"out.{kind}")
            self.assertEqual(pictures[""], pictures["--denoise" if filtered else "--no-denoise"])
            self.assertNotEqual(pictures["--denoise"], pictures["--no-denoise"])

    def test_the_own_filter_replaces_a_library_that_cannot_be_loaded(self):
        self.enterContext(unittest.mock.patch.dict(os.environ, INTERFLECT_OIDN="none"))
        options = ("render", "room.h5", *SMALL, *VIEW)
        refused = self.interflect(*options, "-o", "no.png", "--denoise=oidn", exit_code=WRONG_USAGE)
        self.assertIn("INTERFLECT_OIDN: cannot load", refused.stderr)
        for filter_name in ("auto", "own"):
            self.interflect(*options, "-o", f"{filter_name}.png", f"--denoise={filter_name}")
        self.assertEqual(self.bytes("auto.png"), self.bytes("own.png"))

    def test_layers_lie_beside_the_picture(self):
        self.gathered("out.exr", "--layers")
        _, channels = exr_attributes(self.bytes("out.exr"))["channels"]
        names = {name.decode() for name in re.findall(rb"([A-Za-z_.]+)\0", channels)}
        for layer in ("", "emitted.", "direct.", "indirect.", "albedo.", "standard_error."):
            self.assertLessEqual({layer + c for c in "RGB"}, names)
        self.assertLessEqual({"normal.X", "depth.Z", "element_level.V", "direct_variance.V"}, names)
        refused = self.interflect("render", "room.h5", "-o", "out.png", "--layers", exit_code=WRONG_USAGE).stderr
        self.assertIn(".exr", refused)


class PathTracing(CommandTest):
    """Options, messages and refusals; shadings_test.py compares the pictures."""

    SIZE = ("--size", "32x18")
    PATH = ("--shading", "path", *SIZE)

    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def trace(self, name, *options, source="room.mgf"):
        return self.interflect("render", source, "-o", name, *self.PATH, *VIEW, *options).stderr

    def test_does_not_solve_and_tells_its_error(self):
        log = self.trace("out.exr", "--samples", "64")
        self.assertRegex(log, r"info: path tracing: 36\.9 k paths, .* rays in .*, estimated relative error [\d.]+% a pixel")
        self.assertRegex(log, r"100%  .* rays, .*/s, error [\d.]+%")
        self.assertNotIn("elements", log)

    def test_same_bytes_on_any_number_of_threads(self):
        def run(name, *options):
            self.trace(f"{name}.exr", "--until", "20%", "--error-image", f"{name}-error.exr", *options)
            return self.bytes(f"{name}.exr"), self.bytes(f"{name}-error.exr")

        one = run("one", "--threads", "1")
        self.assertEqual(run("two", "--threads", "2"), one)
        self.assertNotEqual(run("seed", "--seed", "2"), one)
        self.assertNotEqual(one[0], one[1])
        attributes = exr_attributes(one[1])
        self.assertEqual(attributes["interflect.quantity"][1], b"standard error of radiance [cd/m^2]")

    def test_of_a_solution_its_scene_counts(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "10k")
        self.trace("scene.hdr")
        self.trace("solution.hdr", source="room.h5")
        self.assertEqual(self.bytes("solution.hdr"), self.bytes("scene.hdr"))

    def test_combinations_without_meaning_are_refused(self):
        render = ("render", "room.mgf", "-o", "out.exr", *self.SIZE, *VIEW)
        for options, word in (
            (("--shading", "path", "--show", "mesh"), "--show"),
            (("--shading", "path", "--show", "importance"), "--show"),
            (("--shading", "path", "--rays", "1M"), "--rays"),
            (("--shading", "path", "--method", "hsrr"), "--method"),
            (("--shading", "path", "--mesh-size", "0.1"), "--mesh-size"),
            (("--shading", "path", "--epsilon", "1e-6"), "--epsilon"),
            (("--shading", "path", "--importance", "full"), "--importance"),
            (("--shading", "path", "--max-samples", "99"), "--until"),
            (("--shading", "path", "--samples", "1"), "--samples"),
            (("--shading", "gather", "--samples", "1"), "--samples"),
            (("--shading", "path", "--until", "5%", "--max-samples", "3"), "--max-samples"),
            (("--shading", "gather", "--max-samples", "99"), "--until"),
            (("--shading", "path", "--error-image", "e.png"), "e.png"),
            (("--shading", "path", "--light-walks", "99"), "--light-walks"),
            (("--shading", "instant", "--light-walks", "0"), "--light-walks"),
            (("--shading", "instant", "--rays", "1M"), "--rays"),
            (("--shading", "flat", "--error-image", "e.exr"), "--error-image"),
            (("--shading", "flat", "--denoise"), "--denoise"),
            (("--show", "level", "--layers"), "--layers"),
            (("--shading", "flat", "--max-samples", "99"), "--max-samples"),
        ):
            stderr = self.interflect(*render, *options, exit_code=WRONG_USAGE).stderr
            self.assertIn(word, stderr, options)
        self.assertEqual(self.files(), ["room.mgf"])


ONE_SIDED = PAINT.replace("m paint =\n", "m paint =\n\tsides 1\n")


class Camera(CommandTest):
    """Views without surfaces, or from an impossible position, are drawn with a warning."""

    WARNING = "the camera seems to be outside the scene"

    def said(self, text, *options, view=VIEW):
        self.write("scene.mgf", text)
        return self.interflect(
            "render", "scene.mgf", "-o", "out.exr", *SMALL, "--rays", "20k", "--mesh-size", "1", *view, *options
        ).stderr

    def test_inside_there_is_no_warning(self):
        self.assertNotIn("warning", self.said(room()))
        self.assertNotIn("warning", self.said(self.dollhouse()))

    @staticmethod
    def dollhouse():
        """The room, with walls that are only visible from inside."""
        return room().replace(PAINT, ONE_SIDED)

    def test_outside_looking_through_the_backs_of_walls(self):
        said = self.said(self.dollhouse(), view=("--eye", "1,-4,1.2", "--look-at", "1,1,1.2", "--fov", "25"))
        self.assertRegex(said, self.WARNING + r": .* and \d+% is seen through the backs")

    def test_looking_away(self):
        said = self.said(room(), view=("--eye", "1,-4,1.2", "--look-at", "1,-9,1.2"))
        self.assertRegex(said, self.WARNING + ": 100% of the picture is empty")
        self.assertIn("the view shows no light: it meets no surface", said)

    def test_inside_a_closed_object(self):
        corners = [(0.1 + 0.4 * x, 0.1 + 0.4 * y, 1.4 + 0.4 * z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        faces = "f v0 v1 v3 v2\nf v4 v6 v7 v5\nf v0 v2 v6 v4\nf v1 v5 v7 v3\nf v0 v4 v5 v1\nf v2 v3 v7 v6\n"
        said = self.said(room() + vertices(*corners) + PAINT + faces)
        self.assertIn("the view shows no light: all that it sees is unlit; is the camera inside a closed object?", said)

    def test_in_the_dark(self):
        said = self.said(room().replace("ed 1000", "ed 0"))
        self.assertIn("warning: the view shows no light: the scene emits no light", said)
        self.write("dark.mgf", room().replace("ed 1000", "ed 0"))
        path = ("--shading", "path", "--samples", "2", "--size", "8x4")
        said = self.interflect("render", "dark.mgf", "-o", "out.png", *path, *VIEW).stderr
        self.assertIn("warning: the view shows no light", said)


if __name__ == "__main__":
    unittest.main()
