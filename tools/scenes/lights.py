"""Lamps of known intensity, and a great number of them."""

import math
import random

from gltf_builder import Gltf, facing, look_along
from shared import COPPER, OCTAHEDRON, SILVER, upright, walls


def lamps():
    s = Gltf(
        "lamps",
        "Three bays with lamps of 45 cd, 3 m above a floor of reflectance 0.5, and two spots on the back"
        " wall. Below the left one, a spot, the floor gets 45 / 3² = 5 lx and has the luminance 5 x 0.5 / pi"
        " = 0.80 (a little more with the light that the room returns). The middle one shines through a thin"
        " pane, which lets 2n / (n² + 1) = 0.923 of it pass: 0.73. The right one is a square of 0.4 m and"
        " luminance 281.25, 45 cd straight down: 0.79, falling off with the fourth power of the cosine, and"
        " with soft shadows where the spots' are sharp.",
    )
    floor = s.surface("floor", "lambertian", reflectance=0.5)
    wall = s.surface("wall", "lambertian", reflectance=[0.42, 0.40, 0.37])
    dark = s.surface("partition", "lambertian", reflectance=0.06)
    ball = s.surface("ball", "lambertian", reflectance=[0.68, 0.30, 0.10])
    block = s.surface("block", "lambertian", reflectance=[0.16, 0.34, 0.46])
    pane = s.surface("pane", "thin_dielectric", ior=1.5)
    metal = s.surface("rail", "conductor", alpha=0.15, **SILVER)
    lamp = s.emitter("square lamp", 281.25)
    walls(s, (-6, 0, -2), (6, 4, 5), floor=floor, back=wall)
    for x in (-1.3, 1.3):
        s.box("partition", dark, [0.06, 3.2, 3.4], translation=[x, 0, -0.3])
    down = [0, -1, 0]
    cones = {"spot": {"innerConeAngle": 0.32, "outerConeAngle": 0.42}}
    for x in (-2.6, 0):
        s.light("spot", "spot", 45, look_along([x, 3, 0], down, (0, 0, -1)), **cones)
    s.shape("square lamp", "rectangle", lamp, matrix=facing([2.6, 3, 0], down, (0, 0, -1)), size=[0.4, 0.4])
    for x in (-2.6, 0):
        s.light(
            "wall washer",
            "spot",
            10,
            look_along([x, 3.4, -1.55], [0, -1, -0.3]),
            (1, 0.72, 0.40),
            spot={"innerConeAngle": 0.1, "outerConeAngle": 0.7},
        )
    s.shape("pane", "rectangle", pane, matrix=upright([0, 1.3, 0]), size=[1.7, 1.7])
    for z in (-0.85, 0.85):
        s.shape("rail", "cylinder", metal, matrix=facing([0, 1.3, z], [1, 0, 0]), radius=0.025, height=1.75)
    for x in (-2.6, 0, 2.6):
        s.shape("ball", "sphere", ball, [x + 0.45, 0.22, 0.35], radius=0.22)
        s.box("block", block, [0.3, 0.75, 0.3], translation=[x - 0.5, 0, -0.3])
    s.camera([0, 3.1, 8.6], [0, 0.95, -0.3], 32, 16 / 9)
    return s


def many_lights():
    s = Gltf("many_lights", "")
    floor = s.surface("floor", "lambertian", reflectance=[0.62, 0.60, 0.57])
    wall = s.surface("wall", "lambertian", reflectance=[0.70, 0.68, 0.66])
    metal = s.surface("pillar", "conductor", alpha=0.25, **COPPER)
    walls(s, (-6, 0, -12), (6, 5, 8), floor=floor, back=wall, left=wall, right=wall, ceiling=wall)
    for z in (-8.5, -4.5, -0.5, 3.5):
        for x in (-3.6, 3.6):
            s.shape("pillar", "cylinder", metal, matrix=upright([x, 2.5, z]), radius=0.3, height=5)
    r, luminance = 0.08, 4.0
    colors = (
        ("amber", (1, 0.50, 0.12)),
        ("rose", (1, 0.22, 0.26)),
        ("white", (1, 0.84, 0.62)),
        ("teal", (0.10, 0.72, 0.60)),
        ("blue", (0.20, 0.36, 1)),
    )
    places = [[] for _ in colors]
    random.seed(7)
    for i in range(25):
        for j in range(50):
            x, z = (
                11 * (v + random.uniform(0.1, 0.9)) / n + low
                for v, n, low in ((i, 25, -5.5), (j * 17 / 11, 50, -11.6))
            )
            y = (
                3.1
                + 0.4 * math.sin(0.9 * x + 0.5 * z)
                + 0.3 * math.cos(0.7 * z - 0.3 * x)
                + random.uniform(-0.1, 0.1)
            )
            band = 2.5 + 2.5 * math.sin(0.35 * z + 0.45 * x) + random.gauss(0, 0.5)
            places[min(max(int(band), 0), 4)].append([x, y, z])
    flux = 0
    for (name, color), some in zip(colors, places):
        s.instances(
            f"{name} lanterns",
            s.emitter(f"{name} lantern", luminance, color),
            [[r * x for x in p] for p in OCTAHEDRON[0]],
            OCTAHEDRON[1],
            some,
        )
        flux += (
            math.pi
            * luminance
            * (0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2])
            * (4 * math.sqrt(3) * r * r * len(some))
        )
    s.expected = (
        f"A hall below {sum(map(len, places))} coloured paper lanterns, 10,000 emissive triangles in all: an"
        " even light on the floor in the colours of the lanterns above it, and noise as low as with a few"
        f" lamps. Together they emit {flux:.0f} lm: pi x {luminance} x the luminance of each colour x the"
        f" octahedra's area of 4 sqrt(3) r², r = {r} m."
    )
    s.camera([0.6, 1.65, 7.6], [-0.1, 1.55, 0], 46, 1.6)
    return s
