"""Cycles, in Blender's Python module. It has no spheres: they become meshes. Scenes of glTF's own materials come by
Blender's importer."""

import math
import os
import tempfile
import time

import numpy as np
import scene_data
import worker


def material(bpy, name, m):
    result = bpy.data.materials.new(name)
    result.use_nodes = True
    nodes, links = result.node_tree.nodes, result.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    kind = m["class"]
    if m.get("medium"):
        volume(nodes, links, output, m["medium"])
    if kind == "boundary":
        return result
    if max(m["emission"]) > 0:  # black behind: the front emits, the back does not
        if kind != "lambertian" or max(m["reflectance"]) > 0:
            raise scene_data.Unsupported("an emitting surface that is not black")
        emission, black, side, mix = (
            nodes.new("ShaderNode" + name) for name in ("Emission", "BsdfDiffuse", "NewGeometry", "MixShader")
        )
        emission.inputs["Color"].default_value = [*m["emission"], 1]
        black.inputs["Color"].default_value = [0, 0, 0, 1]
        links.new(side.outputs["Backfacing"], mix.inputs[0])
        links.new(emission.outputs[0], mix.inputs[1])
        links.new(black.outputs[0], mix.inputs[2])
        links.new(mix.outputs[0], output.inputs["Surface"])
        result.cycles.emission_sampling = "FRONT"
        return result
    if kind == "lambertian":
        node = nodes.new("ShaderNodeBsdfDiffuse")
    elif kind == "conductor" and "reflectance" in m:
        node = nodes.new("ShaderNodeBsdfAnisotropic")
        node.distribution = "GGX"
    elif kind == "dielectric":
        node = nodes.new("ShaderNodeBsdfGlass")
        node.distribution = "GGX"
        node.inputs["IOR"].default_value = m["ior"]
    else:
        raise scene_data.Unsupported(f"this kind of '{kind}'")
    node.inputs["Color"].default_value = [*m.get("reflectance", [1.0] * 3), 1]
    if kind != "lambertian":
        node.inputs["Roughness"].default_value = m["alpha"] ** 0.5  # Cycles squares it
    links.new(node.outputs[0], output.inputs["Surface"])
    return result


def by_importer(bpy, a):
    """glTF's own materials, as Blender's importer reads them: it fills the scene, which has +z up."""
    gltf = scene_data.document(a.scene)
    if beyond := {e for e in gltf.get("extensionsUsed", []) if e.startswith("ETD_") or "light" in e}:
        raise scene_data.Unsupported(", ".join(sorted(beyond)))
    bpy.ops.import_scene.gltf(filepath=a.scene)
    return {
        "meshes": [],
        "spheres": [],
        "camera": scene_data.camera(gltf, a.view),
        "environment": scene_data.environment(gltf, a.scene, a.image),
    }


def world(bpy, tree, environment, up):
    background = tree.nodes["Background"]
    if not isinstance(environment, scene_data.EnvironmentImage):
        background.inputs["Color"].default_value = [*environment, 1]
        return
    # Blender's images have +x in their centre and +z up, and run to the right as ours do.
    image, place, direction = (
        tree.nodes.new("ShaderNode" + name) for name in ("TexEnvironment", "Mapping", "TexCoord")
    )
    image.image = bpy.data.images.load(environment.file)
    quarter = math.pi / 2
    upright = quarter if up.is_identity else 0
    place.inputs["Rotation"].default_value = [upright, 0, -quarter - environment.rotation]
    background.inputs["Strength"].default_value = environment.scale
    tree.links.new(direction.outputs["Generated"], place.inputs["Vector"])
    tree.links.new(place.outputs["Vector"], image.inputs["Vector"])
    tree.links.new(image.outputs["Color"], background.inputs["Color"])


def volume(nodes, links, output, medium):
    """Absorption and scattering beside each other; a colour takes what the density gives."""
    absorption, scattering, both = (
        nodes.new("ShaderNode" + name) for name in ("VolumeAbsorption", "VolumeScatter", "AddShader")
    )
    greatest = max(medium.absorption)
    absorption.inputs["Density"].default_value = greatest
    absorption.inputs["Color"].default_value = [*(1 - x / (greatest or 1) for x in medium.absorption), 1]
    greatest = max(medium.scattering)
    scattering.inputs["Density"].default_value = greatest
    scattering.inputs["Color"].default_value = [*(x / (greatest or 1) for x in medium.scattering), 1]
    scattering.inputs["Anisotropy"].default_value = medium.g
    links.new(absorption.outputs[0], both.inputs[0])
    links.new(scattering.outputs[0], both.inputs[1])
    links.new(both.outputs[0], output.inputs["Volume"])


def start(a):
    import bpy
    from mathutils import Matrix

    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    try:
        data, up = scene_data.load(a.scene, a.view, a.image), Matrix.Identity(4)
    except scene_data.Unsupported:
        data, up = by_importer(bpy, a), Matrix.Rotation(math.pi / 2, 4, "X")  # +y becomes +z
    for i, data_mesh in enumerate(data["meshes"] + [sphere.mesh() for sphere in data["spheres"]]):
        mesh = bpy.data.meshes.new(f"mesh{i}")
        mesh.from_pydata(data_mesh.positions.tolist(), [], data_mesh.triangles.tolist())
        if data_mesh.normals is not None:
            mesh.normals_split_custom_set_from_vertices(data_mesh.normals.tolist())
        mesh.materials.append(material(bpy, f"material{i}", data_mesh.material))
        scene.collection.objects.link(bpy.data.objects.new(f"object{i}", mesh))
    if data["environment"]:
        scene.world = bpy.data.worlds.new("world")
        scene.world.use_nodes = True
        world(bpy, scene.world.node_tree, data["environment"], up)
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", data["camera"]["yfov"]
    camera.clip_start, camera.clip_end = 1e-3, 1e6
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.camera.matrix_world = up @ Matrix(data["camera"]["matrix"].tolist())
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
    cycles.max_bounces = cycles.diffuse_bounces = cycles.volume_bounces = 64
    cycles.glossy_bounces = cycles.transmission_bounces = 64
    cycles.blur_glossy = 0
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
        # Scene update, film and file are not rendering: of two renders the difference in samples counts.
        start_up = min(once(1, seed) for _ in range(2))
        seconds = (once(samples, seed) - start_up) * samples / (samples - 1)
        image = bpy.data.images.load(scene.render.filepath)
        image.colorspace_settings.name = "Non-Color"
        pixels = np.empty(a.width * a.height * 4, np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
        return pixels.reshape(a.height, a.width, 4)[::-1, :, :3], seconds

    return f"Cycles {bpy.app.version_string}", 16, render


worker.serve(start)
