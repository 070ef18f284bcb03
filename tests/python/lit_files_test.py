"""Lightmaps added to the glTF file of a scene: parts of the file that stay, and irradiance against closed forms."""

import copy
import unittest

import command
import numpy as np
from gltf_files import Glb, LitPoints, sample

import interflect as ifl

HALF = float(np.sqrt(0.5))
INTENSITY = 1000.0  # [cd], of a point light at the origin
PLATE = np.array([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)], np.float32)
CUBE = np.array([(x, y, z) for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)], np.float32)
CUBE_FACES = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
# Each plate faces the origin: "turned" is twice as long, "mirrored" has a negative scale, "nested" has a parent.
PLATES = [
    {"name": "below", "mesh": 0, "translation": [0, 0, -2]},
    {"name": "turned", "mesh": 0, "translation": [3, 0, 0], "rotation": [0, -HALF, 0, HALF], "scale": [2, 0.5, 1]},
    {"name": "mirrored", "mesh": 0, "translation": [-3, 0, 0], "rotation": [0, HALF, 0, HALF], "scale": [-1, 1, 1]},
    {"name": "group", "children": [4], "translation": [0, -1, 0], "rotation": [-HALF, 0, 0, HALF], "extras": {"a": 1}},
    {"name": "nested", "mesh": 0, "translation": [0, 0, -1.5]},
    {"name": "cube", "mesh": 1, "translation": [0, 3, 0]},
    {"name": "lamp", "extensions": {"KHR_lights_punctual": {"light": 0}}},
    {"name": "eye", "camera": 0, "translation": [0, 0, 5]},
]


def quads(faces):
    return np.array([(a, b, c, a, c, d) for a, b, c, d in faces], np.uint16).ravel()


def encoded(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055)


def black(name, **more):
    surface = {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0, "roughnessFactor": 0.25}
    return {"name": name, "pbrMetallicRoughness": surface, **more}


def plates():
    """Black surfaces that see only a point light: H = I cos / r^2. Four nodes show the same plate;
    the corners of the cube are shared by its faces, and have a label and an offset of a morph target."""
    glb = Glb()
    plate = {"POSITION": glb.add(PLATE, bounds=True)}
    cube = {"POSITION": glb.add(CUBE, bounds=True), "_LABEL": glb.add(np.arange(8, dtype=np.uint8))}
    offset = {"POSITION": glb.add(np.zeros((8, 3), np.float32), bounds=True)}
    times = glb.add(np.array([0, 1], np.float32), bounds=True)
    glass = {"KHR_materials_transmission": {"transmissionFactor": 0}, "KHR_materials_ior": {"ior": 1.4}}
    glb.json |= {
        "scene": 0,
        "scenes": [{"nodes": [0, 1, 2, 3, 5, 6, 7]}],
        "nodes": copy.deepcopy(PLATES),
        "meshes": [
            {"name": "plate", "primitives": [{"attributes": plate, "indices": glb.add(quads([(0, 1, 2, 3)])), "material": 0}]},
            {"name": "cube", "weights": [0], "primitives": [
                {"attributes": cube, "targets": [offset], "indices": glb.add(quads(CUBE_FACES)), "material": 1}]},
        ],
        "materials": [black("tin"), black("pane", extensions=glass, alphaMode="OPAQUE")],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}],
        "animations": [{"channels": [{"sampler": 0, "target": {"node": 5, "path": "translation"}}], "samplers": [
            {"input": times, "output": glb.add(np.zeros((2, 3), np.float32))}]}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": INTENSITY}]}},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_ior"],
    }  # fmt: skip
    return glb


