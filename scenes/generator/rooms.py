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
    low, high = (-2.6, 0, -1.3), (1.9, 3.2, 4)
    return {
        "table": room("The table.", low, high, ("-y",)),
        "wall": room("The walls behind, and on the right.", low, high, ("-z", "+x")),
        "dark": room("The dark rest of the room.", low, high, ("-x", "+y", "+z")),
        "quad": quad("A square, facing z."),
    }


def inverted():
    """A box as Cornell's, a little wider, closed."""
    low, high = (-1.3, 0, -1), (1.3, 2, 3.4)
    return {
        "white": room("Floor, ceiling, back.", low, high, ("-y", "+y", "-z")),
        "left": room("The wall on the left.", low, high, ("-x",)),
        "right": room("The wall on the right.", low, high, ("+x",)),
        "front": room("The wall behind the camera.", low, high, ("+z",)),
        "quad": quad("A square, facing z."),
    }


def long_way():
    """A room with a doorway to a passage that bends; the lamp is around the bend."""
    hall = Mesh("The room, but for its floor; its back wall has a doorway.")
    low, high = (-1.6, 0, -1), (1.6, 2, 3.2)
    for face in ("-x", "+x", "+y", "+z"):
        add_room(hall, low, high, face)
    wall_with_doorway(hall, (low, high), (-0.85, 0.05), 1.5)
    passage = Mesh("The passage, but for its floor.")
    add_room(passage, (-0.85, 0, -6.6), (0.05, 1.5, -1), "-x", "+y", "-z")
    add_room(passage, (-0.85, 0, -5.6), (0.05, 1.5, -1), "+x")
    add_room(passage, (0.05, 0, -6.6), (3.05, 1.5, -5.6), "+x", "+y", "-z", "+z")
    floor = Mesh("All floors.")
    add_room(floor, low, high, "-y")
    add_room(floor, (-0.85, 0, -6.6), (0.05, 1.5, -1), "-y")
    add_room(floor, (0.05, 0, -6.6), (3.05, 1.5, -5.6), "-y")
    plinth = box("What the ball stands on.", (-0.34, 0, -0.06), (0.34, 0.42, 0.62), ("-x", "+x", "+y", "-z", "+z"))
    return {"hall": hall, "passage": passage, "floor": floor, "plinth": plinth, "quad": quad("A square, facing z.")}


def add_room(mesh, low, high, *faces):
    """Adds walls, seen from inside."""
    for polygon in room("", low, high, faces).faces_as_points():
        mesh.polygon(polygon)


def wall_with_doorway(mesh, ends, opening, height):
    """Adds a wall at the far end, facing z, with an opening between two x as high as `height`."""
    (x0, y0, z), (x1, y1, _) = ends
    for left, right, low in ((x0, opening[0], y0), (opening[0], opening[1], height), (opening[1], x1, y0)):
        mesh.polygon([(left, low, z), (right, low, z), (right, y1, z), (left, y1, z)])


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
    door = Mesh("The door, hinged on the right, open by 14 degrees.")
    slab = box("", (-0.79, 0.005, -0.05), (0, 1.895, 0))
    angle = radians(14)
    for polygon in slab.faces_as_points():
        door.polygon([(0.895 + x * cos(angle) - z * sin(angle), y, -0.02 + x * sin(angle) + z * cos(angle))
                      for x, y, z in polygon])
    return {"near": near, "far": far, "floor": floor, "door": door, "quad": quad("A square, facing z.")}


def bulb():
    """A table before a wall, in a closed room."""
    low, high = (-3, 0, -1.5), (3, 4, 5)
    books = {f"book-{i + 1}": box("A book.", a, b) for i, (a, b) in enumerate(BOOKS)}
    return {
        "table": room("The table.", low, high, ("-y",)),
        "wall": room("The wall.", low, high, ("-z",)),
        "rest": room("The rest of the room.", low, high, ("-x", "+x", "+y", "+z")),
        "block": box("The block of wood that holds the bulb.", (-0.34, 0, -0.34), (0.34, 0.3, 0.34)),
        **books,
    }


BOOKS = (((-0.75, 0.0, -0.5), (0.75, 0.16, 0.5)), ((-0.68, 0.161, -0.45), (0.68, 0.29, 0.45)),
         ((-0.56, 0.291, -0.4), (0.56, 0.46, 0.4)))
