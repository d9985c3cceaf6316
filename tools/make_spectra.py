#!/usr/bin/env python3
"""Writes host/spectra/library.json: the spectra that scenes can name without bringing them.

    tools/make_spectra.py FOLDER

FOLDER holds files of the refractiveindex.info database (CC0 1.0). Observer and illuminants come from the Python package
colour-science. Values are spectral values of the scene format (wavelengths in nm), each with its source.
"""
import json
import re
import sys
from pathlib import Path

import colour  # pip install colour-science
import numpy as np

PACKAGE = "as in the Python package colour-science (BSD-3-Clause)"
CIE = f"table of CIE 15:2018, Colorimetry, {PACKAGE}"
OUT = Path(__file__).parent.parent / "host/spectra/library.json"


def table(wavelengths, values, source, digits=6):
    return {"wavelengths": [float(f"{w:.6g}") for w in wavelengths],
            "values": [float(f"{v:.{digits}g}") for v in values], "source": source}


def from_colour(distribution, source):
    keep = (distribution.wavelengths >= 360) & (distribution.wavelengths <= 830)
    return table(distribution.wavelengths[keep], distribution.values[keep], source)


def of_file(path):
    """(blocks of data by type, source) of a file of the database."""
    text = path.read_text()
    blocks = {}
    for kind, body in re.findall(r"- type: (.+?)\n((?:    .*\n?)+)", text):
        blocks[kind.strip()] = body
    reference = re.search(r"REFERENCES: \|\n((?:    .*\n)+)", text).group(1)
    reference = " ".join(re.sub(r"<[^>]+>", "", reference).split())
    return blocks, f"{reference[:200].strip()} (refractiveindex.info, CC0 1.0, file {path.name})"


def index(path):
    blocks, source = of_file(path)
    if "tabulated nk" in blocks:
        rows = np.array([[float(x) for x in line.split()] for line in blocks["tabulated nk"].splitlines()[1:]])
        return table(1e3 * rows[:, 0], rows[:, 1], source)
    kind = "formula 1" if "formula 1" in blocks else "formula 2"
    c = [float(x) for x in re.search(r"coefficients: (.+)", blocks[kind]).group(1).split()]
    assert c[0] == 0
    strengths, poles = c[1::2], c[2::2]
    if kind == "formula 1":  # poles are wavelengths there
        poles = [float(f"{p * p:.10g}") for p in poles]
    return {"sellmeier": strengths + poles, "source": source}


def metal(path):
    """eta and k in the visible, with one point beyond on each side."""
    blocks, source = of_file(path)
    rows = np.array([[float(x) for x in line.split()] for line in blocks["tabulated nk"].splitlines()[1:]])
    inside = np.flatnonzero((rows[:, 0] >= 0.36) & (rows[:, 0] <= 0.83))
    rows = rows[max(inside[0] - 1, 0):inside[-1] + 2]
    return table(1e3 * rows[:, 0], rows[:, 1], source), table(1e3 * rows[:, 0], rows[:, 2], source)


def main(folder):
    library = {}
    observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"]
    for i, name in enumerate("xyz"):
        keep = (observer.wavelengths >= 360) & (observer.wavelengths <= 830)
        library[f"CIE 1931 {name}"] = table(observer.wavelengths[keep], observer.values[keep, i],
                                            "CIE 1931 standard observer, 2 degrees, 1 nm: " + CIE)
    for name, key in {"A": "A", "D65": "D65", "E": "E", **{f"F{i}": f"FL{i}" for i in range(1, 13)}}.items():
        library[f"illuminant {name}"] = from_colour(colour.SDS_ILLUMINANTS[key], f"CIE illuminant {key}: {CIE}")
    daylight = colour.colorimetry.SDS_BASIS_FUNCTIONS_CIE_ILLUMINANT_D_SERIES
    for name in ["S0", "S1", "S2"]:
        library[f"CIE daylight {name}"] = from_colour(daylight[name], f"component {name} of CIE daylight: {CIE}")
    test_colours = colour.quality.datasets.SDS_TCS["CIE 1995"]
    for i in range(1, 15):
        library[f"CIE test colour {i}"] = from_colour(
            test_colours[f"TCS{i:02d}"], f"reflectance of test colour {i} of CIE 13.3-1995, {PACKAGE}")
    for name, file in {"BK7": "N-BK7", "SF11": "SF11", "fused silica": "fused_silica.Malitson",
                       "PMMA": "PMMA.Sultanova", "polycarbonate": "polycarbonate.Sultanova",
                       "water": "water.Daimon-20C"}.items():
        library[f"{name} ior"] = index(folder / f"{file}.yml")
    for name in ["Ag.Johnson", "Al.Rakic", "Au.Johnson", "Cr.Johnson", "Cu.Johnson"]:
        library[f"{name[:2]} eta"], library[f"{name[:2]} k"] = metal(folder / f"{name}.yml")
    lines = [f"{json.dumps(name)}: {json.dumps(value)}" for name, value in library.items()]
    OUT.write_text("{\n" + ",\n".join(lines) + "\n}\n")


main(Path(sys.argv[1]))
