"""Draws an exported scene in Mitsuba 3: draw_in_mitsuba.py SCENE.xml OUT.npy SAMPLES SEED BOUNCES [denoise]."""

import sys

import mitsuba
import numpy as np

SAMPLES_AT_ONCE = 1 << 25  # in all pixels; a pass of the vectorised variant needs about 100 bytes for each
FIRST_ROULETTE = 5  # Mitsuba's default


def main(scene_file: str, output: str, samples: int, seed: int, bounces: int, denoise: bool) -> None:
    mitsuba.set_variant("llvm_ad_rgb")
    scene = mitsuba.load_file(scene_file)
    integrator = mitsuba.load_dict(integrator_of(bounces, denoise))
    pixels = int(np.prod(scene.sensors()[0].film().size()))
    per_pass = max(1, min(samples, SAMPLES_AT_ONCE // pixels))
    total, done, part = 0, 0, 0
    while done < samples:
        count = min(per_pass, samples - done)
        drawn = mitsuba.render(scene, integrator=integrator, spp=count, seed=seed * 65536 + part)
        total = total + np.array(drawn, np.float64) * count
        done, part = done + count, part + 1
    layers = (total / samples).astype(np.float32)
    picture = layers[:, :, :3]
    if denoise:
        from denoise import denoised

        picture = denoised(picture, layers[:, :, 3:6], layers[:, :, 6:9])
    np.save(output, picture)


def integrator_of(bounces: int, denoise: bool) -> dict:
    """Returns a path tracer. Its depth counts the segment from the camera too."""
    path = {"type": "path", "max_depth": bounces + 1, "rr_depth": FIRST_ROULETTE}
    return {"type": "aov", "aovs": "albedo:albedo,normal:sh_normal", "image": path} if denoise else path


scene_file, output, *numbers = sys.argv[1:6]
main(scene_file, output, *map(int, numbers), "denoise" in sys.argv[6:])
