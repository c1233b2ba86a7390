//! Embree's side of the comparison by ray kind: every way of putting rays into its calls.

use super::rays::{EMPTY, LANES, Lot, Packet};
use super::stage::Stage;
use crate::Failure;
use crate::embree::ffi::{self, Aligned, Build, Device, Query, RayHits, Rays, Scene, Triangles};
use lancer_core::geometry::{Ray, Transform};
use rayon::prelude::*;
use std::sync::Arc;

/// A stage as Embree's scene.
pub(crate) fn scene_of(
    stage: &Stage,
    triangles: &Arc<Triangles>,
    device: &Arc<Device>,
    build: Build,
) -> Result<Scene, Failure> {
    let mesh = Scene::of_triangles(device, triangles, build)?;
    if stage.places.is_empty() {
        return Ok(mesh);
    }
    let places = Arc::new(stage.places.iter().map(columns).collect::<Vec<_>>());
    Scene::of_instances(&Arc::new(mesh), &places, build)
}

/// The stage's mesh as Embree reads it.
pub(crate) fn triangles_of(stage: &Stage) -> Arc<Triangles> {
    let data = stage.mesh.data();
    Arc::new(Triangles::new(&data.positions, &data.indices))
}

fn columns(place: &Transform) -> [f32; 12] {
    let linear = place.linear();
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis, place.translation()];
    let mut flat = [0.0; 12];
    for (column, to) in columns.iter().zip(flat.chunks_exact_mut(3)) {
        to.copy_from_slice(&column.as_vec3().to_array());
    }
    flat
}

/// One way to trace a lot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Form {
    /// 1, 8 or 16.
    pub(super) width: usize,
    pub(super) coherent: bool,
    /// Which of the lot's groupings; with a width of 1 none counts.
    pub(super) grouping: usize,
}

impl Form {
    /// All that make sense for a lot.
    pub(super) fn all(lot: &Lot) -> Vec<Self> {
        let mut forms = vec![Self { width: 1, coherent: false, grouping: 0 }];
        for coherent in [false, true] {
            forms.push(Self { width: 8, coherent, grouping: 0 });
            forms.extend((0..lot.groupings.len()).map(|grouping| Self { width: 16, coherent, grouping }));
        }
        forms
    }

    pub(super) fn name(&self, lot: &Lot) -> String {
        let flag = if self.coherent { " coherent" } else { "" };
        match self.width {
            1 => "1".to_owned(),
            width => format!("{width} {}{flag}", lot.groupings[self.grouping].0),
        }
    }
}

/// What a ray met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Met {
    pub(super) t: f32,
    pub(super) object: u32,
    pub(super) primitive: u32,
}

/// The rays of a packet in less memory than Embree's form takes.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Compact {
    origin: [[f32; LANES]; 3],
    direction: [[f32; LANES]; 3],
    t_far: [f32; LANES],
    valid: [i32; LANES],
}

/// A lot, ready for Embree.
pub(super) struct Prepared<'a> {
    lot: &'a Lot,
    singles: Vec<[f32; 7]>,
    groupings: Vec<Vec<Compact>>,
}

/// Rays or packets that a thread takes at a time.
const CHUNK: usize = 64;

impl<'a> Prepared<'a> {
    pub(super) fn new(lot: &'a Lot) -> Self {
        let single = |ray: &Ray| {
            let ([ox, oy, oz], [dx, dy, dz]) =
                (ray.origin.as_vec3().to_array(), ray.direction.as_vec3().to_array());
            [ox, oy, oz, dx, dy, dz, ray.t_max as f32]
        };
        let singles: Vec<_> = lot.rays.iter().map(single).collect();
        let compact = |packet: &Packet| {
            let mut compact = Compact {
                origin: [[0.0; LANES]; 3],
                direction: [[1.0; LANES]; 3],
                t_far: [-1.0; LANES],
                valid: [0; LANES],
            };
            for (lane, &index) in packet.iter().enumerate().filter(|(_, index)| **index != EMPTY) {
                let single = singles[index as usize];
                for axis in 0..3 {
                    compact.origin[axis][lane] = single[axis];
                    compact.direction[axis][lane] = single[3 + axis];
                }
                compact.t_far[lane] = single[6];
                compact.valid[lane] = -1;
            }
            compact
        };
        let groupings =
            lot.groupings.iter().map(|(_, packets)| packets.par_iter().map(compact).collect()).collect();
        Self { lot, singles, groupings }
    }

    /// Traces all rays on the threads of the current pool. Returns how many met something.
    pub(super) fn trace(&self, scene: &Scene, form: Form) -> usize {
        match (form.width, self.lot.kind.is_occlusion()) {
            (1, false) => self.singles(form, |single, query| hit_single(scene, single, query).is_some()),
            (1, true) => self.singles(form, |single, query| occluded_single(scene, single, query)),
            (8, false) => self.packets(form, |packet, query| {
                count_hits(&hit_half::<0>(scene, packet, query))
                    + count_hits(&hit_half::<8>(scene, packet, query))
            }),
            (8, true) => self.packets(form, |packet, query| {
                occluded_half::<0>(scene, packet, query) + occluded_half::<8>(scene, packet, query)
            }),
            (_, false) => self.packets(form, |packet, query| count_hits(&hit_whole(scene, packet, query))),
            (_, true) => self.packets(form, |packet, query| {
                let rays = occluded_whole(scene, packet, query);
                (0..LANES).filter(|&lane| packet.valid[lane] != 0 && rays.t_far[lane] < 0.0).count()
            }),
        }
    }

