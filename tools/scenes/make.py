#!/usr/bin/env python3
"""Writes the example scenes: tools/scenes/make.py [FOLDER], scenes/ by default.

A scene is a function here that returns a Gltf with its expected value in words; those words go into the file
(scenes[0].extras.expected) and into the folder's README.md.
"""

import math
import random
import sys
import textwrap
from pathlib import Path

from gltf_builder import Gltf, facing, look_along

# Complex refractive indices at about 630, 550 and 465 nm (Johnson & Christy 1972 for gold and copper).
GOLD = {"eta": [0.18, 0.42, 1.37], "k": [3.42, 2.35, 1.77]}
COPPER = {"eta": [0.22, 1.03, 1.22], "k": [3.60, 2.58, 2.45]}
SILVER = {"eta": [0.06, 0.06, 0.04], "k": [4.27, 3.59, 2.65]}

OCTAHEDRON = (
    [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
)


def backdrop(scene, material, width, front, back, height, radius, steps=10):
    """A floor that bends up into a wall without an edge."""
    profile = [(front, 0.0, (0, 1))]
    for i in range(steps + 1):
        a = i / steps * math.pi / 2
        profile.append(
            (back + radius - radius * math.sin(a), radius - radius * math.cos(a), (math.sin(a), math.cos(a)))
        )
    profile.append((back, height, (1, 0)))
    positions, normals, triangles = [], [], []
    for z, y, (nz, ny) in profile:
        for x in (-width / 2, width / 2):
            positions.append([x, y, z])
            normals.append([0, ny, nz])
    for i in range(len(profile) - 1):
        a = 2 * i
        triangles += [[a, a + 1, a + 3], [a, a + 3, a + 2]]
    scene.mesh("backdrop", material, positions, triangles, normals)


def example():
    s = Gltf(
        "example",
        "Glass, metal and matte spheres on a seamless grey backdrop below a large lamp. The clear sphere"
        " shows the room upside down and gathers the lamp's light in its shadow; the green and amber ones"
        " take on the colour that glass has after some decimetres (Beer-Lambert); gold and copper follow"
        " Fresnel's equations for their measured refractive indices.",
    )
    s.environment = {"class": "constant", "radiance": [0.36, 0.37, 0.39]}
    s.medium("glass", ior=1.52)
    s.medium("green glass", ior=1.52, absorption=[4.5, 0.5, 2.6])
    s.medium("amber glass", ior=1.52, absorption=[0.25, 2.2, 9.0])
    grey = s.surface("backdrop", "lambertian", reflectance=[0.52, 0.51, 0.50])
    lamp = s.emitter("lamp", 3.6, (1, 0.95, 0.87))
    clear = s.surface("glass", "dielectric", inside="glass")
    green = s.surface("green glass", "dielectric", inside="green glass")
    amber = s.surface("amber glass", "dielectric", inside="amber glass")
    gold = s.surface("brushed gold", "conductor", alpha=0.12, **GOLD)
    copper = s.surface("copper", "conductor", alpha=0.02, **COPPER)
    red = s.surface("red clay", "lambertian", reflectance=[0.60, 0.11, 0.07])
    blue = s.surface("blue clay", "lambertian", reflectance=[0.09, 0.22, 0.42])
    backdrop(s, grey, 14, 6, -3, 6, 1.5)
    s.shape("lamp", "rectangle", lamp, matrix=facing([-2.4, 4.4, 1.6], [0.5, -1, -0.4]), size=[4, 3])
    for name, material, radius, x, z in (
        ("clear", clear, 0.62, 0.05, 0.55),
        ("gold", gold, 0.80, -1.40, -0.55),
        ("copper", copper, 0.55, 1.38, 0.20),
        ("red clay", red, 0.42, 0.42, -1.15),
        ("blue clay", blue, 0.95, 2.15, -1.55),
        ("green", green, 0.34, -0.98, 1.12),
        ("amber", amber, 0.26, 0.93, 1.35),
        ("small gold", gold, 0.17, -0.28, 1.62),
        ("small red clay", red, 0.24, -2.15, 0.75),
        ("small blue clay", blue, 0.20, 1.98, 1.22),
    ):
        s.shape(name, "sphere", material, [x, radius, z], radius=radius)
    s.camera([0.25, 1.75, 6.4], [0.08, 0.66, 0], 30, 1.6)
    return s


def cornell_box():
    s = Gltf(
        "cornell_box",
        "An open-fronted room of 3.2 x 2.4 x 3 m (width, height, depth) with two boxes, lit by one lamp of"
        " 0.9 x 0.7 m and luminance 18 (times its colour): the white walls and boxes take on the blue and the"
        " orange of the side walls. The flux of the lamp is pi x 18 x 0.8653 x 0.63 m² = 30.83 lm; 0.8653 is"
        " the luminance of its colour.",
    )
    white = s.surface("white", "lambertian", reflectance=0.74)
    blue = s.surface("blue", "lambertian", reflectance=[0.10, 0.22, 0.55])
    orange = s.surface("orange", "lambertian", reflectance=[0.72, 0.30, 0.06])
    lamp = s.emitter("lamp", 18, (1, 0.85, 0.62))
    w, h, d = 1.6, 2.4, 1.5
    s.quad("floor", white, [[-w, 0, d], [w, 0, d], [w, 0, -d], [-w, 0, -d]])
    s.quad("ceiling", white, [[-w, h, -d], [w, h, -d], [w, h, d], [-w, h, d]])
    s.quad("back", white, [[-w, 0, -d], [w, 0, -d], [w, h, -d], [-w, h, -d]])
    s.quad("left", blue, [[-w, 0, d], [-w, 0, -d], [-w, h, -d], [-w, h, d]])
    s.quad("right", orange, [[w, 0, -d], [w, 0, d], [w, h, d], [w, h, -d]])
    s.quad(
        "lamp",
        lamp,
        [[-0.45, h - 0.01, -0.35], [0.45, h - 0.01, -0.35], [0.45, h - 0.01, 0.35], [-0.45, h - 0.01, 0.35]],
    )
    for name, size, x, z, degrees in (
        ("tall box", [0.85, 1.45, 0.85], -0.62, -0.45, 20),
        ("low box", [0.85, 0.70, 0.85], 0.58, 0.38, -17),
    ):
        a = math.radians(degrees) / 2
        s.box(name, white, size, translation=[x, 0, z], rotation=[0, math.sin(a), 0, math.cos(a)])
    s.camera([0, 1.2, 5.6], [0, 1.2, 0], 32.4, 4 / 3)
    return s


def caustic_box():
    s = Gltf(
        "caustic_box",
        "A closed box of 2 m with a glass sphere (index 1.5) and a mirror sphere of radius 0.4 m under a lamp of 0.1 x 0.1 m"
        " that sends pi lm times its luminance 400 x 0.01 m². All of the lamp's light that has passed the glass lies in a bright spot"
        " in its shadow on the floor, and the mirror throws a wide bright arc on floor and walls; both are seen in the spheres, too.",
    )
    s.medium("glass", ior=1.5)
    white = s.surface("white", "lambertian", reflectance=0.7)
    red = s.surface("red", "lambertian", reflectance=[0.63, 0.07, 0.05])
    green = s.surface("green", "lambertian", reflectance=[0.15, 0.48, 0.09])
    glass = s.surface("glass", "dielectric", inside="glass")
    mirror = s.surface("mirror", "conductor", reflectance=0.95)
    lamp = s.emitter("lamp", 400, (1, 1, 1))
    a = 1.0
    s.quad("floor", white, [[-a, 0, a], [a, 0, a], [a, 0, -a], [-a, 0, -a]])
    s.quad("ceiling", white, [[-a, 2, -a], [a, 2, -a], [a, 2, a], [-a, 2, a]])
    s.quad("back", white, [[-a, 0, -a], [a, 0, -a], [a, 2, -a], [-a, 2, -a]])
    s.quad("front", white, [[a, 0, a], [-a, 0, a], [-a, 2, a], [a, 2, a]])
    s.quad("left", red, [[-a, 0, a], [-a, 0, -a], [-a, 2, -a], [-a, 2, a]])
    s.quad("right", green, [[a, 0, -a], [a, 0, a], [a, 2, a], [a, 2, -a]])
    s.quad("lamp", lamp, [[-0.05, 1.99, -0.05], [0.05, 1.99, -0.05], [0.05, 1.99, 0.05], [-0.05, 1.99, 0.05]])
    s.shape("glass sphere", "sphere", glass, [0.42, 0.4, -0.15], radius=0.4)
    s.shape("mirror sphere", "sphere", mirror, [-0.45, 0.4, -0.5], radius=0.4)
    s.camera([0, 1.1, 0.98], [0, 0.75, -0.3], 80, 1)
    return s


def glass_in_fog():
    s = Gltf(
        "glass_in_fog",
        "A glass sphere (index 1.5, radius 0.35 m) hangs in a cube of fog, which scatters a quarter of the light on each metre,"
        " under a lamp of 0.07 x 0.07 m whose light it gathers: a bright cone in the fog narrows towards a spot on the floor, and"
        " the shadow around it is a dark cone. The lamp sends pi x 1500 x 0.956 x 0.0049 m² = 22.1 lm; 0.956 is the luminance of"
        " its colour.",
    )
    s.medium("fog", scattering=0.25, phase={"class": "henyey_greenstein", "g": 0.4})
    s.medium("glass", ior=1.5)
    grey = s.surface("grey", "lambertian", reflectance=0.3)
    border = s.surface("border of the fog", "boundary", inside="fog")
    glass = s.surface("glass", "dielectric", inside="glass", outside="fog")
    lamp = s.emitter("lamp", 1500, (1, 0.95, 0.88))
    s.quad("floor", grey, [[-3, 0, 3], [3, 0, 3], [3, 0, -3], [-3, 0, -3]])
    s.box("fog", border, [2.6, 2.6, 2.6], translation=[0, 0.02, 0])
    a = 0.035
    s.quad("lamp", lamp, [[-a, 2.4, -a], [a, 2.4, -a], [a, 2.4, a], [-a, 2.4, a]])
    s.shape("glass sphere", "sphere", glass, [0, 1.5, 0], radius=0.35)
    s.camera([0, 1.9, 6.5], [0, 1.2, 0], 26, 1)
    return s


def noise(x, y, z):
    """Smooth random numbers between -1 and 1: a hash at the points of a lattice of unit width, cubic between them."""

    def corner(i, j, k):
        h = (i * 0x8DA6B343 + j * 0xD8163841 + k * 0xCB1AB31F) & 0xFFFFFFFF
        h = (h ^ h >> 15) * 0x2C1B3C6D & 0xFFFFFFFF
        return ((h ^ h >> 13) & 0xFFFF) / 32767.5 - 1

    def between(a, b, t):
        return a + (b - a) * t * t * (3 - 2 * t)

    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    planes = []
    for c in (k, k + 1):
        rows = [between(corner(i, b, c), corner(i + 1, b, c), x - i) for b in (j, j + 1)]
        planes.append(between(rows[0], rows[1], y - j))
    return between(planes[0], planes[1], z - k)


def cumulus():
    """A heap of balls over a flat base, frayed by noise: bytes of a lattice of 4 m, as NRRD."""
    nx, ny, nz, step = 68, 44, 52, 4.0
    low = (-nx * step / 2, 0.0, -nz * step / 2)
    balls = [(-68, 38, 5, 56), (0, 55, -15, 80), (66, 40, 10, 58), (18, 105, -8, 58), (-25, 68, 32, 62), (38, 40, 40, 56)]
    data = bytearray()
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                x, y, z = low[0] + i * step, low[1] + j * step, low[2] + k * step
                inside = max(1 - math.dist((x, y, z), ball[:3]) / ball[3] for ball in balls)
                if inside > -0.6 and y > 0:
                    for octave in range(4):
                        f = 0.021 * 2.1**octave
                        inside += 0.26 * 0.6**octave * noise(f * x, f * y + 7 * octave, f * z)
                inside *= min(1.0, y / 20)
                edge = i in (0, nx - 1) or j in (0, ny - 1) or k in (0, nz - 1)
                data.append(0 if edge or inside <= 0 else min(255, round(255 * min(1, 4 * inside))))
    header = (
        f"NRRD0004\ntype: uchar\ndimension: 3\nsizes: {nx} {ny} {nz}\nencoding: raw\nspace dimension: 3\n"
        f"space directions: ({step},0,0) (0,{step},0) (0,0,{step})\n"
        f"space origin: ({low[0]},{low[1]},{low[2]})\n\n"
    )
    return header.encode() + bytes(data)


def cloud():
    s = Gltf(
        "cloud",
        "A small cumulus, 250 m wide, from the file cloud.nrrd: droplets that scatter, mostly forward, and absorb nothing, 0.08/m"
        " where they are densest. The sun stands high on the left: that side is bright, almost white, every fold of it"
        " shades the next; the flat base is grey, with a little green of the plain, and the shadow below has soft edges. Where the"
        " cloud is thin, at its fringes, the sky shines through.",
    )
    s.environment = {"class": "constant", "radiance": [0.23, 0.38, 0.72]}
    s.files["cloud.nrrd"] = cumulus()
    s.medium(
        "cloud",
        **{"class": "grid"},
        file={"name": "cloud.nrrd", "translation": [0, 60, 0]},
        density=1 / 255,
        scattering=0.08,
        phase={"class": "henyey_greenstein", "g": 0.6},
    )
    border = s.surface("border of the cloud", "boundary", inside="cloud")
    plain = s.surface("plain", "lambertian", reflectance=[0.16, 0.2, 0.08])
    s.quad("plain", plain, [[-3000, 0, 3000], [3000, 0, 3000], [3000, 0, -3000], [-3000, 0, -3000]])
    s.box("cloud", border, [270, 174, 206], translation=[-2, 146.5, -2])
    s.light("sun", "directional", 7, look_along([0, 0, 0], [0.66, -0.7, -0.27]), (1, 0.94, 0.85))
    s.camera([60, 40, 520], [0, 122, 0], 30, 1.5)
    return s


def pool():
    s = Gltf(
        "pool",
        "A basin of 3 x 3 m, 1 m deep, full of water (index 1.33) whose surface ripples, under a square lamp of 0.2 m 3 m above the water."
        " The water bends the lamp's light into a net of bright lines on the floor, which is seen through the water: a path that no"
        " backward ray finds but by hitting the lamp.",
    )
    s.medium("water", ior=1.33)
    tiles = s.surface("tiles", "lambertian", reflectance=[0.55, 0.65, 0.7])
    water = s.surface("water", "dielectric", inside="water")
    lamp = s.emitter("lamp", 300, (1, 1, 1))
    a, rim = 1.5, 0.15
    s.quad("floor", tiles, [[-a, -1, a], [a, -1, a], [a, -1, -a], [-a, -1, -a]])
    s.quad("back", tiles, [[-a, -1, -a], [a, -1, -a], [a, rim, -a], [-a, rim, -a]])
    s.quad("front", tiles, [[a, -1, a], [-a, -1, a], [-a, rim, a], [a, rim, a]])
    s.quad("left", tiles, [[-a, -1, a], [-a, -1, -a], [-a, rim, -a], [-a, rim, a]])
    s.quad("right", tiles, [[a, -1, -a], [a, -1, a], [a, rim, a], [a, rim, -a]])
    waves = [(0.012, 5.1, 2.3, 0.4), (0.010, -3.7, 6.4, 1.9), (0.006, 9.8, -5.2, 0.7), (0.004, 3.1, 13.0, 2.6)]
    n = 64
    positions, triangles = [], []
    for j in range(n + 1):
        for i in range(n + 1):
            x, z = a * (2 * i / n - 1), a * (2 * j / n - 1)
            positions.append([x, sum(h * math.sin(kx * x + kz * z + p) for h, kx, kz, p in waves), z])
    for j in range(n):
        for i in range(n):
            k = j * (n + 1) + i
            triangles += [[k, k + n + 1, k + n + 2], [k, k + n + 2, k + 1]]
    s.mesh("water", water, positions, triangles)
    s.quad("lamp", lamp, [[-0.1, 3, -0.1], [0.1, 3, -0.1], [0.1, 3, 0.1], [-0.1, 3, 0.1]])
    s.camera([0, 2.6, 3.4], [0, -0.6, 0], 45, 1)
    return s


def lathe(scene, name, material, profile, segments=96):
    """A closed body of revolution about y; `profile`: (radius, height) along its right side from the axis, upward on the outside,
    back to the axis. Corners stay sharp: each band has its own normals."""
    positions, normals, triangles = [], [], []
    for (r0, y0), (r1, y1) in zip(profile, profile[1:]):
        length = math.hypot(r1 - r0, y1 - y0)
        nr, ny = (y1 - y0) / length, (r0 - r1) / length
        first = len(positions)
        for i in range(segments):
            c, s = math.cos(2 * math.pi * i / segments), math.sin(2 * math.pi * i / segments)
            positions += [[r0 * c, y0, r0 * s], [r1 * c, y1, r1 * s]]
            normals += [[nr * c, ny, nr * s]] * 2
        for i in range(segments):
            a, b = first + 2 * i, first + 2 * ((i + 1) % segments)
            triangles += [[a, a + 1, b + 1]] if r1 > 0 else []
            triangles += [[a, b + 1, b]] if r0 > 0 else []
    scene.mesh(name, material, positions, triangles, normals)


def iced_water():
    s = Gltf(
        "iced_water",
        "A tumbler (index 1.5, walls of 3 mm) with water (1.33) and three ice cubes (1.31) on a table, under a lamp of 3 x 3 cm half a"
        " metre above. The meshes overlap, and priorities say what is where: the water's reaches 1 mm into the glass, the cubes stand in"
        " the water, out of it, in each other and in the wall. No film of air shows between glass and water; the ice is nearly invisible"
        " below the surface and clear above it. The lamp's light lies on the table in bright curves within the tumbler's shadow.",
    )
    s.medium("glass", ior=1.5, absorption=[6, 1.5, 3])
    s.medium("ice", ior=1.31)
    s.medium("water", ior=1.33, absorption=[0.35, 0.07, 0.02])
    table = s.surface("table", "lambertian", reflectance=[0.55, 0.5, 0.44])
    glass = s.surface("glass", "dielectric", inside="glass", priority=3)
    ice = s.surface("ice", "dielectric", inside="ice", priority=2)
    water = s.surface("water", "dielectric", inside="water", priority=1)
    lamp = s.emitter("lamp", 4000, (1, 0.96, 0.9))
    s.environment = {"class": "constant", "radiance": [0.25, 0.3, 0.4]}
    s.quad("table", table, [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]])
    a = 0.015
    s.quad("lamp", lamp, [[-0.2 - a, 0.5, -0.1 - a], [-0.2 + a, 0.5, -0.1 - a], [-0.2 + a, 0.5, -0.1 + a], [-0.2 - a, 0.5, -0.1 + a]])
    foot, floor, rim, level, wall = 0.0005, 0.008, 0.1, 0.078, 0.003
    bottom, top = 0.032, 0.04  # outer radii

    def inner(y):
        return bottom + (top - bottom) * (y - foot) / (rim - foot) - wall

    lathe(s, "tumbler", glass, [(0, foot), (bottom, foot), (top, rim), (inner(rim), rim), (inner(floor), floor), (0, floor)])
    overlap = 0.001
    lathe(
        s,
        "water",
        water,
        [(0, floor - overlap), (inner(floor) + overlap, floor - overlap), (inner(level) + overlap, level), (0, level)],
    )
    for position, axis, degrees in (
        ((-0.012, 0.058, 0.006), (0.3, 1, 0.2), 25),
        ((0.013, 0.062, 0.008), (1, 0.4, -0.3), 40),
        ((0.004, 0.066, -0.021), (-0.2, 1, 0.6), 70),
    ):
        length = math.sqrt(sum(x * x for x in axis))
        half = math.radians(degrees) / 2
        rotation = [x / length * math.sin(half) for x in axis] + [math.cos(half)]
        s.box("ice cube", ice, [0.024, 0.024, 0.024], translation=list(position), rotation=rotation)
    s.camera([0.05, 0.15, 0.34], [0.012, 0.042, 0], 24, 1)
    return s


