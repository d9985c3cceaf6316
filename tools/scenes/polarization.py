"""Sheets that polarize light, before a light table."""

import math

from gltf_builder import Gltf


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
