"""Mitsuba 3: variant llvm_ad_rgb, integrators `path` (`volpath` where there are media) and `ptracer` without a depth limit,
one kernel for the whole image."""

import math
import os
import tempfile
import time

import numpy as np
import scene_data
import worker


def bsdf(m):
    kind = m["class"]
    color = {"type": "rgb", "value": m.get("reflectance", [0.5] * 3)}
    alpha = m["alpha"]
    if kind == "lambertian":
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": color}}
    if kind == "conductor":
        if "eta" in m:
            metal = {key: {"type": "rgb", "value": m.get(key, [1.0] * 3)} for key in ("eta", "k")}
        else:
            metal = {"material": "none", "specular_reflectance": color}
        rough = (
            {"type": "roughconductor", "distribution": "ggx", "alpha": alpha}
            if alpha
            else {"type": "conductor"}
        )
        return {"type": "twosided", "bsdf": rough | metal}
    if kind == "dielectric":
        rough = (
            {"type": "roughdielectric", "distribution": "ggx", "alpha": alpha}
            if alpha
            else {"type": "dielectric"}
        )
        return rough | {"int_ior": m["ior"], "ext_ior": 1.0}
    if kind == "boundary":
        return {"type": "null"}
    raise scene_data.Unsupported(f"the surface '{kind}'")


def medium(m):
    absorption, scattering = np.array(m.absorption), np.array(m.scattering)
    extinction = absorption + scattering
    albedo = np.divide(scattering, extinction, out=np.zeros(3), where=extinction > 0)
    return {
        "type": "homogeneous",
        "scale": float(extinction.max()),  # colours are at most 1
        "sigma_t": {"type": "rgb", "value": (extinction / extinction.max()).tolist()},
        "albedo": {"type": "rgb", "value": albedo.tolist()},
        "phase": {"type": "hg", "g": m.g} if m.g else {"type": "isotropic"},
    }


def environment(mi, e):
    if not isinstance(e, scene_data.EnvironmentImage):
        return {"type": "constant", "radiance": {"type": "rgb", "value": e}}
    # Mitsuba's images have -z at their edges, ours in their centre; both run to the right.
    turn = mi.ScalarTransform4f().rotate([0, 1, 0], 180 + math.degrees(e.rotation))
    return {"type": "envmap", "filename": e.file, "scale": e.scale, "to_world": turn}


def ply(mi, data):
    smooth = data.normals is not None
    mesh = mi.Mesh("mesh", len(data.positions), len(data.triangles), has_vertex_normals=smooth)
    parameters = mi.traverse(mesh)
    parameters["vertex_positions"] = data.positions.astype(np.float32).ravel()
    parameters["faces"] = data.triangles.ravel()
    if smooth:
        parameters["vertex_normals"] = data.normals.astype(np.float32).ravel()
    parameters.update()
    handle, path = tempfile.mkstemp(".ply")
    os.close(handle)
    mesh.write_ply(path)
    return path


def scene_dict(mi, data, width, height, integrator):
    camera = data["camera"]
    turned = camera["matrix"] @ np.diag([-1.0, 1, -1, 1])  # Mitsuba's cameras look along +z, +x to the left
    scene = {
        "type": "scene",
        "integrator": {"type": integrator, "max_depth": -1},
        "sensor": {
            "type": "perspective",
            "fov": math.degrees(camera["yfov"]),
            "fov_axis": "y",
            "near_clip": 1e-3,
            "far_clip": 1e6,
            "to_world": mi.ScalarTransform4f(turned),
            "sampler": {"type": "independent"},
            "film": {
                "type": "hdrfilm",
                "width": width,
                "height": height,
                "pixel_format": "rgb",
                "component_format": "float32",
                "rfilter": {"type": "box"},
            },
        },
    }

    def add(shape, m):
        shape["bsdf"] = bsdf(m)
        if m.get("medium"):
            if integrator != "path":
                raise scene_data.Unsupported("media")
            scene["integrator"]["type"] = "volpath"
            shape["interior"] = medium(m["medium"])
        if max(m["emission"]) > 0:
            shape["emitter"] = {"type": "area", "radiance": {"type": "rgb", "value": m["emission"]}}
        scene[f"shape{len(scene)}"] = shape

    for mesh in data["meshes"]:
        corners = scene_data.as_quad(mesh)
        if corners is None:
            flat = mesh.normals is None
            add({"type": "ply", "filename": ply(mi, mesh), "face_normals": flat}, mesh.material)
            continue
        x, y = (corners[1] - corners[0]) / 2, (corners[3] - corners[0]) / 2
        normal = np.cross(x, y)
        to_world = np.eye(4)  # Mitsuba's own rectangle is [-1, 1]² in xy and faces +z
        to_world[:3] = np.stack([x, y, normal / np.linalg.norm(normal), corners[0] + x + y], 1)
        add({"type": "rectangle", "to_world": mi.ScalarTransform4f(to_world)}, mesh.material)
    for sphere in data["spheres"]:
        add({"type": "sphere", "center": sphere.centre, "radius": sphere.radius}, sphere.material)
    if data["environment"]:
        scene["environment"] = environment(mi, data["environment"])
    return scene


def start(a):
    import drjit as dr
    import mitsuba as mi

    mi.set_variant("llvm_ad_rgb")
    dr.set_thread_count(a.threads)
    scene = mi.load_dict(scene_dict(mi, scene_data.load(a.scene, a.view, a.image), a.width, a.height, a.engine))

    def render(samples, seed):
        begin = time.perf_counter()
        image = mi.render(scene, spp=samples, seed=seed)
        dr.eval(image)
        dr.sync_thread()
        return np.array(image), time.perf_counter() - begin

    return f"Mitsuba {mi.__version__} llvm_ad_rgb {a.engine}", 1, render


worker.serve(start)
