"""Scenes to be measured: lamps as their makers publish them, and meters. `etendue measure` reads them."""

import math

from gltf_builder import Gltf, facing, look_along
from shared import walls

DOWN = [0, -1, 0]


def level(height, x=0, z=0):
    """Of a meter that faces up, its rows along x."""
    return facing([x, height, z], [0, 1, 0], (0, 0, -1))


def eulumdat(name, candela, gammas, lumens, side):
    """A luminaire whose light is the same all around: `candela` of gamma (degrees), scaled to the flux; its opening is a square (mm)."""
    fine = [(i + 0.5) / 10 for i in range(int(10 * gammas[-1]))]
    flux = sum(2 * math.pi * candela(g) * math.sin(math.radians(g)) * math.radians(0.1) for g in fine)
    lines = ["computed", 1, 1, 1, 0, len(gammas), gammas[1] - gammas[0], "", name, "", "", "2026", side, side, 60, side, side]
    lines += [0, 0, 0, 0, 100, 100, 1, 0, 1, 1, "LED", lumens, 4000, 80, 30, *[0] * 10, 0, *gammas]
    lines += [f"{candela(g) * 1000 / flux:.3f}" for g in gammas]
    return ("\r\n".join(map(str, lines)) + "\r\n").encode("latin-1")


def street_lamp():
    """An IES file: two lobes along the road at gamma = 62 degrees, turned 20 degrees to the road, and some light straight down."""

    def candela(c, gamma):
        along = max(math.cos(math.radians(c - 20)), math.cos(math.radians(c - 160)), 0) ** 4
        lobes = 900 * math.exp(-(((gamma - 62) / 14) ** 2)) * along
        return (lobes + 320 * math.cos(math.radians(gamma))) * (1 if gamma < 75 else max(0, (85 - gamma) / 10))

    gammas, planes = range(0, 91, 5), range(0, 361, 15)
    lines = ["IES:LM-63-2019", "[TEST] computed", "[TESTLAB] étendue", "[ISSUEDATE] 2026", "[MANUFAC] none"]
    lines += ["[LUMINAIRE] street luminaire, a formula", "TILT=NONE", f"1 -1 1 {len(gammas)} {len(planes)} 1 2 0.3 0.5 0", "1 1.00010 40"]
    lines += [" ".join(map(str, gammas)), " ".join(map(str, planes))]
    lines += [" ".join(f"{candela(c, gamma):.1f}" for gamma in gammas) for c in planes]
    return ("\n".join(lines) + "\n").encode()


def office():
    s = Gltf(
        "office",
        "A room of 5 x 4 m, 2.8 m high (reflectances 0.7, 0.5, 0.2), with four luminaires of 3400 lm in its ceiling, from the file"
        " office.ldt. The meters: `desks`, 0.75 m above the floor and half a metre from the walls, `faces`, cylindrical"
        " illuminance at 1.2 m, and `eye`, all luminances before an observer who sits at the wall, for UGR. `etendue measure` finds 508 lx on the desks (EN 12464-1 asks 500), the least 0.82 of that, and 246 lx at the faces.",
    )
    ceiling = s.surface("ceiling", "lambertian", reflectance=0.7)
    wall = s.surface("wall", "lambertian", reflectance=0.5)
    floor = s.surface("floor", "lambertian", reflectance=0.2)
    desk = s.surface("desk", "lambertian", reflectance=[0.42, 0.33, 0.22])
    walls(s, (-2.5, 0, -2), (2.5, 2.8, 2), floor=floor, ceiling=ceiling, back=wall, front=wall, left=wall, right=wall)
    for x in (-1.25, 1.25):
        s.box("desk", desk, [1.6, 0.72, 0.8], translation=[x, 0, -0.4])
    s.files["office.ldt"] = eulumdat(
        "recessed panel, a formula",
        lambda g: math.cos(math.radians(g)) * (1 + 0.7 * math.sin(math.radians(g)) ** 2) * min(1, max(0, (80 - g) / 20)),
        list(range(0, 91, 5)),
        3400,
        600,
    )
    cover = s.surface("cover", "lambertian", reflectance=0.7)
    panel = {"class": "rectangle", "size": [0.6, 0.6], "material": cover}
    for x in (-1.25, 1.25):
        for z in (-1, 1):
            s.lamp("panel", look_along([x, 2.795, z], DOWN, (0, 0, -1)), "ies", shape=panel, file="office.ldt", opening=True)
    s.camera([2.3, 1.6, 1.85], [-0.6, 0.95, -0.8], 62, 3 / 2)
    s.receiver("desks", level(0.75), "illuminance", size=[4, 3], resolution=[16, 12])
    s.receiver("faces", level(1.2), "illuminance", size=[4, 3], resolution=[8, 6], shape="cylinder")
    s.receiver("eye", look_along([2.2, 1.2, 1.2], [-1, 0, -0.2]), "luminance_meter", angle=3.1415926, resolution=[384, 192])
    return s


