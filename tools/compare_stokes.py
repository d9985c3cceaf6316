#!/usr/bin/env python3
"""Stokes images of étendue and of Mitsuba 3's integrator `stokes`, on one core in one run.

    tools/compare_stokes.py [--size 96x64] [--seeds 12] [--time 4]

Three scenes that both can do: a ball of glass on a floor, the same behind a polarizer, and two metal mirrors. Each renders every
scene with as many seeds, in turn, each for about so many seconds. Printed are S0 to S3 of the image, how far the renderers are apart
in standard errors (over tiles of 8 x 8 pixels; the largest of them all is tested at 1 % after Šidák), and the ratio of the times
that they take to the same error, étendue's over Mitsuba's: of the variances times seconds of all four images. The exit code says
whether they agree.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import NormalDist

import compare_peers as peers

ROOT = peers.ROOT
TILE = 8


def matrix(position, z=(0, 0, 1), x=(1, 0, 0)):
    """Of a node that faces z, its x axis as near to x as may be."""
    unit = lambda v: [c / math.sqrt(sum(d * d for d in v)) for c in v]
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    z = unit(z)
    y = unit(cross(z, x))
    x = cross(y, z)
    return [[x[i], y[i], z[i], position[i]] for i in range(3)] + [[0, 0, 0, 1]]


def rectangle(size, surface, position, z=(0, 0, 1), x=(1, 0, 0), **more):
    return {"shape": "rectangle", "size": size, "surface": surface, "matrix": matrix(position, z, x), **more}


def scenes():
    black, gray = {"class": "absorber"}, {"class": "lambertian", "reflectance": 0.5}
    lamp = rectangle([2, 2], black, [-1.5, 2.5, 1], [1, -1.6, -0.6], emission=8.0)
    floor = rectangle([8, 8], gray, [0, -1, 0], [0, 1, 0])
    ball = {"shape": "sphere", "radius": 1, "surface": {"class": "dielectric"}, "matrix": matrix([0, 0, 0])}
    camera = {"yfov": 0.7, "matrix": matrix([0, 0.6, 4.5], [0, 0.13, 1])}
    glass = {"camera": camera, "sky": 0.2, "nodes": [lamp, floor, ball]}
    sheet = rectangle([0.5, 0.5], {"class": "linear_polarizer"}, [0, 0.57, 4.2], [0, 0.13, 1], [0.8, 0.6, 0])
    gold = {"class": "conductor", "eta": 0.183, "k": 3.43}
    mirrors = [
        rectangle([3, 3], gold, [-0.4, 0, -0.5], [0.7, 0.4, 1]),
        rectangle([3, 3], gold, [1.6, 0.8, 0.5], [-1, -0.3, 0.2]),
    ]
    return {
        "glass": glass,
        "polarizer": glass | {"nodes": glass["nodes"] + [sheet]},
        "mirrors": {"camera": camera, "sky": 0.2, "nodes": [lamp, floor, *mirrors]},
    }


def gltf(scene):
    materials, nodes = [], []
    for node in scene["nodes"]:
        optics = {"surface": node["surface"]}
        if node["surface"]["class"] == "dielectric":
            optics["inside"] = "glass"
        if "emission" in node:
            optics["emission"] = {"radiance": node["emission"]}
        shape = {"class": node["shape"], "material": len(materials)}
        shape |= {"radius": node["radius"]} if node["shape"] == "sphere" else {"size": node["size"]}
        materials.append({"extensions": {"ETD_optics": optics}})
        nodes.append({"matrix": columns(node["matrix"]), "extensions": {"ETD_optics": {"geometry": shape}}})
    receiver = {"class": "perspective", "yfov": scene["camera"]["yfov"], "stokes": True}
    nodes.append(
        {"matrix": columns(scene["camera"]["matrix"]), "extensions": {"ETD_optics": {"receiver": receiver}}}
    )
    return {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["ETD_optics"],
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "materials": materials,
        "extensions": {
            "ETD_optics": {
                "media": [{"name": "glass", "class": "homogeneous", "ior": 1.5}],
                "environment": {"class": "constant", "radiance": scene["sky"]},
            }
        },
    }


def columns(rows):
    return [rows[i][k] for k in range(4) for i in range(4)]


class Etendue:
    name = "étendue"

    def __init__(self, scene, size, folder):
        self.folder, self.size = folder, size
        (folder / "scene.gltf").write_text(json.dumps(gltf(scene)))
        self.render(1, 0)

    def render(self, samples, seed):
        import numpy as np
        import OpenEXR

        image, stats = self.folder / "image.exr", self.folder / "stats.json"
        command = ["taskset", "-c", "0", ROOT / "build/release/etendue", "render", self.folder / "scene.gltf", "-q"]
        command += ["--algorithm", "backward", "--passes", samples, "--seed", seed, "--size", "{}x{}".format(*self.size)]
        command += ["--color", "rgb", "--stats", stats, "-o", image]
        subprocess.run(list(map(str, command)), check=True, env=os.environ | {"LP_NUM_THREADS": "1"})
        with OpenEXR.File(str(image), separate_channels=True) as file:
            channels = file.channels()
            layers = [[channels[layer + c].pixels for c in "RGB"] for layer in ("", "S1.", "S2.", "S3.")]
        return np.array(layers, dtype=np.float64).mean(axis=1), json.loads(stats.read_text())["seconds"]


class Mitsuba:
    def __init__(self, variant, scene, size, folder):
        self.file = folder / "image.npy"
        (folder / "scene.json").write_text(json.dumps(scene))
        worker = ROOT / "tools/peers/mitsuba_stokes_worker.py"
        words = [peers.environment_for("mitsuba"), worker, variant, folder / "scene.json", *size, 1]
        self.process = subprocess.Popen(
            ["taskset", "-c", "0", *map(str, words)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=os.environ | {"DRJIT_LIBLLVM_PATH": str(peers.find_llvm())},
        )
        self.name = self.reply()["ready"]

    def reply(self):
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"Mitsuba ended with code {self.process.wait()}")
        return json.loads(line)

    def render(self, samples, seed):
        import numpy as np

        self.process.stdin.write(json.dumps({"samples": samples, "seed": seed, "file": str(self.file)}) + "\n")
        self.process.stdin.flush()
        seconds = self.reply()["seconds"]
        return np.load(self.file), seconds

    def end(self):
        self.process.stdin.close()
        self.process.wait()


def tiles(image):
    import numpy as np

    _, h, w = image.shape
    cut = image[:, : h // TILE * TILE, : w // TILE * TILE]
    return cut.reshape(4, h // TILE, TILE, w // TILE, TILE).mean(axis=(2, 4)).reshape(4, -1)


def compare(name, variant, scene, a):
    import numpy as np

    with tempfile.TemporaryDirectory() as text:
        folder = Path(text)
        renderers = [Etendue(scene, a.size, folder), Mitsuba(variant, scene, a.size, folder)]
        samples = []
        for renderer in renderers:  # as many as fit into the time
            count, seconds = 4, 0.0
            while seconds < 0.2:
                count *= 4
                _, seconds = renderer.render(count, 1)
            samples.append(max(1, round(count * a.time / seconds)))
        images, seconds = [[], []], [0.0, 0.0]
        for seed in range(a.seeds):
            for i, renderer in enumerate(renderers):
                image, took = renderer.render(samples[i], 100 + seed)
                images[i].append(image)
                seconds[i] += took / a.seeds
        renderers[1].end()
    means = [np.mean(i, axis=0) for i in images]
    mean_tiles = [np.array([tiles(i) for i in own]) for own in images]
    variance = [t.var(axis=0, ddof=1) / a.seeds for t in mean_tiles]
    apart = mean_tiles[0].mean(axis=0) - mean_tiles[1].mean(axis=0)
    # Tiles hold little of the images' own variance: with few seeds it is taken from all tiles of a layer alike, too.
    noise = np.sqrt(sum(0.5 * v + 0.5 * v.mean(axis=1, keepdims=True) for v in variance) + 1e-20)
    z = np.where(np.abs(apart) < 1e-6, 0, apart / noise)
    limit = -NormalDist().inv_cdf(0.5 * (1 - 0.99 ** (1 / z.size)))
    # Per pixel, all four layers together.
    error = [np.var(own, axis=0, ddof=1).sum(axis=0).mean() for own in images]
    ratio = error[0] * seconds[0] / (error[1] * seconds[1])
    agree = np.abs(z).max() < limit
    verdict = "agree" if agree else "DIFFERENT"
    print(f"{name}, {renderers[1].name}: {verdict}, largest |z| {np.abs(z).max():.2f} of {z.size} tiles, limit {limit:.2f}")
    for i, renderer in enumerate(renderers):
        layers = " ".join(f"{m:+.5f}" for m in means[i].mean(axis=(1, 2)))
        print(f"  {renderer.name:32} S0 to S3 {layers}, {samples[i]} samples in {seconds[i]:.2f} s")
    print(f"  time to equal error, étendue / Mitsuba: {ratio:.3f}")
    return agree


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=lambda t: tuple(map(int, t.split("x"))), default=(96, 64))
    parser.add_argument("--seeds", type=int, default=12)
    parser.add_argument("--time", type=float, default=4, help="seconds a seed and renderer")
    parser.add_argument("--variants", default="llvm_ad_mono_polarized,llvm_ad_spectral_polarized")
    a = parser.parse_args()
    peers.set_up(["tool", "mitsuba"])
    if Path(sys.executable) != peers.environment_for("tool"):
        os.execv(peers.environment_for("tool"), [str(peers.environment_for("tool")), __file__, *sys.argv[1:]])
    agree = [compare(n, v, s, a) for v in a.variants.split(",") for n, s in scenes().items()]
    return 0 if all(agree) else 1


if __name__ == "__main__":
    sys.exit(main())
