"""Triangle meshes of the comparison's scenes, and the two formats that the renderers read them from.

All closed meshes are wound so that their normals point outwards; what is hollow is still closed (a cup has a thickness).
"""

import math

import numpy as np


class Mesh:
    """Triangles: `points` (n, 3) in single precision, `faces` (m, 3), and `normals` (n, 3) where shading is smooth."""

    def __init__(self, points, faces, normals=None):
        self.points = np.asarray(points, np.float32).reshape(-1, 3)
        self.faces = np.asarray(faces, np.int32).reshape(-1, 3)
        self.normals = None if normals is None else np.asarray(normals, np.float32).reshape(-1, 3)

    def turned(self, axis, degrees):
        """This mesh turned about a coordinate axis (0, 1 or 2) through the origin."""
        cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        matrix = np.eye(3)
        matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = cos, -sin, sin, cos
        normals = None if self.normals is None else self.normals @ matrix.T
        return Mesh(self.points @ matrix.T, self.faces, normals)

    def moved(self, x, y, z):
        """This mesh moved by a vector."""
        return Mesh(self.points + np.array([x, y, z]), self.faces, self.normals)

    def volume(self):
        """The enclosed volume, by the divergence theorem; positive if a closed mesh is wound outwards."""
        a, b, c = (self.points[self.faces[:, k]].astype(float) for k in range(3))
        return float(np.sum(a * np.cross(b, c)) / 6)

    def normal_of_first_face(self):
        """The unit normal of the first triangle, by its winding."""
        a, b, c = self.points[self.faces[0]].astype(float)
        n = np.cross(b - a, c - a)
        return n / np.linalg.norm(n)


def quad(a, b, c, d):
    """A parallelogram; its corners run anticlockwise seen from the side that its normal points to."""
    return Mesh([a, b, c, d], [[0, 1, 2], [0, 2, 3]])


def box(width, height, depth):
    """A closed box that stands on the origin: twelve triangles, outwards."""
    x, z = width / 2, depth / 2
    corners = np.array([[sx * x, sy * height, sz * z] for sx in (-1, 1) for sy in (0, 1) for sz in (-1, 1)])
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    points, faces = [], []
    for side in sides:
        faces += [[len(points), len(points) + 1, len(points) + 2], [len(points), len(points) + 2, len(points) + 3]]
        points += [corners[k] for k in side]
    return Mesh(points, faces)


def lathe(profile, segments=64):
    """Turns a profile of (radius, height) points about the y axis, in flat facets.

    A profile that starts and ends on the axis and runs anticlockwise in the (radius, height) plane gives a closed mesh
    that is wound outwards.
    """
    points, faces = [], []
    angles = [2 * math.pi * k / segments for k in range(segments + 1)]
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        for a, b in zip(angles, angles[1:]):
            p = [(r0 * math.cos(a), y0, r0 * math.sin(a)), (r1 * math.cos(a), y1, r1 * math.sin(a)),
                 (r1 * math.cos(b), y1, r1 * math.sin(b)), (r0 * math.cos(b), y0, r0 * math.sin(b))]
            # At the axis a quad shrinks to a triangle.
            corners = p[:1] + p[1:3] if r0 == 0 else p[:2] + p[3:] if r1 == 0 else p
            first = len(points)
            points += corners
            faces += [[first, first + k, first + k + 1] for k in range(1, len(corners) - 1)]
    return Mesh(points, faces)


def cup(radius, height, wall):
    """An opaque cup with a thick wall and floor, open at the top, standing on the origin."""
    inner = radius - wall
    return lathe([(0, 0), (radius, 0), (radius, height), (inner, height), (inner, wall), (0, wall)])


def disc_slab(radius, low, high):
    """A closed flat cylinder about the y axis between two heights."""
    return lathe([(0, low), (radius, low), (radius, high), (0, high)])


def sphere(radius, subdivisions):
    """A geodesic sphere about the origin with smooth normals: 20·4^subdivisions triangles."""
    golden = (1 + 5 ** 0.5) / 2
    points = [p for a in (-1, 1) for b in (-golden, golden) for p in ((0, a, b), (a, b, 0), (b, 0, a))]
    points = [np.array(p) / np.linalg.norm(p) for p in points]
    edge = min(np.linalg.norm(points[0] - p) for p in points[1:]) * 1.01
    near = [[np.linalg.norm(p - q) < edge for q in points] for p in points]
    faces = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                if near[i][j] and near[j][k] and near[i][k]:
                    outwards = np.linalg.det([points[i], points[j], points[k]]) > 0
                    faces.append((i, j, k) if outwards else (i, k, j))
    for _ in range(subdivisions):
        middles, finer = {}, []

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                m = points[i] + points[j]
                middles[key] = len(points)
                points.append(m / np.linalg.norm(m))
            return middles[key]

        for i, j, k in faces:
            ij, jk, ki = middle(i, j), middle(j, k), middle(k, i)
            finer += [(i, ij, ki), (j, jk, ij), (k, ki, jk), (ij, jk, ki)]
        faces = finer
    normals = np.array(points)
    return Mesh(normals * radius, faces, normals)


def write_obj(mesh, path):
    """Writes a Wavefront OBJ; nine digits carry single precision exactly."""
    with open(path, "w") as out:
        for p in mesh.points:
            out.write("v %.9g %.9g %.9g\n" % tuple(p))
        if mesh.normals is not None:
            for n in mesh.normals:
                out.write("vn %.9g %.9g %.9g\n" % tuple(n))
        corner = "%d" if mesh.normals is None else "%d//%d"
        for face in mesh.faces + 1:
            out.write("f " + " ".join(corner % ((k,) if mesh.normals is None else (k, k)) for k in face) + "\n")


def write_ply(mesh, path):
    """Writes a binary little-endian PLY."""
    columns = ["x", "y", "z"] + (["nx", "ny", "nz"] if mesh.normals is not None else [])
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(mesh.points)}"]
    header += [f"property float {c}" for c in columns]
    header += [f"element face {len(mesh.faces)}", "property list uchar int vertex_indices", "end_header", ""]
    vertices = mesh.points if mesh.normals is None else np.hstack([mesh.points, mesh.normals])
    faces = np.empty(len(mesh.faces), np.dtype([("count", "u1"), ("corner", "<i4", 3)]))
    faces["count"], faces["corner"] = 3, mesh.faces
    with open(path, "wb") as out:
        out.write("\n".join(header).encode() + vertices.astype("<f4").tobytes() + faces.tobytes())
