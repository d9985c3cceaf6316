"""Rooms whose walls light each other."""

import math

from gltf_builder import Gltf
from shared import hanging_lamp, walls


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
    walls(s, (-w, 0, -d), (w, h, d), floor=white, ceiling=white, back=white, left=blue, right=orange)
    hanging_lamp(s, lamp, (0, h - 0.01, 0), 0.9, 0.7)
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
    walls(s, (-1, 0, -1), (1, 2, 1), floor=white, ceiling=white, back=white, front=white, left=red, right=green)
    hanging_lamp(s, lamp, (0, 1.99, 0), 0.1, 0.1)
    s.shape("glass sphere", "sphere", glass, [0.42, 0.4, -0.15], radius=0.4)
    s.shape("mirror sphere", "sphere", mirror, [-0.45, 0.4, -0.5], radius=0.4)
    s.camera([0, 1.1, 0.98], [0, 0.75, -0.3], 80, 1)
    return s