def prism():
    s = Gltf(
        "prism",
        "A narrow beam of white light (D65) in a dim room meets a prism of flint glass (SF11, 60 degrees), turned so that the beam"
        " passes symmetrically: by Snell's law at both faces, it leaves at 66 degrees to its old direction, and"
        " throws a band on the white screen 1.2 m away, from red at the less bent side to violet, the lines F and C 3.9 degrees (8 cm)"
        " apart.",
    )
    s.environment = {"class": "constant", "radiance": 0.002}
    s.medium("flint", ior={"name": "SF11 ior"})
    white = s.surface("white", "lambertian", reflectance=0.8)
    glass = s.surface("flint glass", "dielectric", inside="flint")
    side, beam_height = 0.12, 0.15
    apex = math.radians(60)
    incidence = math.asin(1.785 * math.sin(apex / 2))  # index at 588 nm

    def along(angle, length):  # in the ground plane, from -z towards -x
        return (-math.sin(angle) * length, -math.cos(angle) * length)

    # The beam comes along -z and meets the middle of the face `first` - `top` at the origin; within it runs along the base.
    inner, exit_angle = incidence - apex / 2, 2 * incidence - apex
    dx, dz = along(inner, 1)
    nx, nz = along(incidence, -1)  # normal of the first face
    fx, fz = (dx + math.cos(apex / 2) * nx) * side, (dz + math.cos(apex / 2) * nz) * side  # half the face, towards the apex
    first, top = (-fx, -fz), (fx, fz)
    second = (first[0] + side * dx, first[1] + side * dz)
    height = 2 * beam_height
    corners = [(first[0], 0.001, first[1]), (top[0], 0.001, top[1]), (second[0], 0.001, second[1])]
    positions = corners + [(x, height, z) for x, _, z in corners]
    triangles = [[0, 2, 1], [3, 4, 5], [0, 4, 3], [0, 1, 4], [1, 5, 4], [1, 2, 5], [2, 3, 5], [2, 0, 3]]
    s.mesh("prism", glass, positions, triangles)
    # A screen across the bent beam.
    sx, sz = along(exit_angle, 1.2)
    ax, az = along(exit_angle + math.pi / 2, 0.5)
    s.quad("screen", white, [[sx + ax, 0, sz + az], [sx - ax, 0, sz - az], [sx - ax, 0.4, sz - az], [sx + ax, 0.4, sz + az]])
    s.quad("floor", white, [[-2, 0, 1], [1, 0, 1], [1, 0, -2], [-2, 0, -2]])
    s.light("beam", "spot", 4000, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, beam_height, 2, 1],
            spot={"innerConeAngle": 0.004, "outerConeAngle": 0.005})
    s.camera([0.35, 0.95, 0.55], [-0.5, 0.08, -0.3], 50, 1.5)
    return s


