"""Path-traces the irradiance of small areas with Mitsuba 3: mitsuba_irradiance.py SCENE.xml AREAS.npz OUT.npz SAMPLES.

AREAS contains `points` and `normals`, shape (areas, points of an area, 3). OUT receives `halves`: the irradiance of
each point from two independent halves of the samples, shape (2, areas, points, 3); and `backs`: the share of its rays
that hit the back of a surface, shape (areas, points). Runs under a Python that has Mitsuba.
"""

import sys

import drjit as dr
import mitsuba as mi
import numpy as np

RAYS_AT_ONCE = 1 << 22
MAX_DEPTH, FIRST_ROULETTE = 64, 6
LIFT = 1e-5  # of ray starts above their surface, relative to the size of the scene


def main(scene_file: str, areas_file: str, output: str, samples: int) -> None:
    mi.set_variant("llvm_ad_rgb")
    scene = mi.load_file(scene_file)
    areas = np.load(areas_file)
    points, normals = areas["points"], areas["normals"]
    count, of_area = points.shape[:2]
    per_point = max(1, samples // (2 * of_area))
    at_once = max(1, RAYS_AT_ONCE // (of_area * per_point))
    halves, backs = np.zeros((2, count, of_area, 3)), np.zeros((count, of_area))
    for first in range(0, count, at_once):
        part = slice(first, min(count, first + at_once))
        for half in range(2):
            light, back = irradiance(scene, points[part], normals[part], per_point, seed=2 * first + half)
            halves[half, part] = light.reshape(-1, of_area, per_point, 3).mean(axis=2)
            backs[part] += back.reshape(-1, of_area, per_point).mean(axis=2) / 2
    np.savez(output, halves=halves, backs=backs)


def irradiance(scene, points: np.ndarray, normals: np.ndarray, per_point: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Returns one sample of the irradiance for each ray, and whether the ray hit the back of a surface."""
    x, n = (mi.Point3f(np.repeat(a.reshape(-1, 3), per_point, axis=0).T.astype(np.float32)) for a in (points, normals))
    n = mi.Normal3f(n)
    sampler = mi.load_dict({"type": "independent"})
    sampler.seed(seed, dr.width(x))
    box = scene.bbox()
    start = x + LIFT * float(np.linalg.norm(np.array(box.max) - np.array(box.min))) * n
    # Direct light: one light source for each ray
    si = dr.zeros(mi.SurfaceInteraction3f, dr.width(x))
    si.p, si.n, si.t = start, n, 1
    si.sh_frame = mi.Frame3f(n)
    emitter, weight = scene.sample_emitter_direction(si, sampler.next_2d(), True)
    direct = weight * dr.maximum(0, dr.dot(emitter.d, n))
    # Indirect light: cosine-distributed rays, without the emission of their first hit
    ray = si.spawn_ray(mi.Frame3f(n).to_world(mi.warp.square_to_cosine_hemisphere(sampler.next_2d())))
    hit = scene.ray_intersect(ray)
    integrator = mi.load_dict({"type": "path", "max_depth": MAX_DEPTH, "rr_depth": FIRST_ROULETTE})
    received, _, _ = integrator.sample(scene, sampler, mi.RayDifferential3f(ray))
    emitted = hit.emitter(scene).eval(hit)
    indirect = dr.pi * (received - emitted)
    is_back = hit.is_valid() & (dr.dot(hit.n, ray.d) > 0)
    return np.array(direct + indirect).T, np.array(dr.select(is_back, mi.Float(1), mi.Float(0)))


main(*sys.argv[1:4], int(sys.argv[4]))
