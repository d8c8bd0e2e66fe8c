"""Plates and lamps, after Veach's thesis (1997), figure 9.2: the scene file of `veach-mi`."""

from math import atan2, degrees, hypot, pi

from .nori import head

EYE = (0.0, 1.6, 13.0)
LAMPS_Y, LAMPS_Z = 2.3, -1.2

# Radii and colours of the lamps; all have about the same power.
LAMPS = ((-3.3, 0.04, (0.35, 0.60, 1.0)), (-1.2, 0.12, (0.35, 0.95, 0.75)), (1.05, 0.34, (1.0, 0.45, 0.60)),
         (3.5, 0.85, (1.0, 0.66, 0.28)))
# Roughness, and the middle of each plate (y, z).
PLATES = ((0.008, 0.42, -0.5), (0.03, -0.28, 0.75), (0.09, -0.85, 2.15), (0.22, -1.32, 3.7))
POWER = 34.0

ABOUT = """Lamps of different size, seen in plates of different roughness: small lamps in
     rough plates are found by looking for them, large ones in smooth plates by following the reflection."""

FLOOR = """	<mesh type="obj">
		<string name="filename" value="meshes/floor.obj"/>
		<bsdf type="diffuse"><color name="albedo" value="0.36, 0.37, 0.40"/></bsdf>
	</mesh>
"""

PLATE = """	<mesh type="obj">
		<string name="filename" value="meshes/plate.obj"/>
		<transform name="toWorld">
			<scale value="4.3, {half:.2f}, 1"/><rotate axis="1, 0, 0" angle="{angle:.3f}"/>
			<translate value="0, {y}, {z}"/>
		</transform>
		<bsdf type="roughconductor"><string name="material" value="Ag"/><float name="alpha" value="{alpha}"/></bsdf>
	</mesh>
"""

LAMP = """	<mesh type="sphere">
		<point name="center" value="{x}, {y}, {z}"/><float name="radius" value="{radius}"/>
		<bsdf type="diffuse"><color name="albedo" value="0, 0, 0"/></bsdf>
		<emitter type="area"><color name="radiance" value="{r:.4g}, {g:.4g}, {b:.4g}"/></emitter>
	</mesh>
"""


def scene():
    """The text of the scene file."""
    text = head(ABOUT, (EYE, (0, 0.35, 0)), 40, (800, 600)) + FLOOR + "\n\t<!-- The plates, from smooth to rough -->\n"
    for alpha, y, z in PLATES:
        text += PLATE.format(half=0.46, angle=tilt(y, z), y=y, z=z, alpha=alpha)
    text += "\n\t<!-- The lamps -->\n"
    for x, radius, colour in LAMPS:
        radiance = POWER / (4 * pi * pi * radius * radius)
        r, g, b = (radiance * c for c in colour)
        text += LAMP.format(x=x, y=LAMPS_Y, z=LAMPS_Z, radius=radius, r=r, g=g, b=b)
    return text + "</scene>\n"


def tilt(y, z):
    """The turn about x, in degrees, by which a plate mirrors the row of lamps to the eye."""
    to_eye = (EYE[1] - y, EYE[2] - z)
    to_lamps = (LAMPS_Y - y, LAMPS_Z - z)
    half = [e / hypot(*to_eye) + l / hypot(*to_lamps) for e, l in zip(to_eye, to_lamps)]
    return -degrees(atan2(half[0], half[1]))
