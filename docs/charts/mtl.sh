#!/usr/bin/env bash
# Writes a test chart of MTL materials into a directory: chart.obj with chart.mtl, and chart.yaml that shows it.
# Six rows of ten balls before a checkered wall; docs/formats.md says what they are.
set -euo pipefail
directory=$1
mkdir -p "$directory"

# One statement set a ball, from left to right; Kd is red for all.
row() { for i in 0 1 2 3 4 5 6 7 8 9; do "$@" "$i"; done; }
tenths() { awk -v n="$1" 'BEGIN { printf "%.1f", n / 10 }'; }
illum() { echo "illum $1; Ks 0.3 0.3 0.3; Ns 60; d 0.4; Ni 1.5"; }
ks() { k=$(tenths "$1"); echo "illum 2; Ks $k $k $k; Ns 50"; }
ns() { n=(1 2 5 10 20 50 100 200 500 1000); echo "illum 2; Ks 0.6 0.6 0.6; Ns ${n[$1]}"; }
mirror() { k=$(tenths "$1"); echo "illum 3; Ks $k $k $k; Ns 50"; }
dissolve() { echo "illum 2; Ks 0.3 0.3 0.3; Ns 60; d $(tenths $((10 - $1)))"; }
glass() { echo "illum 7; Ks 0.3 0.3 0.3; Ns 60; Ni 1.5; d $(tenths $((10 - $1)))"; }
{ row illum; row ks; row ns; row mirror; row dissolve; row glass; } |
    awk '{ gsub("; ", "\n"); printf "newmtl m%d\nKd 0.8 0.15 0.1\n%s\n\n", NR - 1, $0 }' >"$directory/chart.mtl"

awk 'BEGIN {
    rings = 24; segments = 48; pi = atan2(0, -1)
    print "mtllib chart.mtl"
    for (ring = 0; ring <= rings; ring++)
        for (s = 0; s < segments; s++) {
            t = ring / rings * pi; f = 2 * s / segments * pi
            printf "vn %.6f %.6f %.6f\n", sin(t) * sin(f), cos(t), sin(t) * cos(f)
        }
    for (ball = 0; ball < 60; ball++) {
        x = ball % 10 - 4.5; y = 2.5 - int(ball / 10)
        for (ring = 0; ring <= rings; ring++)
            for (s = 0; s < segments; s++) {
                t = ring / rings * pi; f = 2 * s / segments * pi
                printf "v %.6f %.6f %.6f\n", x + 0.42 * sin(t) * sin(f), y + 0.42 * cos(t), 0.42 * sin(t) * cos(f)
            }
        print "usemtl m" ball
        first = ball * (rings + 1) * segments
        for (ring = 0; ring < rings; ring++)
            for (s = 0; s < segments; s++) {
                a = ring * segments + s; b = ring * segments + (s + 1) % segments
                c = b + segments; d = a + segments
                printf "f %d//%d %d//%d %d//%d %d//%d\n", \
                    first + a + 1, a + 1, first + d + 1, d + 1, first + c + 1, c + 1, first + b + 1, b + 1
            }
    }
}' >"$directory/chart.obj"

cat >"$directory/chart.yaml" <<'YAML'
format: 1
name: MTL
camera: {eye: [0, 0, 24], target: [0, 0, 0], fov: 15}
ambient: 0.3
background: "#c3cdd9"
lights: [{position: [-8, 12, 14], intensity: 1000}]
materials:
  wall: {color: {checker: {even: 0.75, odd: 0.45, size: 0.25}}, diffuse: 0.8}
objects:
  - {shape: {mesh: chart.obj}}
  - {shape: plane, material: wall, transform: [{rotate: {axis: x, angle: 90}}, {translate: [0, 0, -2]}]}
render: {width: 640, height: 384, samples: 3, depth: 6}
YAML
