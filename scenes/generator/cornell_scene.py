"""The scene file of `cornell`."""

from .cornell import colours
from .nori import head

# Luminance of the lamp: the published spectrum has no absolute unit.
LUMINANCE = 20.0

ABOUT = """The Cornell box as Cornell's Program of Computer Graphics measured it, in metres.
     Colours are the published spectra under the lamp's, in linear sRGB."""
LENS = "\t\t<!-- A film 25 mm wide, 35 mm behind the lens -->\n"
LOOK = ((0.278, 0.273, -0.8), (0.278, 0.273, 0))

PART = """	<mesh type="obj">
		<string name="filename" value="meshes/{mesh}.obj"/>
		<bsdf type="diffuse"><color name="albedo" value="{colour}"/></bsdf>{rest}
	</mesh>
"""

LAMP = """
		<emitter type="area"><color name="radiance" value="{colour}"/></emitter>"""


def scene():
    """The text of the scene file."""
    rgb = colours()
    text = lambda values, factor=1.0: ", ".join(f"{factor * v:.4f}" for v in values)
    parts = [(name, text(rgb[name]), "") for name in ("white", "red", "green")]
    parts += [(name, text(rgb["white"]), "") for name in ("short", "tall")]
    # The lamp's own paint was taken to be white of reflectance 0.78.
    parts.append(("lamp", "0.78, 0.78, 0.78", LAMP.format(colour=text(rgb["lamp"], LUMINANCE))))
    return head(ABOUT, LOOK, 39.3077, (600, 600), LENS) + "".join(PART.format(mesh=m, colour=c, rest=r) for m, c, r in parts) + "</scene>\n"
