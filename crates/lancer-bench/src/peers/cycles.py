"""Renders a scene file of Lancer by Blender's Cycles: SCENE THREADS IMAGE.

Prints the seconds that went by after Blender was imported."""

import json
import math
import os
import sys
import time

import bpy
import numpy
from mathutils import Matrix, Vector

scene_file, threads, image = sys.argv[1:]
begin = time.perf_counter()
with open(scene_file) as file:
    scene = json.load(file)
render, camera = scene["render"], scene["camera"]
bpy.ops.wm.read_factory_settings(use_empty=True)
blender = bpy.context.scene
collection = blender.collection


def transform(steps):
    whole = Matrix.Identity(4)
    for step in steps:
        [(kind, value)] = step.items()
        if kind == "scale":
            whole = Matrix.Diagonal((value, value, value, 1)) @ whole
        elif kind == "translate":
            whole = Matrix.Translation(value) @ whole
        else:
            whole = Matrix([value[row : row + 4] for row in range(0, 16, 4)]) @ whole
    return whole


def material(name, lancer):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    # What glows with the ambient light is no lamp.
    made.cycles.emission_sampling = "NONE"
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    output = nodes.new("ShaderNodeOutputMaterial")

    def shader(kind, color):
        node = nodes.new(kind)
        node.inputs["Color"].default_value = (*color, 1)
        return node

    if lancer["fresnel"]:
        node = shader("ShaderNodeBsdfGlass", lancer["transmit"])
        node.inputs["Roughness"].default_value = 0
        node.inputs["IOR"].default_value = lancer["ior"]
    elif any(lancer["reflect"]):
        node = shader("ShaderNodeBsdfGlossy", lancer["reflect"])
        node.inputs["Roughness"].default_value = 0
    else:
        matte = shader("ShaderNodeBsdfDiffuse", [c * k for c, k in zip(lancer["color"], lancer["diffuse"])])
        glow = zip(lancer["color"], lancer["ambient"], scene["ambient"])
        glow = shader("ShaderNodeEmission", [c * k * l for c, k, l in glow])
        node = nodes.new("ShaderNodeAddShader")
        links.new(matte.outputs[0], node.inputs[0])
        links.new(glow.outputs[0], node.inputs[1])
    links.new(node.outputs[0], output.inputs["Surface"])
    return made


def read_ply(path):
    with open(path, "rb") as file:
        data = file.read()
    head, body = data.split(b"end_header\n", 1)
    words = head.split()
    vertices = int(words[words.index(b"vertex") + 1])
    triangles = int(words[words.index(b"face") + 1])
    columns = 6 if b"nx" in words else 3
    points = numpy.frombuffer(body, "<f4", vertices * columns).reshape(-1, columns)[:, :3]
    faces = numpy.frombuffer(body, [("n", "u1"), ("i", "<i4", 3)], triangles, vertices * columns * 4)["i"]
    return points, faces


def ball(rings=64):
    """A fine mesh with smooth normals, since Cycles has no spheres."""
    row = 2 * rings
    tilt, turn = numpy.meshgrid(
        numpy.linspace(0, math.pi, rings + 1), numpy.linspace(0, 2 * math.pi, row, endpoint=False), indexing="ij"
    )
    x, z = numpy.sin(tilt) * numpy.sin(turn), numpy.sin(tilt) * numpy.cos(turn)
    points = numpy.stack([x, numpy.cos(tilt), z], axis=-1).reshape(-1, 3).astype("<f4")
    ring, step = numpy.meshgrid(numpy.arange(rings), numpy.arange(row), indexing="ij")
    here, next = ring * row + step, ring * row + (step + 1) % row
    # At the poles one of the two has no area.
    upper = numpy.stack([here, next + row, next], axis=-1)[1:]
    lower = numpy.stack([here, here + row, next + row], axis=-1)[:-1]
    return points, numpy.concatenate([upper, lower]).reshape(-1, 3).astype("i4")


