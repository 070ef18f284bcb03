"""The memory limit: refinement stops before it, and `info` predicts the memory of a run."""

import base64
import json
import os
import re
import resource
import struct
import subprocess
import time
import unittest

from command import BAD_INPUT, COMMAND, DONE, FAILED, LAMP, CommandTest, room, vertices

FINE = ("--refinement-criterion", "power", "--view", "room-0", "--min-area", "1e-7", "--rays")
MIB = 1 << 20


class MemoryCase(CommandTest):
    def peak(self, *arguments):
        """Runs the command. @return its peak resident size [bytes] and its messages."""
        said = self.folder / "said"
        with open(said, "w") as stderr:
            process = os.posix_spawn(
                COMMAND,
                [COMMAND, *arguments],
                os.environ,
                file_actions=[(os.POSIX_SPAWN_DUP2, stderr.fileno(), 2)],
            )
        _, status, usage = os.wait4(process, 0)
        self.assertEqual(os.waitstatus_to_exitcode(status), DONE, said.read_text())
        return usage.ru_maxrss * 1024, said.read_text()


class MemoryLimit(MemoryCase):
    def solve(self, *options):
        stats = self.folder / "stats"
        peak, said = self.peak(
            "solve", str(self.folder / self.maze(2)), "-o", str(self.folder / "out.h5"), "--stats", str(stats), *FINE, *options
        )
        return json.loads(stats.read_text().splitlines()[-1])["elements"], peak, said

    def test_ends_refinement_and_says_so(self):
        limit = 180 * MIB
        elements, peak, said = self.solve("500k", "--epsilon", "1e-12", "--memory", "180M")
        self.assertIn("refinement ended at", said)
        self.assertIn("--memory", said)
        self.assertGreater(elements, 500_000)
        self.assertLess(peak, limit)

    def test_takes_what_info_predicts_for_each_element(self):
        # Peaks vary by 5 MiB with the timing of threads: 4 bytes an element over this span.
        few, few_peak, _ = self.solve("500k", "--epsilon", "1e-11")
        many, many_peak, _ = self.solve("500k", "--epsilon", "1e-13")
        self.assertGreater(many, few + 1_200_000)
        self.assertLess((many_peak - few_peak) / (many - few), self.json("info", self.maze(2))["memory"]["per_element"])

    def test_is_refused_where_not_even_the_patches_fit(self):
        scene = self.maze(2)
        before = self.files()
        result = self.interflect("solve", scene, "-o", "out.h5", "--memory", "50M", exit_code=BAD_INPUT)
        self.assertIn("need", result.stderr)
        self.assertIn("50 MiB", result.stderr)
        self.assertEqual(self.files(), before)


class LimitedAddressSpace(CommandTest):
    """ulimit -v: addresses are reserved only for the number of elements that fit into the limit."""

    def under(self, limit, *arguments, exit_code=DONE):
        result = subprocess.run(
            [COMMAND, *arguments],
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=120,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
        )
        self.assertEqual(result.returncode, exit_code, result.stderr)
        return result.stderr

    def test_solves_whatever_is_asked_for(self):
        few = ("solve", self.maze(2), "-o", "out.h5", "--rays", "100k", "--view", "room-0")
        for options in ((), ("--memory", "500M"), ("--memory", "64G"), ("--max-elements", "4G"), ("--method", "hwdrs")):
            importance = ("--importance", "off") if "hwdrs" in options else ()
            self.assertIn("elements", self.under(2000 * MIB, *few, *options, *importance))

    def test_ends_refinement_before_the_limit(self):
        said = self.under(450 * MIB, "solve", self.maze(2), "-o", "out.h5", *FINE, "500k", "--epsilon", "1e-12")
        self.assertIn("refinement ended at", said)

    def test_keeps_no_more_rays_than_fit(self):
        few = ("solve", self.maze(2), "-o", "out.h5", "--view", "room-0", "--method", "ihwdrs")
        self.assertIn("100.0 k rays", self.under(2000 * MIB, *few, "--rays", "100k"))
        said = self.under(2000 * MIB, *few, "--rays", "1G", exit_code=BAD_INPUT)
        self.assertRegex(said, r"--rays 1000000000: ihwdrs keeps every ray; the memory suffices for at most \d+")

    def test_says_what_is_missing(self):
        said = self.under(250 * MIB, "solve", self.maze(2), "-o", "out.h5", "--rays", "100k", exit_code=FAILED)
        self.assertRegex(said, r"maze-2\.mgf needs \d+ MiB of memory; the limits of this process .* leave \d+ MiB")


