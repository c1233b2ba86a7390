#!/usr/bin/env python3
"""Writes chart.gltf into a directory: balls of glTF materials before a checkered wall, with a camera and lights.

    docs/charts/gltf.py DIRECTORY && lancer render DIRECTORY/chart.gltf -o chart.png
"""

import base64
import json
import math
import os
import struct
import sys

COLUMNS = 10
SPACING = 2.3
RED, GOLD, WHITE = [0.8, 0.12, 0.1], [1.0, 0.72, 0.3], [0.95, 0.97, 1.0]


def pbr(color, metallic, roughness, alpha=1.0, **extensions):
    factors = {"baseColorFactor": [*color, alpha], "metallicFactor": metallic, "roughnessFactor": roughness}
    material = {"pbrMetallicRoughness": factors}
    if alpha < 1:
        material["alphaMode"] = "BLEND"
    if extensions:
        material["extensions"] = {"KHR_materials_" + name: value for name, value in extensions.items()}
    return material


ROWS = [
    lambda i: pbr(RED, 0, i / 9),
    lambda i: pbr(GOLD, 1, i / 9),
    lambda i: pbr(GOLD, i / 9, 0.3),
    lambda i: pbr(WHITE, 0, 0, transmission={"transmissionFactor": i / 9}),
    lambda i: pbr(WHITE, 0, 0, transmission={"transmissionFactor": 1}, ior={"ior": 1 + i / 6}),
    lambda i: pbr(RED, 0, 0.3, alpha=1 - i / 10),
]


class Document:
    """The arrays of a document, as they grow."""

    def __init__(self):
        self.bytes = bytearray()
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}
        for array in ("nodes", "meshes", "materials", "accessors", "bufferViews", "cameras"):
            self.json[array] = []

    def add(self, array, entry):
        self.json[array].append(entry)
        return len(self.json[array]) - 1

    def place(self, **node):
        self.json["scenes"][0]["nodes"].append(self.add("nodes", node))

    def accessor(self, kind, component, code, numbers):
        data = struct.pack(f"<{len(numbers)}{code}", *numbers)
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)}
        self.bytes += data
        self.bytes += bytes(-len(self.bytes) % 4)
        size = {"SCALAR": 1, "VEC3": 3}[kind]
        entry = {"bufferView": self.add("bufferViews", view), "componentType": component, "type": kind}
        return self.add("accessors", entry | {"count": len(numbers) // size})

    def attributes(self, **arrays):
        return {name: self.accessor("VEC3", 5126, "f", numbers) for name, numbers in arrays.items()}

    def indices(self, numbers):
        return self.accessor("SCALAR", 5123, "H", numbers)


def ball(rows=32, columns=64):
    positions, indices = [], []
    for row in range(rows + 1):
        for column in range(columns + 1):
            polar, around = math.pi * row / rows, 2 * math.pi * column / columns
            positions += [math.sin(polar) * math.sin(around), math.cos(polar), math.sin(polar) * math.cos(around)]
    for row in range(rows):
        for column in range(columns):
            a = row * (columns + 1) + column
            b = a + columns + 1
            indices += [a, b, a + 1, a + 1, b, b + 1]
    return positions, indices


def wall(width, height, size):
    """Squares of two greys, as colours of vertices."""
    positions, colors, indices = [], [], []
    for row in range(int(2 * height / size)):
        for column in range(int(2 * width / size)):
            x, y, first = column * size - width, row * size - height, len(positions) // 3
            positions += [x, y, 0, x + size, y, 0, x + size, y + size, 0, x, y + size, 0]
            colors += [0.75 if (row + column) % 2 else 0.25] * 12
            indices += [first, first + 1, first + 2, first, first + 2, first + 3]
    return positions, colors, indices


def chart():
    document = Document()
    positions, indices = ball()
    attributes, indices = document.attributes(POSITION=positions, NORMAL=positions), document.indices(indices)
    for row, material in enumerate(ROWS):
        for column in range(COLUMNS):
            primitive = {"attributes": attributes, "indices": indices}
            primitive["material"] = document.add("materials", material(column))
            mesh = document.add("meshes", {"primitives": [primitive]})
            at = [(column - (COLUMNS - 1) / 2) * SPACING, ((len(ROWS) - 1) / 2 - row) * SPACING, 0]
            document.place(mesh=mesh, translation=at)
    positions, colors, indices = wall(16, 10, 0.8)
    attributes, indices = document.attributes(POSITION=positions, COLOR_0=colors), document.indices(indices)
    material = document.add("materials", pbr([1, 1, 1], 0, 1))
    primitive = {"attributes": attributes, "indices": indices, "material": material}
    document.place(mesh=document.add("meshes", {"primitives": [primitive]}), translation=[0, 0, -2.5])

    perspective = {"yfov": math.radians(20), "aspectRatio": 1.6, "znear": 0.1}
    camera = document.add("cameras", {"type": "perspective", "perspective": perspective})
    document.place(name="front", camera=camera, translation=[0, 0, 42])
    lights = [{"type": "point", "intensity": 900}, {"type": "point", "intensity": 300, "color": [0.8, 0.9, 1.0]}]
    document.json["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    for light, at in enumerate([[-9, 12, 16], [12, 3, 16]]):
        document.place(translation=at, extensions={"KHR_lights_punctual": {"light": light}})
    used = ["lights_punctual", "materials_ior", "materials_transmission"]
    document.json["extensionsUsed"] = ["KHR_" + name for name in used]
    uri = "data:application/octet-stream;base64," + base64.b64encode(document.bytes).decode()
    document.json["buffers"] = [{"uri": uri, "byteLength": len(document.bytes)}]
    return document.json


if __name__ == "__main__":
    with open(os.path.join(sys.argv[1], "chart.gltf"), "w") as out:
        json.dump(chart(), out)
