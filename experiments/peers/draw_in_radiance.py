"""Draws an exported scene in Radiance with its irradiance cache: draw_in_radiance.py SCENE.rad OUT.npy WIDTH HEIGHT SIDE
OPTION... The picture has lumens in place of watts. SIDE squared rays are averaged in each pixel, a box filter.

A coarse picture fills the cache first, as Radiance's documentation recommends. All processors share the cache's file.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pyradiance

EFFICACY = 179  # of Radiance [lm/W]
COARSENESS = 4  # pixels of the picture per pixel of the coarse one, along each axis

scene, output = Path(sys.argv[1]), sys.argv[2]
width, height, side = map(int, sys.argv[3:6])
options = sys.argv[6:]
package = Path(pyradiance.__file__).parent
os.environ["RAYPATH"] = f".:{package / 'lib'}"
os.environ["PATH"] = f"{package / 'bin'}:{os.environ['PATH']}"
os.chdir(scene.parent)
octree, cache = Path(output).with_suffix(".oct"), Path(output).with_suffix(".amb")
with octree.open("wb") as file:
    subprocess.run(["oconv", scene.name], stdout=file, stderr=subprocess.DEVNULL, check=True)
cache.unlink(missing_ok=True)


def traced(columns: int, rows: int, jitter: str) -> np.ndarray:
    """Returns the radiance of rays through a grid of this size [W/sr/m2]."""
    size = ["-x", str(columns), "-y", str(rows), "-pa", "0", "-pj", jitter]
    rays = ["vwrays", "-ff", *size, "-vf", f"{scene.stem}-rad-view-0.vf"]
    trace = ["rtrace", "-h-", "-w-", "-fff", "-n", str(os.cpu_count()), *options, "-af", cache, octree]
    started = subprocess.Popen(rays, stdout=subprocess.PIPE)
    values = subprocess.run(trace, stdin=started.stdout, stdout=subprocess.PIPE, check=True).stdout
    if started.wait() != 0:
        sys.exit("vwrays failed")
    return np.frombuffer(values, np.float32).reshape(rows, columns, 3)


traced(-(-width // COARSENESS), -(-height // COARSENESS), "0")
rays = traced(side * width, side * height, "1")
picture = rays.reshape(height, side, width, side, 3).mean(axis=(1, 3)) * EFFICACY
np.save(output, picture.astype(np.float32))
