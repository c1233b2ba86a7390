"""Writes a knot on a torus as an OBJ model, with normals: the mesh of the report's first figure."""
import math
import sys

TURNS, CIRCLES = 2, 3  # around the axis, and around the tube of the torus
ALONG, AROUND = 240, 20
RADIUS, SWING, TUBE = 1.0, 0.42, 0.2


def centre(t):
    reach = RADIUS + SWING * math.cos(CIRCLES * t)
    return (reach * math.cos(TURNS * t), SWING * math.sin(CIRCLES * t), reach * math.sin(TURNS * t))


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


with open(sys.argv[1], "w", encoding="ascii") as out:
    for i in range(ALONG):
        t = 2 * math.pi * i / ALONG
        here = centre(t)
        ahead, behind = centre(t + 1e-4), centre(t - 1e-4)
        tangent = unit(tuple(a - b for a, b in zip(ahead, behind)))
        # From the ring in the middle of the torus to the curve: never along the tangent.
        ring = (RADIUS * math.cos(TURNS * t), 0.0, RADIUS * math.sin(TURNS * t))
        outward = unit(tuple(a - b for a, b in zip(here, ring)))
        side = unit(cross(tangent, outward))
        up = cross(side, tangent)
        for j in range(AROUND):
            angle = 2 * math.pi * j / AROUND
            normal = tuple(math.cos(angle) * u + math.sin(angle) * s for u, s in zip(up, side))
            point = tuple(c + TUBE * n for c, n in zip(here, normal))
            out.write("v %.5f %.5f %.5f\nvn %.5f %.5f %.5f\n" % (*point, *normal))
    for i in range(ALONG):
        for j in range(AROUND):
            a, b = i * AROUND + j, i * AROUND + (j + 1) % AROUND
            c, d = ((i + 1) % ALONG) * AROUND + j, ((i + 1) % ALONG) * AROUND + (j + 1) % AROUND
            for triangle in ((a, c, b), (b, c, d)):
                out.write("f " + " ".join("%d//%d" % (k + 1, k + 1) for k in triangle) + "\n")