    /// What each ray of the lot meets; in lots of occlusion only whether it does counts.
    pub(super) fn answers(&self, scene: &Scene, form: Form) -> Vec<Option<Met>> {
        let mut answers = vec![None; self.lot.rays.len()];
        let blocked = |is: bool| is.then_some(Met { t: 0.0, object: 0, primitive: 0 });
        let mut query = Query::new(form.coherent);
        if form.width == 1 {
            for (single, answer) in self.singles.iter().zip(&mut answers) {
                *answer = match self.lot.kind.is_occlusion() {
                    false => hit_single(scene, single, &mut query),
                    true => blocked(occluded_single(scene, single, &mut query)),
                };
            }
            return answers;
        }
        let packets = &self.lot.groupings[form.grouping].1;
        for (packet, compact) in packets.iter().zip(&self.groupings[form.grouping]) {
            let mut put = |lane: usize, answer: Option<Met>| {
                if let Some(answers) = answers.get_mut(packet[lane] as usize) {
                    *answers = answer;
                }
            };
            if self.lot.kind.is_occlusion() {
                let rays = occluded_whole(scene, compact, &mut query);
                (0..LANES).for_each(|lane| put(lane, blocked(rays.t_far[lane] < 0.0)));
            } else {
                let found = hit_whole(scene, compact, &mut query);
                (0..LANES).for_each(|lane| put(lane, met(scene, &found, lane)));
            }
        }
        answers
    }

    fn singles(&self, form: Form, trace: impl Fn(&[f32; 7], &mut Query) -> bool + Sync) -> usize {
        let chunks = self.singles.par_chunks(CHUNK * LANES);
        chunks
            .map(|chunk| {
                let mut query = Query::new(form.coherent);
                chunk.iter().filter(|single| trace(single, &mut query)).count()
            })
            .sum()
    }

    fn packets(&self, form: Form, trace: impl Fn(&Compact, &mut Query) -> usize + Sync) -> usize {
        let chunks = self.groupings[form.grouping].par_chunks(CHUNK);
        chunks
            .map(|chunk| {
                let mut query = Query::new(form.coherent);
                chunk.iter().map(|packet| trace(packet, &mut query)).sum::<usize>()
            })
            .sum()
    }
}

#[inline(always)]
fn rays_of_single(single: &[f32; 7]) -> Rays<1> {
    let [ox, oy, oz, dx, dy, dz, t_far] = *single;
    Rays::new([[ox], [oy], [oz]], [[dx], [dy], [dz]], [t_far])
}

#[inline(always)]
fn hit_single(scene: &Scene, single: &[f32; 7], query: &mut Query) -> Option<Met> {
    let mut found = Aligned(RayHits::new(rays_of_single(single)));
    scene.intersect(&Aligned([-1]), &mut found, query);
    met(scene, &found.0, 0)
}

#[inline(always)]
fn occluded_single(scene: &Scene, single: &[f32; 7], query: &mut Query) -> bool {
    let mut rays = Aligned(rays_of_single(single));
    scene.occluded(&Aligned([-1]), &mut rays, query);
    rays.0.t_far[0] < 0.0
}

#[inline(always)]
fn hit_whole(scene: &Scene, packet: &Compact, query: &mut Query) -> RayHits<LANES> {
    let mut found = Aligned(RayHits::new(Rays::new(packet.origin, packet.direction, packet.t_far)));
    scene.intersect(&Aligned(packet.valid), &mut found, query);
    found.0
}

#[inline(always)]
fn occluded_whole(scene: &Scene, packet: &Compact, query: &mut Query) -> Rays<LANES> {
    let mut rays = Aligned(Rays::new(packet.origin, packet.direction, packet.t_far));
    scene.occluded(&Aligned(packet.valid), &mut rays, query);
    rays.0
}

/// Eight lanes of sixteen from the `FIRST`.
#[inline(always)]
fn half<const FIRST: usize, T: Copy>(lanes: &[T; LANES]) -> [T; 8] {
    std::array::from_fn(|lane| lanes[FIRST + lane])
}

#[inline(always)]
fn half_rays<const FIRST: usize>(packet: &Compact) -> Rays<8> {
    let (origin, direction) = (&packet.origin, &packet.direction);
    Rays::new(
        std::array::from_fn(|axis| half::<FIRST, f32>(&origin[axis])),
        std::array::from_fn(|axis| half::<FIRST, f32>(&direction[axis])),
        half::<FIRST, f32>(&packet.t_far),
    )
}

#[inline(always)]
fn hit_half<const FIRST: usize>(scene: &Scene, packet: &Compact, query: &mut Query) -> RayHits<8> {
    let mut found = Aligned(RayHits::new(half_rays::<FIRST>(packet)));
    scene.intersect(&Aligned(half::<FIRST, i32>(&packet.valid)), &mut found, query);
    found.0
}

#[inline(always)]
fn occluded_half<const FIRST: usize>(scene: &Scene, packet: &Compact, query: &mut Query) -> usize {
    let mut rays = Aligned(half_rays::<FIRST>(packet));
    let valid = half::<FIRST, i32>(&packet.valid);
    scene.occluded(&Aligned(valid), &mut rays, query);
    (0..8).filter(|&lane| valid[lane] != 0 && rays.0.t_far[lane] < 0.0).count()
}

#[inline(always)]
fn count_hits<const N: usize>(found: &RayHits<N>) -> usize {
    found.hits.geometry.iter().filter(|&&geometry| geometry != ffi::NONE).count()
}

#[inline(always)]
fn met<const N: usize>(scene: &Scene, found: &RayHits<N>, lane: usize) -> Option<Met> {
    (found.hits.geometry[lane] != ffi::NONE).then(|| Met {
        t: found.rays.t_far[lane],
        object: scene.object(&found.hits, lane),
        primitive: found.hits.primitive[lane],
    })
}