def rainbow():
    s = Gltf(
        "rainbow",
        "Theodoric's rainbow: a beam of white light (D65) comes through a hole in a white screen and fills a ball of"
        " water, 5 cm wide and 53 cm away, which throws light back around the hole. After one reflection in the water the"
        " light ends at a bright ring, red outside, violet inside, under Descartes' angles of 42.4 and 40.6 degrees: 51"
        " and 48 cm from the axis, as rays leave the ball 2.5 cm beside its centre. A faint ring after two reflections,"
        " with red inside, begins at 50 degrees, 60 cm from the axis; between the two it is darkest.",
    )
    s.environment = {"class": "constant", "radiance": 0.002}
    s.medium("water", ior={"name": "water ior"})
    white = s.surface("white", "lambertian", reflectance=0.8)
    s.shape("drop", "sphere", s.surface("water", "dielectric", inside="water"), [0, 0, 0], radius=0.025)
    distance, hole, width, height = 0.53, 0.03, 0.95, 0.75
    for name, x0, x1, y0, y1 in (
        ("left", -width, -hole, -height, height),
        ("right", hole, width, -height, height),
        ("below", -hole, hole, -height, -hole),
        ("above", -hole, hole, hole, height),
    ):
        corners = [[x1, y0, distance], [x0, y0, distance], [x0, y1, distance], [x1, y1, distance]]
        s.quad("screen, " + name, white, corners)
    s.light("beam", "spot", 6e5, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 8, 1],
            spot={"innerConeAngle": 0.0033, "outerConeAngle": 0.0034})
    s.camera([0.5, -0.25, -0.85], [0, 0, 0.53], 54, 1.5)
    return s


