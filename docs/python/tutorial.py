"""The tutorial of the Python module: room.png, plan.png, and the illuminance at desk height on stdout."""

import matplotlib.pyplot as plt
import numpy as np

import interflect as ifl

# The corners of the room, then the corners of a lamp 1 cm below the ceiling. Faces are
# counter-clockwise seen from the inside.
floor = [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)]
lamp = [(1.5, 1.2), (1.5, 1.8), (2.5, 1.8), (2.5, 1.2)]
corners = [(x, y, z) for xy, z in ((floor, 0), (floor, 2.5), (lamp, 2.49)) for x, y in xy]
faces = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0),
         (8, 9, 10, 11)]
materials = [ifl.Material("white", reflectance=0.6),
             ifl.Material("red", reflectance=(0.6, 0.1, 0.1)),
             ifl.Material("lamp", exitance=6000)]  # 6000 lm/m^2 from 0.6 m^2
scene = ifl.Scene(corners, faces, materials, face_materials=[0, 0, 0, 0, 0, 1, 2],
                  objects=["", "floor"], face_objects=[1, 0, 0, 0, 0, 0, 0],
                  views=[ifl.View("door", eye=(3.8, 0.2, 1.6), look_at=(1, 2, 1), fov=60)])

# The light, on a mesh that is fine where the view shows differences.
solution = ifl.solve(scene, view="door", rays=1e6)
print(solution, solution.power_balance())

# A picture: radiance in cd/m^2, float32 (height, width, 3).
picture = ifl.render(solution, width=320, height=180)
ifl.write_image("room.png", picture)

# A plot: illuminance of the leaves of the floor, from arrays of the solution.
on_floor = solution.scene.face_objects[solution.patch] == scene.objects.index("floor")
centres = solution.vertices[on_floor].mean(axis=1)
lux = solution.irradiance[on_floor] @ np.array([0.2126, 0.7152, 0.0722])
plt.scatter(centres[:, 0], centres[:, 1], c=lux, s=5)
plt.colorbar(label="illuminance [lx]")
plt.savefig("plan.png")

# Lux at desk height, on the grid of EN 12464-1, with its standard error.
grid = ifl.area_grid(scene, ifl.find_top(scene, "floor"), height=0.75)
summary = ifl.probe(solution, grid, samples=256).summary()
print(f"{summary.mean:.0f} +- {summary.mean_error:.1f} lx, uniformity {summary.uniformity:.2f}")
