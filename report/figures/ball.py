"""Writes a ball of few triangles with the normals of a sphere as an OBJ model: for the report's figure of problems."""
import math
import sys

RINGS, SEGMENTS = 10, 20

with open(sys.argv[1], "w", encoding="ascii") as out:
    for i in range(RINGS + 1):
        for j in range(SEGMENTS):
            polar, azimuth = math.pi * i / RINGS, 2 * math.pi * j / SEGMENTS
            point = (math.sin(polar) * math.cos(azimuth), math.cos(polar), math.sin(polar) * math.sin(azimuth))
            out.write("v %.6f %.6f %.6f\nvn %.6f %.6f %.6f\n" % (*point, *point))
    for i in range(RINGS):
        for j in range(SEGMENTS):
            a, b = i * SEGMENTS + j, i * SEGMENTS + (j + 1) % SEGMENTS
            triangles = []
            if i > 0:
                triangles.append((a, b, b + SEGMENTS))
            if i < RINGS - 1:
                triangles.append((a, b + SEGMENTS, a + SEGMENTS))
            for triangle in triangles:
                out.write("f " + " ".join("%d//%d" % (k + 1, k + 1) for k in triangle) + "\n")