def street():
    s = Gltf(
        "street",
        "A road 7 m wide between pavements, at night, lit by two luminaires from the file street.ies on poles 8 m high, 30 m apart, that"
        " turn their light along the road. The meters: `carriageway`, the road between the poles, and `walkers`, hemispherical illuminance"
        " a metre above the pavement on the far side. `etendue measure` finds 10.6 lx on the carriageway, the least 0.67 of that, and 6.1 lx for walkers.",
    )
    asphalt = s.surface("asphalt", "lambertian", reflectance=0.09)
    paving = s.surface("paving", "lambertian", reflectance=[0.24, 0.22, 0.20])
    house = s.surface("house", "lambertian", reflectance=[0.36, 0.31, 0.25])
    paint = s.surface("paint", "lambertian", reflectance=[0.10, 0.12, 0.11])
    s.box("road", asphalt, [90, 0.2, 7], translation=[0, -0.2, 0])
    for z in (-5.25, 5.25):
        s.box("pavement", paving, [90, 0.2, 3.5], translation=[0, -0.1, z])
    for x in (-24, -8, 8, 24):
        s.box("house", house, [14, 9 if x % 16 else 7, 6], translation=[x, 0.1, -10])
    s.files["street.ies"] = street_lamp()
    for x in (-15, 15):
        s.shape("pole", "cylinder", paint, matrix=facing([x, 3.9, 4.7], [0, 1, 0], (0, 0, -1)), radius=0.07, height=7.6)
        s.lamp("luminaire", look_along([x, 8, 3.2], DOWN, (0, 0, -1)), "ies", file="street.ies", flux=7000, color=[1, 0.85, 0.66])
    s.camera([-26, 2.1, 1.2], [0, 1.5, -1.5], 44, 16 / 9)
    s.receiver("carriageway", level(0), "illuminance", size=[30, 7], resolution=[20, 14])
    s.receiver("walkers", level(1.1, z=-5), "illuminance", size=[30, 3], resolution=[20, 2], shape="hemisphere")
    return s


def led_lens():
    s = Gltf(
        "led_lens",
        "An LED of 1 mm that sends 100 lm, by the ray file manual/led.dat, in the back focus of a ball lens of 10 mm (index 1.5168), before"
        " a dark screen of 0.5 m in half a metre. 59.0 lm arrive on the meter `spot`: 71 lm meet the ball, 60.3 leave it after two"
        " surfaces, and 58.9 of these come to the screen, the rest by reflections within the ball. Every ray of the file leaves"
        " a dot of its own, most within 10 cm of the middle.",
    )
    s.medium("glass", ior=1.5168)
    glass = s.surface("glass", "dielectric", inside="glass")
    screen = s.surface("screen", "lambertian", reflectance=0.05)
    # The back focal length of a ball of radius R is R (2 - n) / (2 (n - 1)).
    radius, n = 0.005, 1.5168
    focus = radius * (2 - n) / (2 * (n - 1))
    s.lamp("LED", facing([0, 0, 0], [0, 0, -1]), "rays", file="manual/led.dat", flux=100)
    s.shape("ball lens", "sphere", glass, [0, 0, -focus - radius], radius=radius)
    s.shape("screen", "rectangle", screen, matrix=facing([0, 0, -0.5], [0, 0, 1]), size=[0.5, 0.5])
    s.camera([0.16, 0.1, 0.1], [0, 0, -0.45], 50, 4 / 3)
    s.receiver("spot", facing([0, 0, -0.5], [0, 0, 1]), "illuminance", size=[0.5, 0.5], resolution=[50, 50])
    return s


def integrating_sphere():
    s = Gltf(
        "integrating_sphere",
        "A sphere of radius 0.5 m, white within (reflectance 0.95), with an opening of a hundredth of its area, and 1000 lm from a lamp"
        " in its centre. The meters: `wall`, illuminance near the wall; `port`, what comes out; `spot`, the luminance of the wall through the port."
        " Light that fills a sphere evenly gives E = flux / area / (1 - 0.95 x 0.99) = 5349.7 lx on the wall, 168.07 lm at the port,"
        " and a luminance of 0.95 E / pi = 1617.7 cd/m².",
    )
    white = s.surface("white", "lambertian", reflectance=0.95)
    radius, open_part, columns, rows = 0.5, 0.01, 128, 96
    rim = math.acos(1 - 2 * open_part)  # around +z
    points = [[0, 0, -radius]]
    for row in range(rows):
        angle = rim + (math.pi - rim) * row / rows
        r, z = radius * math.sin(angle), radius * math.cos(angle)
        turns = [2 * math.pi * i / columns for i in range(columns)]
        points += [[r * math.cos(a), r * math.sin(a), z] for a in turns]
    triangles = []
    for row in range(rows):
        for i in range(columns):
            a, b = (1 + row * columns + k % columns for k in (i, i + 1))
            if row + 1 < rows:
                triangles += [[a, b, b + columns], [a, b + columns, a + columns]]
            else:
                triangles.append([a, b, 0])
    s.mesh("sphere", white, points, triangles)
    s.light("lamp", "point", 1000 / (4 * math.pi), look_along([0, 0, 0], [0, 0, -1]))
    s.camera([0.5, 0.25, 1.2], [0, 0, 0.3], 40, 4 / 3)
    s.receiver("wall", facing([0, -0.498, 0], [0, 1, 0], (0, 0, -1)), "illuminance", size=[0.02, 0.02], resolution=[1, 1])
    s.receiver("port", facing([0, 0, 0.4905], [0, 0, -1]), "illuminance", size=[0.21, 0.21], resolution=[1, 1])
    s.receiver("spot", look_along([0.1, 0, 1], [-0.1, 0, -0.6]), "luminance_meter", angle=0.05)
    return s
