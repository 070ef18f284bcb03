"""The commands of docs/ are accepted: those in code blocks run on a small room, and options in the text exist.

Inputs that a page does not make are made here under the name on the page, so only options, formats and names count.
"""

import json
import re
import shlex
import shutil
import subprocess
import unittest

from command import COMMAND, DONE, FAILED, LAMP, PAINT, ROOT, CommandTest, vertices

LESS_WORK = {
    r"--rays \S+": "--rays 20k",
    r"--time \S+": "--time 0.2",
    r"--until \S+": "--until 50%",
    r"--(pixel-)?samples \S+": r"--\1samples 4",
    r"--size (\d+)x(\d+)": "--size 32x18",
    r"--texels-per-metre \S+": "--texels-per-metre 1",
    r"--probe-rays \S+": "--probe-rays 8",
}
SMALL = {
    "render": "--size 32x18", "report": "--samples 2 --size 32x18", "solve": "--rays 20k", "viewfactors": "--rays 20k",
    "bench": "--rays 20k --rounds 1", "probe": "--samples 4",
}
SUBCOMMANDS = {*SMALL, "info", "resume", "export", "compare", "validate", "make-scene"}
OBJ = "o street1\nv 0 0 0\nv 6 0 0\nv 6 4 0\nf 1 2 3\no roof1\nv 0 0 9\nv 6 0 9\nv 6 4 9\nf 4 6 5\n"
STL = "solid part\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 900 0 0\nvertex 0 900 0\nendloop\nendfacet\nendsolid\n"
VIEW3D = """T one face above another
V 1 0 0 0
V 2 1 0 0
V 3 1 1 0
V 4 0 1 0
V 5 0 0 1
V 6 1 0 1
V 7 1 1 1
V 8 0 1 1
S 1 1 2 3 4 0 0 .5 floor
S 2 5 8 7 6 0 0 .5 ceiling
End
"""
RADIANCE_MATERIAL = "void plastic oak 0 0 5 .5 .4 .3 0 0\n"
VIEW_FILE = "rvu -vtv -vp 5.6 0.4 1.6 -vd -1 1 -0.1 -vu 0 0 1 -vh 60 -vv 40\n"


def pages():
    return sorted(page for page in (ROOT / "docs").glob("*/*.md") if page.parent.name != "figures")


def code_commands(page):
    """Words of each `interflect SUBCOMMAND ...` in code blocks; without placeholders in capitals."""
    text = page.read_text().replace("\\\n", " ")
    found = []
    for line in re.findall(r"^ {4}(.*)$", text, re.MULTILINE):
        command = re.search(r"(?:^|\s)interflect ((?:%s) .*)" % "|".join(SUBCOMMANDS), line)
        if command and not re.search(r"\b[A-Z]{4,}\b", command[1]):
            found.append(command[1])
    return found


def room(views):
    """A furnished room of 6 x 4 x 3 m, whose views have these names."""
    corners = [(x, y, z) for z in (0, 3) for y in (0, 4) for x in (0, 6)]
    walls = "o room\nf v0 v1 v3 v2\nf v4 v6 v7 v5\nf v0 v2 v6 v4\nf v1 v5 v7 v3\nf v0 v4 v5 v1\nf v2 v3 v7 v6\no\n"
    lamp = vertices((1, 1, 2.9), (1, 2, 2.9), (2, 2, 2.9), (2, 1, 2.9)) + LAMP + "o lamp\nf v0 v1 v2 v3\no\n"
    view = {"eye": [5.6, 0.4, 1.6], "look_at": [1.9, 3.5, 1], "up": [0, 0, 1], "fov": 45}
    return vertices(*corners) + PAINT + walls + lamp, json.dumps({"views": [{"name": name, **view} for name in views]})