class LitFiles(command.CommandTest):
    def lit(self, glb, name="lit", rays="20k", exposure=0, **options):
        """Solves a scene and adds a lightmap to its file. Returns the paths of both."""
        glb.write(self.folder / f"{name}-source.glb")
        self.interflect("solve", f"{name}-source.glb", "--rays", rays, "-o", f"{name}.h5")
        solution = ifl.open_solution(self.folder / f"{name}.h5")
        ifl.export(solution, self.folder / f"{name}.glb", lightmap=True, exposure=exposure, **options)
        return self.folder / f"{name}-source.glb", self.folder / f"{name}.glb"

    def picture(self, file, texture):
        view = file.json["bufferViews"][file.json["images"][file.json["textures"][texture]["source"]]["bufferView"]]
        path = self.folder / "picture.png"
        path.write_bytes(file.binary[view.get("byteOffset", 0) :][: view["byteLength"]])
        return ifl.read_image(path)

    def assert_exact(self, path):
        """Compares with H = I cos / r^2. A texel is 5 cm wide at 1.5 m or more from the light: within 2%, 4 times as
        wide on the cube of one test."""
        lit = LitPoints(path)
        distance = np.linalg.norm(lit.positions, axis=1)
        cosine = -np.sum(lit.positions * lit.normals, axis=1) / distance
        expected = INTENSITY * np.maximum(0, cosine) / distance**2
        for name in set(lit.names):
            of_node = lit.names == name
            np.testing.assert_allclose(lit.irradiance[of_node, 1], expected[of_node], rtol=0.02, atol=1, err_msg=name)
            self.assertGreater(expected[of_node].max(), 50)
        self.assertEqual(len(set(lit.names)), 5)


class Light(LitFiles):
    def test_is_exact_on_every_node(self):
        self.assert_exact(self.lit(plates())[1])

    def test_is_exact_in_several_images(self):
        path = self.lit(plates(), max_size=64)[1]
        self.assert_exact(path)
        materials = Glb.read(path).json["materials"]
        self.assertGreater(len(materials), 2)  # a material for each image
        self.assertEqual({material["name"] for material in materials}, {"tin", "pane"})

    def test_is_exact_beside_textures_that_use_the_second_coordinates(self):
        glb = plates()
        coordinates = glb.add(np.full((4, 2), 0.25, np.float32))
        glb.json["meshes"][0]["primitives"][0]["attributes"] |= {"TEXCOORD_0": coordinates, "TEXCOORD_1": coordinates}
        image = {"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNgAAAAAgABSK+kcQAAAABJRU5ErkJggg=="}
        glb.json |= {"images": [image], "textures": [{"source": 0}]}
        glb.json["materials"][0]["occlusionTexture"] = {"index": 0, "texCoord": 1}
        path = self.lit(glb)[1]
        self.assert_exact(path)
        for _, _, primitive in Glb.read(path).primitives():
            self.assertIn("TEXCOORD_2", primitive["attributes"])
            if primitive["material"] == 0:
                self.assertEqual(primitive["attributes"]["TEXCOORD_1"], coordinates)

    def test_of_a_wall_with_two_lit_sides_is_that_of_its_front(self):
        """The lamp behind the plate is brighter than the lamp in front. Mirroring does not swap front and back."""
        for x in (1, -1):
            with self.subTest(scale=x):
                glb = plates()
                glb.json["materials"][0]["doubleSided"] = True
                lights = glb.json["extensions"]["KHR_lights_punctual"]["lights"]
                lights.append({"type": "point", "intensity": 4 * INTENSITY})
                glb.json["nodes"][0]["scale"] = [x, 1, 1]
                glb.json["nodes"].append({"translation": [0, 0, -4], "extensions": {"KHR_lights_punctual": {"light": 1}}})
                glb.json["scenes"][0]["nodes"] = [0, 6, 8]
                with self.assertWarnsRegex(ifl.Warning, "below.*lit on both sides"):
                    path = self.lit(glb)[1]
                np.testing.assert_allclose(LitPoints(path).irradiance[:, 1].max(), INTENSITY / 4, rtol=0.01)

    def test_of_a_floor_is_dark_behind_a_wall_even_if_its_back_is_lit(self):
        """One lamp on one side of the wall, one below the floor."""
        glb = plates()
        wall = {"mesh": 0, "rotation": [0, HALF, 0, HALF], "scale": [6, 4, 1]}
        lamp = {"extensions": {"KHR_lights_punctual": {"light": 0}}}
        glb.json["nodes"] = [
            {"name": "floor", "mesh": 0, "scale": [4, 4, 1], "translation": [0, 0, -3]},
            {"name": "wall", **wall},
            {"translation": [2, 0, -1], **lamp},
            {"translation": [0, 0, -5], **lamp},
        ]
        glb.json["scenes"][0]["nodes"] = [0, 1, 2, 3]
        lit = LitPoints(self.lit(glb)[1])
        floor, x = lit.names == "floor", lit.positions[:, 0]
        self.assertGreater((floor & (x < -0.1)).sum(), 20)
        self.assertLess(lit.irradiance[floor & (x < -0.1)].max(), 1)
        self.assertGreater(lit.irradiance[floor & (x > 0.1), 1].min(), 50)

    def test_of_a_floor_continues_below_a_crate(self):
        """Dark texels below the crate would darken the interpolated light at its edges."""
        glb = plates()
        lamp = np.array((2, 0, -1))
        glb.json["nodes"] = [
            {"name": "floor", "mesh": 0, "scale": [4, 4, 1], "translation": [0, 0, -3]},
            {"name": "crate", "mesh": 1, "translation": [0.013, 0.017, -2.5]},
            {"translation": lamp.tolist(), "extensions": {"KHR_lights_punctual": {"light": 0}}},
        ]
        glb.json["scenes"][0]["nodes"] = [0, 1, 2]
        lit = LitPoints(self.lit(glb)[1], count=4000)
        x, y, _ = (lit.positions - (0.013, 0.017, 0)).T
        below = (lit.names == "floor") & (x < 0.499) & (x > 0.46) & (np.abs(y) < 0.4)
        expected = 2 * INTENSITY / np.linalg.norm(lit.positions[below] - lamp, axis=1) ** 3
        self.assertGreater(below.sum(), 10)
        np.testing.assert_allclose(lit.irradiance[below, 1], expected, rtol=0.1)
        # Multisampling shows the bottom of the crate along its edges.
        bottom = (lit.names == "crate") & (lit.normals[:, 2] < -0.9) & (x > 0.46) & (np.abs(y) < 0.4)
        self.assertGreater(bottom.sum(), 10)
        self.assertGreater(lit.irradiance[bottom, 1].min(), 0.5 * expected.min())


