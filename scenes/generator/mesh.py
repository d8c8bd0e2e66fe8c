"""Meshes and how they are written: OBJ with few digits, so that the same script gives the same bytes."""


def number(x):
    """A coordinate with five decimals, without trailing zeros."""
    text = f"{x:.5f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


class Mesh:
    """Polygons with positions and, where the surface is smooth, normals. Front faces are anticlockwise."""

    def __init__(self, about):
        self.about = about
        self.positions = []
        self.normals = []
        self.faces = []

    def vertex(self, position, normal=None):
        """Adds a vertex and returns its index."""
        self.positions.append(position)
        if normal is not None:
            self.normals.append(normal)
        return len(self.positions) - 1

    def polygon(self, corners):
        """Adds a flat polygon with corners of its own."""
        self.faces.append([self.vertex(p) for p in corners])
        return self

    def faces_as_points(self):
        """The corners of all faces."""
        return [[self.positions[i] for i in face] for face in self.faces]

    def obj(self):
        """The text of the OBJ file."""
        if self.normals and len(self.normals) != len(self.positions):
            raise ValueError(f"{self.about}: some vertices have normals and some have none")
        row = lambda tag, v: f"{tag} " + " ".join(map(number, v))
        lines = [f"# {self.about}"]
        lines += [row("v", p) for p in self.positions]
        lines += [row("vn", n) for n in self.normals]
        corner = (lambda i: f"{i + 1}//{i + 1}") if self.normals else (lambda i: f"{i + 1}")
        lines += ["f " + " ".join(map(corner, face)) for face in self.faces]
        return "\n".join(lines) + "\n"