def letter(s, x, y, z, yellow, red):
    """An F, 36 mm high, with a red square of 8 mm where its centre is."""
    for x0, y0, x1, y1 in ((-14, -18, -6, 18), (-6, 10, 14, 18), (-6, -4, -4, 4), (4, -4, 8, 4)):
        corners = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
        s.quad("letter", yellow, [[x + u / 1000, y + v / 1000, z] for u, v in corners])
    s.quad("centre", red, [[x + u, y + v, z] for u, v in ((-0.004, -0.004), (0.004, -0.004), (0.004, 0.004), (-0.004, 0.004))])


def grin():
    s = Gltf(
        "grin",
        "Media whose refractive index varies, before a chart that glows, seen by parallel rays: letters F with a red square"
        " in their middle. Above, rods of radius 3 cm and length 40 cm whose index falls from 1.6 on the axis as 1 / cosh(g r), a"
        " quarter of a pitch long, a half and a whole one (g L = pi/2, pi, 2 pi): the first shows the red square all over, since parallel"
        " rays meet on its far face; the second an F of the same size, upside down and the wrong way round; the third one upright. Of"
        " light 0.90 passes both faces. Below, from the left: the letter itself; a Luneburg lens, which touches the chart with the point"
        " where all rays meet, all red and as bright as the square, since it reflects nothing; a ball of glass (index 1.5), whose image is distorted.",
    )
    blue = s.emitter("ground", 1, (0.05, 0.1, 0.4))
    yellow = s.emitter("letter", 1, (1, 0.8, 0.1))
    red = s.emitter("centre", 1, (0.9, 0.05, 0.05))
    z, length, radius, gap = 0.0, 0.4, 0.03, 0.0003
    s.quad("ground", blue, [[-0.2, -0.15, z - 0.001], [0.2, -0.15, z - 0.001], [0.2, 0.15, z - 0.001], [-0.2, 0.15, z - 0.001]])
    columns = (-0.09, 0.0, 0.09)
    for x in columns:
        for y in (0.05, -0.05):
            letter(s, x, y, z, yellow, red)
    for x, quarters in zip(columns, (1, 2, 4)):
        g = quarters * math.pi / (2 * length)
        name = s.medium(
            f"rod of {quarters} quarters",
            **{"class": "gradient_index"},
            ior=1.6,
            radial=[round(-(g**2), 6), round(2 / 3 * g**4, 4), round(-17 / 45 * g**6, 2)],  # 1 / cosh², to r⁶
            center=[x, 0.05, z],
            tolerance=1e-5,
        )
        rod = s.surface(name, "dielectric", inside=name)
        back, front = z + gap, z + gap + length
        s.shape(name, "cylinder", rod, [x, 0.05, (back + front) / 2], radius=radius, height=length)
        s.shape(name, "disk", rod, [x, 0.05, front], radius=radius)
        s.shape(name, "disk", rod, matrix=facing([x, 0.05, back], [0, 0, -1]), radius=radius)
    center = [0.0, -0.05, z + gap + radius]
    s.medium(
        "Luneburg",
        **{"class": "gradient_index"},
        ior=round(math.sqrt(2), 9),
        radial=[round(-0.5 / radius**2, 6), 0, 0],
        axial=[0, round(-0.5 / radius**2, 6), 0],
        center=center,
        tolerance=1e-5,
    )
    s.medium("glass", ior=1.5)
    s.shape("Luneburg", "sphere", s.surface("Luneburg", "dielectric", inside="Luneburg"), center, radius=radius)
    glass = s.surface("glass", "dielectric", inside="glass")
    s.shape("glass", "sphere", glass, [0.09, -0.05, center[2]], radius=radius)
    s.orthographic([0, 0, 1], [0, 0, 0], 0.1, 1.5)
    return s