class File(LitFiles):
    def test_keeps_all_but_lights(self):
        source, path = self.lit(plates())
        before, after = Glb.read(source), Glb.read(path)
        self.assertEqual(after.binary[: len(before.binary)], before.binary)
        for key in ("scene", "scenes", "cameras", "animations"):
            self.assertEqual(after.json[key], before.json[key], key)
        for key in ("accessors", "bufferViews"):
            self.assertEqual(after.json[key][: len(before.json[key])], before.json[key], key)
        for old, new in zip(before.json["nodes"], after.json["nodes"], strict=True):
            self.assertEqual({**new, "mesh": 0, "extensions": 0}, {**old, "mesh": 0, "extensions": 0})
            self.assertNotIn("extensions", new)  # of the lamp
        for old, new in zip(before.json["materials"], after.json["materials"], strict=True):
            extensions = {**new["extensions"]}
            self.assertEqual(extensions.pop("MOZ_lightmap")["texCoord"], 1)
            self.assertEqual({**new, "extensions": extensions}, {**old, "extensions": old.get("extensions", {})})
        self.assertNotIn("extensions", after.json)
        self.assertNotIn("KHR_lights_punctual", after.json["extensionsUsed"])

    def test_shows_a_mesh_at_several_places_with_the_same_accessors(self):
        path = self.lit(plates())[1]
        shared = [p["attributes"]["POSITION"] for name, _, p in Glb.read(path).primitives() if name != "cube"]
        own = [p["attributes"]["TEXCOORD_1"] for name, _, p in Glb.read(path).primitives() if name != "cube"]
        self.assertEqual((len(shared), len(set(shared)), len(set(own))), (4, 1, 4))

    def test_copies_vertices_where_charts_meet(self):
        file = Glb.read(self.lit(plates())[1])
        primitive = file.json["meshes"][1]["primitives"][0]
        positions = file.values(primitive["attributes"]["POSITION"])
        labels = file.values(primitive["attributes"]["_LABEL"]).ravel()
        corners = file.values(primitive["indices"]).ravel()
        self.assertEqual(len(positions), 24)  # each corner of a cube is in three charts
        np.testing.assert_array_equal(positions, CUBE[labels])
        np.testing.assert_array_equal(labels[corners], quads(CUBE_FACES))
        self.assertEqual(file.json["accessors"][primitive["targets"][0]["POSITION"]]["count"], 24)

    def test_keeps_lights_on_request(self):
        source, path = self.lit(plates(), keep_lights=True)
        self.assertEqual(Glb.read(path).json["extensions"], Glb.read(source).json["extensions"])

    def test_has_the_emission_of_the_exposure(self):
        glb = plates()
        glb.json["materials"][0]["emissiveFactor"] = [1, 0.5, 0]
        glb.write(self.folder / "lamp.glb")
        self.interflect("solve", "lamp.glb", "--rays", "20k", "-o", "lamp.h5")
        solution = ifl.open_solution(self.folder / "lamp.h5")
        ifl.export(solution, self.folder / "lit.glb", lightmap=True, exposure=-3)
        extensions = Glb.read(self.folder / "lit.glb").json["materials"][0]["extensions"]
        self.assertEqual(extensions["KHR_materials_emissive_strength"], {"emissiveStrength": 0.125})

    def test_shows_radiance_without_an_extension_of_lightmaps(self):
        glb = plates()
        glb.json["scenes"][0]["nodes"] = [0, 5, 6]
        surface = {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}
        glb.json["materials"] = [{"name": "paint", "pbrMetallicRoughness": surface}, {"name": "gold"}]  # a metal
        file = Glb.read(self.lit(glb, content="radiance")[1])
        (_, matrix, plate), (_, _, cube) = file.primitives()
        paint = file.json["materials"][plate["material"]]
        self.assertEqual((paint["name"], paint["extensions"]), ("paint", {"KHR_materials_unlit": {}}))
        texture = paint["pbrMetallicRoughness"]["baseColorTexture"]
        image = ifl.read_image(self.folder / "lit.lightmap-0.exr")
        corners = file.values(plate["attributes"][f"TEXCOORD_{texture['texCoord']}"])
        middle = sample(image, corners.mean(axis=0))
        np.testing.assert_allclose(middle, 0.5 / np.pi * INTENSITY / 2**2, rtol=0.02)  # some light of the metal's edges
        self.assertEqual(file.json["materials"][cube["material"]], {"name": "gold"})
        variants = [variant["name"] for variant in file.json["extensions"]["KHR_materials_variants"]["variants"]]
        mappings = plate["extensions"]["KHR_materials_variants"]["mappings"]
        shown = {variants[mapping["variants"][0]]: mapping["material"] for mapping in mappings}
        self.assertEqual(shown, {"lit": plate["material"], "authored": 0})

    def test_has_the_gain_of_texels_that_are_too_bright_for_8_bits(self):
        self.lit(plates())
        ifl.export(ifl.open_solution(self.folder / "lit.h5"), self.folder / "lit.glb", lightmap=True, exposure=-1)
        file = Glb.read(self.folder / "lit.glb")
        lightmap = file.json["materials"][0]["extensions"]["MOZ_lightmap"]
        gain = lightmap["extras"]["gain"]
        texels, gains = (self.picture(file, index) for index in (lightmap["index"], gain["index"]))
        light = ifl.read_image(self.folder / "lit.lightmap-0.exr") * 2.0**-1  # as the viewer shows it
        self.assertGreater(light.max(), 8 * np.pi)  # the limit without a gain
        found = texels * 2 ** (gain["stops"] * encoded(gains)) * lightmap["intensity"]
        bright = light > 0.05 * light.max()
        np.testing.assert_allclose(found[bright], light[bright], rtol=0.01)
        self.assertAlmostEqual(float(encoded(gains).max()), 1, places=5)

    def test_is_solved_and_lit_again_as_the_author_s(self):
        glb = plates()
        white = {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}
        glb.json["materials"] = [
            {"name": "panel", "pbrMetallicRoughness": white, "emissiveFactor": [0, 0, 1]},
            {"name": "paint", "pbrMetallicRoughness": white},
        ]
        source, _ = self.lit(glb)
        for content in ("irradiance", "radiance"):
            with self.subTest(content):
                ifl.export(ifl.open_solution(self.folder / "lit.h5"), self.folder / "baked.glb", lightmap=True,
                           exposure=-3, content=content, keep_lights=True)
                with self.assertWarnsRegex(ifl.Warning, "baked.glb.*Interflect has baked this file"):
                    again = ifl.load(self.folder / "baked.glb")
                authored = ifl.load(source)
                self.assertEqual(again.views, authored.views)
                for found, expected in zip(again.materials, authored.materials, strict=True):
                    np.testing.assert_allclose([found.reflectance, found.exitance],
                                               [expected.reflectance, expected.exitance], rtol=1e-6)
                ifl.export(ifl.solve(again, rays=20_000), self.folder / "again.glb", lightmap=True, exposure=-3,
                           content=content, keep_lights=True)
                first, second = Glb.read(self.folder / "baked.glb").json, Glb.read(self.folder / "again.glb").json
                for part in ("materials", "extensions", "extensionsUsed", "nodes"):
                    self.assertEqual(second[part], first[part], part)

    def test_is_written_anew_if_it_has_changed(self):
        glb = plates()
        glb.write(self.folder / "plates.glb")
        self.interflect("solve", "plates.glb", "--rays", "20k", "-o", "plates.h5")
        solution = ifl.open_solution(self.folder / "plates.h5")
        glb.json["materials"][0]["name"] = "steel"
        glb.write(self.folder / "plates.glb")
        with self.assertWarnsRegex(ifl.Warning, "has changed since it was solved"):
            ifl.export(solution, self.folder / "lit.glb", lightmap=True)
        self.assertEqual(Glb.read(self.folder / "lit.glb").json["materials"][0]["name"], "tin")
        (self.folder / "plates.glb").unlink()
        with self.assertWarnsRegex(ifl.Warning, "is not there"):
            ifl.export(solution, self.folder / "lit.glb", lightmap=True)

    def test_is_written_anew_on_request(self):
        path = self.lit(plates(), keep_file=False)[1]
        self.assertNotIn("animations", Glb.read(path).json)

    def test_is_written_anew_from_another_unit(self):
        plates().write(self.folder / "plates.glb")
        self.interflect("solve", "plates.glb", "--unit", "2", "--rays", "20k", "-o", "plates.h5")
        solution = ifl.open_solution(self.folder / "plates.h5")
        with self.assertWarnsRegex(ifl.Warning, "another unit"):
            ifl.export(solution, self.folder / "lit.glb", lightmap=True)


