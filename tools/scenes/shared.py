"""What several scenes use: metals, shapes, rooms, lamps."""

import math

from gltf_builder import facing

# Complex refractive indices at about 630, 550 and 465 nm (Johnson & Christy 1972 for gold and copper).
GOLD = {"eta": [0.18, 0.42, 1.37], "k": [3.42, 2.35, 1.77]}
COPPER = {"eta": [0.22, 1.03, 1.22], "k": [3.60, 2.58, 2.45]}
SILVER = {"eta": [0.06, 0.06, 0.04], "k": [4.27, 3.59, 2.65]}

OCTAHEDRON = (
    [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]],
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
)


def upright(position):
    """Matrix of a node whose z axis, that of cylinders and spheres, points up."""
    return facing(position, [0, 1, 0], (0, 0, -1))


def sample(scene, class_name, material, *place, **parameters):
    """A shape called as its material is."""
    scene.shape(scene.materials[material]["name"], class_name, material, *place, **parameters)


def walls(scene, low, high, **materials):
    """Sides of a box between two corners that face its inside, each a mesh called by its side, in this order."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    corners = {
        "floor": [[x0, y0, z1], [x1, y0, z1], [x1, y0, z0], [x0, y0, z0]],
        "ceiling": [[x0, y1, z0], [x1, y1, z0], [x1, y1, z1], [x0, y1, z1]],
        "back": [[x0, y0, z0], [x1, y0, z0], [x1, y1, z0], [x0, y1, z0]],
        "front": [[x1, y0, z1], [x0, y0, z1], [x0, y1, z1], [x1, y1, z1]],
        "left": [[x0, y0, z1], [x0, y0, z0], [x0, y1, z0], [x0, y1, z1]],
        "right": [[x1, y0, z0], [x1, y0, z1], [x1, y1, z1], [x1, y1, z0]],
    }
    for side, material in materials.items():
        scene.quad(side, material, corners[side])


def hanging_lamp(scene, material, center, width, depth):
    """A rectangle that shines down: `width` along x, `depth` along z."""
    (x, y, z), a, b = center, width / 2, depth / 2
    scene.quad("lamp", material, [[x - a, y, z - b], [x + a, y, z - b], [x + a, y, z + b], [x - a, y, z + b]])


def backdrop(scene, material, width, front, back, height, radius, steps=10):
    """A floor that bends up into a wall without an edge."""
    profile = [(front, 0.0, (0, 1))]
    for i in range(steps + 1):
        a = i / steps * math.pi / 2
        profile.append(
            (back + radius - radius * math.sin(a), radius - radius * math.cos(a), (math.sin(a), math.cos(a)))
        )
    profile.append((back, height, (1, 0)))
    positions, normals, triangles = [], [], []
    for z, y, (nz, ny) in profile:
        for x in (-width / 2, width / 2):
            positions.append([x, y, z])
            normals.append([0, ny, nz])
    for i in range(len(profile) - 1):
        a = 2 * i
        triangles += [[a, a + 1, a + 3], [a, a + 3, a + 2]]
    scene.mesh("backdrop", material, positions, triangles, normals)
