"""Cycles, in Blender's Python module. Diffuse surfaces and emissive meshes."""

import os
import tempfile
import time

import numpy as np
import scene_data
import worker


def start(a):
    import bpy
    from mathutils import Matrix

    data = scene_data.load(a.scene)
    if data["spheres"] or data["environment"]:
        raise scene_data.Unsupported("spheres and environments")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for i, (positions, triangles, m) in enumerate(data["meshes"]):
        if m["class"] != "lambertian":
            raise scene_data.Unsupported(f"the surface '{m['class']}'")
        mesh = bpy.data.meshes.new(f"mesh{i}")
        mesh.from_pydata(positions.tolist(), [], triangles.tolist())
        material = bpy.data.materials.new(f"material{i}")
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        output = nodes.new("ShaderNodeOutputMaterial")
        if max(m["emission"]) > 0:  # black behind: the front emits, the back does not
            emission, black, side, mix = (
                nodes.new("ShaderNode" + name)
                for name in ("Emission", "BsdfDiffuse", "NewGeometry", "MixShader")
            )
            emission.inputs["Color"].default_value = [*m["emission"], 1]
            black.inputs["Color"].default_value = [0, 0, 0, 1]
            links.new(side.outputs["Backfacing"], mix.inputs[0])
            links.new(emission.outputs[0], mix.inputs[1])
            links.new(black.outputs[0], mix.inputs[2])
            links.new(mix.outputs[0], output.inputs["Surface"])
            material.cycles.emission_sampling = "FRONT"
        else:
            diffuse = nodes.new("ShaderNodeBsdfDiffuse")
            diffuse.inputs["Color"].default_value = [*m["reflectance"], 1]
            links.new(diffuse.outputs[0], output.inputs["Surface"])
        mesh.materials.append(material)
        scene.collection.objects.link(bpy.data.objects.new(f"object{i}", mesh))
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", data["camera"]["yfov"]
    camera.clip_start, camera.clip_end = 1e-3, 1e6
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.camera.matrix_world = Matrix(data["camera"]["matrix"].tolist())
    scene.collection.objects.link(scene.camera)

    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = (
        a.width,
        a.height,
        100,
    )
    scene.render.threads_mode, scene.render.threads = "FIXED", a.threads
    scene.render.use_persistent_data = True
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    cycles = scene.cycles
    cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", False, False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.use_auto_tile = False
    folder = tempfile.mkdtemp()

    def once(samples, seed):
        cycles.samples, cycles.seed = samples, seed
        scene.render.filepath = os.path.join(folder, "image.exr")
        begin = time.perf_counter()
        bpy.ops.render.render(write_still=True)
        return time.perf_counter() - begin

    once(1, 0)

    def render(samples, seed):
        start_up = min(once(1, seed) for _ in range(2))  # scene update, film and file: not rendering
        seconds = once(samples, seed) - start_up
        image = bpy.data.images.load(scene.render.filepath)
        image.colorspace_settings.name = "Non-Color"
        pixels = np.empty(a.width * a.height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        return pixels.reshape(a.height, a.width, 4)[::-1, :, :3], seconds, samples - 1

    return f"Cycles {bpy.app.version_string}", render


worker.serve(start)
