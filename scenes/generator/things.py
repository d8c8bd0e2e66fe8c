"""The things in the scenes: a tumbler with water, a bulb, fruit."""

from .smooth import arc, curve, revolve


def tumbler():
    """A glass of water as its three interfaces, each closed by the others.

    Glass meets air outside, at the rim and above the water; water meets glass below, and air above. Where the three
    meet they share the same ring of vertices. Heights are from the table, the radius of the rim is 0.42.
    """
    foot = [(0.0, 0.0), (0.27, 0.0)]
    heel = arc((0.27, 0.05), (0.055, 0.05), -90, -8, 10)
    outside = heel + [(0.3245 + 0.0955 * t / 12, 0.045 + 0.965 * t / 12) for t in range(1, 13)]
    rim = arc((0.405, 1.01), (0.015, 0.018), 0, 180, 12)
    outer = [foot, outside + rim[1:]]
    # The inner wall goes down from the rim to the bottom; water wets it up to `level`.
    slope = lambda y: 0.297 + 0.093 * (y - 0.14) / (1.01 - 0.14)
    level = 0.70
    dry = [(slope(y), y) for y in (1.01 - (1.01 - level) * i / 8 for i in range(9))]
    bowl = arc((0.237, 0.14), (0.06, 0.05), -90, 0, 12)
    wet = [(0.0, 0.09), (0.08, 0.09), (0.16, 0.09), *bowl]
    wet += [(slope(y), y) for y in (0.14 + (level - 0.14) * i / 14 for i in range(1, 15))]
    wall = wet[-1]
    meniscus = [(wall[0] - w, level - 0.03 + 0.03 * (1 - w / 0.07) ** 3) for w in (0.07 * i / 10 for i in range(11))]
    surface = [wall, *meniscus[1:], (0.2, level - 0.03), (0.0, level - 0.03)]
    dry[-1] = wall
    return {
        "glass-air": revolve("Where glass meets air.", [*outer, dry], 128),
        "water-glass": revolve("Where water meets glass; water is inside.", [wet], 128),
        "water-air": revolve("Where water meets air; water is below.", [surface], 128),
    }


def bulb():
    """A bulb of glass one unit in diameter, standing on its neck, and its socket. Its walls are 0.02 thick."""
    outline = curve([(0.19, 0.0), (0.19, 0.08), (0.235, 0.24), (0.38, 0.47), (0.49, 0.72), (0.5, 0.82)], 4)
    dome = arc((0.0, 0.82), (0.5, 0.5), 0, 90, 20)
    outer = outline + dome[1:]
    inner = [(r * 0.96, 0.82 + (y - 0.82) * 0.96) for r, y in outer]
    glass = revolve("The bulb: its outside, its edge below, and its inside.",
                    [outer, inner[::-1], [inner[0], outer[0]]], 80)
    turns = [(0.205 + (0.018 if i % 2 else 0.0), -0.52 + 0.06 * i) for i in range(10)]
    screw = [(0.1, -0.60), (0.16, -0.56), *curve(turns, 4), (0.17, 0.06), (0.17, 0.07)]
    socket = revolve("The screw of the bulb.", [[(0.0, -0.64), (0.1, -0.60)], screw, [(0.17, 0.07), (0.0, 0.07)]], 64)
    return {"bulb": glass, "screw": socket}


def pear():
    """A pear one unit high, with its stalk."""
    points = [(0.0, 0.03), (0.12, 0.0), (0.26, 0.07), (0.345, 0.24), (0.32, 0.42), (0.22, 0.6), (0.155, 0.76),
              (0.12, 0.86), (0.06, 0.9), (0.0, 0.87)]
    stalk = [(0.014, 0.86), (0.015, 0.95), (0.02, 1.04), (0.0, 1.045)]
    return {
        "pear": revolve("A pear.", [curve(points, 5)], 56),
        "pear-stalk": revolve("The stalk of the pear.", [stalk], 24),
    }


def apple():
    """An apple one unit wide, with its stalk."""
    points = [(0.0, 0.09), (0.07, 0.05), (0.16, 0.0), (0.3, 0.05), (0.43, 0.22), (0.5, 0.46), (0.46, 0.68),
              (0.33, 0.82), (0.19, 0.84), (0.08, 0.77), (0.0, 0.69)]
    stalk = [(0.016, 0.68), (0.014, 0.82), (0.022, 0.98), (0.0, 0.985)]
    return {
        "apple": revolve("An apple.", [curve(points, 5)], 56),
        "apple-stalk": revolve("The stalk of the apple.", [stalk], 24),
    }


def vase():
    """A vase one unit high, with an inside."""
    outer = curve([(0.0, 0.0), (0.16, 0.0), (0.22, 0.05), (0.34, 0.3), (0.3, 0.55), (0.13, 0.78), (0.1, 0.88),
                   (0.17, 1.0)], 5)
    inner = curve([(0.15, 1.0), (0.085, 0.88), (0.1, 0.78), (0.1, 0.7)], 4)
    return revolve("A vase.", [outer, [outer[-1], inner[0]], inner], 72)
