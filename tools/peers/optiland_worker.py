"""optiland: traces the starts of a table of `etendue lens FILE -o TABLE.csv` through the same file, all of a wavelength at once.

    optiland_worker.py FILE TABLE.csv

Prints rays, where they differ most on the image, and rays a second of this process, from 2^17 rays traced together.
"""

import csv
import itertools
import sys
import time

import numpy as np
from optiland import fileio
from optiland.rays import RealRays

file, table = sys.argv[1:3]
lens = (fileio.load_zemax_file if file.lower().endswith(".zmx") else fileio.load_codev_file)(file)


def rows_of_rays():
    with open(table, newline="", encoding="utf-8") as rows:
        key = lambda r: (r["field"], r["wavelength_nm"], r["pupil_x"], r["pupil_y"])  # noqa: E731
        for _, ray in itertools.groupby(csv.DictReader(rows), key):
            yield list(ray)


def columns(rows, names):
    return [np.array([float(row[name]) for row in rows]) for name in names]


PLACE, DIRECTION = ("x_mm", "y_mm", "z_mm"), ("direction_x", "direction_y", "direction_z")
arriving = [ray for ray in rows_of_rays() if ray[0]["fate"] == "arrives"]
starts = [ray[0] for ray in arriving]
nm = np.array([float(row["wavelength_nm"]) for row in starts])


def traced(repeats):
    """Optiland's rays at the image, and the seconds; a batch a wavelength, as its functions have it."""
    seconds, places = 0.0, {}
    for wavelength in np.unique(nm):
        chosen = np.flatnonzero(nm == wavelength)
        columns_of = columns([starts[i] for i in chosen], PLACE + DIRECTION)
        one = np.ones(len(chosen) * repeats)
        rays = RealRays(*(np.tile(c, repeats) for c in columns_of), one, one * wavelength / 1000)
        begin = time.perf_counter()
        lens.surfaces.trace(rays, skip=1, record=False)
        seconds += time.perf_counter() - begin
        places.update({i: (rays.x[k], rays.y[k]) for k, i in enumerate(chosen)})
    return places, seconds


places, _ = traced(1)  # compiles what optiland compiles
images = columns([ray[-1] for ray in arriving], PLACE)
worst = max(np.hypot(places[i][0] - images[0][i], places[i][1] - images[1][i]) for i in range(len(arriving)))
repeats = max((1 << 17) // len(arriving), 1)
_, seconds = traced(repeats)
print(f"{len(arriving)} rays: on the image within {worst:.1e} mm; optiland {repeats * len(arriving) / seconds:.3g} rays/s")
