"""LuxCore: engines PATHCPU, BIDIRCPU and BIDIRVMCPU with the SOBOL sampler. It has no spheres: they become meshes."""

import math
import time

import numpy as np
import scene_data
import worker


def material(m):
    """Properties of a material, without their prefix."""
    kind = m["class"]
    if m.get("medium"):
        raise scene_data.Unsupported("media")
    if kind == "lambertian":
        properties = {"type": ["matte"], "kd": m["reflectance"]}
    elif kind == "conductor" and m["alpha"] < 1e-4 and "reflectance" in m:
        properties = {"type": ["mirror"], "kr": m["reflectance"]}
    elif kind == "dielectric" and m["alpha"] < 1e-4:
        properties = {"type": ["glass"], "kr": [1.0] * 3, "kt": [1.0] * 3}
        properties |= {"interiorior": [m["ior"]], "exteriorior": [1.0]}
    else:
        raise scene_data.Unsupported(f"this kind of '{kind}'")
    if max(m["emission"]) > 0:
        properties |= {"emission": m["emission"], "emission.gain.normalizebycolor": [False]}
    return properties


def engine(a):
    if a.engine == "PATHCPU":
        return {"path.pathdepth.total": 64, "path.pathdepth.diffuse": 64, "path.pathdepth.specular": 64}
    # With Russian roulette (a cap below 1) the bidirectional engines come out too bright: 10 % in a Cornell box.
    settings = {"path.maxdepth": 32, "light.maxdepth": 32, "path.russianroulette.cap": 1.0}
    if a.engine == "BIDIRVMCPU":
        settings["bidirvm.lightpath.count"] = a.width * a.height
    return settings


def start(a):
    import pyluxcore as lux

    lux.Init()
    lux.SetLogHandler(lambda message: None)
    data = scene_data.load(a.scene, a.view, a.image)
    scene = lux.Scene()
    camera = data["camera"]["matrix"]
    position, forward, up = camera[:3, 3], -camera[:3, 2], camera[:3, 1]
    half = math.tan(data["camera"]["yfov"] / 2)
    across = half * a.width / a.height
    properties = lux.Properties()

    def put(key, *values):
        properties.Set(lux.Property(key, list(values) if len(values) > 1 else values[0]))

    put("scene.camera.type", "perspective")
    put("scene.camera.lookat.orig", *map(float, position))
    put("scene.camera.lookat.target", *map(float, position + forward))
    put("scene.camera.up", *map(float, up))
    put("scene.camera.fieldofview", math.degrees(2 * math.atan(min(half, across))))
    window = np.array([-across, across, -half, half]) / min(across, half)
    window[2:] -= (window[3] - window[2]) / a.height  # its rows come one lower than those of other renderers
    put("scene.camera.screenwindow", *map(float, window))
    put("scene.camera.clippingplane.enable", False)
    if isinstance(data["environment"], scene_data.EnvironmentImage):
        raise scene_data.Unsupported("environment images")
    if data["environment"]:
        put("scene.lights.environment.type", "constantinfinite")
        put("scene.lights.environment.color", *data["environment"])
    for i, mesh in enumerate(data["meshes"] + [sphere.mesh() for sphere in data["spheres"]]):
        normals = None if mesh.normals is None else [tuple(map(float, n)) for n in mesh.normals]
        positions = [tuple(map(float, p)) for p in mesh.positions]
        triangles = [tuple(map(int, t)) for t in mesh.triangles]
        scene.DefineMesh(f"mesh{i}", positions, triangles, normals, None, None, None)
        for key, values in material(mesh.material).items():
            put(f"scene.materials.material{i}.{key}", *values)
        put(f"scene.objects.object{i}.shape", f"mesh{i}")
        put(f"scene.objects.object{i}.material", f"material{i}")
    scene.Parse(properties)

    def render(samples, seed):
        settings = lux.Properties()
        for key, value in {
            "renderengine.type": a.engine,
            "sampler.type": "SOBOL",
            "renderengine.seed": seed + 1,
            "film.width": a.width,
            "film.height": a.height,
            "film.filter.type": "NONE",
            "native.threads.count": a.threads,
            "batch.haltspp": samples,
            "path.clamping.variance.maxvalue": 0.0,
            "film.imagepipelines.0.0.type": "NOP",
            **engine(a),
        }.items():
            settings.Set(lux.Property(key, value))
        session = lux.RenderSession(lux.RenderConfig(settings, scene))
        session.Start()
        while not session.HasDone():
            time.sleep(0.002)
            session.UpdateStats()
        stats = session.GetStats()
        seconds = stats.Get("stats.renderengine.time").GetFloat()
        session.Stop()
        image = np.zeros(a.width * a.height * 3, np.float32)
        session.GetFilm().GetOutputFloat(lux.FilmOutputType.RGB_IMAGEPIPELINE, image, 0, True)
        return image.reshape(a.height, a.width, 3)[::-1], seconds

    return (
        f"LuxCore {lux.Version()} {a.engine}",
        16 if a.engine == "BIDIRVMCPU" else 1,
        render,
    )  # its first passes are too dark


worker.serve(start)
