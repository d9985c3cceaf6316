#!/usr/bin/env python3
"""Rays through lens files, against ray-optics, ray by ray, and as fast as optiland traces them.

    tools/compare_lenses.py [FILE …] [--rays 9]

FILE: .zmx and .seq files; by default seven of the shared folder (ETENDUE_SHARED, else ../shared): spheres, aspheres, mirrors, in
inches and mm. `etendue lens FILE -o rays.csv` traces rays of every field and wavelength; ray-optics (the package rayoptics,
BSD-3-Clause, in an environment under build/peers) reads the same file and traces the same starts. Positions and directions at every
surface, in its frame, must be equal to 1e-6 mm and 1e-6; fails where they are not.

Indices that the two take for a glass are told, and those of étendue are then taken by both: ray-optics has formulas of
its own for glasses of which a file states nd and vd. Its coordinate breaks turn the other way than OpticStudio's; such files differ. Rays a second are those
of tracing alone, on one thread; étendue's are told where the target lens_bench is built. optiland (MIT) traces 2^17 rays at once, as arrays, with glasses of its
own; how far its rays are from étendue's on the image is told.
"""

import argparse
import csv
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import compare_peers as peers

ETENDUE = ROOT / "build" / "release" / "etendue"
BENCH = ROOT / "build" / "release" / "tests" / "lens_bench"
SHARED = Path(os.environ.get("ETENDUE_SHARED", ROOT.parent / "shared")) / "photometry" / "lenses"
FILES = ["ol_lens1.zmx", "ol_lens_thorlabs_iso_8859_1.zmx", "ol_circular_aperture_example_with_aperture.zmx", "ro_HoO-V2C18Ex27.zmx",
         "ro_HoO-V2C18Ex03.zmx", "ro_ag_dblgauss.seq", "ro_questar35.seq"]


def optiland(file, table):
    alone = dict(os.environ, OMP_NUM_THREADS="1", NUMBA_NUM_THREADS="1")
    worker = [peers.environment_for("optiland"), ROOT / "tools" / "peers" / "optiland_worker.py", file, table]
    done = subprocess.run(list(map(str, worker)), capture_output=True, text=True, env=alone)
    if done.returncode != 0:
        return f"optiland: {(done.stderr.strip().splitlines() or ['?'])[-1]}"
    return done.stdout.strip().splitlines()[-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", type=Path, metavar="FILE")
    parser.add_argument("--rays", type=int, default=9, help="across the pupil, of each field and wavelength")
    a = parser.parse_args()
    files = a.files or [SHARED / name for name in FILES]
    peers.PACKAGES.update(rayoptics=["rayoptics"], optiland=["optiland"])
    peers.set_up(["rayoptics", "optiland"])
    if not peers.installed("rayoptics"):
        sys.exit("compare_lenses: rayoptics cannot be installed")
    failed = False
    for file in files:
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "rays.csv"
            subprocess.run([ETENDUE, "lens", file, "-o", table, "--rays", str(a.rays)], check=True, capture_output=True)
            copy = Path(folder) / file.name  # ray-optics writes a file beside it where it lacks a glass
            copy.write_bytes(file.read_bytes())
            worker = [peers.environment_for("rayoptics"), ROOT / "tools" / "peers" / "rayoptics_worker.py", copy, table]
            done = subprocess.run(list(map(str, worker)), capture_output=True, text=True)
            line = (done.stdout.strip().splitlines() or [""])[-1]
            if done.returncode != 0:
                failed = True
                line = line or (done.stderr.strip().splitlines() or ["?"])[-1]
            elif BENCH.exists():
                theirs = float(line.split()[-2])
                ours = float(subprocess.run([BENCH, file], check=True, capture_output=True, text=True).stdout)
                line += f", étendue {ours:.3g}: {ours / theirs:.0f} times"
            if done.returncode == 0 and peers.installed("optiland"):
                line += "; " + optiland(copy, table)
            print(f"{file.name:46} {line}{'  DIFFERENT' if done.returncode else ''}", flush=True)
    sys.exit(failed)


main()
