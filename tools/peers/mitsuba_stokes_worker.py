"""Mitsuba 3: integrator `stokes` over `path`, without a depth limit, of a scene of tools/compare_stokes.py.

    mitsuba_stokes_worker.py VARIANT SCENE.json WIDTH HEIGHT THREADS

Reads lines {"samples", "seed", "file"}; writes the mean over the wavelengths of S0 to S3 as an array (4, height, width), and a line
{"seconds"}.
"""

import json
import sys
import time

import mitsuba as mi
import numpy as np

variant, scene_file, width, height, threads = sys.argv[1], sys.argv[2], *map(int, sys.argv[3:6])
mi.set_variant(variant)
from drjit import set_thread_count, sync_thread  # noqa: E402

set_thread_count(threads)


def light(value):
    """Of the white of an RGB image."""
    return {"type": "uniform", "value": value} if "mono" in variant else {"type": "rgb", "value": [value] * 3}


def placed(node):
    transform = mi.ScalarTransform4f(np.array(node["matrix"], dtype=float))
    if node["shape"] == "sphere":
        shape = {"type": "sphere", "to_world": transform @ mi.ScalarTransform4f().scale(node["radius"])}
    else:
        w, h = node["size"]
        shape = {"type": "rectangle", "to_world": transform @ mi.ScalarTransform4f().scale([w / 2, h / 2, 1])}
    surface = node["surface"]
    if "emission" in node:
        shape["emitter"] = {"type": "area", "radiance": light(node["emission"])}
        shape["bsdf"] = {"type": "diffuse", "reflectance": {"type": "uniform", "value": 0.0}}
    elif surface["class"] == "lambertian":
        shape["bsdf"] = {
            "type": "twosided",
            "bsdf": {"type": "diffuse", "reflectance": {"type": "uniform", "value": surface["reflectance"]}},
        }
    elif surface["class"] == "conductor":
        shape["bsdf"] = {
            "type": "twosided",
            "bsdf": {"type": "conductor"} | {k: {"type": "uniform", "value": surface[k]} for k in ("eta", "k")},
        }
    elif surface["class"] == "dielectric":
        shape["bsdf"] = {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0}
    else:
        shape["bsdf"] = {"type": "polarizer", "theta": 0.0}
    return shape


data = json.load(open(scene_file))
camera = np.array(data["camera"]["matrix"]) @ np.diag([-1.0, 1, -1, 1])  # Mitsuba's cameras look along +z, +x to the left
scene = {
    "type": "scene",
    "integrator": {"type": "stokes", "nested": {"type": "path", "max_depth": -1}},
    "sensor": {
        "type": "perspective",
        "fov_axis": "y",
        "fov": np.degrees(data["camera"]["yfov"]),
        "to_world": mi.ScalarTransform4f(camera),
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "luminance" if "mono" in variant else "rgb",
            "rfilter": {"type": "box"},
        },
    },
    "sky": {"type": "constant", "radiance": light(data["sky"])},
}
scene |= {f"shape{i}": placed(node) for i, node in enumerate(data["nodes"])}
scene = mi.load_dict(scene)
mi.render(scene, spp=1, seed=0)
print(json.dumps({"ready": f"Mitsuba {mi.__version__}, {variant}"}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    start = time.time()
    image = mi.render(scene, spp=request["samples"], seed=request["seed"])
    values = np.array(image)
    sync_thread()
    seconds = time.time() - start
    # Behind the picture itself S0 to S3, each in three channels.
    stokes = values[:, :, -12:].reshape(*values.shape[:2], 4, 3).mean(axis=3).transpose(2, 0, 1)
    np.save(request["file"], stokes.astype(np.float64))
    print(json.dumps({"seconds": seconds}), flush=True)
