"""Reads the part of the scene format that other renderers have too into plain data, for the peers' workers."""

import base64
import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np


class Unsupported(Exception):
    pass


@dataclass
class Mesh:
    positions: np.ndarray  # n x 3, m
    triangles: np.ndarray  # n x 3, indices
    normals: np.ndarray | None  # n x 3 unit vectors to shade with; None: those of the triangles
    material: dict


@dataclass
class Sphere:
    centre: list
    radius: float
    material: dict

    def mesh(self, columns=256, rows=128):
        """For renderers without spheres: inside the sphere by 8e-5 of the radius at most."""
        u, v = np.meshgrid(np.arange(columns) * 2 * np.pi / columns, np.arange(rows + 1) * np.pi / rows)
        normals = np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)], -1).reshape(-1, 3)
        column, row = np.meshgrid(np.arange(columns), np.arange(rows))
        a, b = row * columns + column, row * columns + (column + 1) % columns
        below = np.stack([a, a + columns, b + columns], -1)[:-1]  # without those of no area at the poles
        above = np.stack([a, b + columns, b], -1)[1:]
        triangles = np.concatenate([below.reshape(-1, 3), above.reshape(-1, 3)]).astype(np.uint32)
        return Mesh(np.array(self.centre) + self.radius * normals, triangles, normals, self.material)


def _rgb(value):
    if isinstance(value, (int, float)):
        return [float(value)] * 3
    if isinstance(value, list) and len(value) == 3:
        return [float(x) for x in value]
    raise Unsupported(f"a spectral value {json.dumps(value)}")


def _matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    m = np.eye(4)
    m[:3, :3] = rotation * node.get("scale", [1, 1, 1])
    m[:3, 3] = node.get("translation", [0, 0, 0])
    return m


SURFACES = {
    "boundary": set(),
    "lambertian": {"reflectance"},
    "conductor": {"reflectance", "eta", "k", "alpha", "multiscatter"},
    "dielectric": {"alpha", "multiscatter"},
}


@dataclass
class Medium:
    """The same everywhere; 1/m."""

    absorption: list
    scattering: list
    g: float  # of Henyey and Greenstein's phase function; 0: isotropic


def _medium(medium):
    """None where it is clear."""
    phase = medium.get("phase", {"class": "isotropic"})
    known = {"isotropic": {"class"}, "henyey_greenstein": {"class", "g"}}
    if (
        medium["class"] != "homogeneous"
        or set(medium) - {"name", "class", "ior", "absorption", "scattering", "phase"}
        or set(phase) - known.get(phase["class"], set())
        or not isinstance(medium.get("ior", 1.0), (int, float))
    ):
        raise Unsupported(f"the medium '{medium['name']}'")
    absorption, scattering = (_rgb(medium.get(key, 0)) for key in ("absorption", "scattering"))
    if max(absorption + scattering) == 0:
        return None
    return Medium(absorption, scattering, phase.get("g", 0.0))


def _material(gltf, material):
    name = material.get("name")
    optics = material.get("extensions", {}).get("ETD_optics", {})
    if "surface" not in optics or set(optics) - {"surface", "inside"}:
        raise Unsupported(f"the material '{name}'")
    surface = dict(optics["surface"])
    if surface["class"] not in SURFACES:
        raise Unsupported(f"the surface '{surface['class']}'")
    if unknown := set(surface) - SURFACES[surface["class"]] - {"class"}:
        raise Unsupported(f"'{unknown.pop()}' of the material '{name}'")
    if surface.get("multiscatter"):
        raise Unsupported("multiscatter")
    for key in ("reflectance", "eta", "k"):
        if key in surface:
            surface[key] = _rgb(surface[key])
    if surface["class"] == "lambertian":
        surface.setdefault("reflectance", [0.5] * 3)
    surface.setdefault("alpha", 0.0)
    surface["ior"] = 1.0
    if "inside" in optics:
        media = {m["name"]: m for m in gltf["extensions"]["ETD_optics"]["media"]}
        inside = media[optics["inside"]]
        surface["ior"] = inside.get("ior", 1.0)
        surface["medium"] = _medium(inside)
    elif surface["class"] == "dielectric":
        raise Unsupported(f"the material '{name}' without a medium inside")
    strength = (
        material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
    )
    surface["emission"] = [strength * x for x in material.get("emissiveFactor", [0, 0, 0])]
    if max(surface["emission"]) > 0 and material.get("doubleSided"):
        raise Unsupported(f"the material '{name}', which emits on both sides")
    return surface


def _accessor(gltf, index):
    accessor = gltf["accessors"][index]
    view = gltf["bufferViews"][accessor["bufferView"]]
    if not gltf["buffers"][view["buffer"]].get("uri", "").startswith("data:"):
        raise Unsupported("a buffer in another file")
    data = base64.b64decode(gltf["buffers"][view["buffer"]]["uri"].split(",", 1)[1])
    dtype = {5126: "<f4", 5123: "<u2", 5125: "<u4", 5121: "<u1"}[accessor["componentType"]]
    width = {"SCALAR": 1, "VEC3": 3}[accessor["type"]]
    if "byteStride" in view:
        raise Unsupported("an interleaved buffer")
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return np.frombuffer(data, dtype, accessor["count"] * width, start).reshape(-1, width)