def body(thing):
    kind, smooth = thing["shape"], False
    if kind == "sphere":
        (points, faces), smooth = ball(), True
    elif kind == "plane":
        # There is no endless one.
        points = numpy.array([(-1e4, 0, -1e4), (-1e4, 0, 1e4), (1e4, 0, 1e4), (1e4, 0, -1e4)], "<f4")
        faces = numpy.array([(0, 1, 2), (0, 2, 3)], "i4")
    else:
        points, faces = read_ply(os.path.join(os.path.dirname(scene_file), kind["mesh"]["file"]))
    mesh = bpy.data.meshes.new("mesh")
    mesh.vertices.add(len(points))
    mesh.vertices.foreach_set("co", points.ravel())
    mesh.loops.add(faces.size)
    mesh.loops.foreach_set("vertex_index", faces.ravel())
    mesh.polygons.add(len(faces))
    mesh.polygons.foreach_set("loop_start", numpy.arange(0, faces.size, 3, "i4"))
    mesh.polygons.foreach_set("use_smooth", numpy.full(len(faces), smooth))
    mesh.update(calc_edges=True)
    made = bpy.data.objects.new("thing", mesh)
    collection.objects.link(made)
    made.matrix_world = transform(thing["transform"])
    mesh.materials.append(materials[thing["material"]])


materials = {name: material(name, value) for name, value in scene["materials"].items()}
for thing in scene["objects"]:
    body(thing)

for light in scene["lights"]:
    lamp = bpy.data.lights.new("light", "POINT")
    lamp.shadow_soft_size = 0
    strongest = max(light["intensity"])
    # A lamp of P watts has the radiant intensity P / (4 pi^2).
    lamp.energy = strongest * 4 * math.pi**2 / math.pi
    lamp.color = [c / strongest for c in light["intensity"]]
    made = bpy.data.objects.new("light", lamp)
    made.location = light["position"]
    collection.objects.link(made)

eye, target = Vector(camera["eye"]), Vector(camera["target"])
lens = bpy.data.cameras.new("camera")
lens.sensor_fit = "VERTICAL"
lens.angle = math.radians(camera["fov"])
lens.clip_end = 1e5
viewer = bpy.data.objects.new("camera", lens)
backward = (eye - target).normalized()
right = Vector(camera["up"]).cross(backward).normalized()
frame = Matrix((right, backward.cross(right), backward)).transposed().to_4x4()
viewer.matrix_world = Matrix.Translation(eye) @ frame
collection.objects.link(viewer)
blender.camera = viewer

world = bpy.data.worlds.new("world")
blender.world = world
world.use_nodes = True
world.node_tree.nodes["Background"].inputs["Color"].default_value = (*scene["background"], 1)
# The background is seen, and lights nothing.
world.cycles_visibility.diffuse = False

blender.render.engine = "CYCLES"
cycles = blender.cycles
cycles.device = "CPU"
cycles.samples = render["samples"] ** 2
cycles.use_adaptive_sampling = False
cycles.use_denoising = False
cycles.light_sampling_threshold = 0
cycles.pixel_filter_type = "BOX"
cycles.filter_width = 1
cycles.max_bounces = render["depth"]
cycles.glossy_bounces = render["depth"]
cycles.transmission_bounces = render["depth"]
cycles.diffuse_bounces = 0
cycles.caustics_reflective = True
cycles.caustics_refractive = True
cycles.blur_glossy = 0
blender.render.threads_mode = "FIXED"
blender.render.threads = int(threads)
blender.render.resolution_x = render["width"]
blender.render.resolution_y = render["height"]
blender.render.resolution_percentage = 100
blender.view_settings.view_transform = "Standard"
blender.render.image_settings.file_format = "PNG"
blender.render.image_settings.color_mode = "RGB"
blender.render.filepath = os.path.abspath(image)
bpy.ops.render.render(write_still=True)
print("seconds after import:", time.perf_counter() - begin)
