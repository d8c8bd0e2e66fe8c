"""Flat things: boxes, rooms, brilliants."""

from math import cos, pi, radians, sin, tan

from .mesh import Mesh

# The corners of a box's faces as bits xyz (1 is the high side), anticlockwise seen from outside.
FACES = {
    "-x": (0b000, 0b001, 0b011, 0b010),
    "+x": (0b100, 0b110, 0b111, 0b101),
    "-y": (0b000, 0b100, 0b101, 0b001),
    "+y": (0b010, 0b011, 0b111, 0b110),
    "-z": (0b000, 0b010, 0b110, 0b100),
    "+z": (0b001, 0b101, 0b111, 0b011),
}


def box(about, low, high, faces=tuple(FACES)):
    """The named faces of a box, seen from outside."""
    return add_box(Mesh(about), low, high, faces)


def add_box(mesh, low, high, faces=tuple(FACES)):
    """Adds the named faces of a box, seen from outside."""
    for name in faces:
        mesh.polygon([corner(low, high, bits) for bits in FACES[name]])
    return mesh


def room(about, low, high, faces):
    """The named walls of a room, seen from inside."""
    mesh = Mesh(about)
    for name in faces:
        mesh.polygon([corner(low, high, bits) for bits in reversed(FACES[name])])
    return mesh


def corner(low, high, bits):
    """A corner of a box, by its bits."""
    return tuple(high[i] if bits >> (2 - i) & 1 else low[i] for i in range(3))


def brilliant(about, table=0.53, crown=34.5, pavilion=40.75):
    """A round brilliant cut of radius 1 about the y axis, its girdle around the origin.

    `table` is a share of the diameter; the angles of crown and pavilion are in degrees. All 57 facets are flat.
    """
    girdle = 0.02
    top = (1 - table) * tan(radians(crown)) + girdle
    depth = tan(radians(pavilion)) + girdle
    half = cos(pi / 8)

    def at(radius, y, eighth):
        return (radius * sin(eighth * pi / 4), y, radius * cos(eighth * pi / 4))

    # The points between two kites lie in both kites' planes.
    upper, lower = 0.8, 0.25
    upper_y = girdle + (top - girdle) * (1 - upper * half) / (1 - table)
    lower_y = -girdle - (depth - girdle) * (1 - lower * half)
    mesh = Mesh(about)
    mesh.polygon([at(table, top, k) for k in range(8)])
    culet = (0, -depth, 0)
    for k in range(8):
        crown_points = [at(upper, upper_y, k + s) for s in (-0.5, 0.5)]
        pavilion_points = [at(lower, lower_y, k + s) for s in (-0.5, 0.5)]
        rim = {y: [at(1, y, k + s) for s in (0, 0.5, 1)] for y in (girdle, -girdle)}
        mesh.polygon([at(table, top, k), crown_points[0], rim[girdle][0], crown_points[1]])
        mesh.polygon([at(table, top, k), crown_points[1], at(table, top, k + 1)])
        mesh.polygon([culet, pavilion_points[1], rim[-girdle][0], pavilion_points[0]])
        for s in (0, 1):
            mesh.polygon([crown_points[1], rim[girdle][s], rim[girdle][s + 1]])
            mesh.polygon([pavilion_points[1], rim[-girdle][s + 1], rim[-girdle][s]])
            mesh.polygon([rim[girdle][s], rim[-girdle][s], rim[-girdle][s + 1], rim[girdle][s + 1]])
    return mesh
