"""Makes the meshes and images that the scenes need, into `scenes/assets`: they are made up, and the same each time."""

import pathlib
import struct
import zlib

import mitsuba
import numpy

FOLDER = pathlib.Path(__file__).resolve().parent / "scenes" / "assets"
COLUMNS, ROWS = 24, 12


def make():
    """Makes all files, unless they are there."""
    if (FOLDER / "done").exists():
        return
    FOLDER.mkdir(exist_ok=True)
    positions, normals, uvs, triangles = egg()
    write_obj(FOLDER / "egg.obj", positions, normals, uvs, triangles)
    vertices = numpy.hstack([positions, normals, uvs]).astype("f4")
    names = "x y z nx ny nz u v".split()
    for encoding in ("ascii", "little", "big"):
        write_ply(FOLDER / f"egg-{encoding}.ply", (names, vertices), triangles, encoding)
    coloured = numpy.hstack([vertices, 0.5 + 0.4 * numpy.sin(3.0 * positions + [0.0, 1.0, 2.0])]).astype("f4")
    write_ply(FOLDER / "egg-coloured.ply", (names + "r g b".split(), coloured), triangles, "little")
    flat = (positions * [1.0, 0.3, 1.0], normals, uvs, triangles)
    write_serialized(FOLDER / "eggs.serialized", [flat, (positions, normals, uvs, triangles)])
    images()
    (FOLDER / "done").touch()


def egg():
    """An ellipsoid around the origin, with a seam, and triangles that have an area."""
    v, u = numpy.mgrid[0 : ROWS + 1, 0 : COLUMNS + 1]
    theta, phi = numpy.pi * v / ROWS, 2.0 * numpy.pi * u / COLUMNS
    unit = numpy.stack([numpy.sin(theta) * numpy.cos(phi), numpy.cos(theta), -numpy.sin(theta) * numpy.sin(phi)], -1)
    axes = numpy.array([0.8, 1.0, 0.6])
    normals = unit / axes
    normals /= numpy.linalg.norm(normals, axis=-1, keepdims=True)
    uvs = numpy.stack([u / COLUMNS, 1.0 - v / ROWS], -1)
    triangles = []
    for row in range(ROWS):
        for column in range(COLUMNS):
            a = row * (COLUMNS + 1) + column
            b, c, d = a + COLUMNS + 1, a + COLUMNS + 2, a + 1
            triangles += [(a, b, c)] if row < ROWS - 1 else []
            triangles += [(a, c, d)] if row > 0 else []
            triangles += [(a, b, d)] if row == ROWS - 1 and row == 0 else []
    return [x.reshape(-1, x.shape[-1]) for x in (unit * axes, normals, uvs)] + [numpy.array(triangles, "u4")]


def write_obj(path, positions, normals, uvs, triangles):
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in positions]
    lines += [f"vt {u:.6f} {v:.6f}" for u, v in uvs]
    lines += [f"vn {x:.6f} {y:.6f} {z:.6f}" for x, y, z in normals]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}/{i + 1}" for i in t) for t in triangles]
    path.write_text("\n".join(lines) + "\n")


def write_ply(path, vertices, triangles, encoding):
    names, values = vertices
    form = {"ascii": "ascii", "little": "binary_little_endian", "big": "binary_big_endian"}[encoding]
    header = ["ply", f"format {form} 1.0", f"element vertex {len(values)}"]
    header += [f"property float {name}" for name in names]
    header += [f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    if encoding == "ascii":
        body = "".join(" ".join(f"{x:.6f}" for x in v) + "\n" for v in values)
        body = (body + "".join("3 " + " ".join(map(str, t)) + "\n" for t in triangles)).encode()
    else:
        order = "<" if encoding == "little" else ">"
        body = values.astype(order + "f4").tobytes()
        body += b"".join(struct.pack(order + "B3i", 3, *map(int, t)) for t in triangles)
    path.write_bytes(("\n".join(header) + "\n").encode() + body)


def write_serialized(path, meshes):
    """Version 4 of Mitsuba's own format: compressed meshes, and where each begins."""
    normals, uvs, single = 0x1, 0x2, 0x1000
    data, starts = b"", []
    for positions, directions, coordinates, triangles in meshes:
        starts.append(len(data))
        body = struct.pack("<I", normals | uvs | single) + b"egg\0"
        body += struct.pack("<QQ", len(positions), len(triangles))
        body += b"".join(x.astype("<f4").tobytes() for x in (positions, directions, coordinates))
        body += triangles.astype("<u4").tobytes()
        data += struct.pack("<HH", 0x041C, 4) + zlib.compress(body)
    path.write_bytes(data + struct.pack(f"<{len(starts)}QI", *starts, len(starts)))


def images():
    y, x = numpy.mgrid[0:8, 0:16]
    waves = [0.5 + 0.45 * numpy.sin(a * x + b * y + c) for a, b, c in ((0.9, 1.7, 0.0), (1.9, 0.6, 1.0), (0.4, 2.3, 2.0))]
    write("colours.png", numpy.rint(255.0 * numpy.stack(waves, -1)).astype("u1"))
    y, x = numpy.mgrid[0:32, 0:32] * (2.0 * numpy.pi / 32.0)
    write("bumps.png", numpy.rint(127.5 + 120.0 * numpy.sin(x) * numpy.cos(2.0 * y)).astype("u1")[..., None])
    write("alphas.png", numpy.rint(64.0 + 38.0 * numpy.sin(x) * numpy.cos(y)).astype("u1")[..., None])
    slopes = numpy.stack([-0.5 * numpy.cos(x) * numpy.cos(y), 0.5 * numpy.sin(x) * numpy.sin(y), numpy.ones_like(x)], -1)
    slopes /= numpy.linalg.norm(slopes, axis=-1, keepdims=True)
    write("normals.png", numpy.rint(127.5 + 127.5 * slopes).astype("u1"))
    v, u = numpy.mgrid[0:32, 0:64]
    theta, phi = numpy.pi * (v + 0.5) / 32.0, 2.0 * numpy.pi * (u + 0.5) / 64.0
    glow = numpy.exp(4.0 * (numpy.sin(theta) * numpy.cos(phi - 1.0) - 1.0)) + 0.2 * numpy.cos(theta) + 0.3
    write("sky.exr", (glow[..., None] * [1.0, 0.9, 0.7]).astype("f4"))


def write(name, pixels):
    bitmap = mitsuba.Bitmap(numpy.ascontiguousarray(pixels))
    bitmap.set_srgb_gamma(name.endswith(".png"))
    bitmap.write(str(FOLDER / name))
