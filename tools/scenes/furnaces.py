"""Surroundings of radiance 1, in which it is known what a pixel must show."""

from gltf_builder import Gltf, facing
from shared import COPPER, GOLD, SILVER, sample


def grid(i):
    """Centre of the i-th of six things of radius 1, in two rows of three."""
    return [2.3 * (i % 3 - 1), 1.15 - 2.3 * (i // 3), 0]


def show_grid(s):
    s.camera([0, 0, 14], [0, 0, 0], 21, 1.5)


def spheres():
    s = Gltf(
        "spheres",
        "Six spheres before a constant surround of radiance 1. The clear and the frosted glass sphere (top"
        " left and middle) lose nothing and are invisible: 1. The tinted one (top right) is darker where the"
        " way through it is longer. The metals (below: silver, gold, copper) show at their centres the"
        " reflectance of their refractive indices at normal incidence: silver (0.988, 0.983, 0.980), gold"
        " (0.945, 0.777, 0.374), copper (0.939, 0.618, 0.554); the gold is rough, and is within 2 % of that.",
    )
    s.surround(1)
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
        sample(s, "sphere", kind, grid(i), radius=1)
    show_grid(s)
    return s


def furnace_smooth():
    s = Gltf(
        "furnace_smooth",
        "Lossless things in a constant surround of radiance 1: white plaster, a perfect mirror, clear glass,"
        " a thin pane, white glossy paint, and a mirror cylinder. All are invisible: every pixel is 1 within"
        " 0.2 %.",
    )
    s.surround(1)
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
        sample(s, shape, kind, matrix=facing(grid(i), [0.5, 0.3, 1]), **parameters)
    show_grid(s)
    return s


def furnace_rough():
    s = Gltf(
        "furnace_rough",
        "Rough mirrors (above) and rough glass (below) that keep the light scattered more than once between"
        " facets, of GGX width 0.1, 0.3 and 0.7 from left to right, in a constant surround of radiance 1:"
        " invisible, every pixel is 1 within 0.5 %.",
    )
    s.surround(1)
    s.medium("glass", ior=1.5)
    for i, alpha in enumerate((0.1, 0.3, 0.7)):
        metal = s.surface(
            f"mirror, alpha {alpha}", "conductor", reflectance=1, alpha=alpha, multiscatter=True
        )
        glass = s.surface(
            f"glass, alpha {alpha}", "dielectric", inside="glass", alpha=alpha, multiscatter=True
        )
        s.shape(f"mirror {i}", "sphere", metal, grid(i), radius=1)
        s.shape(f"glass {i}", "sphere", glass, grid(i + 3), radius=1)
    show_grid(s)
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
        sample(s, "sphere", kind, [x, 0, 0], radius=0.5)
    s.camera([0, 0, 3.5], [0, 0, 0], 45, 1.5)
    return s
