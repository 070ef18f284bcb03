"""The limit of memory: refinement ends before it is reached, and what `info` predicts is what a run takes."""

import json
import os
import resource
import subprocess
import unittest

from command import BAD_INPUT, COMMAND, DONE, FAILED, CommandTest

FINE = ("--refinement-criterion", "power", "--rays", "1500k", "--view", "room-0", "--min-area", "1e-7", "--epsilon")
MIB = 1 << 20


class MemoryCase(CommandTest):
    def peak(self, *arguments):
        """Runs the command. @return its largest resident size [bytes] and what it said."""
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
            "solve", "maze:2", "-o", str(self.folder / "out.h5"), "--stats", str(stats), *FINE, *options
        )
        return json.loads(stats.read_text().splitlines()[-1])["elements"], peak, said

    def test_ends_refinement_and_says_so(self):
        limit = 400 * MIB
        elements, peak, said = self.solve("1e-12", "--memory", "400M")
        self.assertIn("refinement ended at", said)
        self.assertIn("--memory", said)
        self.assertGreater(elements, 2_000_000)
        self.assertLess(peak, limit)

    def test_takes_what_info_predicts_for_each_element(self):
        few, few_peak, _ = self.solve("1e-10")  # many: what the allocator keeps of small arrays counts for little
        many, many_peak, _ = self.solve("1e-12")
        self.assertGreater(many, few + 2_000_000)
        self.assertLess((many_peak - few_peak) / (many - few), self.json("info", "maze:2")["memory"]["per_element"])

    def test_is_refused_where_not_even_the_patches_fit(self):
        result = self.interflect("solve", "maze:2", "-o", "out.h5", "--memory", "50M", exit_code=BAD_INPUT)
        self.assertIn("need", result.stderr)
        self.assertIn("50 MiB", result.stderr)
        self.assertEqual(self.files(), [])


class LimitedAddressSpace(CommandTest):
    """ulimit -v: addresses are reserved for no more elements than the limit leaves room for."""

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
        few = ("solve", "maze:2", "-o", "out.h5", "--rays", "100k", "--view", "room-0")
        for options in ((), ("--memory", "500M"), ("--memory", "64G"), ("--max-elements", "4G"), ("--method", "hwdrs")):
            importance = ("--importance", "off") if "hwdrs" in options else ()
            self.assertIn("elements", self.under(2000 * MIB, *few, *options, *importance))

    def test_ends_refinement_before_the_limit(self):
        said = self.under(850 * MIB, "solve", "maze:2", "-o", "out.h5", *FINE, "1e-12")
        self.assertIn("refinement ended at", said)

    def test_says_what_is_missing(self):
        said = self.under(250 * MIB, "solve", "maze:2", "-o", "out.h5", "--rays", "100k", exit_code=FAILED)
        self.assertRegex(said, r"maze:2 needs \d+ MiB of memory; the limits of this process .* leave \d+ MiB")


class LongRuns(MemoryCase):
    ITERATIONS = 6000
    REPORT = 200  # bytes that are kept for each, with room to spare

    def peak_after(self, iterations):
        few = ("--one-bounce", "--rays-per-iteration", "1000", "--rays", str(1000 * iterations))
        mesh = ("--view", "room-0", "--mesh-size", "none", "--epsilon", "1e-3")  # no elements are made on the way
        return self.peak("solve", "maze:2", "-o", str(self.folder / "out.h5"), *mesh, *few)[0]

    def test_take_no_more_memory_than_short_ones(self):
        growth = self.peak_after(self.ITERATIONS) - self.peak_after(self.ITERATIONS // 20)
        self.assertLess(growth, self.ITERATIONS * self.REPORT + MIB // 2)


if __name__ == "__main__":
    unittest.main()
