"""White light that refraction parts into colours."""

import math

from gltf_builder import Gltf
from shared import walls


def dark_room(name, expected):
    """A scene with little light of its own, and the white material that catches the colours."""
    s = Gltf(name, expected)
    s.surround(0.002)
    return s, s.surface("white", "lambertian", reflectance=0.8)


def beam(s, intensity, y, z, inner, outer):
    """Light (cd) from (0, y, z) along -z, within half-angles in rad."""
    matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, y, z, 1]
    s.light("beam", "spot", intensity, matrix, spot={"innerConeAngle": inner, "outerConeAngle": outer})


def prism():
    s, white = dark_room(
        "prism",
        "A narrow beam of white light (D65) in a dim room meets a prism of flint glass (SF11, 60 degrees), turned so that the beam"
        " passes symmetrically: by Snell's law at both faces, it leaves at 66 degrees to its old direction, and"
        " throws a band on the white screen 1.2 m away, from red at the less bent side to violet, the lines F and C 3.9 degrees (8 cm)"
        " apart.",
    )
    s.medium("flint", ior={"name": "SF11 ior"})
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
    walls(s, (-2, 0, -2), (1, 0, 1), floor=white)
    beam(s, 4000, beam_height, 2, 0.004, 0.005)
    s.camera([0.35, 0.95, 0.55], [-0.5, 0.08, -0.3], 50, 1.5)
    return s


def rainbow():
    s, white = dark_room(
        "rainbow",
        "Theodoric's rainbow: a beam of white light (D65) comes through a hole in a white screen and fills a ball of"
        " water, 5 cm wide and 53 cm away, which throws light back around the hole. After one reflection in the water the"
        " light ends at a bright ring, red outside, violet inside, under Descartes' angles of 42.4 and 40.6 degrees: 51"
        " and 48 cm from the axis, as rays leave the ball 2.5 cm beside its centre. A faint ring after two reflections,"
        " with red inside, begins at 50 degrees, 60 cm from the axis; between the two it is darkest.",
    )
    s.medium("water", ior={"name": "water ior"})
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
    beam(s, 6e5, 0, 8, 0.0033, 0.0034)
    s.camera([0.5, -0.25, -0.85], [0, 0, 0.53], 54, 1.5)
    return s
