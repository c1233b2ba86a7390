"""Renders a scene file of Lancer by Mitsuba 3: SCENE VARIANT INTEGRATOR THREADS IMAGE.

Prints the seconds that went by after Mitsuba was imported."""

import json
import os
import sys
import time

import mitsuba as mi

scene_file, variant, integrator, threads, image = sys.argv[1:]
begin = time.perf_counter()
mi.set_variant(variant)
import drjit as dr  # after the variant, whose types it holds

dr.set_thread_count(int(threads))

with open(scene_file) as file:
    scene = json.load(file)
render, ambient, background = scene["render"], scene["ambient"], scene["background"]
T = mi.ScalarTransform4f


def transform(steps):
    whole = T()
    for step in steps:
        [(kind, value)] = step.items()
        if kind == "scale":
            whole = T().scale(value) @ whole
        elif kind == "translate":
            whole = T().translate(value) @ whole
        else:
            whole = T([value[row : row + 4] for row in range(0, 16, 4)]) @ whole
    return whole


def rgb(value):
    return {"type": "rgb", "value": value}


def bsdf(material):
    if material["fresnel"]:
        return {"type": "dielectric", "int_ior": material["ior"], "ext_ior": 1.0}
    if any(material["reflect"]):
        return {"type": "conductor", "material": "none", "specular_reflectance": rgb(material["reflect"])}
    albedo = [c * k for c, k in zip(material["color"], material["diffuse"])]
    return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(albedo)}}


def shape(thing):
    kind, place = thing["shape"], transform(thing["transform"])
    if kind == "sphere":
        body = {"type": "sphere", "to_world": place}
    elif kind == "plane":
        # There is no endless one.
        flat = T().rotate([1, 0, 0], -90) @ T().scale([1e4, 1e4, 1])
        body = {"type": "rectangle", "to_world": place @ flat}
    else:
        path = os.path.join(os.path.dirname(scene_file), kind["mesh"]["file"])
        with open(path, "rb") as file:
            smooth = b"property float nx" in file.read(400)
        body = {"type": "ply", "filename": path, "to_world": place, "face_normals": not smooth}
    body["bsdf"] = bsdf(scene["materials"][thing["material"]])
    return body


class Whitted(mi.SamplingIntegrator):
    """Lancer's model: what is matte sees the lights and the ambient light, what is smooth sends one ray on."""

    def __init__(self, props):
        super().__init__(props)
        self.depth = render["depth"]

    @dr.syntax
    def sample(self, world, sampler, ray, medium=None, active=True):
        ray, radiance, weight = mi.Ray3f(ray), mi.Spectrum(0), mi.Spectrum(1)
        active, depth = mi.Bool(active), mi.UInt32(0)
        context = mi.BSDFContext()
        while active:
            hit = world.ray_intersect(ray, active)
            missed = active & ~hit.is_valid()
            radiance += dr.select(missed, weight * mi.Spectrum(background), 0)
            active &= hit.is_valid()
            surface = hit.bsdf(ray)
            matte = active & mi.has_flag(surface.flags(), mi.BSDFFlags.Smooth)
            for light in world.emitters():
                toward, light_weight = light.sample_direction(hit, mi.Point2f(0.5), matte)
                lit = matte & ~world.ray_test(hit.spawn_ray_to(toward.p), matte)
                reflected = surface.eval(context, hit, hit.to_local(toward.d), lit)
                radiance += dr.select(lit, weight * reflected * light_weight, 0)
            albedo = surface.eval_diffuse_reflectance(hit, matte)
            radiance += dr.select(matte, weight * albedo * mi.Spectrum(ambient), 0)
            active &= ~matte & (depth < self.depth)
            onward, factor = surface.sample(context, hit, sampler.next_1d(active), sampler.next_2d(active), active)
            ray = hit.spawn_ray(hit.to_world(onward.wo))
            weight *= factor
            depth += 1
        return radiance, mi.Bool(True), []


mi.register_integrator("whitted", Whitted)
camera = scene["camera"]
description = {
    "type": "scene",
    "sensor": {
        "type": "perspective",
        "fov": camera["fov"],
        "fov_axis": "y",
        "to_world": T().look_at(camera["eye"], camera["target"], camera["up"]),
        "film": {
            "type": "hdrfilm",
            "width": render["width"],
            "height": render["height"],
            "pixel_format": "rgb",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": "stratified", "sample_count": render["samples"] ** 2},
    },
}
if integrator == "path":
    # The eye's ray, each reflection or refraction, and the ray to the light; no roulette before that.
    depth = render["depth"] + 2
    description["integrator"] = {"type": "path", "max_depth": depth, "rr_depth": depth}
    description["sky"] = {"type": "constant", "radiance": rgb(background)}
else:
    description["integrator"] = {"type": "whitted"}
for number, light in enumerate(scene["lights"]):
    description[f"light-{number}"] = {
        "type": "point",
        "position": light["position"],
        "intensity": rgb(light["intensity"]),
    }
for number, thing in enumerate(scene["objects"]):
    description[f"thing-{number}"] = shape(thing)

world = mi.load_dict(description)
picture = mi.render(world)
mi.util.write_bitmap(image, picture, write_async=False)
print("seconds after import:", time.perf_counter() - begin)