class Update(LitFiles):
    def pictures(self, file):
        """Returns the light and its gains, in which a linear value is a byte."""
        lightmap = file.json["materials"][0]["extensions"]["MOZ_lightmap"]
        return lightmap, [self.picture(file, texture) for texture in (lightmap["index"], lightmap["extras"]["gain"]["index"])]

    def brighten(self, path, update):
        """Updates objects in three times the light."""
        brighter = plates()
        brighter.json["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = 3 * INTENSITY
        brighter.write(self.folder / "lit-source.glb")
        self.interflect("solve", "lit-source.glb", "--rays", "20k", "-o", "lit.h5")
        ifl.export(ifl.open_solution(self.folder / "lit.h5"), path, lightmap=True, update=update)

    def test_changes_the_texels_of_its_objects_alone(self):
        """A brighter lamp, beyond the range of the images. Seen to fail with the stops of the new light."""
        path = self.lit(plates(), exposure=-1)[1]
        before, light = Glb.read(path), ifl.read_image(self.folder / "lit.lightmap-0.exr")
        with self.assertWarnsRegex(ifl.Warning, "exceeds the range"):
            self.brighten(path, ["group.nested", "pane"])
        after = Glb.read(path)
        new_light = ifl.read_image(self.folder / "lit.lightmap-0.exr")
        changed = (new_light != light).any(axis=2)
        nested = 20 * 20
        self.assertGreater(changed.sum(), nested)
        self.assertLess(changed.sum(), 0.5 * changed.size)
        bright = changed & (light[:, :, 1] > 50)
        np.testing.assert_allclose(new_light[bright], 3 * light[bright], rtol=0.02)
        (encoding, old), (same_encoding, new) = self.pictures(before), self.pictures(after)
        self.assertEqual(same_encoding, encoding)
        for a, b in zip(old, new, strict=True):
            np.testing.assert_array_equal(a[~changed], b[~changed])
        self.assertGreater((old[0] != new[0]).sum(), 0)

    def test_keeps_the_scale(self):
        """The new light exceeds the scale, so it gets gains. Seen to fail with the scale of the new light."""
        path = self.lit(plates(), exposure=-8)[1]  # the scale is the brightest texel, 2 m from the light
        before = Glb.read(path).json["materials"][0]["extensions"]["MOZ_lightmap"]
        self.assertNotIn("extras", before)
        self.brighten(path, ["*.nested"])
        after = Glb.read(path).json["materials"][0]["extensions"]["MOZ_lightmap"]
        self.assertEqual(after["intensity"], before["intensity"])
        self.assertAlmostEqual(after["extras"]["gain"]["stops"], np.log2(3 * (2 / 2.5) ** 2), delta=0.02)

    def test_keeps_the_exposure(self):
        with self.assertRaisesRegex(ifl.InputError, "exposure"):
            self.lit(plates(), update=["group"])


class Density(LitFiles):
    def area(self, path, name):
        """Returns the number of texels below a node's triangles."""
        file = Glb.read(path)
        image = ifl.read_image(self.folder / f"{path.stem}.lightmap-0.exr")
        primitive = next(primitive for node, _, primitive in file.primitives() if node == name)
        corners = file.values(primitive["attributes"]["TEXCOORD_1"])[file.values(primitive["indices"]).ravel()]
        a, b, c = (corners.reshape(-1, 3, 2) * image.shape[1::-1]).transpose(1, 0, 2)
        return np.abs(np.cross(b - a, c - a)).sum() / 2

    def test_is_drawn_before_solving(self):
        """The lightmap has the same layout."""
        source, path = self.lit(plates(), densities={"tin": 10})
        log = self.interflect("export", source.name, "-o", "map.glb", "--lightmap", "--lightmap-content", "density",
                              "--density", "tin=10").stderr  # fmt: skip
        self.assertRegex(log, "nested: 10 of 10 texels per metre")
        self.assertNotIn("map.lightmap-0.exr", self.files())
        lit, drawn = Glb.read(path), Glb.read(self.folder / "map.glb")
        described = [file.json["asset"]["extras"]["interflect"]["lightmap"] for file in (lit, drawn)]
        self.assertEqual(described[1]["layout"], described[0]["layout"])
        for (name, _, a), (_, _, b) in zip(lit.primitives(), drawn.primitives(), strict=True):
            coordinates = [file.values(p["attributes"]["TEXCOORD_1"]) for file, p in ((lit, a), (drawn, b))]
            np.testing.assert_array_equal(*coordinates, err_msg=name)
            self.assertIn("KHR_materials_unlit", drawn.json["materials"][b["material"]]["extensions"])

    def test_is_that_of_the_pattern(self):
        path = self.lit(plates(), densities={"group.nest*": 40, "pane": 5, "b*": 80})[1]
        self.assert_exact(path)
        for name, density in (("nested", 40), ("below", 80), ("mirrored", 20)):
            self.assertAlmostEqual(self.area(path, name), density**2, delta=0.01 * density**2, msg=name)
        self.assertAlmostEqual(self.area(path, "cube"), 6 * 5**2, delta=1)  # of the material

    def test_is_that_of_the_file(self):
        """Precedence: option, node, material."""
        glb = plates()
        for node, density in ((0, 80), (1, 30), (2, 60)):
            glb.json["nodes"][node]["extras"] = {"texels_per_metre": density}
        for material in glb.json["materials"]:
            material["extras"] = {"texels_per_metre": 10, "rough": True}
        path = self.lit(glb, densities={"turned": 40})[1]
        self.assert_exact(path)
        for name, texels in (("below", 80**2), ("turned", 40**2), ("mirrored", 60**2), ("nested", 10**2), ("cube", 6 * 10**2)):
            self.assertAlmostEqual(self.area(path, name), texels, delta=0.01 * texels, msg=name)
        self.assertEqual(Glb.read(path).json["nodes"][0]["extras"], {"texels_per_metre": 80})

    def test_of_the_file_that_is_no_number_is_refused(self):
        for density in (-1, "20", None):
            glb = plates()
            glb.json["materials"][1]["extras"] = {"texels_per_metre": density}
            with self.subTest(density), self.assertRaisesRegex(ifl.InputError, r"materials\[1\] 'pane': extras.texels_per_metre"):
                self.lit(glb)

    def test_of_zero_leaves_surfaces_as_they_are(self):
        source, path = self.lit(plates(), densities={"turned": 10, "cube": 20, "*": 0})
        before, after = Glb.read(source), Glb.read(path)
        lit = {name for name, _, p in after.primitives() if "TEXCOORD_1" in p["attributes"]}
        self.assertEqual(lit, {"turned", "cube"})
        for (name, _, primitive), (_, _, old) in zip(after.primitives(), before.primitives(), strict=True):
            material = after.json["materials"][primitive["material"]]
            self.assertEqual("MOZ_lightmap" in material.get("extensions", {}), name in lit)
            if name not in lit:
                self.assertEqual((primitive, material), (old, before.json["materials"][old["material"]]))

    def test_of_zero_on_a_material_leaves_its_primitives_as_they_are(self):
        glb = plates()
        cube = glb.json["meshes"][1]["primitives"][0]
        sides = [{**cube, "indices": glb.add(quads(CUBE_FACES[i::2])), "material": i} for i in range(2)]
        glb.json["meshes"][1]["primitives"] = sides
        glb.json["scenes"][0]["nodes"] = [5, 6]
        file = Glb.read(self.lit(glb, densities={"tin": 0})[1])
        self.assertEqual([("TEXCOORD_1" in p["attributes"]) for _, _, p in file.primitives()], [False, True])
        self.assertEqual(file.json["materials"][0], black("tin"))

    def test_of_zero_everywhere_is_refused(self):
        with self.assertRaisesRegex(ValueError, "no surface gets a lightmap"):
            self.lit(plates(), densities={"*": 0})

    def test_of_zero_needs_the_scene_s_own_file(self):
        with self.assertRaisesRegex(ValueError, "the density of '\\*' is 0"):
            self.lit(plates(), densities={"*": 0}, keep_file=False)


class Layout(LitFiles):
    def coordinates(self, path):
        file = Glb.read(path)
        return [file.values(p["attributes"]["TEXCOORD_1"]).tolist() for _, _, p in file.primitives()]

    def test_does_not_depend_on_the_light(self):
        first = self.coordinates(self.lit(plates())[1])
        other = plates()
        other.json["extensions"]["KHR_lights_punctual"]["lights"][0] |= {"intensity": 7, "color": [1, 0.2, 0.1]}
        other.json["nodes"][6]["translation"] = [0.4, 0.3, -0.2]
        self.assertEqual(first, self.coordinates(self.lit(other, "other", rays="100k", samples=4, seed=5)[1]))


if __name__ == "__main__":
    unittest.main()
