"""The rooms, tables and doors: everything that is flat."""

from math import cos, radians, sin

from .flat import add_box, box, room
from .mesh import Mesh

QUAD = ((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0))


def meshes():
    """Meshes by scene and name."""
    return {
        "glass": glass(),
        "long-way": long_way(),
        "inverted": inverted(),
        "veach-mi": {"plate": quad("A plate, facing z."), "floor": room("Floor and wall.", *VEACH, ("-y", "-z"))},
        "furnace": {"walls": room("The whole room.", (-1.5, 0, -1.5), (1.5, 2, 3.5), FURNACE_FACES)},
        "many-lamps": {"quad": quad("A square, facing z.")},
        "gap": gap(),
        "bulb": bulb(),
    }


VEACH = ((-8, -2, -2.4), (8, 6, 7))
FURNACE_FACES = ("-x", "+x", "-y", "+y", "-z", "+z")


def quad(about):
    """A square of side 2 in the xy plane, facing z."""
    return Mesh(about).polygon(QUAD)


def glass():
    """A table before a wall that turns a corner on the right; dark behind the camera."""
    low, high = (-2.6, 0, -1.7), (1.7, 3.2, 5)
    return {
        "table": room("The table.", low, high, ("-y",)),
        "wall": room("The walls behind, and on the right.", low, high, ("-z", "+x")),
        "dark": room("The dark rest of the room.", low, high, ("-x", "+y", "+z")),
        "quad": quad("A square, facing z."),
    }


def inverted():
    """A box as Cornell's, a little wider, closed."""
    low, high = (-1.3, 0, -1), (1.3, 2, 4.6)
    return {
        "white": room("Floor, ceiling, back.", low, high, ("-y", "+y", "-z")),
        "left": room("The wall on the left.", low, high, ("-x",)),
        "right": room("The wall on the right.", low, high, ("+x",)),
        "front": room("The wall behind the camera.", low, high, ("+z",)),
        "quad": quad("A square, facing z."),
    }


# The opening in the ceiling of `long-way` (x and z), its height, and how far the shaft leads, which leans.
OPENING = ((-1.3, -0.2), (-1.1, 0.0))
CEILING = 2.0
SHAFT = (-2.5, 7.0, -1.9)


def long_way():
    """A room under a long shaft that leans, with a lamp at its upper end."""
    low, high = (-1.6, 0, -1.3), (1.6, CEILING, 4.2)
    hall = room("The room, but for its floor.", low, high, ("-x", "+x", "-z", "+z"))
    (x0, x1), (z0, z1) = OPENING
    for a, b, c, d in ((low[0], high[0], low[2], z0), (low[0], high[0], z1, high[2]),
                       (low[0], x0, z0, z1), (x1, high[0], z0, z1)):
        hall.polygon([(a, CEILING, c), (b, CEILING, c), (b, CEILING, d), (a, CEILING, d)])
    rim = [(x0, CEILING, z0), (x0, CEILING, z1), (x1, CEILING, z1), (x1, CEILING, z0)]
    top = [tuple(c + s for c, s in zip(p, SHAFT)) for p in rim]
    shaft = Mesh("The walls of the shaft, seen from inside.")
    for i, j in ((0, 1), (1, 2), (2, 3), (3, 0)):
        shaft.polygon([rim[j], rim[i], top[i], top[j]])
    lamp = Mesh("The lamp at the upper end of the shaft, facing down.").polygon(top[::-1])
    return {"hall": hall, "shaft": shaft, "lamp": lamp, "floor": room("The floor.", low, high, ("-y",))}


def add_room(mesh, low, high, *faces):
    """Adds walls, seen from inside."""
    for polygon in room("", low, high, faces).faces_as_points():
        mesh.polygon(polygon)


def gap():
    """Two rooms with a door between them that is ajar, and a low table."""
    near = Mesh("The walls and the ceiling of the near room, and the wall with the door.")
    low, high = (-1.9, 0, 0), (1.7, 2.3, 4.2)
    for face in ("-x", "+x", "+y", "+z"):
        add_room(near, low, high, face)
    add_box(near, (-1.9, 0, -0.1), (0.1, 2.3, 0), ("+z", "-z", "+x"))
    add_box(near, (0.9, 0, -0.1), (1.7, 2.3, 0), ("+z", "-z", "-x"))
    add_box(near, (0.1, 1.9, -0.1), (0.9, 2.3, 0), ("+z", "-z", "-y"))
    far = Mesh("The room beyond.")
    add_room(far, (-1.9, 0, -3), (1.7, 2.3, -0.1), "-x", "+x", "+y", "-z")
    floor = room("The floors.", (-1.9, 0, -3), (1.7, 2.3, 4.2), ("-y",))
    door = Mesh("The door, hinged on the right, open by 22 degrees.")
    slab = box("", (-0.79, 0.005, -0.05), (0, 1.895, 0))
    angle = radians(22)
    for polygon in slab.faces_as_points():
        door.polygon([(0.895 + x * cos(angle) - z * sin(angle), y, -0.02 + x * sin(angle) + z * cos(angle))
                      for x, y, z in polygon])
    return {"near": near, "far": far, "floor": floor, "door": door, "quad": quad("A square, facing z.")}


def bulb():
    """A table before a wall, in a closed room."""
    low, high = (-3.2, 0, -2.6), (3.2, 4, 5)
    books = {f"book-{i + 1}": box("A book.", a, b) for i, (a, b) in enumerate(BOOKS)}
    return {
        "table": room("The table.", low, high, ("-y",)),
        "wall": room("The wall.", low, high, ("-z",)),
        "rest": room("The rest of the room.", low, high, ("-x", "+x", "+y", "+z")),
        "window": Mesh("A window in the wall on the left.").polygon(WINDOW),
        "block": box("The block of wood that holds the bulb.", (-0.34, 0, -0.34), (0.34, 0.3, 0.34)),
        **books,
    }


WINDOW = ((-3.19, 1, 1.6), (-3.19, 1, -0.4), (-3.19, 3, -0.4), (-3.19, 3, 1.6))
BOOKS = (((-0.75, 0.0, -0.5), (0.75, 0.16, 0.5)), ((-0.68, 0.161, -0.45), (0.68, 0.29, 0.45)),
         ((-0.56, 0.291, -0.4), (0.56, 0.46, 0.4)))
