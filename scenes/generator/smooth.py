"""Smooth things: surfaces of revolution about the y axis, and tori."""

from math import cos, hypot, pi, sin

from .mesh import Mesh


def curve(points, steps=8):
    """A smooth line (Catmull–Rom) through `points`, in `steps` pieces between two of them."""
    ends = [reflect(points[0], points[1]), *points, reflect(points[-1], points[-2])]
    line = [points[0]]
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:]):
        for i in range(1, steps + 1):
            t = i / steps
            line.append(tuple(catmull_rom(a[k], b[k], c[k], d[k], t) for k in (0, 1)))
    return line


def reflect(p, q):
    """The point as far beyond `p` as `q` is before it."""
    return (2 * p[0] - q[0], 2 * p[1] - q[1])


def catmull_rom(a, b, c, d, t):
    """The cubic from `b` to `c` whose slopes at its ends are those of the chords ac and bd."""
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))


def arc(centre, radii, start, end, steps):
    """Points of an ellipse in the (r, y) plane from angle `start` to `end`, in degrees."""
    angles = [(start + (end - start) * i / steps) * pi / 180 for i in range(steps + 1)]
    line = [(centre[0] + radii[0] * cos(a), centre[1] + radii[1] * sin(a)) for a in angles]
    return [(0.0 if abs(r) < 1e-9 else r, y) for r, y in line]


def revolve(about, strips, segments=96):
    """Turns lines of (r, y) about the y axis.

    Each strip is smooth; where two meet there is an edge. The front is on the right of the way along a line, so that a
    line that goes from the bottom, around, to the top has its front outside.
    """
    mesh = Mesh(about)
    for strip in strips:
        rings = [ring(mesh, p, n, segments) for p, n in zip(strip, normals(strip))]
        for low, high in zip(rings, rings[1:]):
            for i in range(segments):
                add_face(mesh, low, high, (i, (i + 1) % segments))
    return mesh


def normals(strip):
    """The normals of a line in the (r, y) plane; upright on the axis."""
    result = []
    for i, (r, _) in enumerate(strip):
        a, b = strip[max(i - 1, 0)], strip[min(i + 1, len(strip) - 1)]
        nr, ny = b[1] - a[1], a[0] - b[0]
        if r == 0:
            nr = 0
        length = hypot(nr, ny)
        result.append((nr / length, ny / length))
    return result


def ring(mesh, point, normal, segments):
    """The vertices of a point that goes around; only one on the axis."""
    count = segments if point[0] > 0 else 1
    angles = [2 * pi * i / segments for i in range(count)]
    turn = lambda v, a: (v[0] * sin(a), v[1], v[0] * cos(a))
    return [mesh.vertex(turn(point, a), turn(normal, a)) for a in angles]


def add_face(mesh, low, high, pair):
    """The face between two rings and two angles: a triangle where a ring is a point."""
    i, j = pair
    if len(low) == 1:
        mesh.faces.append([low[0], high[j], high[i]])
    elif len(high) == 1:
        mesh.faces.append([low[i], low[j], high[0]])
    else:
        mesh.faces.append([low[i], low[j], high[j], high[i]])


def torus(about, radius, thickness, segments=(128, 48)):
    """A ring about the y axis: the radius of its middle line, and that of the tube."""
    mesh = Mesh(about)
    around, across = segments
    for i in range(around):
        a = 2 * pi * i / around
        for j in range(across):
            b = 2 * pi * j / across
            normal = (cos(b) * sin(a), sin(b), cos(b) * cos(a))
            position = [thickness * c for c in normal]
            mesh.vertex((position[0] + radius * sin(a), position[1], position[2] + radius * cos(a)), normal)
    for i in range(around):
        for j in range(across):
            k, l = (i + 1) % around, (j + 1) % across
            mesh.faces.append([i * across + j, k * across + j, k * across + l, i * across + l])
    return mesh


def ball(about, radii, segments=(96, 48)):
    """An ellipsoid of revolution about the y axis: its radius across, and along the axis."""
    return revolve(about, [arc((0, 0), radii, -90, 90, segments[1])], segments[0])
