"""Sheets that polarize light, before a light table; a table of glass; a rhomb that turns linear light circular."""

import math

from gltf_builder import Gltf, facing, sub, unit


def light_table(scene, luminance):
    table = scene.surface("light table", "absorber")
    scene.materials[table]["extensions"]["ETD_optics"]["emission"] = {
        "luminance": luminance,
        "spectrum": {"illuminant": "D65"},
    }
    scene.shape("light table", "rectangle", table, [0, 0, -1], size=[6, 4])


def sheet(scene, name, class_name, place, size, **parameters):
    scene.shape(name, "rectangle", scene.surface(name, class_name, **parameters), place, size=size)


def polarizers():
    s = Gltf(
        "polarizers",
        "Polarizers before a light table of 100 cd/m². One lets half of the light through: 50. Two that are crossed, where the first"
        " and the last overlap, none: 0. A third one between them, its axis half-way, brings an eighth back: 12.5. A quarter-wave"
        " plate in the same place, at the right, brings a quarter of the wavelength that it is made for, 550 nm, less of longer ones"
        " and more of shorter ones: a bluish grey of 24 cd/m².",
    )
    light_table(s, 100)
    sheet(s, "first", "linear_polarizer", [-0.35, -0.25, -0.6], [2.1, 1.1], axis=0)
    sheet(s, "between", "linear_polarizer", [-0.25, 0, -0.5], [0.4, 2], axis=math.pi / 4)
    sheet(
        s,
        "quarter-wave plate",
        "retarder",
        [0.4, 0, -0.45],
        [0.4, 2],
        axis=math.pi / 4,
        ior_ordinary=1.5443,
        ior_extraordinary=1.5533,
        thickness=550 / 4 / 0.009,
    )
    sheet(s, "last", "linear_polarizer", [0.35, 0.25, -0.4], [2.1, 1.1], axis=math.pi / 2)
    s.orthographic([0, 0, 2], [0, 0, 0], 1.1, 1.6)
    return s


def retarders():
    s = Gltf(
        "retarders",
        "The colours of Michel-Lévy's chart: strips of a crystal of birefringence 0.009, each 5.5 micrometres thicker than the one at its"
        " left, between crossed polarizers before a light table of D65 and 100 cd/m². Their retardance goes from 50 to 1550 nm:"
        " grey, white, yellow, red and, at 551 nm, the purple that turns red or blue by the least change; then second-order blue, green,"
        " yellow and red, and the third order, paler. Of each wavelength sin²(pi G / lambda) / 2 passes.",
    )
    light_table(s, 100)
    sheet(s, "polarizer", "linear_polarizer", [0, 0, -0.6], [4, 2.6], axis=0)
    count, width = 31, 0.1
    for i in range(count):
        retardance = 50 * (i + 1)
        sheet(
            s,
            f"{retardance} nm",
            "retarder",
            [width * (i - (count - 1) / 2), 0, -0.5],
            [width, 1.4],
            axis=math.pi / 4,
            ior_ordinary=1.544,
            ior_extraordinary=1.553,
            thickness=retardance / 0.009,
        )
    sheet(s, "analyser", "linear_polarizer", [0, 0, -0.4], [4, 2.6], axis=math.pi / 2)
    s.orthographic([0, 0, 2], [0, 0, 0], 0.9, 2)
    return s


