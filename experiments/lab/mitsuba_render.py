"""Draws a scene with Mitsuba 3: mitsuba_render.py SCENE.xml OUT.npy SAMPLES SEED. Runs under a Python that has Mitsuba."""

import sys

import mitsuba
import numpy as np

scene, output, samples, seed = sys.argv[1:]
mitsuba.set_variant("llvm_ad_rgb")
picture = mitsuba.render(mitsuba.load_file(scene), spp=int(samples), seed=int(seed))
np.save(output, np.array(picture)[:, :, :3])
