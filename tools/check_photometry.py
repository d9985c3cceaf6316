#!/usr/bin/env python3
"""Reads the photometric files of a measurement with a library that knows nothing of étendue, and compares them with its table.

    pip install eulumdat
    tools/check_photometry.py DIR      DIR: what `etendue measure … -o DIR` has written

For every intensity meter NAME the candelas of NAME.ies and NAME.ldt are compared with those of NAME.csv, direction by direction; the
rows of the poles, which are a single direction, with their mean. Says the greatest relative difference of each file, and fails where
one exceeds 1e-5: files are written with nine digits.
"""

import csv
import pathlib
import sys

LIMIT = 1e-5  # of the greatest intensity


def candelas_of_table(path):
    """{(C, gamma) in degrees: cd}"""
    with open(path, newline="", encoding="utf-8") as file:
        table = {(float(r["C_deg"]), float(r["gamma_deg"])): float(r["value_cd"]) for r in csv.DictReader(file)}
    for gamma in (0.0, 180.0):
        row = [value for (_, g), value in table.items() if g == gamma]
        for c, g in table:
            if g == gamma:
                table[c, g] = sum(row) / len(row)
    return table


def greatest_difference(photometry, table):
    """Part of the greatest intensity of the table. Files hold cd/klm, of the flux that their lamps have."""
    scale = sum(lamps.total_luminous_flux for lamps in photometry.lamp_sets) / 1000 * photometry.conversion_factor
    read = {
        (c, g): scale * value
        for c, plane in zip(photometry.c_angles, photometry.intensities)
        for g, value in zip(photometry.g_angles, plane)
        if c < 360
    }
    if set(read) != set(table):
        return float("inf")
    peak = max(table.values())
    return max(abs(read[at] - table[at]) for at in table) / peak


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        from eulumdat import Eulumdat
    except ImportError:
        sys.exit("check_photometry: needs the package eulumdat: pip install eulumdat")
    folder = pathlib.Path(sys.argv[1])
    failed = compared = 0
    for file in sorted([*folder.glob("*.ies"), *folder.glob("*.ldt")]):
        read = Eulumdat.from_ies_file if file.suffix == ".ies" else Eulumdat.from_file
        difference = greatest_difference(read(str(file)), candelas_of_table(file.with_suffix(".csv")))
        compared += 1
        failed += difference > LIMIT
        print(f"{file.name:40} greatest difference {difference:.2g} of the peak{'  TOO LARGE' if difference > LIMIT else ''}")
    if compared == 0:
        sys.exit(f"check_photometry: {folder} holds no photometric files")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
