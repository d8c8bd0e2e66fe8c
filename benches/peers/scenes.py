"""The scenes of the comparison, described once, and written for each renderer.

Lengths are in arbitrary units; radiances and reflectances are linear RGB. All scenes share a room: a Cornell box widened
to 4:3, open towards the camera. A lamp emits on the side that its normal points to. Glass is smooth and lossless with an
index of 1.5 in a vacuum of 1, mirrors reflect everything.
"""

from collections import namedtuple
from pathlib import Path

from meshes import box, cup, disc_slab, quad, sphere, write_obj, write_ply

WIDTH, HEIGHT, MAX_DEPTH = 400, 300, 32
IOR = 1.5

Part = namedtuple("Part", "name mesh material emission", defaults=[None])
Camera = namedtuple("Camera", "origin target up fov")  # fov: across the width, in degrees
Scene = namedtuple("Scene", "name title parts camera")

# Materials: ("diffuse", reflectance), ("mirror",) or ("glass",).
WHITE = ("diffuse", (0.73, 0.73, 0.71))
RED = ("diffuse", (0.63, 0.06, 0.05))
GREEN = ("diffuse", (0.14, 0.45, 0.09))
METAL = ("diffuse", (0.55, 0.55, 0.58))
BLACK = ("diffuse", (0.0, 0.0, 0.0))
MIRROR, GLASS = ("mirror",), ("glass",)

CAMERA = Camera((0, 1, 4.2), (0, 1, 0), (0, 1, 0), 44.5)


def room():
    """Floor, ceiling, back and two coloured walls, facing inwards: x in ±4/3, y in 0…2, z in ±1."""
    x, y, z = 4 / 3, 2, 1
    return [
        Part("floor", quad((-x, 0, z), (x, 0, z), (x, 0, -z), (-x, 0, -z)), WHITE),
        Part("ceiling", quad((-x, y, -z), (x, y, -z), (x, y, z), (-x, y, z)), WHITE),
        Part("back", quad((-x, 0, -z), (x, 0, -z), (x, y, -z), (-x, y, -z)), WHITE),
        Part("left", quad((-x, 0, z), (-x, 0, -z), (-x, y, -z), (-x, y, z)), RED),
        Part("right", quad((x, 0, -z), (x, 0, z), (x, y, z), (x, y, -z)), GREEN),
    ]


def square_up(side):
    """A square about the origin whose normal points upwards."""
    s = side / 2
    return quad((-s, 0, s), (s, 0, s), (s, 0, -s), (-s, 0, -s))


def ceiling_lamp(side, radiance):
    """A square lamp just under the middle of the ceiling, facing down."""
    return Part("lamp", square_up(side).turned(0, 180).moved(0, 1.99, 0), BLACK, radiance)


def blocks():
    """The two blocks of the Cornell box."""
    return [
        Part("tall", box(0.6, 1.2, 0.6).turned(1, 18).moved(-0.5, 0, -0.35), WHITE),
        Part("short", box(0.6, 0.6, 0.6).turned(1, -17).moved(0.5, 0, 0.25), WHITE),
    ]


def plain_box():
    return room() + blocks() + [ceiling_lamp(0.5, (17, 12, 6))]


def spheres():
    """Two spheres of 81,920 triangles each."""
    return room() + [
        Part("mirror", sphere(0.42, 6).moved(-0.55, 0.42, -0.35), MIRROR),
        Part("glass", sphere(0.42, 6).moved(0.5, 0.5, 0.3), GLASS),
        ceiling_lamp(0.5, (17, 12, 6)),
    ]


def shaded_lamp():
    """A small lamp at the bottom of a shade that faces the ceiling: all else is lit by a spot up there."""
    return room() + blocks()[1:] + [
        Part("shade", cup(0.14, 0.4, 0.02).moved(-0.55, 0.7, -0.2), METAL),
        Part("lamp", square_up(0.08).moved(-0.55, 0.73, -0.2), BLACK, (1700, 1350, 900)),
    ]


def lamp_behind_glass():
    """A lamp in a can under the ceiling, closed by a pane that is let into the can's wall: no light gets past it."""
    radius, height, wall = 0.14, 0.34, 0.03
    parts = [
        Part("can", cup(radius, height, wall), METAL),
        Part("pane", disc_slab(radius - wall / 2, height - 0.06, height - 0.03), GLASS),
        Part("lamp", square_up(0.08).moved(0, wall + 0.01, 0), BLACK, (1700, 1350, 900)),
    ]
    hung = [part._replace(mesh=part.mesh.turned(2, 205).moved(-0.45, 1.85, -0.1)) for part in parts]
    return room() + blocks()[1:] + hung


SCENES = {
    "a": ("plain box", plain_box),
    "b": ("mirror and glass spheres of 82 thousand triangles", spheres),
    "c": ("lamp in a shade that faces the ceiling", shaded_lamp),
    "d": ("lamp in a can closed by a glass pane", lamp_behind_glass),
}


def scene(name):
    """One of `SCENES`, built."""
    title, parts = SCENES[name]
    return Scene(name, title, parts(), CAMERA)


def _numbers(values):
    return ", ".join(f"{v:.9g}" for v in values)


