"""Draws the first view of a scene in Mitsuba 3: `draw_in_mitsuba.py SCENE.xml PICTURE.exr`."""

import sys

import mitsuba

mitsuba.set_variant("scalar_rgb")
scene, picture = sys.argv[1:]
mitsuba.Bitmap(mitsuba.render(mitsuba.load_file(scene))).write(picture)
