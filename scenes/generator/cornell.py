"""The Cornell box, from the measurements that Cornell's Program of Computer Graphics published (1985 to 2005).

Lengths are published in millimetres and written in metres.
"""

from math import exp

from .mesh import Mesh

# x 0 … 556 with the walls a little out of true, y up, z away from the camera.
FLOOR = [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)]
BACK = [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)]
GREEN = [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)]
RED = [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)]
LAMP = [(343, 548.8, 227), (343, 548.8, 332), (213, 548.8, 332), (213, 548.8, 227)]
SHORT = (165, [(130, 65), (82, 225), (240, 272), (290, 114)])
TALL = (330, [(423, 247), (265, 296), (314, 456), (472, 406)])
MIDDLE = (278, 274.4, 279.6)

# Reflectances at 400, 404, … 700 nm, in thousandths.
WHITE_SPECTRUM = """
    343 445 551 624 665 687 708 723 715 710 745 758 739 767 777 765 751 745 748 729 745 757 753 750 746 747
    735 732 739 734 725 721 733 725 732 743 744 748 728 716 733 726 713 740 754 764 752 736 734 741 740 732
    745 755 751 744 731 733 744 731 712 708 729 730 727 707 703 729 750 760 751 739 724 730 740 737"""
GREEN_SPECTRUM = """
    092 096 098 097 098 095 095 097 095 094 097 098 096 101 103 104 107 109 112 115 125 140 160 187 229 285
    343 390 435 464 472 476 481 462 447 441 426 406 373 347 337 314 285 277 266 250 230 207 186 171 160 148
    141 136 130 126 123 121 122 119 114 115 117 117 118 120 122 128 132 139 144 146 150 152 157 159"""
RED_SPECTRUM = """
    040 046 048 053 049 050 053 055 057 056 059 057 061 061 060 062 062 062 061 062 060 059 057 058 058 058
    056 055 056 059 057 055 059 059 058 059 061 061 063 063 067 068 072 080 090 099 124 154 192 255 287 349
    402 443 487 513 558 584 620 606 609 651 612 610 650 638 627 620 630 628 642 639 657 639 635 642"""
# The lamp's emission at 400, 500, 600 and 700 nm; linear between.
LAMP_SPECTRUM = (0.0, 8.0, 15.6, 18.4)


def meshes():
    """The box's parts, by the names of their files."""
    white = Mesh("Floor, back wall, and a ceiling that goes around the lamp.")
    for polygon in [FLOOR, BACK, *ceiling()]:
        facing(white, polygon, MIDDLE, True)
    parts = {"white": white, "red": Mesh("The wall on the left."), "green": Mesh("The wall on the right.")}
    parts |= {"lamp": Mesh("The lamp, in the plane of the ceiling.")}
    for name, polygon in (("red", RED), ("green", GREEN), ("lamp", LAMP)):
        facing(parts[name], polygon, MIDDLE, True)
    for name, (height, base) in (("short", SHORT), ("tall", TALL)):
        parts[name] = block(f"The {name} block.", height, base)
    return parts


def ceiling():
    """The ceiling without the lamp's rectangle, as four quadrilaterals."""
    x = (0, 213, 343, 556)
    z = (0, 227, 332, 559.2)
    spans = [(x[0], x[3], z[0], z[1]), (x[0], x[3], z[2], z[3]), (x[0], x[1], z[1], z[2]), (x[2], x[3], z[1], z[2])]
    return [[(a, 548.8, c), (b, 548.8, c), (b, 548.8, d), (a, 548.8, d)] for a, b, c, d in spans]


def block(about, height, base):
    """A block without its bottom, which lies on the floor."""
    mesh = Mesh(about)
    middle = (sum(p[0] for p in base) / 4, height / 2, sum(p[1] for p in base) / 4)
    facing(mesh, [(x, height, z) for x, z in base], middle, False)
    for (x0, z0), (x1, z1) in zip(base, base[1:] + base[:1]):
        facing(mesh, [(x0, 0, z0), (x0, height, z0), (x1, height, z1), (x1, 0, z1)], middle, False)
    return mesh


def facing(mesh, polygon, point, towards):
    """Adds a polygon whose front is towards a point, or away from it; millimetres become metres."""
    a, b, c = polygon[:3]
    u, v, w = ([q[i] - a[i] for i in range(3)] for q in (b, c, point))
    volume = sum(w[i] * (u[i - 2] * v[i - 1] - u[i - 1] * v[i - 2]) for i in range(3))
    ordered = polygon if (volume > 0) == towards else polygon[::-1]
    mesh.polygon([tuple(c / 1000 for c in p) for p in ordered])


def colours():
    """Linear sRGB of the three paints under the lamp, and of the lamp (luminance 1)."""
    lamp = to_rgb([1.0] * 76)
    luminance = 0.2126 * lamp[0] + 0.7152 * lamp[1] + 0.0722 * lamp[2]
    result = {"lamp": [c / luminance for c in lamp]}
    for name, text in (("white", WHITE_SPECTRUM), ("green", GREEN_SPECTRUM), ("red", RED_SPECTRUM)):
        paint = to_rgb([int(v) / 1000 for v in text.split()])
        result[name] = [max(c / l, 0) for c, l in zip(paint, lamp)]
    return result


def to_rgb(reflectance):
    """Linear sRGB of the lamp's light off a reflectance at 400, 404, … 700 nm; not normalised."""
    xyz = [0.0, 0.0, 0.0]
    for i, r in enumerate(reflectance):
        for k, response in enumerate(observer(400 + 4 * i)):
            xyz[k] += response * r * emission(400 + 4 * i)
    rows = ((3.2406, -1.5372, -0.4986), (-0.9689, 1.8758, 0.0415), (0.0557, -0.2040, 1.0570))
    return [sum(m * c for m, c in zip(row, xyz)) for row in rows]


def emission(wavelength):
    """The lamp's emission at a wavelength in nm."""
    i = min((wavelength - 400) // 100, 2)
    t = (wavelength - 400) / 100 - i
    return LAMP_SPECTRUM[i] * (1 - t) + LAMP_SPECTRUM[i + 1] * t


def observer(nm):
    """The CIE 1931 observer: the lobes that Wyman, Sloan and Shirley fitted (JCGT 2(2), 2013, table 1)."""

    def lobe(height, mean, left, right):
        t = (nm - mean) / (left if nm < mean else right)
        return height * exp(-0.5 * t * t)

    x = lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7) - lobe(0.065, 501.1, 20.4, 26.2)
    y = lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1)
    z = lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8)
    return x, y, z