def nori_xml(scene):
    """The scene as a Nori file, which Caustica reads; its meshes are the OBJ files beside it."""
    camera = scene.camera
    lines = ["<scene>", '\t<integrator type="bdpt"/>', '\t<camera type="perspective">', '\t\t<transform name="toWorld">',
             f'\t\t\t<lookat origin="{_numbers(camera.origin)}" target="{_numbers(camera.target)}" '
             f'up="{_numbers(camera.up)}"/>', "\t\t</transform>", f'\t\t<float name="fov" value="{camera.fov}"/>',
             f'\t\t<integer name="width" value="{WIDTH}"/>', f'\t\t<integer name="height" value="{HEIGHT}"/>',
             '\t\t<rfilter type="box"/>', "\t</camera>"]
    for part in scene.parts:
        lines += ['\t<mesh type="obj">', f'\t\t<string name="filename" value="{part.name}.obj"/>']
        kind = part.material[0]
        if kind == "diffuse":
            lines += [f'\t\t<bsdf type="diffuse"><color name="albedo" value="{_numbers(part.material[1])}"/></bsdf>']
        elif kind == "mirror":
            lines += ['\t\t<bsdf type="mirror"/>']
        else:
            lines += [f'\t\t<bsdf type="dielectric"><float name="intIOR" value="{IOR}"/>'
                      '<float name="extIOR" value="1"/></bsdf>']
        if part.emission:
            lines += [f'\t\t<emitter type="area"><color name="radiance" value="{_numbers(part.emission)}"/></emitter>']
        lines += ["\t</mesh>"]
    return "\n".join(lines + ["</scene>", ""])


def mitsuba_xml(scene):
    """The scene for Mitsuba 3, with the integrator and the sampler to be compared."""
    camera = scene.camera
    lines = ['<scene version="3.0.0">', '\t<default name="integrator" value="path"/>',
             f'\t<integrator type="$integrator"><integer name="max_depth" value="{MAX_DEPTH}"/></integrator>',
             '\t<sensor type="perspective">', '\t\t<transform name="to_world">',
             f'\t\t\t<lookat origin="{_numbers(camera.origin)}" target="{_numbers(camera.target)}" '
             f'up="{_numbers(camera.up)}"/>', "\t\t</transform>", f'\t\t<float name="fov" value="{camera.fov}"/>',
             '\t\t<string name="fov_axis" value="x"/>', '\t\t<sampler type="independent"/>', '\t\t<film type="hdrfilm">',
             f'\t\t\t<integer name="width" value="{WIDTH}"/>', f'\t\t\t<integer name="height" value="{HEIGHT}"/>',
             '\t\t\t<rfilter type="box"/>', '\t\t\t<string name="pixel_format" value="rgb"/>',
             '\t\t\t<string name="component_format" value="float32"/>', "\t\t</film>", "\t</sensor>"]
    for part in scene.parts:
        flat = "true" if part.mesh.normals is None else "false"
        lines += ['\t<shape type="ply">', f'\t\t<string name="filename" value="{part.name}.ply"/>',
                  f'\t\t<boolean name="face_normals" value="{flat}"/>']
        kind = part.material[0]
        if kind == "diffuse":
            lines += [f'\t\t<bsdf type="diffuse"><rgb name="reflectance" value="{_numbers(part.material[1])}"/></bsdf>']
        elif kind == "mirror":
            lines += ['\t\t<bsdf type="conductor"><string name="material" value="none"/></bsdf>']
        else:
            lines += [f'\t\t<bsdf type="dielectric"><float name="int_ior" value="{IOR}"/>'
                      '<float name="ext_ior" value="1"/></bsdf>']
        if part.emission:
            lines += [f'\t\t<emitter type="area"><rgb name="radiance" value="{_numbers(part.emission)}"/></emitter>']
        lines += ["\t</shape>"]
    return "\n".join(lines + ["</scene>", ""])


def luxcore_scn(scene, folder):
    """The scene for LuxCore. Its field of view is across the longer side; power 0 makes the gain a plain factor."""
    camera = scene.camera

    def row(values):
        return " ".join(f"{v:.9g}" for v in values)

    lines = [f"scene.camera.lookat.orig = {row(camera.origin)}", f"scene.camera.lookat.target = {row(camera.target)}",
             f"scene.camera.up = {row(camera.up)}", f"scene.camera.fieldofview = {camera.fov}",
             "scene.camera.lensradius = 0", "scene.camera.autofocus.enable = 0"]
    for part in scene.parts:
        key, kind = f"scene.materials.{part.name}", part.material[0]
        if kind == "diffuse":
            lines += [f"{key}.type = matte", f"{key}.kd = {row(part.material[1])}"]
        elif kind == "mirror":
            lines += [f"{key}.type = mirror", f"{key}.kr = 1 1 1"]
        else:
            lines += [f"{key}.type = glass", f"{key}.kr = 1 1 1", f"{key}.kt = 1 1 1",
                      f"{key}.interiorior = {IOR}", f"{key}.exteriorior = 1"]
        if part.emission:
            lines += [f"{key}.emission = {row(part.emission)}", f"{key}.emission.gain = 1 1 1",
                      f"{key}.emission.power = 0", f"{key}.emission.efficency = 0",
                      f"{key}.emission.normalizebycolor = 0"]
        lines += [f"scene.objects.{part.name}.ply = {Path(folder) / part.name}.ply",
                  f"scene.objects.{part.name}.material = {part.name}"]
    return "\n".join(lines + [""])


def export(name, folder):
    """Writes a scene for all renderers into `folder` and returns that folder."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    built = scene(name)
    for part in built.parts:
        write_obj(part.mesh, folder / f"{part.name}.obj")
        write_ply(part.mesh, folder / f"{part.name}.ply")
    (folder / "caustica.xml").write_text(nori_xml(built))
    (folder / "mitsuba.xml").write_text(mitsuba_xml(built))
    (folder / "luxcore.scn").write_text(luxcore_scn(built, folder.resolve()))
    return folder