def _mesh(gltf, primitive, m, materials):
    attributes = primitive["attributes"]
    positions = _accessor(gltf, attributes["POSITION"]) @ m[:3, :3].T + m[:3, 3]
    normals = None
    if "NORMAL" in attributes:
        normals = _accessor(gltf, attributes["NORMAL"]) @ np.linalg.inv(m[:3, :3])
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    if "indices" in primitive:
        triangles = _accessor(gltf, primitive["indices"]).reshape(-1, 3).astype(np.uint32)
    else:
        triangles = np.arange(len(positions), dtype=np.uint32).reshape(-1, 3)
    return Mesh(positions, triangles, normals, materials[primitive["material"]])


def _shape(geometry, m, materials):
    material = materials[geometry["material"]]
    if geometry["class"] == "sphere":
        scale = np.linalg.norm(m[:3, :3], axis=0)
        if scale.max() - scale.min() > 1e-6 * scale.max():
            raise Unsupported("a sphere that is scaled unevenly")
        return Sphere(m[:3, 3].tolist(), float(geometry["radius"] * scale[0]), material)
    if geometry["class"] == "rectangle":
        x, y = m[:3, 0] * geometry["size"][0] / 2, m[:3, 1] * geometry["size"][1] / 2
        corners = m[:3, 3] + np.array([-x - y, x - y, x + y, y - x])
        return Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), None, material)
    raise Unsupported(f"the geometry '{geometry['class']}'")


@dataclass
class EnvironmentImage:
    """Latitude and longitude: the centre looks along -z, columns run to the right as seen from inside, +y is up."""

    file: str
    scale: float
    rotation: float  # rad, about +y, counter-clockwise seen from above


def document(path):
    """The JSON of a .gltf or .glb file."""
    data = Path(path).read_bytes()
    if data[:4] == b"glTF":
        data = data[20 : 20 + int.from_bytes(data[12:16], "little")]
    return json.loads(data)


def roots(gltf):
    return gltf["scenes"][gltf.get("scene", 0)]["nodes"]


def camera(gltf, default=None):
    """The first camera, {matrix, yfov}; `default` where the file has none."""
    open_nodes = [(root, np.eye(4)) for root in reversed(roots(gltf))]
    while open_nodes:
        index, parent = open_nodes.pop()
        node = gltf["nodes"][index]
        m = parent @ _matrix(node)
        if "camera" in node:
            found = gltf["cameras"][node["camera"]]
            if found["type"] != "perspective":
                raise Unsupported("an orthographic camera")
            return {"matrix": m, "yfov": found["perspective"]["yfov"]}
        open_nodes += [(child, m) for child in reversed(node.get("children", []))]
    if default is None:
        raise Unsupported("a scene without a camera")
    return {"matrix": np.array(default["matrix"]), "yfov": default["yfov"]}


def environment(gltf, path, image=None):
    """Radiance, EnvironmentImage or None; `image` is the file of one in its place."""
    if image:
        return EnvironmentImage(str(image), 1.0, 0.0)
    found = gltf.get("extensions", {}).get("ETD_optics", {}).get("environment")
    if found is None:
        return None
    if found["class"] == "constant":
        return _rgb(found["radiance"])
    if found["class"] == "image":
        file = Path(path).parent / found["file"]
        return EnvironmentImage(str(file), found.get("scale", 1.0), found.get("rotation", 0.0))
    raise Unsupported(f"the environment '{found['class']}'")


def load(path, view=None, image=None):
    """meshes, spheres, camera, environment: `view` and `image` are the defaults of those two."""
    if Path(path).suffix != ".gltf":
        raise Unsupported("files that are not .gltf")
    gltf = document(path)
    materials = [_material(gltf, m) for m in gltf.get("materials", [])]
    scene = {"meshes": [], "spheres": []}
    scene["camera"], scene["environment"] = camera(gltf, view), environment(gltf, path, image)

    def visit(index, parent):
        node = gltf["nodes"][index]
        m = parent @ _matrix(node)
        extensions = node.get("extensions", {})
        optics = extensions.get("ETD_optics", {})
        if set(extensions) - {"ETD_optics"} or set(optics) - {"geometry"}:
            raise Unsupported(f"the node '{node.get('name')}'")
        if "geometry" in optics:
            shape = _shape(optics["geometry"], m, materials)
            scene["spheres" if isinstance(shape, Sphere) else "meshes"].append(shape)
        for primitive in gltf["meshes"][node["mesh"]]["primitives"] if "mesh" in node else []:
            scene["meshes"].append(_mesh(gltf, primitive, m, materials))
        for child in node.get("children", []):
            visit(child, m)

    for root in roots(gltf):
        visit(root, np.eye(4))
    return scene


def as_quad(mesh):
    """The four corners where a mesh is one parallelogram of two triangles, else None."""
    if len(mesh.positions) == 4 and mesh.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]:
        p = mesh.positions
        if np.abs(p[0] + p[2] - p[1] - p[3]).max() <= 1e-5 * np.abs(p - p[0]).max():
            return p
    return None
