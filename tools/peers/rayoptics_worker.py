"""ray-optics: traces the starts of a table of `etendue lens FILE -o TABLE.csv` through the same file.

    rayoptics_worker.py FILE TABLE.csv

Prints rays, rays a second of this process, and the greatest differences; the exit status is 1 where they are too large.
"""

import csv
import itertools
import sys
import time

import numpy as np
from rayoptics.environment import *  # noqa: F403  (its modules import each other in this order)
from rayoptics.gui.appcmds import open_model
from rayoptics.raytr.raytrace import trace_raw
from rayoptics.raytr.traceerror import TraceError

LIMIT = 1e-6  # mm, and of a direction

file, table = sys.argv[1:3]
model = open_model(file)
sequence = model.seq_model
sequence.update_model()
mm = {"mm": 1, "cm": 0.1, "m": 0.001, "inches": 1 / 25.4}[model.system_spec.dimensions]  # in units of the file


def rows_of_rays():
    with open(table, newline="", encoding="utf-8") as rows:
        key = lambda r: (r["field"], r["wavelength_nm"], r["pupil_x"], r["pupil_y"])  # noqa: E731
        for _, ray in itertools.groupby(csv.DictReader(rows), key):
            yield list(ray)


def vector(row, name):
    return np.array([float(row[name + a]) for a in "xyz"])


def position(row):
    return np.array([float(row[a + "_mm"]) for a in "xyz"])


worst_position = worst_direction = worst_index = 0.0
rays = seconds = 0
paths = {}
for ray in rows_of_rays():
    nm = float(ray[0]["wavelength_nm"])
    if len(ray) != len(sequence.ifcs):  # does not arrive
        continue
    if nm not in paths:
        path = list(sequence.path(sequence.wvlns[int(np.argmin(np.abs(np.array(sequence.wvlns) - nm)))]))
        for i, row in enumerate(ray[:-1]):
            interface, gap, transform, index, z = path[i]
            own = float(row["index"])
            if abs(index) > 0:
                worst_index = max(worst_index, abs(abs(index) - own))
            # The start stands in the frame of the first surface.
            transform = (np.identity(3), np.zeros(3)) if i == 0 else transform
            path[i] = (interface, gap, transform, own, z)
        paths[nm] = path
    begin = time.perf_counter()
    try:
        points = trace_raw(iter(paths[nm]), position(ray[0]) * mm, vector(ray[0], "direction_"), nm, intersect_obj=False)[0]
    except TraceError as e:
        sys.exit(f"a ray that arrives for étendue does not for ray-optics: {type(e).__name__} {ray[0]}")
    seconds += time.perf_counter() - begin
    rays += 1
    for row, point in list(zip(ray, points))[1:]:
        worst_position = max(worst_position, np.abs(position(row) - point[0] / mm).max())
        if row is not ray[-1]:
            worst_direction = max(worst_direction, np.abs(vector(row, "direction_") - point[1]).max())

different = rays == 0 or not (worst_position <= LIMIT and worst_direction <= LIMIT)
print(f"{rays} rays: positions within {worst_position:.1e} mm, directions {worst_direction:.1e}, indices {worst_index:.1e}; "
      f"ray-optics {rays / max(seconds, 1e-9):.0f} rays/s")
sys.exit(different)
