"""Builds small glTF scenes with embedded buffers: materials, meshes, shapes, lights, cameras. Metres, +Y up."""

import base64
import json
import math
import struct


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


def look_along(position, direction, up=(0, 1, 0)):
    """Column-major matrix of a node at `position` whose -z axis points along `direction`."""
    z = [-x for x in unit(direction)]
    x = unit(cross(up, z))
    y = cross(z, x)
    return [*x, 0, *y, 0, *z, 0, *position, 1]


def look_at(position, target, up=(0, 1, 0)):
    return look_along(position, sub(target, position), up)


def facing(position, direction, up=(0, 1, 0)):
    """Matrix of a node whose +z axis, the front of rectangles and disks, points along `direction`."""
    return look_along(position, [-x for x in direction], up)


class Gltf:
    """`expected`: what the scene must show, in words. Without words the file lists no scenes, and all its nodes are shown."""

    def __init__(self, name, expected):
        self.name, self.expected = name, expected
        self.nodes, self.meshes, self.materials, self.cameras = [], [], [], []
        self.inner = []  # further scenes, for elements: lists of nodes
        self.lights, self.accessors, self.views, self.media = [], [], [], []
        self.environment = None
        self.data = bytearray()
        self.files = {}  # name -> bytes, written beside the scene
        self.extensions = {"ETD_optics"}

    # Materials. `surface` is a class of ETD_optics with its parameters; `glowing` adds emission.
    def surface(self, name, class_name, inside=None, outside=None, priority=None, **parameters):
        optics = {"surface": {"class": class_name, **parameters}}
        if inside:
            optics["inside"] = inside
        if outside:
            optics["outside"] = outside
        if priority:
            optics["priority"] = priority
        return self._material({"name": name, "extensions": {"ETD_optics": optics}})

    def principled(
        self, name, color, metallic=0.0, roughness=0.5, transmission=None, ior=None, attenuation=None, **more
    ):
        """glTF's own material. `attenuation`: (color, distance in m) of the glass inside; `more`: members of
        KHR_materials_NAME by NAME."""
        pbr = {"baseColorFactor": [*color, 1], "metallicFactor": metallic, "roughnessFactor": roughness}
        extensions = {}
        if transmission is not None:
            extensions["KHR_materials_transmission"] = {"transmissionFactor": transmission}
            volume = {"thicknessFactor": 1}
            if attenuation:
                volume |= {"attenuationColor": attenuation[0], "attenuationDistance": attenuation[1]}
            extensions["KHR_materials_volume"] = volume
        if ior is not None:
            extensions["KHR_materials_ior"] = {"ior": ior}
        extensions |= {f"KHR_materials_{key}": members for key, members in more.items()}
        self.extensions |= set(extensions)
        material = {"name": name, "pbrMetallicRoughness": pbr}
        return self._material(material | ({"extensions": extensions} if extensions else {}))

    def emitter(self, name, luminance, color=(1, 1, 1)):
        """A black surface of that radiance (color × luminance) on its front."""
        self.extensions.add("KHR_materials_emissive_strength")
        return self._material(
            {
                "name": name,
                "emissiveFactor": list(color),
                "extensions": {
                    "KHR_materials_emissive_strength": {"emissiveStrength": luminance},
                    "ETD_optics": {"surface": {"class": "lambertian", "reflectance": 0}},
                },
            }
        )

    def medium(self, name, **parameters):
        self.media.append({"name": name, "class": "homogeneous", **parameters})
        return name

    def surround(self, radiance):
        self.environment = {"class": "constant", "radiance": radiance}

    # Objects.
    def shape(self, name, class_name, material, translation=None, matrix=None, **parameters):
        node = {
            "name": name,
            **({"matrix": matrix} if matrix else {"translation": list(translation or (0, 0, 0))}),
        }
        node["extensions"] = {
            "ETD_optics": {"geometry": {"class": class_name, **parameters, "material": material}}
        }
        self.nodes.append(node)

    def mesh(self, name, material, positions, triangles, normals=None, **placement):
        """Adds a mesh and a node that shows it. Without normals the mesh is faceted."""
        attributes = {"POSITION": self._accessor(positions, "VEC3", "f", bounds=True)}
        if normals:
            attributes["NORMAL"] = self._accessor(normals, "VEC3", "f")
        indices = self._accessor(
            [[i] for t in triangles for i in t], "SCALAR", "H" if len(positions) < 65536 else "I"
        )
        self.meshes.append(
            {
                "name": name,
                "primitives": [{"attributes": attributes, "indices": indices, "material": material}],
            }
        )
        self.nodes.append({"name": name, **placement, "mesh": len(self.meshes) - 1})

    def quad(self, name, material, corners):
        """Four corners, counter-clockwise seen from the front."""
        self.mesh(name, material, corners, [[0, 1, 2], [0, 2, 3]])

    def box(self, name, material, size, **placement):
        """A box that stands on the origin of its node: x and z centred, y from 0."""
        w, h, d = size[0] / 2, size[1], size[2] / 2
        positions, triangles = [], []
        for corners in (
            [(-w, 0, d), (w, 0, d), (w, h, d), (-w, h, d)],
            [(w, 0, -d), (-w, 0, -d), (-w, h, -d), (w, h, -d)],
            [(w, 0, d), (w, 0, -d), (w, h, -d), (w, h, d)],
            [(-w, 0, -d), (-w, 0, d), (-w, h, d), (-w, h, -d)],
            [(-w, h, d), (w, h, d), (w, h, -d), (-w, h, -d)],
            [(-w, 0, -d), (w, 0, -d), (w, 0, d), (-w, 0, d)],
        ):
            first = len(positions)
            positions += corners
            triangles += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
        self.mesh(name, material, positions, triangles, **placement)

    def instances(self, name, material, positions, triangles, translations, rotations=None):
        """One mesh shown at every translation (EXT_mesh_gpu_instancing)."""
        self.mesh(name, material, positions, triangles)
        self.extensions.add("EXT_mesh_gpu_instancing")
        attributes = {"TRANSLATION": self._accessor(translations, "VEC3", "f")}
        if rotations:
            attributes["ROTATION"] = self._accessor(rotations, "VEC4", "f")
        self.nodes[-1]["extensions"] = {"EXT_mesh_gpu_instancing": {"attributes": attributes}}

    def light(self, name, kind, intensity, matrix, color=(1, 1, 1), **rest):
        """A point or spot light (cd) or a directional one (lx) that shines along -z of its node."""
        self.extensions.add("KHR_lights_punctual")
        self.lights.append({"name": name, "type": kind, "color": list(color), "intensity": intensity, **rest})
        self.nodes.append(
            {
                "name": name,
                "matrix": matrix,
                "extensions": {"KHR_lights_punctual": {"light": len(self.lights) - 1}},
            }
        )

    def lamp(self, name, matrix, class_name, shape=None, **parameters):
        """A light of a class of ETD_optics; `shape`: the geometry at its node, too."""
        self._placed("light", name, matrix, class_name, parameters)
        if shape:
            self.nodes[-1]["extensions"]["ETD_optics"]["geometry"] = shape

    def receiver(self, name, matrix, class_name, **parameters):
        """A receiver of a class of ETD_optics."""
        self._placed("receiver", name, matrix, class_name, parameters)

    def scene(self, name, fill):
        """What `fill` adds stands in another scene of the file; returns its index, for elements."""
        first = len(self.nodes)
        inner = len(self.inner)
        fill()
        held = {i for scene in self.inner[inner:] for i in scene["nodes"]}
        self.inner.append({"name": name, "nodes": [i for i in range(first, len(self.nodes)) if i not in held]})
        return len(self.inner)

    def element(self, name, matrix, class_name, **parameters):
        """An optical element; a `subscene` names the index of its scene."""
        self._placed("element", name, matrix, class_name, parameters)

    def _placed(self, interface, name, matrix, class_name, parameters):
        optics = {interface: {"class": class_name, **parameters}}
        placement = {"matrix": matrix} if matrix else {}
        self.nodes.append({"name": name, **placement, "extensions": {"ETD_optics": optics}})

    def camera(self, position, target, yfov_degrees, aspect, name="camera", stokes=False):
        self.cameras.append(
            {
                "name": name,
                "type": "perspective",
                "perspective": {
                    "yfov": round(math.radians(yfov_degrees), 9),
                    "aspectRatio": aspect,
                    "znear": 0.01,
                },
            }
        )
        self._camera_node(name, position, target, stokes)

    def orthographic(self, position, target, ymag, aspect, name="camera", stokes=False):
        """Shows `ymag` metres above and below the target."""
        self.cameras.append(
            {
                "name": name,
                "type": "orthographic",
                "orthographic": {"xmag": ymag * aspect, "ymag": ymag, "znear": 0.01, "zfar": 100},
            }
        )
        self._camera_node(name, position, target, stokes)

    def _camera_node(self, name, position, target, stokes):
        """`stokes`: the receiver measures S1 to S3, too."""
        node = {"name": name, "camera": len(self.cameras) - 1, "matrix": look_at(position, target)}
        if stokes:
            node["extensions"] = {"ETD_optics": {"receiver": {"stokes": True}}}
        self.nodes.append(node)

    # The file.
    def write(self, path):
        optics = {}
        if self.media:
            optics["media"] = self.media
        if self.environment:
            optics["environment"] = self.environment
        extensions = {"ETD_optics": optics} if optics else {}
        if self.lights:
            extensions["KHR_lights_punctual"] = {"lights": self.lights}
        root = {
            "asset": {"version": "2.0", "generator": "tools/scenes/make.py"},
            "extensionsUsed": sorted(self.extensions),
            "extensions": extensions,
            **(self._scenes() if self.expected else {}),
            "nodes": self.nodes,
            "cameras": self.cameras,
            "materials": self.materials,
            "meshes": self.meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
        }
        if self.data:
            uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
            root["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
        root = {key: value for key, value in root.items() if value != [] and value != {}}
        path.write_text(_text(_rounded(root)), encoding="utf-8")
        for name, content in self.files.items():
            (path.parent / name).write_bytes(content)

    def _scenes(self):
        held = {i for scene in self.inner for i in scene["nodes"]}
        nodes = [i for i in range(len(self.nodes)) if i not in held]
        scene = {"name": self.name, "extras": {"expected": self.expected}, "nodes": nodes}
        return {"scene": 0, "scenes": [scene, *self.inner]}

    def _material(self, material):
        self.materials.append(material)
        return len(self.materials) - 1

    def _accessor(self, rows, kind, letter, bounds=False):
        self.data += b"\0" * (-len(self.data) % 4)
        packed = b"".join(struct.pack(f"<{len(row)}{letter}", *row) for row in rows)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.data += packed
        accessor = {
            "bufferView": len(self.views) - 1,
            "count": len(rows),
            "type": kind,
            "componentType": {"f": 5126, "H": 5123, "I": 5125}[letter],
        }
        if bounds:
            single = [struct.unpack(f"<{len(row)}f", struct.pack(f"<{len(row)}f", *row)) for row in rows]
            accessor |= {"min": [min(c) for c in zip(*single)], "max": [max(c) for c in zip(*single)]}
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _rounded(value):
    if isinstance(value, float):
        return int(value) if value == int(value) and abs(value) < 1e9 else float(f"{value:.9g}")
    if isinstance(value, dict):
        return {k: _rounded(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_rounded(v) for v in value]
    return value


def _text(root):
    """JSON with one object of glTF's arrays a line, so that a scene can be read and changed by hand."""
    lines = []
    for key, value in root.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            items = ",\n".join("    " + json.dumps(item, ensure_ascii=False) for item in value)
            lines.append(f"  {json.dumps(key)}: [\n{items}\n  ]")
        else:
            lines.append(f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"