def spheres():
    s = Gltf(
        "spheres",
        "Six spheres before a constant surround of radiance 1. The clear and the frosted glass sphere (top"
        " left and middle) lose nothing and are invisible: 1. The tinted one (top right) is darker where the"
        " way through it is longer. The metals (below: silver, gold, copper) show at their centres the"
        " reflectance of their refractive indices at normal incidence: silver (0.988, 0.983, 0.980), gold"
        " (0.945, 0.777, 0.374), copper (0.939, 0.618, 0.554); the gold is rough, and is within 2 % of that.",
    )
    s.environment = {"class": "constant", "radiance": 1}
    s.medium("glass", ior=1.5)
    s.medium("tinted glass", ior=1.5, absorption=[0.9, 0.35, 0.10])
    kinds = [
        s.surface("clear glass", "dielectric", inside="glass"),
        s.surface("frosted glass", "dielectric", inside="glass", alpha=0.2, multiscatter=True),
        s.surface("tinted glass", "dielectric", inside="tinted glass"),
        s.surface("silver", "conductor", **SILVER),
        s.surface("rough gold", "conductor", alpha=0.15, multiscatter=True, **GOLD),
        s.surface("copper", "conductor", **COPPER),
    ]
    for i, kind in enumerate(kinds):
        s.shape(
            s.materials[kind]["name"], "sphere", kind, [2.3 * (i % 3 - 1), 1.15 - 2.3 * (i // 3), 0], radius=1
        )
    s.camera([0, 0, 14], [0, 0, 0], 21, 1.5)
    return s


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
    s.quad("floor", floor, [[-6, 0, 5], [6, 0, 5], [6, 0, -2], [-6, 0, -2]])
    s.quad("back", wall, [[-6, 0, -2], [6, 0, -2], [6, 4, -2], [-6, 4, -2]])
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
    s.shape("pane", "rectangle", pane, matrix=facing([0, 1.3, 0], [0, 1, 0], (0, 0, -1)), size=[1.7, 1.7])
    sideways = facing([0, 0, 0], [1, 0, 0])
    for z in (-0.85, 0.85):
        s.shape("rail", "cylinder", metal, matrix=sideways[:12] + [0, 1.3, z, 1], radius=0.025, height=1.75)
    for x in (-2.6, 0, 2.6):
        s.shape("ball", "sphere", ball, [x + 0.45, 0.22, 0.35], radius=0.22)
        s.box("block", block, [0.3, 0.75, 0.3], translation=[x - 0.5, 0, -0.3])
    s.camera([0, 3.1, 8.6], [0, 0.95, -0.3], 32, 16 / 9)
    return s


def materials():
    s = Gltf(
        "materials",
        "glTF's metallic-roughness material: metal (back row), glass (middle) and painted plastic (front),"
        " roughness from 0 (left) to 1 (right). Highlights widen from left to right; rough metal and rough"
        " glass darken, as light that meets more than one facet is lost; no sphere is brighter than what it"
        " mirrors.",
    )
    s.environment = {"class": "constant", "radiance": [0.32, 0.34, 0.38]}
    floor = s.surface("floor", "lambertian", reflectance=0.42)
    backdrop(s, floor, 20, 8, -4.5, 7, 2)
    lamp = s.emitter("lamp", 6, (1, 0.95, 0.88))
    s.shape("lamp", "rectangle", lamp, matrix=facing([-2.5, 5, 2.5], [0.45, -1, -0.5]), size=[4, 2])
    s.shape("strip", "rectangle", lamp, matrix=facing([5.5, 2.5, 3], [-1, -0.3, -0.6]), size=[0.7, 4])
    columns = 6
    for row, (name, color, metallic, transmission) in enumerate(
        (
            ("plastic", [0.05, 0.23, 0.50], 0, None),
            ("glass", [1, 1, 1], 0, 1),
            ("metal", [0.91, 0.62, 0.38], 1, None),
        )
    ):
        for i in range(columns):
            roughness = i / (columns - 1)
            material = s.principled(
                f"{name}, roughness {roughness:.1f}",
                color,
                metallic,
                roughness,
                transmission,
                1.5 if transmission else None,
            )
            s.shape(
                f"{name} {i}",
                "sphere",
                material,
                [1.08 * (i - (columns - 1) / 2), 0.46, 1.7 - 1.5 * row],
                radius=0.46,
            )
    s.camera([0, 6.2, 9.0], [0, 0.28, 0.15], 25, 1.6)
    return s


def finishes():
    s = Gltf(
        "finishes",
        "What lies on surfaces, plain (back row) and finished (front row), from the left: red paint under a clear coat, which"
        " mirrors the lamps sharply; brushed steel, whose highlight is drawn out along the parallels; velvet with a bright"
        " rim at grazing angles; resin with a golden reflection; a paper globe that passes on three quarters of the diffuse"
        " light, with a lamp inside.",
    )
    s.environment = {"class": "constant", "radiance": [0.22, 0.23, 0.26]}
    floor = s.surface("floor", "lambertian", reflectance=0.35)
    backdrop(s, floor, 20, 8, -4.5, 7, 2)
    lamp = s.emitter("lamp", 7, (1, 0.95, 0.88))
    s.shape("lamp", "rectangle", lamp, matrix=facing([-2.5, 5, 2.5], [0.45, -1, -0.5]), size=[4, 2])
    s.shape("strip", "rectangle", lamp, matrix=facing([5.5, 2.5, 3], [-1, -0.3, -0.6]), size=[0.7, 4])
    paint, steel, cloth, resin = [0.42, 0.02, 0.02], [0.62, 0.61, 0.60], [0.10, 0.02, 0.16], [0.05, 0.05, 0.06]
    paper = [0.85, 0.80, 0.70]
    rows = (
        (
            s.principled("paint", paint, 0, 0.6),
            s.principled("steel", steel, 1, 0.35),
            s.principled("cloth", cloth, 0, 1),
            s.principled("resin", resin, 0, 0.35),
            s.principled("card", paper, 0, 1),
        ),
        (
            s.principled("coated paint", paint, 0, 0.6, clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.05}),
            s.principled("brushed steel", steel, 1, 0.35, anisotropy={"anisotropyStrength": 0.8}),
            s.principled(
                "velvet", cloth, 0, 1, sheen={"sheenColorFactor": [0.75, 0.55, 0.95], "sheenRoughnessFactor": 0.45}
            ),
            s.principled("gilded resin", resin, 0, 0.35, specular={"specularColorFactor": [12, 8, 3]}),
            s.principled(
                "paper",
                paper,
                0,
                1,
                diffuse_transmission={
                    "diffuseTransmissionFactor": 0.75,
                    "diffuseTransmissionColorFactor": [0.95, 0.86, 0.66],
                },
            ),
        ),
    )
    upright = facing([0, 0, 0], [0, 1, 0], (0, 0, -1))
    for row, kinds in enumerate(rows):
        for i, kind in enumerate(kinds):
            x, z = 1.15 * (i - 2), -0.35 + 1.5 * row
            s.shape(s.materials[kind]["name"], "sphere", kind, matrix=upright[:12] + [x, 0.46, z, 1], radius=0.46)
    bulb = s.emitter("bulb", 8, (1, 0.8, 0.55))
    s.shape("bulb", "sphere", bulb, [2.3, 0.46, 1.15], radius=0.12)
    s.camera([0, 4.2, 9.0], [0, 0.28, 0.3], 23, 1.8)
    return s


def films():
    s = Gltf(
        "films",
        "Colours of thin films, in wavelengths, before a bright surround. Above, chromium under an oxide of index 2.2 and 20, 40,"
        " 60, 90 and 130 nm: straw, brown, blue, pale blue and yellow, as metals take them on when they are heated. Below, from the"
        " left: soap films of 100, 300 and 500 nm around air, coloured in their rims; black plastic with glTF's"
        " iridescence of 400 nm; glass with a film of index 1.22 and 112 nm, which mirrors less than bare glass.",
    )
    s.environment = {"class": "constant", "radiance": 0.25}
    floor = s.surface("floor", "lambertian", reflectance=0.12)
    backdrop(s, floor, 20, 8, -4.5, 7, 2, steps=40)
    lamp = s.emitter("lamp", 5)
    s.shape("lamp", "rectangle", lamp, matrix=facing([-3, 5, 3], [0.5, -1, -0.5]), size=[5, 3])
    s.shape("strip", "rectangle", lamp, matrix=facing([5.5, 2.5, 3], [-1, -0.3, -0.6]), size=[1.5, 4])
    s.medium("glass", ior=1.5)
    chromium = {"eta": {"name": "Cr eta"}, "k": {"name": "Cr k"}}
    rows = (
        [
            s.surface(f"oxide of {d} nm", "thin_film", ior=2.2, thickness=d, alpha=0.1, **chromium)
            for d in (20, 40, 60, 90, 130)
        ],
        [s.surface(f"soap of {d} nm", "thin_film", ior=1.33, thickness=d) for d in (100, 300, 500)]
        + [
            s.principled("iridescent plastic", [0.02, 0.02, 0.02], 0, 0.2, iridescence={"iridescenceFactor": 1}),
            s.surface("coated glass", "thin_film", inside="glass", ior=1.22, thickness=112),
        ],
    )
    for row, kinds in enumerate(rows):
        for i, kind in enumerate(kinds):
            s.shape(s.materials[kind]["name"], "sphere", kind, [1.15 * (i - 2), 0.5, -0.35 + 1.5 * row], radius=0.46)
    s.camera([0, 4.2, 9.0], [0, 0.28, 0.3], 23, 1.8)
    return s


def many_lights():
    s = Gltf("many_lights", "")
    floor = s.surface("floor", "lambertian", reflectance=[0.62, 0.60, 0.57])
    wall = s.surface("wall", "lambertian", reflectance=[0.70, 0.68, 0.66])
    metal = s.surface("pillar", "conductor", alpha=0.25, **COPPER)
    s.quad("floor", floor, [[-6, 0, 8], [6, 0, 8], [6, 0, -12], [-6, 0, -12]])
    s.quad("back", wall, [[-6, 0, -12], [6, 0, -12], [6, 5, -12], [-6, 5, -12]])
    s.quad("left", wall, [[-6, 0, 8], [-6, 0, -12], [-6, 5, -12], [-6, 5, 8]])
    s.quad("right", wall, [[6, 0, -12], [6, 0, 8], [6, 5, 8], [6, 5, -12]])
    s.quad("ceiling", wall, [[-6, 5, -12], [6, 5, -12], [6, 5, 8], [-6, 5, 8]])
    upright = facing([0, 0, 0], [0, 1, 0], (0, 0, -1))
    for z in (-8.5, -4.5, -0.5, 3.5):
        for x in (-3.6, 3.6):
            s.shape("pillar", "cylinder", metal, matrix=upright[:12] + [x, 2.5, z, 1], radius=0.3, height=5)
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


def furnace_smooth():
    s = Gltf(
        "furnace_smooth",
        "Lossless things in a constant surround of radiance 1: white plaster, a perfect mirror, clear glass,"
        " a thin pane, white glossy paint, and a mirror cylinder. All are invisible: every pixel is 1 within"
        " 0.2 %.",
    )
    s.environment = {"class": "constant", "radiance": 1}
    s.medium("glass", ior=1.5)
    for i, (shape, kind, parameters) in enumerate(
        (
            ("sphere", s.surface("white", "lambertian", reflectance=1), {"radius": 1}),
            ("sphere", s.surface("mirror", "conductor", reflectance=1), {"radius": 1}),
            ("sphere", s.surface("glass", "dielectric", inside="glass"), {"radius": 1}),
            ("disk", s.surface("pane", "thin_dielectric", ior=1.5), {"radius": 1}),
            ("sphere", s.principled("white paint", [1, 1, 1], 0, 0), {"radius": 1}),
            (
                "cylinder",
                s.surface("mirror cylinder", "conductor", reflectance=1),
                {"radius": 0.8, "height": 1.8},
            ),
        )
    ):
        s.shape(
            s.materials[kind]["name"],
            shape,
            kind,
            matrix=facing([2.3 * (i % 3 - 1), 1.15 - 2.3 * (i // 3), 0], [0.5, 0.3, 1]),
            **parameters,
        )
    s.camera([0, 0, 14], [0, 0, 0], 21, 1.5)
    return s


def furnace_rough():
    s = Gltf(
        "furnace_rough",
        "Rough mirrors (above) and rough glass (below) that keep the light scattered more than once between"
        " facets, of GGX width 0.1, 0.3 and 0.7 from left to right, in a constant surround of radiance 1:"
        " invisible, every pixel is 1 within 0.5 %.",
    )
    s.environment = {"class": "constant", "radiance": 1}
    s.medium("glass", ior=1.5)
    for i, alpha in enumerate((0.1, 0.3, 0.7)):
        metal = s.surface(
            f"mirror, alpha {alpha}", "conductor", reflectance=1, alpha=alpha, multiscatter=True
        )
        glass = s.surface(
            f"glass, alpha {alpha}", "dielectric", inside="glass", alpha=alpha, multiscatter=True
        )
        s.shape(f"mirror {i}", "sphere", metal, [2.3 * (i - 1), 1.15, 0], radius=1)
        s.shape(f"glass {i}", "sphere", glass, [2.3 * (i - 1), -1.15, 0], radius=1)
    s.camera([0, 0, 14], [0, 0, 0], 21, 1.5)
    return s


def furnace_closed():
    s = Gltf(
        "furnace_closed",
        "Inside a closed sphere that emits radiance 1 everywhere and reflects half of what it gets,"
        " diffusely, with a white ball, a mirror and a glass ball that lose nothing: 1 + 1/2 + 1/4 + … = 2,"
        " every pixel within 0.3 %.",
    )
    s.medium("glass", ior=1.5)
    wall = s.emitter("wall", 1)
    s.materials[wall]["doubleSided"] = True
    s.materials[wall]["extensions"]["ETD_optics"]["surface"]["reflectance"] = 0.5
    s.shape("wall", "sphere", wall, radius=4)
    for x, kind in (
        (-1.2, s.surface("white", "lambertian", reflectance=1)),
        (0, s.surface("mirror", "conductor", reflectance=1)),
        (1.2, s.surface("glass", "dielectric", inside="glass")),
    ):
        s.shape(s.materials[kind]["name"], "sphere", kind, [x, 0, 0], radius=0.5)
    s.camera([0, 0, 3.5], [0, 0, 0], 45, 1.5)
    return s


SCENES = [
    example,
    cornell_box,
    caustic_box,
    glass_in_fog,
    cloud,
    pool,
    iced_water,
    prism,
    rainbow,
    grin,
    spheres,
    lamps,
    materials,
    finishes,
    films,
    many_lights,
    furnace_smooth,
    furnace_rough,
    furnace_closed,
]

README = """# Example scenes

Written by `tools/scenes/make.py`, which says how each is built; change the scenes there. Render one with
`build/release/etendue render scenes/example.gltf -o example.exr`. What each must show:

"""


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2] / "scenes"
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for make in SCENES:
        scene = make()
        scene.write(folder / f"{scene.name}.gltf")
        text = textwrap.fill(
            f"**{scene.name}.gltf** {scene.expected}",
            108,
            initial_indent="- ",
            subsequent_indent="  ",
            break_on_hyphens=False,
        )
        lines.append(text)
    (folder / "README.md").write_text(README + "\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
