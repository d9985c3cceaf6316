#!/usr/bin/env python3
"""Writes the example scenes: tools/scenes/make.py [FOLDER], scenes/ by default.

A scene is a function in a file beside this one that returns a Gltf with its expected value in words; those words go into
the scene's file (scenes[0].extras.expected) and into the folder's README.md. The scenes that `etendue classes --html` puts its examples into go to FOLDER/manual.
"""

import sys
import textwrap
from pathlib import Path

from boxes import caustic_box, cornell_box
from crystals import calcite
from dispersion import prism, rainbow
from elements import housing, light_guide, light_guide_fine
from example import example
from furnaces import furnace_closed, furnace_rough, furnace_smooth, spheres
from grin import grin
from lenses import ball_lens, double_gauss, spectrometer
from lights import lamps, many_lights
from manual import write_showcases
from measured import integrating_sphere, led_lens, office, street
from polarization import fresnel_rhomb, glass_table, polarizers, retarders
from scattering import cloud, fogbow, glass_in_fog
from surfaces import films, finishes, materials
from water import iced_water, pool

SCENES = [
    example,
    cornell_box,
    caustic_box,
    glass_in_fog,
    cloud,
    fogbow,
    pool,
    iced_water,
    prism,
    rainbow,
    grin,
    spheres,
    lamps,
    materials,
    finishes,
    films,
    polarizers,
    retarders,
    glass_table,
    fresnel_rhomb,
    calcite,
    many_lights,
    office,
    street,
    led_lens,
    integrating_sphere,
    light_guide,
    light_guide_fine,
    housing,
    double_gauss,
    ball_lens,
    spectrometer,
    furnace_smooth,
    furnace_rough,
    furnace_closed,
]

README = """# Example scenes

Written by `tools/scenes/make.py`; the files beside it say how each is built; change the scenes there. Render one with
`build/release/etendue render scenes/example.gltf -o example.exr`. What each must show:

"""


MANUAL = """
[manual/](manual) has the scenes, one an interface, into which `etendue classes --html` puts the examples that stand in the class
files, and the files that these name.
"""


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2] / "scenes"
    folder.mkdir(parents=True, exist_ok=True)
    lines = []
    for make in SCENES:
        scene = make()
        scene.write(folder / f"{scene.name}.gltf")
        text = textwrap.fill(
            f"**{scene.name}.gltf** {scene.expected}",
            108,
            initial_indent="- ",
            subsequent_indent="  ",
            break_on_hyphens=False,
        )
        lines.append(text)
    write_showcases(folder / "manual")
    (folder / "README.md").write_text(README + "\n".join(lines) + "\n" + MANUAL, encoding="utf-8")


if __name__ == "__main__":
    main()
