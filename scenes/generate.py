#!/usr/bin/env python3
"""Writes the meshes of the scenes, and those scene files that are too regular to write by hand.

    scenes/generate.py [FOLDER]

FOLDER is where the scenes lie; by default, where this script lies. The same script writes the same bytes.
"""

import sys
from pathlib import Path

from generator import cornell, cornell_scene, many_lamps, rooms, things, veach
from generator.flat import brilliant
from generator.smooth import ball, torus


def files():
    """All files: texts by their paths."""
    meshes = {"cornell": cornell.meshes(), **rooms.meshes()}
    meshes["glass"] |= things.tumbler()
    meshes["glass"] |= {
        "ring": torus("A ring of glass.", 0.34, 0.11),
        "ellipsoid": ball("An ellipsoid of glass.", (0.3, 0.21)),
        "brilliant": brilliant("A round brilliant."),
    }
    meshes["furnace"]["brilliant"] = brilliant("A round brilliant.")
    meshes["bulb"] |= things.bulb()
    meshes["bulb"] |= things.pear() | things.apple()
    meshes["gap"]["vase"] = things.vase()
    texts = {f"{scene}/meshes/{name}.obj": m.obj() for scene, parts in meshes.items() for name, m in parts.items()}
    texts["cornell/cornell.xml"] = cornell_scene.scene()
    texts["many-lamps/many-lamps.xml"] = many_lamps.scene()
    texts["veach-mi/veach-mi.xml"] = veach.scene()
    return texts


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    for name, text in files().items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
