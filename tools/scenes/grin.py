"""Media whose refractive index varies."""

import math

from gltf_builder import Gltf, facing


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
