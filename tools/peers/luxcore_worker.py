"""LuxCore: engine PATHCPU with the SOBOL sampler. Diffuse surfaces and emissive meshes (no spheres: it has none)."""

import math
import time

import numpy as np
import scene_data
import worker


def start(a):
    import pyluxcore as lux

    lux.Init()
    lux.SetLogHandler(lambda message: None)
    data = scene_data.load(a.scene)
    if data["spheres"] or data["environment"]:
        raise scene_data.Unsupported("spheres and environments")
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
    for i, (positions, triangles, m) in enumerate(data["meshes"]):
        if m["class"] != "lambertian":
            raise scene_data.Unsupported(f"the surface '{m['class']}'")
        scene.DefineMesh(
            f"mesh{i}",
            [tuple(map(float, p)) for p in positions],
            [tuple(map(int, t)) for t in triangles],
            None,
            None,
            None,
            None,
        )
        put(f"scene.materials.material{i}.type", "matte")
        put(f"scene.materials.material{i}.kd", *m["reflectance"])
        if max(m["emission"]) > 0:
            put(f"scene.materials.material{i}.emission", *m["emission"])
            put(f"scene.materials.material{i}.emission.gain.normalizebycolor", False)
        put(f"scene.objects.object{i}.shape", f"mesh{i}")
        put(f"scene.objects.object{i}.material", f"material{i}")
    scene.Parse(properties)

    def render(samples, seed):
        settings = lux.Properties()
        for key, value in (
            ("renderengine.type", "PATHCPU"),
            ("sampler.type", "SOBOL"),
            ("renderengine.seed", seed),
            ("film.width", a.width),
            ("film.height", a.height),
            ("film.filter.type", "NONE"),
            ("native.threads.count", a.threads),
            ("batch.haltspp", samples),
            ("path.pathdepth.total", 64),
            ("path.pathdepth.diffuse", 64),
            ("path.clamping.variance.maxvalue", 0.0),
            ("film.imagepipelines.0.0.type", "NOP"),
        ):
            settings.Set(lux.Property(key, value))
        session = lux.RenderSession(lux.RenderConfig(settings, scene))
        session.Start()
        while not session.HasDone():
            time.sleep(0.002)
            session.UpdateStats()
        stats = session.GetStats()
        seconds = stats.Get("stats.renderengine.time").GetFloat()
        done = stats.Get("stats.renderengine.pass").GetFloat()
        session.Stop()
        image = np.zeros(a.width * a.height * 3, np.float32)
        session.GetFilm().GetOutputFloat(lux.FilmOutputType.RGB_IMAGEPIPELINE, image, 0, True)
        return image.reshape(a.height, a.width, 3)[::-1], seconds, done

    return f"LuxCore {lux.Version()} PATHCPU", render


worker.serve(start)