class Predictions(CommandTest):
    """Work beyond the available memory is refused at once, with the reason and a remedy."""

    def setUp(self):
        super().setUp()
        self.write("room.mgf", room())

    def refused(self, *arguments, exit_code=FAILED, limit=2000 * MIB):
        before = self.files()
        start = time.monotonic()
        result = subprocess.run(
            [COMMAND, *arguments],
            cwd=self.folder,
            capture_output=True,
            text=True,
            timeout=120,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
        )
        self.assertEqual(result.returncode, exit_code, result.stderr)
        self.assertLess(time.monotonic() - start, 20, arguments)
        self.assertEqual(self.files(), before)
        for word in ("bad_alloc", "std::", "terminate"):
            self.assertNotIn(word, result.stderr)
        return result.stderr

    # Seen to end with std::bad_alloc, in some cases after minutes.
    def test_of_pictures(self):
        for shading, needed in (("path", 100_000), ("gather", 100_000), ("smooth", 10_000)):
            said = self.refused("render", "room.mgf", "-o", "out.png", "--size", "16384x16384", "--shading", shading)
            needs, there_is = map(int, re.search(r"needs (\d+) MiB of memory; .* leave (\d+) MiB", said).groups())
            self.assertGreater(needs, needed)
            self.assertLess(there_is, 2000)
            for words in ("a picture of 16384 x 16384 pixels", "a smaller --size"):
                self.assertIn(words, said)

    def test_of_curved_surfaces(self):
        self.write("ball.mgf", vertices((0, 0, 0)) + LAMP + "sph v0 1\n")
        said = self.refused("info", "ball.mgf", "--curve-divisions", "1000")
        self.assertRegex(said, r"ball\.mgf:\d+: this would give more than \d+ patches .* the memory does not suffice for more")
        self.assertIn("--curve-divisions", said)

    def test_of_lightmaps(self):
        self.interflect("solve", "room.mgf", "-o", "room.h5", "--rays", "20k")
        self.refused_lightmap("--texels-per-metre", "4000", "--lightmap-max-size", "16384")
        self.refused_lightmap("--texels-per-metre", "400", "--shading", "gather")

    def refused_lightmap(self, *options):
        said = self.refused("export", "room.h5", "-o", "out.glb", "--lightmap", *options, exit_code=BAD_INPUT)
        self.assertRegex(said, r"million texels need \d+ MiB of memory, more than the limit of \d+ MiB \(max_bytes\)")
        self.assertIn("--texels-per-metre", said)

    def test_where_there_is_none_the_message_says_what_to_do(self):
        said = self.refused("make-scene", "maze", "--rooms", "3000", "--furniture", "-o", "out.mgf", limit=500 * MIB)
        self.assertIn("not enough memory", said)


class Copies(MemoryCase):
    """A small glTF file that asks for many copies of a triangle (EXT_mesh_gpu_instancing)."""

    def write_copies(self, count):
        corners = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
        data = "data:application/octet-stream;base64," + base64.b64encode(corners).decode()
        instancing = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 1}}}
        document = {
            "asset": {"version": "2.0"},
            "extensionsUsed": list(instancing),
            "nodes": [{"mesh": 0, "extensions": instancing}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                {"componentType": 5126, "count": count, "type": "VEC3"},  # all 0
            ],
            "bufferViews": [{"buffer": 0, "byteLength": len(corners)}],
            "buffers": [{"byteLength": len(corners), "uri": data}],
        }
        self.write("copies.gltf", json.dumps(document))

    # Seen to take 3 GB and 15 s, and hours of cutting at contacts.
    def test_at_one_place_are_read_once(self):
        self.write_copies(10_000_000)
        peak, said = self.peak("info", str(self.folder / "copies.gltf"))
        self.assertIn("copies of a mesh", said)
        self.assertLess(peak, 200 * MIB)

    def test_beyond_the_limit_are_refused_at_once(self):
        self.write_copies(1_000_000_000_000)
        said = self.interflect("info", "copies.gltf", exit_code=BAD_INPUT, timeout=20).stderr
        self.assertIn("its 1000000000000 instances of 1 faces would give more than 50000000 patches", said)


class LongRuns(MemoryCase):
    ITERATIONS = 6000
    REPORT = 200  # bytes kept for each, rounded up

    def peak_after(self, iterations):
        few = ("--one-bounce", "--rays-per-iteration", "1000", "--rays", str(1000 * iterations))
        mesh = ("--view", "room-0", "--mesh-size", "none", "--epsilon", "1e-3")  # no new elements
        run = ("solve", str(self.folder / self.maze(2)), "-o", str(self.folder / "out.h5"), *mesh, *few)
        return min(self.peak(*run, "--threads", "1")[0] for _ in range(3))

    def test_take_no_more_memory_than_short_ones(self):
        # Linux counts resident pages per processor and thread, in batches: a single thread has the least error.
        processors = os.sched_getaffinity(0)
        os.sched_setaffinity(0, {min(processors)})
        self.addCleanup(os.sched_setaffinity, 0, processors)
        growth = self.peak_after(self.ITERATIONS) - self.peak_after(self.ITERATIONS // 20)
        self.assertLess(growth, self.ITERATIONS * self.REPORT + MIB // 2)


if __name__ == "__main__":
    unittest.main()
