"""Lanterns on a spiral above dark water: the scene file of `many-lamps`."""

from math import cos, pi, sin, sqrt

from .nori import head

LAMPS = 480
# Turning by the golden angle spreads points evenly (Vogel, Mathematical Biosciences 44, 1979).
GOLDEN_ANGLE = pi * (3 - sqrt(5))

# Colours from the middle of the spiral to its rim.
COLOURS = ((1.0, 0.78, 0.42), (1.0, 0.48, 0.16), (1.0, 0.20, 0.16), (0.72, 0.14, 0.50), (0.25, 0.22, 0.90),
           (0.10, 0.50, 0.90), (0.12, 0.75, 0.70))

ABOUT = f"{LAMPS} lanterns of all colours float over a dark pool, around a ball of glass."

PLACE = """	<!-- The pool, and the sky at dusk -->
	<mesh type="obj">
		<string name="filename" value="meshes/quad.obj"/>
		<transform name="toWorld"><scale value="14, 14, 1"/><rotate axis="1, 0, 0" angle="-90"/></transform>
		<bsdf type="microfacet">
			<float name="alpha" value="0.06"/>
			<float name="intIOR" value="2.2"/>
			<color name="kd" value="0.05, 0.06, 0.085"/>
		</bsdf>
	</mesh>
	<emitter type="constant"><color name="radiance" value="0.016, 0.022, 0.05"/></emitter>

	<mesh type="sphere">
		<point name="center" value="0, 0.72, 0"/>
		<float name="radius" value="0.62"/>
		<bsdf type="dielectric"><float name="intIOR" value="1.5"/></bsdf>
	</mesh>
"""

LAMP = """	<mesh type="sphere">
		<point name="center" value="{x:.3f}, {y:.3f}, {z:.3f}"/><float name="radius" value="{radius:.3f}"/>
		<bsdf type="diffuse"><color name="albedo" value="0, 0, 0"/></bsdf>
		<emitter type="area"><color name="radiance" value="{r:.3f}, {g:.3f}, {b:.3f}"/></emitter>
	</mesh>
"""


def scene():
    """The text of the scene file."""
    lamps = "".join(lamp(i) for i in range(LAMPS))
    look = ((0, 4.3, 6.3), (0, 0.22, 0.1))
    return head(ABOUT, look, 38, (800, 600)) + PLACE + "\n\t<!-- The lanterns -->\n" + lamps + "</scene>\n"


def lamp(i):
    """The lantern of a number: farther out with it, and rising and falling in waves."""
    share = (i + 0.5) / LAMPS
    distance = 0.95 + 2.75 * sqrt(share)
    angle = GOLDEN_ANGLE * i
    wave = 0.5 + 0.5 * sin(3 * angle + 5 * distance)
    y = 0.08 + 0.30 * wave * (0.35 + share) + 0.20 * max(0.0, 1 - cos(angle)) * distance * share
    red, green, blue = (1.7 * c for c in colour(share))
    place = {"x": distance * sin(angle), "y": y, "z": distance * cos(angle), "radius": 0.042 + 0.014 * sin(7 * i)}
    return LAMP.format(r=red, g=green, b=blue, **place)


def colour(share):
    """The colour at a share of the way to the rim, between two of the palette."""
    place = share * (len(COLOURS) - 1)
    i = min(int(place), len(COLOURS) - 2)
    return [a + (b - a) * (place - i) for a, b in zip(COLOURS[i], COLOURS[i + 1])]
