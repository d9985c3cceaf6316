"""Reads the part of the scene format that the reference scenes use into plain data, for the peers' workers."""

import base64
import json
from pathlib import Path

import numpy as np


class Unsupported(Exception):
    pass


def _rgb(value):
    if isinstance(value, (int, float)):
        return [float(value)] * 3
    if isinstance(value, list) and len(value) == 3:
        return [float(x) for x in value]
    raise Unsupported(f"a spectral value {json.dumps(value)}")


def _matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    if "rotation" in node:
        raise Unsupported("a node with a rotation")
    m = np.diag([*node.get("scale", [1, 1, 1]), 1.0])
    m[:3, 3] = node.get("translation", [0, 0, 0])
    return m


def _material(gltf, material):
    optics = material.get("extensions", {}).get("ETD_optics", {})
    if "surface" not in optics or set(optics) - {"surface", "inside"}:
        raise Unsupported(f"the material '{material.get('name')}'")
    surface = dict(optics["surface"])
    for key in ("reflectance", "eta", "k"):
        if key in surface:
            surface[key] = _rgb(surface[key])
    if "inside" in optics:
        media = {m["name"]: m for m in gltf["extensions"]["ETD_optics"]["media"]}
        inside = media[optics["inside"]]
        if set(inside) - {"name", "class", "ior"}:
            raise Unsupported(f"the medium '{inside['name']}'")
        surface["ior"] = inside.get("ior", 1.0)
    strength = (
        material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
    )
    surface["emission"] = [strength * x for x in material.get("emissiveFactor", [0, 0, 0])]
    return surface


def _accessor(gltf, index):
    accessor = gltf["accessors"][index]
    view = gltf["bufferViews"][accessor["bufferView"]]
    data = base64.b64decode(gltf["buffers"][view["buffer"]]["uri"].split(",", 1)[1])
    dtype = {5126: "<f4", 5123: "<u2", 5125: "<u4", 5121: "<u1"}[accessor["componentType"]]
    width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
    if "byteStride" in view:
        raise Unsupported("an interleaved buffer")
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return np.frombuffer(data, dtype, accessor["count"] * width, start).reshape(-1, width)


def load(path):
    """meshes [(positions, triangles, material)], spheres [(centre, radius, material)], camera, environment."""
    gltf = json.loads(Path(path).read_text(encoding="utf-8"))
    materials = [_material(gltf, m) for m in gltf["materials"]]
    scene = {"meshes": [], "spheres": [], "camera": None, "environment": None}
    environment = gltf.get("extensions", {}).get("ETD_optics", {}).get("environment")
    if environment:
        if environment["class"] != "constant":
            raise Unsupported(f"the environment '{environment['class']}'")
        scene["environment"] = _rgb(environment["radiance"])
    for node in (gltf["nodes"][i] for i in gltf["scenes"][gltf.get("scene", 0)]["nodes"]):
        m = _matrix(node)
        geometry = node.get("extensions", {}).get("ETD_optics", {}).get("geometry")
        if node.get("children") or (geometry and geometry["class"] != "sphere"):
            raise Unsupported(f"the node '{node.get('name')}'")
        if geometry:
            scene["spheres"].append((m[:3, 3].tolist(), geometry["radius"], materials[geometry["material"]]))
        for primitive in gltf["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            positions = _accessor(gltf, primitive["attributes"]["POSITION"]) @ m[:3, :3].T + m[:3, 3]
            triangles = _accessor(gltf, primitive["indices"]).reshape(-1, 3).astype(np.uint32)
            scene["meshes"].append((positions, triangles, materials[primitive["material"]]))
        if "camera" in node:
            perspective = gltf["cameras"][node["camera"]]["perspective"]
            scene["camera"] = {"matrix": m, "yfov": perspective["yfov"]}
    return scene


def as_quad(positions, triangles):
    """The four corners where a mesh is one parallelogram of two triangles, else None."""
    if len(positions) == 4 and triangles.tolist() == [[0, 1, 2], [0, 2, 3]]:
        p = positions
        if np.abs(p[0] + p[2] - p[1] - p[3]).max() <= 1e-5 * np.abs(p - p[0]).max():
            return p
    return None
