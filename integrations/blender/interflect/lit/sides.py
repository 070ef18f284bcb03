"""Separation of the two sides of lit faces, which a file has in the same place."""

import bmesh
import numpy
from mathutils import Vector

from .arrays import read

# Distance by which each side moves, relative to the largest coordinate of the lit meshes. Behind a transparent hit,
# Cycles skips hits closer than its rounding. A room of 4 m lost pixels at 2^-24 and none at 2^-20; this is 4 times
# that, 0.015 mm.
RELATIVE_DISTANCE = 2**-18
PARALLEL = 1 - 2**-15  # cosine of half the angle (0.9 degrees) between faces that count as one plane
OVERLAP = 1 + 2**-4  # growth of faces, in distances; more than 1, to meet other planes despite rounding
LARGEST_GROWTH = 8  # of sharp corners, in distances; reached at 14 degrees


def separate(objects) -> None:
    """Moves each face of lit meshes of triangles forward. Faces also grow by that distance at the edges of their
    planes, and so meet the faces of other planes: corners stay closed."""
    meshes = [each for each in objects if each.type == "MESH"]
    corners = [each.matrix_world @ Vector(corner) for each in meshes for corner in each.bound_box]
    largest = max((abs(coordinate) for corner in corners for coordinate in corner), default=0)
    for each in meshes:
        _split_between_planes(each.data)
        _move(each.data, RELATIVE_DISTANCE * largest)


def _split_between_planes(mesh) -> None:
    """Gives each plane of a mesh, and each side of it, vertices of its own."""
    edges, normals = _edges(mesh), _normals(mesh)
    face_counts, sums = numpy.bincount(edges, minlength=len(mesh.edges)), numpy.zeros((len(mesh.edges), 3))
    numpy.add.at(sums, edges, normals)
    is_within_plane = (face_counts == 2) & (numpy.linalg.norm(sums, axis=1) > 2 * PARALLEL)
    editable = bmesh.new()
    editable.from_mesh(mesh)
    editable.edges.ensure_lookup_table()
    bmesh.ops.split_edges(editable, edges=[editable.edges[i] for i in numpy.flatnonzero(~is_within_plane)])
    editable.to_mesh(mesh)
    editable.free()


def _move(mesh, distance: float) -> None:
    """Moves the planes of a mesh forward, and their rims outwards."""
    places = read(mesh.vertices, "co", numpy.float32, 3)
    starts, edges, normals = read(mesh.loops, "vertex_index", numpy.int32, 1), _edges(mesh), _normals(mesh)
    ends = numpy.roll(starts.reshape(-1, 3), -1, axis=1).ravel()
    outwards = numpy.cross(places[ends] - places[starts], normals)
    outwards /= numpy.maximum(_lengths(outwards), numpy.finfo(numpy.float32).tiny)
    outwards[numpy.bincount(edges)[edges] > 1] = 0  # only the rim grows
    growth, forward = numpy.zeros_like(places), numpy.zeros_like(places)  # in distances
    for vertices in (starts, ends):
        numpy.add.at(growth, vertices, outwards)
    forward[starts] = normals
    growth -= numpy.sum(growth * forward, axis=1, keepdims=True) * forward  # rounding of the normals of slivers
    # For unit vectors m and n, x = 2 (m + n) / |m + n|^2 has x . m = x . n = 1. Ends of slits, where m = -n, stay.
    growth *= 2 * OVERLAP / numpy.maximum(_lengths(growth), 2 / LARGEST_GROWTH) ** 2
    mesh.vertices.foreach_set("co", (places + distance * (growth + forward)).ravel())
    mesh.update()


def _edges(mesh):
    """Returns the edge of each loop."""
    return read(mesh.loops, "edge_index", numpy.int32, 1)


def _normals(mesh):
    """Returns the normal of each loop's triangle."""
    return numpy.repeat(read(mesh.polygons, "normal", numpy.float32, 3), 3, axis=0)


def _lengths(vectors):
    return numpy.linalg.norm(vectors, axis=1, keepdims=True)
