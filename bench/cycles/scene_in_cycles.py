"""Renders a Heliodon scene file with Blender's Cycles: blender -b -P scene_in_cycles.py -- OPTIONS (as JSON)

Only what the comparison needs: quads, boxes, GLB models, Lambertian materials, emission, directional lights, a constant
sky. Lengths and light keep their numbers: a radiance of 1 in Cycles is 1 cd/m² of the scene file. Prints one line of JSON:
seconds of the render call (scene synchronization and acceleration structure included).
"""
import json
import math
import os
import sys
import time

import bpy
from mathutils import Matrix, Vector


def diffuse(name, color, emission=(0, 0, 0), image=None, cutoff=None):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")
    if any(emission):
        shader = nodes.new("ShaderNodeEmission")
        shader.inputs["Color"].default_value = (*emission, 1)
        front = nodes.new("ShaderNodeMixShader")  # the back of a one-sided surface is black
        links.new(nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"], front.inputs[0])
        links.new(shader.outputs[0], front.inputs[1])
        black = nodes.new("ShaderNodeBsdfDiffuse")
        black.inputs["Color"].default_value = (0, 0, 0, 1)
        links.new(black.outputs[0], front.inputs[2])
        links.new(front.outputs[0], output.inputs["Surface"])
        return material
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1)
    surface = shader.outputs[0]
    if image:
        texture = nodes.new("ShaderNodeTexImage")
        texture.image = image
        links.new(texture.outputs["Color"], shader.inputs["Color"])
        if cutoff is not None:
            above = nodes.new("ShaderNodeMath")
            above.operation = "GREATER_THAN"
            above.inputs[1].default_value = cutoff
            links.new(texture.outputs["Alpha"], above.inputs[0])
            mix = nodes.new("ShaderNodeMixShader")
            links.new(above.outputs[0], mix.inputs[0])
            links.new(nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
            links.new(surface, mix.inputs[2])
            surface = mix.outputs[0]
    links.new(surface, output.inputs["Surface"])
    return material


def add_mesh(name, points, faces, material):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(points, [], faces)
    mesh.materials.append(material)
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    return bpy.data.objects[name]


def add_shape(name, shape, material, matrix):
    if shape["type"] == "quad":
        o, u, v = (Vector(shape[key]) for key in ("origin", "u", "v"))
        made = add_mesh(name, [o, o + u, o + u + v, o + v], [(0, 1, 2, 3)], material)
    elif shape["type"] == "box":
        low, high = shape["min"], shape["max"]
        corner = [[(low, high)[i >> axis & 1][axis] for axis in range(3)] for i in range(8)]
        made = add_mesh(name, corner, [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)], material)
    else:
        sys.exit(f"no shape '{shape['type']}' here")
    made.matrix_world = matrix


def add_model(path, matrix):
    """Its base colours as Lambertian surfaces; glTF's +Y up is restored."""
    import numpy
    numpy.bool = bool  # Blender 3.4's importer asks for the alias that NumPy 1.24 dropped
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=path)
    upright = Matrix.Rotation(-math.pi / 2, 4, "X")
    made = [one for one in bpy.data.objects if one not in before]
    for one in made:
        if one.parent is None:
            one.matrix_world = matrix @ upright @ one.matrix_world
    replaced = {}
    for one in made:
        for slot in one.material_slots:
            old = slot.material
            if old.name not in replaced:
                images = [n.image for n in old.node_tree.nodes if n.type == "TEX_IMAGE" and n.image]
                masked = old.blend_method == "CLIP"
                color = next(n for n in old.node_tree.nodes if n.type == "BSDF_PRINCIPLED").inputs["Base Color"].default_value
                replaced[old.name] = diffuse(old.name + " diffuse", tuple(color)[:3], image=images[0] if images else None,
                                             cutoff=old.alpha_threshold if masked else None)
            slot.material = replaced[old.name]


def node_matrix(node):
    x, y, z = (math.radians(a) for a in node.get("rotate_deg", (0, 0, 0)))
    turn = Matrix.Rotation(x, 4, "X") @ Matrix.Rotation(y, 4, "Y") @ Matrix.Rotation(z, 4, "Z")
    scale = node.get("scale", 1)
    scale = scale if isinstance(scale, list) else [scale] * 3
    return Matrix.Translation(node.get("translate", (0, 0, 0))) @ turn @ Matrix.Diagonal((*scale, 1))


def build(scene_file):
    folder = os.path.dirname(os.path.abspath(scene_file))
    description = json.load(open(scene_file))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    materials = {name: diffuse(name, m.get("base_color", (0.8,) * 3), m.get("emission_nits", (0, 0, 0)))
                 for name, m in description["materials"].items()}
    for node in description["nodes"]:
        matrix = node_matrix(node)
        if "shape" in node:
            add_shape(node["name"], node["shape"], materials[node["material"]], matrix)
        elif "mesh" in node:
            add_model(os.path.join(folder, node["mesh"]), matrix)
        elif "light" in node:
            light = bpy.data.lights.new(node["name"], "SUN")
            lux = node["light"]["illuminance_lux"]
            light.energy, light.color, light.angle = max(lux), [c / max(lux) for c in lux], 0
            one = bpy.data.objects.new(node["name"], light)
            one.matrix_world = Vector(node["light"]["direction"]).to_track_quat("-Z", "Y").to_matrix().to_4x4()
            scene.collection.objects.link(one)
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (*description.get("sky", {}).get("luminance_nits", (0, 0, 0)), 1)
    scene.world = world
    seen = description["cameras"][0]
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", math.radians(seen["vertical_fov_deg"])
    camera.clip_start, camera.clip_end = 1e-3, 1e4
    one = bpy.data.objects.new("camera", camera)
    forward = (Vector(seen["target"]) - Vector(seen["position"])).normalized()
    right = forward.cross(Vector(seen.get("up", (0, 1, 0)))).normalized()
    up = right.cross(forward)
    one.matrix_world = Matrix([(*row, p) for row, p in zip(zip(right, up, -forward), seen["position"])] + [(0, 0, 0, 1)])
    scene.collection.objects.link(one)
    scene.camera = one
    return scene


def render(scene, options, samples, seed, output):
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = options["size"]
    scene.render.threads_mode, scene.render.threads = "FIXED", options["threads"]
    scene.render.use_persistent_data = False
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.image_settings.color_mode = "RGB"
    scene.view_settings.view_transform = "Raw"
    scene.render.filepath = os.path.abspath(output)
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", samples, seed
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_auto_tile = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = options["bounces"]
    cycles.transparent_max_bounces = 64
    start = time.perf_counter()
    bpy.ops.render.render(write_still=True)
    print("CYCLES " + json.dumps({"samples": samples, "seconds": time.perf_counter() - start, "output": output}), flush=True)


def mean(path):
    image = bpy.data.images.load(path)
    pixels = image.pixels[:]
    return sum(0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in zip(pixels[0::4], pixels[1::4], pixels[2::4])) / (len(pixels) // 4)


options = json.loads(sys.argv[sys.argv.index("--") + 1])
if "means" in options:  # of the luminance of pictures
    print("CYCLES " + json.dumps([mean(path) for path in options["means"]]), flush=True)
else:
    built = build(options["scene"])
    for samples, seed, output in options["renders"]:
        render(built, options, samples, seed, output)
