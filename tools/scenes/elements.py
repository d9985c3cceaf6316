"""Optical elements: scenes within the scene, with structures too small and too many to be meshes."""

from gltf_builder import Gltf, facing
from shared import walls

WIDTH, HEIGHT, THICKNESS = 0.4, 0.25, 0.003  # of the guides, m


def guide(s, pitch, lumens):
    """A light guide in the xy plane, lit from its edge at -x, with dents in its back at -z and a white foil behind it."""
    clear = s.surface("clear", "dielectric", inside="acrylic")
    foil = s.surface("foil", "lambertian", reflectance=0.95)
    led_height = 0.8 * THICKNESS
    leds = s.emitter("leds", lumens / (3.141592653589793 * HEIGHT * led_height))
    w, h, t = WIDTH / 2, HEIGHT / 2, THICKNESS / 2
    s.shape("front", "rectangle", clear, matrix=facing([0, 0, t], [0, 0, 1]), size=[WIDTH, HEIGHT])
    for name, x, normal in (("left", -w, [-1, 0, 0]), ("right", w, [1, 0, 0])):
        s.shape(name, "rectangle", clear, matrix=facing([x, 0, 0], normal), size=[THICKNESS, HEIGHT])
    for name, y, normal in (("lower", -h, [0, -1, 0]), ("upper", h, [0, 1, 0])):
        s.shape(name, "rectangle", clear, matrix=facing([0, y, 0], normal, (0, 0, 1)), size=[WIDTH, THICKNESS])
    dots = dict(pitch=[pitch, pitch], shape="dome", radius=0.3 * pitch, depth=0.1 * pitch, operation="remove")
    s.shape("dots", "microstructure", clear, matrix=facing([0, 0, -t], [0, 0, -1]), size=[WIDTH, HEIGHT], placement="jittered", density=0.06, **dots)
    s.shape("foil", "rectangle", foil, matrix=facing([0, 0, -t - 2e-4], [0, 0, 1]), size=[WIDTH, HEIGHT])
    s.shape("leds", "rectangle", leds, matrix=facing([-w - 2e-4, 0, 0], [1, 0, 0]), size=[led_height, HEIGHT])


def guide_scene(name, pitch, words):
    s = Gltf(name, words)
    s.medium("acrylic", ior=1.49)
    inner = s.scene("guide", lambda: guide(s, pitch, 100))
    s.element("guide", facing([0, 0, 0], [0, 0, 1]), "subscene", scene=inner)
    sheet = s.surface("diffuser", "diffuse_transmitter", reflectance=0.3, transmittance=0.6)
    s.shape("diffuser", "rectangle", sheet, matrix=facing([0, 0, 0.004], [0, 0, 1]), size=[WIDTH, HEIGHT])
    s.camera([0, -0.25, 0.6], [0, 0, 0], 30, 4 / 3)
    s.receiver("front", facing([0, 0, 0.002], [0, 0, -1]), "illuminance", size=[WIDTH, HEIGHT], resolution=[8, 5])
    return s


def light_guide():
    return guide_scene(
        "light_guide",
        1e-4,
        "The light guide of a display, 0.4 x 0.25 m of acrylic glass (index 1.49), 3 mm thick, with 10 million dents of 60 x 10 µm in its back,"
        " somewhere in cells of 0.1 mm, a white foil behind it, and 100 lm of light from its left edge: an optical element. A diffusing sheet lies 2 mm before it; the meter `front` stands between them: 27 lm come to it, evenly; most of the rest leaves by the other edges, which have no mirrors.",
    )


def light_guide_fine():
    return guide_scene(
        "light_guide_fine",
        1e-4 / 10**0.5,
        "The same with 100 million dents of a tenth of the area each: it looks the same, takes no more memory, and"
        " renders as fast.",
    )


def housing():
    s = Gltf(
        "housing",
        "Elements within elements: a black housing, open in front, holds a light guide and an array of 40 x 25 lenses of acrylic glass"
        " before it, behind a diffusing pane. Floor and pane are lit by what comes out.",
    )
    s.medium("acrylic", ior=1.49)
    black = s.surface("black", "lambertian", reflectance=0.03)
    clear = s.surface("lens", "dielectric", inside="acrylic")
    w, h, t = WIDTH / 2, HEIGHT / 2, 0.002

    def lenses():
        s.shape("caps", "microstructure", clear, matrix=facing([0, 0, t], [0, 0, 1]), size=[WIDTH, HEIGHT], pitch=[0.01, 0.01], radius=0.005, depth=0.0015)
        s.shape("flat", "rectangle", clear, matrix=facing([0, 0, 0], [0, 0, -1]), size=[WIDTH, HEIGHT])
        for name, x, normal in (("left", -w, [-1, 0, 0]), ("right", w, [1, 0, 0])):
            s.shape(name, "rectangle", clear, matrix=facing([x, 0, t / 2], normal), size=[t, HEIGHT])
        for name, y, normal in (("lower", -h, [0, -1, 0]), ("upper", h, [0, 1, 0])):
            s.shape(name, "rectangle", clear, matrix=facing([0, y, t / 2], normal, (0, 0, 1)), size=[WIDTH, t])

    guide_index = s.scene("guide", lambda: guide(s, 1e-4, 100))
    lens_index = s.scene("lenses", lenses)

    def inside():
        walls(s, (-w - 0.01, -h - 0.01, -0.02), (w + 0.01, h + 0.01, 0.06), back=black, left=black, right=black, floor=black, ceiling=black)
        s.element("guide", facing([0, 0, 0], [0, 0, 1]), "subscene", scene=guide_index)
        s.element("lenses", facing([0, 0, 0.02], [0, 0, 1]), "subscene", scene=lens_index)

    s.element("housing", facing([0, 0.2, 0], [0.2, 0.1, 1]), "subscene", scene=s.scene("housing", inside))
    pane = s.surface("pane", "diffuse_transmitter", reflectance=0.3, transmittance=0.6)
    s.shape("pane", "rectangle", pane, matrix=facing([0.0144, 0.2072, 0.072], [0.2, 0.1, 1]), size=[WIDTH + 0.02, HEIGHT + 0.02])
    floor = s.surface("floor", "lambertian", reflectance=[0.5, 0.45, 0.4])
    s.quad("floor", floor, [[-0.6, 0, 0.6], [0.6, 0, 0.6], [0.6, 0, -0.4], [-0.6, 0, -0.4]])
    s.camera([0.15, 0.35, 0.9], [0, 0.17, 0], 34, 4 / 3)
    return s
