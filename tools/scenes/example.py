"""The scene that tools/example.sh renders."""

from gltf_builder import Gltf, facing
from shared import COPPER, GOLD, backdrop


def example():
    s = Gltf(
        "example",
        "Glass, metal and matte spheres on a seamless grey backdrop below a large lamp. The clear sphere"
        " shows the room upside down and gathers the lamp's light in its shadow; the green and amber ones"
        " take on the colour that glass has after some decimetres (Beer-Lambert); gold and copper follow"
        " Fresnel's equations for their measured refractive indices.",
    )
    s.surround([0.36, 0.37, 0.39])
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
