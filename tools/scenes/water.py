"""Water, with waves and with ice."""

import math

from gltf_builder import Gltf
from shared import hanging_lamp, walls


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
    walls(s, (-a, -1, -a), (a, rim, a), floor=tiles, back=tiles, front=tiles, left=tiles, right=tiles)
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
    hanging_lamp(s, lamp, (0, 3, 0), 0.2, 0.2)
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
    s.surround([0.25, 0.3, 0.4])
    s.quad("table", table, [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]])
    hanging_lamp(s, lamp, (-0.2, 0.5, -0.1), 0.03, 0.03)
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
