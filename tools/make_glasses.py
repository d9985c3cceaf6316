#!/usr/bin/env python3
"""Writes host/lens/glasses.json: the glasses that lens files may name, by maker.

    tools/make_glasses.py FOLDER

FOLDER is a checkout of the refractiveindex.info database (CC0 1.0, github.com/polyanskiy/refractiveindex.info-database). Of the
catalogues of SCHOTT and OHARA all glasses are taken whose index is stated by Sellmeier's formula: the strengths, then as many
poles in µm². Indices are relative to air. `nm`: the range that the formula was fitted for.
"""
import json
import re
import sys
from pathlib import Path

CATALOGUES = {"SCHOTT": "SCHOTT Zemax catalog 2017-01-20b", "OHARA": "OHARA Zemax catalog 2017-11-30"}
OUT = Path(__file__).parent.parent / "host/lens/glasses.json"


def glass(text):
    formula = re.search(r"- type: formula 2\n +wavelength_range: (\S+) (\S+)\n +coefficients: (.+)", text)
    if not formula:
        return None
    c = [float(x) for x in formula.group(3).split()]
    assert c[0] == 0
    return {"sellmeier": c[1::2] + c[2::2], "nm": [round(1000 * float(formula.group(i)), 6) for i in (1, 2)]}


def main(folder):
    blocks = []
    for maker, source in CATALOGUES.items():
        glasses = {}
        for file in sorted((folder / "database/data/specs" / maker.lower() / "optical").glob("*.yml")):
            text = file.read_text()
            assert source in text, file
            if found := glass(text):
                glasses[file.stem.upper()] = found
        lines = ",\n".join(f"{json.dumps(name)}: {json.dumps(g)}" for name, g in glasses.items())
        source = json.dumps(f"{source}, as in the refractiveindex.info database (CC0 1.0), snapshot ff11b589 of 2026-06-14")
        blocks.append(f'"{maker}": {{"source": {source}, "glasses": {{\n{lines}}}}}')
    OUT.write_text("{\n" + ",\n".join(blocks) + "\n}\n")


main(Path(sys.argv[1]))
