"""Samples of materials: rows of spheres on a backdrop."""

from gltf_builder import Gltf, facing
from shared import backdrop, sample, upright


def studio(s, reflectance, lamp, key=([-2.5, 5, 2.5], [0.45, -1, -0.5], [4, 2]), strip_width=0.7, steps=10):
    """A backdrop of that reflectance below a lamp on the left (`key`: place, direction, size) and a strip on the right;
    `lamp`: their luminance, and their colour."""
    backdrop(s, s.surface("floor", "lambertian", reflectance=reflectance), 20, 8, -4.5, 7, 2, steps)
    light = s.emitter("lamp", *lamp)
    position, direction, size = key
    s.shape("lamp", "rectangle", light, matrix=facing(position, direction), size=size)
    s.shape("strip", "rectangle", light, matrix=facing([5.5, 2.5, 3], [-1, -0.3, -0.6]), size=[strip_width, 4])


def show_two_rows(s):
    s.camera([0, 4.2, 9.0], [0, 0.28, 0.3], 23, 1.8)


def materials():
    s = Gltf(
        "materials",
        "glTF's metallic-roughness material: metal (back row), glass (middle) and painted plastic (front),"
        " roughness from 0 (left) to 1 (right). Highlights widen from left to right; rough metal and rough"
        " glass darken, as light that meets more than one facet is lost; no sphere is brighter than what it"
        " mirrors.",
    )
    s.surround([0.32, 0.34, 0.38])
    studio(s, 0.42, (6, (1, 0.95, 0.88)))
    columns = 6
    for row, (name, color, metallic, transmission) in enumerate(
        (
            ("plastic", [0.05, 0.23, 0.50], 0, None),
            ("glass", [1, 1, 1], 0, 1),
            ("metal", [0.91, 0.62, 0.38], 1, None),
        )
    ):
        for i in range(columns):
            roughness = i / (columns - 1)
            material = s.principled(
                f"{name}, roughness {roughness:.1f}",
                color,
                metallic,
                roughness,
                transmission,
                1.5 if transmission else None,
            )
            s.shape(
                f"{name} {i}",
                "sphere",
                material,
                [1.08 * (i - (columns - 1) / 2), 0.46, 1.7 - 1.5 * row],
                radius=0.46,
            )
    s.camera([0, 6.2, 9.0], [0, 0.28, 0.15], 25, 1.6)
    return s


def finishes():
    s = Gltf(
        "finishes",
        "What lies on surfaces, plain (back row) and finished (front row), from the left: red paint under a clear coat, which"
        " mirrors the lamps sharply; brushed steel, whose highlight is drawn out along the parallels; velvet with a bright"
        " rim at grazing angles; resin with a golden reflection; a paper globe that passes on three quarters of the diffuse"
        " light, with a lamp inside.",
    )
    s.surround([0.22, 0.23, 0.26])
    studio(s, 0.35, (7, (1, 0.95, 0.88)))
    paint, steel, cloth, resin = [0.42, 0.02, 0.02], [0.62, 0.61, 0.60], [0.10, 0.02, 0.16], [0.05, 0.05, 0.06]
    paper = [0.85, 0.80, 0.70]
    rows = (
        (
            s.principled("paint", paint, 0, 0.6),
            s.principled("steel", steel, 1, 0.35),
            s.principled("cloth", cloth, 0, 1),
            s.principled("resin", resin, 0, 0.35),
            s.principled("card", paper, 0, 1),
        ),
        (
            s.principled("coated paint", paint, 0, 0.6, clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.05}),
            s.principled("brushed steel", steel, 1, 0.35, anisotropy={"anisotropyStrength": 0.8}),
            s.principled(
                "velvet", cloth, 0, 1, sheen={"sheenColorFactor": [0.75, 0.55, 0.95], "sheenRoughnessFactor": 0.45}
            ),
            s.principled("gilded resin", resin, 0, 0.35, specular={"specularColorFactor": [12, 8, 3]}),
            s.principled(
                "paper",
                paper,
                0,
                1,
                diffuse_transmission={
                    "diffuseTransmissionFactor": 0.75,
                    "diffuseTransmissionColorFactor": [0.95, 0.86, 0.66],
                },
            ),
        ),
    )
    for row, kinds in enumerate(rows):
        for i, kind in enumerate(kinds):
            x, z = 1.15 * (i - 2), -0.35 + 1.5 * row
            sample(s, "sphere", kind, matrix=upright([x, 0.46, z]), radius=0.46)
    bulb = s.emitter("bulb", 8, (1, 0.8, 0.55))
    s.shape("bulb", "sphere", bulb, [2.3, 0.46, 1.15], radius=0.12)
    show_two_rows(s)
    return s


def films():
    s = Gltf(
        "films",
        "Colours of thin films, in wavelengths, before a bright surround. Above, chromium under an oxide of index 2.2 and 20, 40,"
        " 60, 90 and 130 nm: straw, brown, blue, pale blue and yellow, as metals take them on when they are heated. Below, from the"
        " left: soap films of 100, 300 and 500 nm around air, coloured in their rims; black plastic with glTF's"
        " iridescence of 400 nm; glass with a film of index 1.22 and 112 nm, which mirrors less than bare glass.",
    )
    s.surround(0.25)
    studio(s, 0.12, (5,), key=([-3, 5, 3], [0.5, -1, -0.5], [5, 3]), strip_width=1.5, steps=40)
    s.medium("glass", ior=1.5)
    chromium = {"eta": {"name": "Cr eta"}, "k": {"name": "Cr k"}}
    rows = (
        [
            s.surface(f"oxide of {d} nm", "thin_film", ior=2.2, thickness=d, alpha=0.1, **chromium)
            for d in (20, 40, 60, 90, 130)
        ],
        [s.surface(f"soap of {d} nm", "thin_film", ior=1.33, thickness=d) for d in (100, 300, 500)]
        + [
            s.principled("iridescent plastic", [0.02, 0.02, 0.02], 0, 0.2, iridescence={"iridescenceFactor": 1}),
            s.surface("coated glass", "thin_film", inside="glass", ior=1.22, thickness=112),
        ],
    )
    for row, kinds in enumerate(rows):
        for i, kind in enumerate(kinds):
            sample(s, "sphere", kind, [1.15 * (i - 2), 0.5, -0.35 + 1.5 * row], radius=0.46)
    show_two_rows(s)
    return s
