//! The teapot's 32 bicubic Bézier patches.
//!
//! Lengths are Newell's own, z points up, and the spout toward +x. Rim, body and bottom are one profile and the lid
//! another, each turned about z in four quarters; handle and spout are symmetric in y. So written, 34
//! rows of numbers say all that his 306 control points do.
//!
//! Source: the data that Martin Newell drew at the University of Utah in 1975, with the bottom that was added
//! later; Crow, "The origins of the teapot" (IEEE Computer Graphics and Applications 7(1), 1987), tells the story.

use super::super::bezier::{slopes, weights};
use lancer_core::geometry::DVec3;

/// Four rows of four control points; u runs from row to row, v along each.
#[derive(Clone, Copy)]
pub(super) struct Patch(pub(super) [[DVec3; 4]; 4]);

/// All patches, each with its outward side where v runs counter-clockwise to u.
pub(super) fn patches() -> Vec<Patch> {
    let turned = [&BODY[..], &LID[..]].into_iter().flat_map(turned_patches);
    let mirrored = [&HANDLE, &SPOUT].into_iter().flat_map(|rows| mirrored_patches(rows));
    turned.chain(mirrored).collect()
}

/// A circle about z, as far as a cubic comes to one: its radius, the length of the tangent arms, and its height.
type Ring = [f64; 3];

/// From the inner edge of the rim over the belly to the middle of the bottom.
const BODY: [Ring; 13] = [
    [1.4, 0.784, 2.4],
    [1.3375, 0.749, 2.53125],
    [1.4375, 0.805, 2.53125],
    [1.5, 0.84, 2.4],
    [1.75, 0.98, 1.875],
    [2.0, 1.12, 1.35],
    [2.0, 1.12, 0.9],
    [2.0, 1.12, 0.45],
    [1.5, 0.84, 0.225],
    [1.5, 0.84, 0.15],
    [1.5, 0.84, 0.075],
    [1.425, 0.798, 0.0],
    [0.0, 0.0, 0.0],
];

/// From the top of the knob to the lid's edge.
const LID: [Ring; 7] = [
    [0.0, 0.0, 3.15],
    [0.8, 0.45, 3.15],
    [0.0, 0.0, 2.85],
    [0.2, 0.112, 2.7],
    [0.4, 0.224, 2.55],
    [1.3, 0.728, 2.55],
    [1.3, 0.728, 2.4],
];

/// Half of a tube's cross section: x and z of its inner and its outer point, in the plane y = 0, and how far its
/// side stands out in y. The two arms between have the same x and z as the points.
type Section = [f64; 5];

/// From the upper to the lower joint with the body.
const HANDLE: [Section; 7] = [
    [-1.6, 2.025, -1.5, 2.25, 0.3],
    [-2.3, 2.025, -2.5, 2.25, 0.3],
    [-2.7, 2.025, -3.0, 2.25, 0.3],
    [-2.7, 1.8, -3.0, 1.8, 0.3],
    [-2.7, 1.575, -3.0, 1.35, 0.3],
    [-2.5, 1.125, -2.65, 0.9375, 0.3],
    [-2.0, 0.9, -1.9, 0.6, 0.3],
];

/// From the body to the inside of the lip.
const SPOUT: [Section; 7] = [
    [1.7, 1.425, 1.7, 0.6, 0.66],
    [2.6, 1.425, 3.1, 0.825, 0.66],
    [2.3, 2.1, 2.4, 2.025, 0.25],
    [2.7, 2.4, 3.3, 2.4, 0.25],
    [2.8, 2.475, 3.525, 2.49375, 0.25],
    [2.9, 2.475, 3.45, 2.5125, 0.15],
    [2.8, 2.4, 3.2, 2.4, 0.15],
];

/// Four patches for every three steps along the profile. Quarter turns are exact, so neighbours share their edges.
fn turned_patches(profile: &[Ring]) -> Vec<Patch> {
    let quarter = |p: DVec3| DVec3::new(p.y, -p.x, p.z);
    let first = |[radius, arm, z]: Ring| {
        [[radius, 0.0], [radius, -arm], [arm, -radius], [0.0, -radius]].map(|[x, y]| DVec3::new(x, y, z))
    };
    let mut patches = Vec::new();
    for rows in curves(profile) {
        let mut patch = rows.map(first);
        for _ in 0..4 {
            patches.push(Patch(patch));
            patch = patch.map(|row| row.map(quarter));
        }
    }
    patches
}

/// Two patches for every three steps along the tube.
fn mirrored_patches(sections: &[Section]) -> Vec<Patch> {
    let half = |[inner_x, inner_z, outer_x, outer_z, side]: Section| {
        [
            DVec3::new(inner_x, 0.0, inner_z),
            DVec3::new(inner_x, -side, inner_z),
            DVec3::new(outer_x, -side, outer_z),
            DVec3::new(outer_x, 0.0, outer_z),
        ]
    };
    let mirrored = |[a, b, c, d]: [DVec3; 4]| [d, c, b, a].map(|p| DVec3::new(p.x, -p.y, p.z));
    curves(sections).flat_map(|rows| [Patch(rows.map(half)), Patch(rows.map(half).map(mirrored))]).collect()
}

/// The chain's cubic pieces: the last control point of each is the first of the next.
fn curves<const N: usize>(chain: &[[f64; N]]) -> impl Iterator<Item = [[f64; N]; 4]> {
    (0..chain.len() - 1).step_by(3).map(|i| [chain[i], chain[i + 1], chain[i + 2], chain[i + 3]])
}

impl Patch {
    /// The point at (u, v) in the unit square.
    pub(super) fn point(&self, u: f64, v: f64) -> DVec3 {
        self.blend(weights(u), weights(v))
    }

    /// The outward normal at (u, v), of any length.
    ///
    /// Where a whole row falls into one point, as in the middle of the lid and of the bottom, the surface has no
    /// derivative by v; how that derivative grows on the way in takes its place.
    pub(super) fn normal(&self, u: f64, v: f64) -> DVec3 {
        let by_u = self.blend(slopes(u), weights(v));
        let pinched = |row: usize| self.0[row].iter().all(|point| *point == self.0[row][0]);
        if u == 0.0 && pinched(0) {
            self.blend(slopes(u), slopes(v)).cross(by_u)
        } else if u == 1.0 && pinched(3) {
            by_u.cross(self.blend(slopes(u), slopes(v)))
        } else {
            self.blend(weights(u), slopes(v)).cross(by_u)
        }
    }

    fn blend(&self, along_u: [f64; 4], along_v: [f64; 4]) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (row, weight_u) in self.0.iter().zip(along_u) {
            for (&control_point, weight_v) in row.iter().zip(along_v) {
                sum += control_point * (weight_u * weight_v);
            }
        }
        sum
    }
}