class Docs(CommandTest):
    def make_scene(self, name):
        mgf, views = room(self.views)
        self.write(name, mgf)
        self.write(name.replace(".mgf", ".views.json"), views)

    def provide(self, name):
        """Makes an input that is not there."""
        path = self.folder / name
        if path.exists():
            return
        written = {".obj": OBJ, ".stl": STL, ".vs3": VIEW3D, ".vf": VIEW_FILE, ".mat": RADIANCE_MATERIAL}.get(path.suffix)
        if written:
            self.write(name, written)
        elif name == "scenes/office.mgf" or path.suffix == ".mgf" and not (ROOT / name).exists():
            self.make_scene(name)
        elif (ROOT / name).exists():
            path.parent.mkdir(exist_ok=True)
            shutil.copy(ROOT / name, path)
        elif path.suffix == ".h5":
            self.provide("made.mgf")
            checkpoint = ("--checkpoint", name) if name.startswith("run") else ()
            self.interflect("solve", "made.mgf", "-o", "made.h5" if checkpoint else name, "--rays", "20k", "--light-groups",
                            *checkpoint)
        elif path.suffix in (".glb", ".rad"):
            self.provide("made.h5")
            shading = ("--shading", "smooth") if path.suffix == ".glb" else ()
            self.interflect("export", "made.h5", "-o", name, *shading)
        elif path.suffix == ".exr":
            self.provide("made.h5")
            self.interflect("render", "made.h5", "-o", name, "--shading", "smooth", "--size", "32x18")

    def run_small(self, command):
        for amount, less in LESS_WORK.items():
            command = re.sub(amount, less, command)
        words = shlex.split(command, comments=True)
        more = shlex.split(SMALL.get(words[0], ""))
        for option, value in zip(more[::2], more[1::2]):
            if option not in words and not (option == "--samples" and "--until" in words):
                words += [option, value]
        if words[0] == "render" and not words[1].endswith(".h5") and not {"--rays", "path", "instant"} & {*words}:
            words += ["--rays", "20k"]
        if words[0] == "export" and words[1].endswith(".h5"):
            words += ["--texels-per-metre", "1"] if "--lightmap" in words else ["--max-triangles", "100"] if ".glb" in command else []
        output = words[words.index("-o") + 1] if "-o" in words else None
        for word in words[1:]:
            if word != output:
                self.provide(re.split("@", word)[0])
        result = subprocess.run([COMMAND, *words], cwd=self.folder, capture_output=True, text=True, timeout=60)
        # validate also fails if it finds problems
        expected = (DONE, FAILED) if words[0] == "validate" else (DONE,)
        self.assertIn(result.returncode, expected, result.stderr)
        if output:
            self.assertTrue((self.folder / output).exists(), output)

    def test_commands_in_code_blocks_run(self):
        count = 0
        for page in pages():
            commands = code_commands(page)
            self.views = {"desk", *re.findall(r"--view (\S+)", page.read_text())}
            shutil.rmtree(self.folder)
            self.folder.mkdir()
            for command in commands:
                with self.subTest(page=page.name, command=command):
                    self.run_small(command)
                count += 1
        self.assertGreater(count, 40)

    def test_options_in_the_text_exist(self):
        count = 0
        for page in [*pages(), ROOT / "docs/python/command.rst"]:
            for name, rest in re.findall(r"`interflect ([a-z-]+)([^`]*)`", page.read_text()):
                with self.subTest(page=page.name, command=name + rest):
                    self.assertIn(name, SUBCOMMANDS if rest else {*SUBCOMMANDS, "checksums"})  # a line of solution files
                    scene = re.findall(r"\w[\w-]+", rest)[:1] if name == "make-scene" else ()
                    known = self.interflect(name, *scene, "--help-all").stdout
                    for option in re.findall(r"(?<!\S)--?[a-z][a-z-]*", rest):
                        self.assertRegex(known, rf"(^|[\s,]){option}\b(?!-)")
                        count += 1
        self.assertGreater(count, 20)


if __name__ == "__main__":
    unittest.main()
