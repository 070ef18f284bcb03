"""Draws the first view of a scene in Radiance, by random paths without an ambient cache: `draw_in_radiance.py SCENE.rad
PICTURE.exr WIDTH HEIGHT`. The picture is in photometric units."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import OpenEXR
import pyradiance

EFFICACY = 179  # of Radiance [lm/W]
SIDE = 8  # rays per pixel along each axis
PATHS = "-ab 30 -aa 0 -ad 2 -as 0 -lw 1e-3 -lr -20 -dj 1 -ds 0.02 -dt 0 -dc 1 -st 0".split()

scene, picture, width, height = Path(sys.argv[1]), sys.argv[2], *map(int, sys.argv[3:])
package = Path(pyradiance.__file__).parent
os.environ["RAYPATH"] = f".:{package / 'lib'}"
os.environ["PATH"] = f"{package / 'bin'}:{os.environ['PATH']}"
octree = scene.with_suffix(".oct")
octree.write_bytes(subprocess.run(["oconv", scene], stdout=subprocess.PIPE, check=True).stdout)
view = scene.with_name(f"{scene.stem}-rad-view-0.vf")
size = ["-x", str(SIDE * width), "-y", str(SIDE * height)]
rays = subprocess.run(["vwrays", "-ff", "-pj", "1", "-pa", "0", "-vf", view, *size], stdout=subprocess.PIPE, check=True)
trace = ["rtrace", "-h-", "-fff", "-n", str(os.cpu_count()), *PATHS, octree]
traced = subprocess.run(trace, input=rays.stdout, stdout=subprocess.PIPE, check=True).stdout
values = np.frombuffer(traced, np.float32).reshape(height, SIDE, width, SIDE, 3).mean(axis=(1, 3)) * EFFICACY
OpenEXR.File({"type": OpenEXR.scanlineimage}, {"RGB": values.astype(np.float32)}).write(picture)
