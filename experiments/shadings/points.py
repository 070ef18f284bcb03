"""Comparison of bakes with path-traced illuminance at points on visible surfaces."""

import math
from dataclasses import dataclass

import numpy as np
from measured.audit_scenes import Scene
from lab.analysis import blocks
from lab.analysis.baked import Baked
from lab.analysis.blocks import Interval, Layout

REACH = 4.0  # largest distance from the point that the view looks at [m]
CELL = 0.45  # side of a block [m]: 9 texels at 20 a metre
POINTS_PER_CELL = 5  # fewer make no block
SAME_DEPTH = 0.03  # relative difference between the distance of a point and of the surface that its pixel shows


@dataclass(frozen=True)
class PointTruth:
    """Path-traced illuminance at points on surfaces that face up or sideways."""

    points: np.ndarray
    normals: np.ndarray
    cell: np.ndarray  # of each point
    references: list[np.ndarray]

    def measures(self, baked: Baked) -> dict[str, Interval]:
        light = [baked.at(self.points, self.normals)]
        single = Layout(np.arange(len(self.cell)), self.cell)  # the mean of all points, also of sparse cells
        full = Layout(self.cell, np.arange(self.cell.max() + 1)).only(np.bincount(self.cell) >= POINTS_PER_CELL)
        found = {"mean": blocks.mean_ratio(light, self.references, single)}
        if len(full.tile) > 1:
            dark = blocks.darkest(sum(self.references), full)
            found |= {"blocks": blocks.block_error(light, self.references, full)}
            found |= {"dark_mean": blocks.mean_ratio(light, self.references, dark)}
            found |= {"dark_blocks": blocks.block_error(light, self.references, dark)}
        return found


def visible(points: np.ndarray, scene: Scene, depth: np.ndarray) -> np.ndarray:
    """Returns whether the scene's view shows each point. @param depth  Distance that each pixel shows [m]."""
    eye, target, up = (np.array(v, float) for v in (scene.eye, scene.look_at, scene.up))
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    height, width = depth.shape
    pixels_per_tangent = height / 2 / math.tan(math.radians(scene.fov) / 2)
    along = np.maximum((points - eye) @ forward, 1e-9)
    column = (width / 2 + pixels_per_tangent * ((points - eye) @ right) / along).astype(int)
    row = (height / 2 - pixels_per_tangent * ((points - eye) @ np.cross(right, forward)) / along).astype(int)
    inside = (along > 1e-6) & (column >= 0) & (column < width) & (row >= 0) & (row < height)
    shown = depth[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]
    distance = np.linalg.norm(points - eye, axis=1)
    return inside & (np.abs(shown - distance) < SAME_DEPTH * distance)


def draw_points(baked: Baked, scene: Scene, depth: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Draws visible points uniformly from surfaces within REACH of the view's target. They face up or to one of the
    four horizontal directions with the most area, since `probe` measures no others. Returns points and normals."""
    random = np.random.default_rng(1)
    normals, areas = baked.normals.round(6), baked.areas()
    vertical = np.abs(normals[:, 2]) < 1e-6
    directions, member = np.unique(normals[vertical], axis=0, return_inverse=True)
    largest = np.argsort(-np.bincount(member.ravel(), areas[vertical]))[:4] if len(directions) else []
    allowed = normals[:, 2] > 0.999999
    for direction in directions[largest]:
        allowed |= (normals == direction).all(axis=1)
    weights = np.where(allowed, areas, 0)
    if not weights.sum() > 0:
        return np.empty((0, 3)), np.empty((0, 3))
    tries = 200 * count  # the area of a hall is some hundred times the visible area within reach
    triangle = random.choice(len(areas), tries, p=weights / weights.sum())
    u, v = np.sqrt(random.random(tries)), random.random(tries)
    corners = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    points = (baked.corners[triangle] * corners[:, :, None]).sum(axis=1)
    near = np.linalg.norm(points - np.array(scene.look_at), axis=1) < REACH
    chosen = np.flatnonzero(near & visible(points, scene, depth))[:count]
    return points[chosen], normals[triangle[chosen]]


def cells_of(points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """Returns the index of the square of side CELL around each point, on its plane."""
    is_up = normals[:, 2] > 0.5
    sideways = np.where(is_up, points[:, 0], points[:, 1] * normals[:, 0] - points[:, 0] * normals[:, 1])
    upwards = np.where(is_up, points[:, 1], points[:, 2])
    plane = (points * normals).sum(axis=1).round(3)
    key = np.column_stack([normals, plane, np.floor(sideways / CELL), np.floor(upwards / CELL)])
    return np.unique(key, axis=0, return_inverse=True)[1].ravel()
