"""The model of the time of several processes."""

import sys
import unittest
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "experiments"))

from measured import scaling

TRUE = scaling.Model(500e-9, 600e-9, 900e-9, 1.5, 60)


def rows(ranks: int) -> list[dict]:
    """Returns the iterations of a run that follows TRUE on as many cores as processes."""
    found = []
    for iteration, rays in enumerate((3e5, 1e6, 4e6, 9e6)):
        elements = 1e5 + 1e4 * iteration
        row = {"iteration": iteration, "ranks": ranks, "mbit_per_second": 0, "rays": rays, "elements": elements}
        row["seconds"] = TRUE.seconds(ranks, rays, elements, scaling.Network(), ranks)
        found.append(row | {"all_sent_bytes": ranks * TRUE.sent(ranks, rays, elements)})
    return found


class Fit(unittest.TestCase):
    def test_finds_the_model_of_a_run_that_follows_it(self):
        found = scaling.fit(rows(1) + rows(scaling.CALIBRATED))
        self.assertAlmostEqual(found.per_ray / TRUE.per_ray, 1, delta=0.01)
        self.assertAlmostEqual(found.per_element / TRUE.per_element, 1, delta=0.01)
        self.assertAlmostEqual(found.per_element_shared / TRUE.per_element_shared, 1, delta=0.01)
        for ranks in (4, 64):
            self.assertAlmostEqual(found.sent(ranks, 5e6, 2e5) / TRUE.sent(ranks, 5e6, 2e5), 1, delta=0.01)


class Predictions(unittest.TestCase):
    def seconds(self, ranks: int, network: scaling.Network, cores: float = 1e9, **changes) -> float:
        return replace(TRUE, **changes).seconds(ranks, 1e7, 1e6, network, cores)

    def test_rays_alone_scale_without_loss(self):
        ideal = {"per_element": 0, "per_element_shared": 0}
        self.assertAlmostEqual(self.seconds(8, scaling.Network(), **ideal) * 8, self.seconds(1, scaling.Network(), **ideal))

    def test_processes_share_cores(self):
        self.assertAlmostEqual(self.seconds(8, scaling.Network(), 2), 4 * self.seconds(8, scaling.Network(), 8))

    def test_a_shared_network_carries_the_bytes_of_all(self):
        free = self.seconds(8, scaling.Network())
        own, shared = (self.seconds(8, scaling.Network(1e8, is_shared=s)) - free for s in (False, True))
        self.assertAlmostEqual(own, TRUE.sent(8, 1e7, 1e6) / 1e8)
        self.assertAlmostEqual(shared, 8 * own)

    def test_each_message_waits(self):
        free, slow = self.seconds(8, scaling.Network()), self.seconds(8, scaling.Network(latency=0.01))
        self.assertAlmostEqual(slow - free, 0.01 * TRUE.messages(8))


if __name__ == "__main__":
    unittest.main()