def glass_table():
    brewster = math.atan(1.5)
    s = Gltf(
        "glass_table",
        "A window of 500 cd/m² mirrored in a table of glass under Brewster's angle, 56.3°, and a printed card below the glass. The first"
        " camera measures Stokes vectors: in the middle the two faces of the glass mirror 0.129 of the window, 64 cd/m², all of it with"
        " S1 > 0, horizontal. The other two look through polarizers: the one with its axis level keeps the whole mirror image, the one"
        " with its axis upright (polarizer turned by 90°) sees none of it, and the card clearly.",
    )
    white = s.surface("paper", "lambertian", reflectance=0.8)
    s.shape("paper", "rectangle", white, matrix=facing([0, -0.06, 0], [0, 1, 0], up=(0, 0, -1)), size=[1.1, 0.9])
    for i in range(5):
        for k in range(3):
            color = [0.08, 0.08, 0.08] if (i + k) % 2 else [[0.6, 0.1, 0.08], [0.1, 0.35, 0.12], [0.1, 0.15, 0.5]][k]
            ink = s.surface(f"ink {i}, {k}", "lambertian", reflectance=color)
            place = [0.2 * (i - 2), -0.0595, 0.26 * (k - 1)]
            s.shape(f"ink {i}, {k}", "rectangle", ink, matrix=facing(place, [0, 1, 0], up=(0, 0, -1)), size=[0.14, 0.2])
    glass = s.surface("glass", "thin_dielectric", ior=1.5)
    s.shape("table", "rectangle", glass, matrix=facing([0, 0, 0], [0, 1, 0], up=(0, 0, -1)), size=[1.3, 1.0])
    view = [0, math.cos(brewster), math.sin(brewster)]  # from the table to the cameras
    back = [0, view[1], -view[2]]
    window = s.emitter("window", 500)
    s.shape("window", "rectangle", window, matrix=facing([2 * x for x in back], [-x for x in back]), size=[1, 0.55])
    s.surround(12)
    for name, x, axis in (("camera", 0, None), ("level", -0.12, 0), ("upright", 0.12, math.pi / 2)):
        place = [x, 1.6 * view[1], 1.6 * view[2]]
        s.camera(place, [0, 0, 0], 34, 1.5, name, stokes=axis is None)
        if axis is not None:
            towards = unit(sub([0, 0, 0], place))
            sheet = s.surface(f"polarizer, {name}", "linear_polarizer", axis=axis)
            at = [p + 0.05 * t for p, t in zip(place, towards)]
            s.shape(f"polarizer, {name}", "rectangle", sheet, matrix=facing(at, [-t for t in towards]), size=[0.08, 0.06])
    return s


def fresnel_rhomb():
    """Light along +x; faces of entry and exit stand upright, the long ones rise by 90° less the angle of incidence."""
    height, depth, incidence = 0.01, 0.012, math.radians(53.258222)
    slope = math.tan(math.pi / 2 - incidence)
    cosine, sine = math.sin(incidence), math.cos(incidence)
    length = 2 * height * cosine**3 / sine  # so that all that enters leaves
    s = Gltf(
        "fresnel_rhomb",
        "Fresnel's rhomb of glass, index 1.5, between a surface that emits light polarized at +45°, 100 cd/m², and a camera that measures"
        " Stokes vectors. Each of two total reflections under 53.26° delays the light across the plane of incidence against that in it by"
        " an eighth of a wave. Beside the rhomb the camera sees (S0, S1, S2, S3) = (100, 0, 100, 0); through its upper face (92.3, 0, 0, 92.0): right-handed"
        " circular light, less what the faces of entry and exit reflect, 4 % each, and with a little that has gone to and fro.",
    )
    s.medium("glass", ior=1.5)
    corners = [(0, 0), (length, length * slope), (length, length * slope + height), (0, height)]
    points = [[x, y, z] for z in (-depth / 2, depth / 2) for x, y in corners]
    triangles = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]]
    for i in range(4):
        k = (i + 1) % 4
        triangles += [[i, k, k + 4], [i, k + 4, i + 4]]
    s.mesh("rhomb", s.surface("glass", "dielectric", inside="glass"), points, triangles)
    lamp = s.surface("lamp", "absorber")
    s.materials[lamp]["extensions"]["ETD_optics"]["emission"] = {"luminance": 100, "stokes": [1, 0, 1, 0]}
    middle = length * slope + height / 2  # of the face of exit
    s.shape("lamp", "rectangle", lamp, matrix=facing([-0.005, middle, 0], [1, 0, 0]), size=[0.05, 0.06])
    s.orthographic([0.05, middle, 0], [0, middle, 0], 0.015, 1, stokes=True)
    return s
