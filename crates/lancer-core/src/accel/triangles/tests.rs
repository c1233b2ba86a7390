//! The kernels against the canonical test on every triangle, on each instruction set of this processor.

use super::*;
use crate::accel::Uncounted;
use crate::geometry::DVec3;
use crate::mesh::MeshData;
use crate::shape::triangle::Canonical;
use crate::simd::InstructionSet;
use crate::testing::{Random, ball, soup};

fn levels() -> impl Iterator<Item = Level> {
    InstructionSet::ALL.into_iter().filter_map(InstructionSet::level)
}

fn build(mesh: &Mesh, level: Level) -> TriangleTree {
    TriangleTree::build(mesh, Quality::High, level, &CancelToken::default()).unwrap()
}

fn moved(mut data: MeshData, scale: f32, offset: f32) -> Mesh {
    for position in &mut data.positions {
        *position = position.map(|x| x * scale + offset);
    }
    Mesh::new(data).unwrap()
}

/// A flat square of n x n cells: every triangle coplanar with all others, every edge and vertex shared.
fn grid(n: u32) -> MeshData {
    let mut data = MeshData::default();
    for (z, x) in (0..=n).flat_map(|z| (0..=n).map(move |x| (z, x))) {
        data.positions.push([x as f32 / n as f32 - 0.5, 0.0, z as f32 / n as f32 - 0.5]);
    }
    for (z, x) in (0..n).flat_map(|z| (0..n).map(move |x| (z, x))) {
        let corner = z * (n + 1) + x;
        data.indices
            .extend([[corner, corner + n + 1, corner + 1], [corner + 1, corner + n + 1, corner + n + 2]]);
    }
    data
}

/// Long thin triangles through one point, and some that are only points or lines.
fn needles() -> MeshData {
    let mut random = Random::new(7);
    let mut data = MeshData::default();
    for i in 0..200_u32 {
        let tip = random.point(1.0).as_vec3().to_array();
        let beside = (random.point(1e-4).as_vec3() + DVec3::from(tip.map(f64::from)).as_vec3()).to_array();
        let degenerate = if i % 5 == 0 { tip } else { beside };
        data.positions.extend([[0.0; 3], tip, degenerate]);
        data.indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    data
}

/// Slivers between opposite corners of a cube: the box of each, and so of each node over them, is the whole cube.
fn diagonals(count: u32) -> MeshData {
    let mut random = Random::new(8);
    let mut data = MeshData::default();
    for i in 0..count {
        let corner = DVec3::new(1.0, [1.0, -1.0][i as usize % 2], [1.0, -1.0][i as usize / 2 % 2]);
        let near = |random: &mut Random| random.point(0.01).as_vec3();
        let ends =
            [corner.as_vec3(), corner.as_vec3() + near(&mut random), -corner.as_vec3() + near(&mut random)];
        data.positions.extend(ends.map(|end| end.to_array()));
        data.indices.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    data
}

fn meshes() -> Vec<Mesh> {
    let mut meshes = Vec::new();
    for data in [ball(12, 24), grid(12), needles(), soup(3, 400).data().clone()] {
        for (scale, offset) in [(1.0, 0.0), (1e-3, 0.0), (1e3, 0.0), (1.0, 1e4), (1e-7, 0.0), (1e30, 0.0)] {
            meshes.push(moved(data.clone(), scale, offset));
        }
    }
    meshes
}

/// Rays of all sorts: from outside and inside, far away, along axes, at vertices and edges, cut off short.
fn ray(random: &mut Random, mesh: &Mesh) -> Ray {
    let bounds = mesh.bounds();
    let size = bounds.diagonal();
    let triangle = mesh.corners(random.below(mesh.triangle_count()) as u32);
    let target = match random.below(4) {
        0 => triangle[0],
        1 => (triangle[0] + triangle[1]) * 0.5,
        2 => (triangle[0] + triangle[1] + triangle[2]) / 3.0,
        _ => bounds.center() + random.point(size * 0.5),
    };
    let distance = [0.1, 1.0, 3.0, 1e3, 1e8][random.below(5)];
    let mut ray = random.ray(1.0);
    ray.origin = match random.below(3) {
        0 => triangle[1],
        1 => bounds.center() + ray.origin * size * 0.4,
        _ => bounds.center() + ray.direction * -distance * size,
    };
    if random.below(3) > 0 && target != ray.origin {
        ray.direction = target - ray.origin;
    }
    let length = [1.0, 1e-6, 1e5][random.below(3)];
    ray.direction *= length;
    if random.below(3) == 0 {
        ray.t_max = random.between(0.0, 2.0) * (target - ray.origin).length() / ray.direction.length();
    }
    ray
}

#[test]
fn nearest_and_any_hit_are_those_of_the_canonical_test_on_every_triangle() {
    let mut random = Random::new(1);
    let (mut hits, mut misses) = (0, 0);
    for mesh in meshes() {
        let trees: Vec<_> = levels().map(|level| build(&mesh, level)).collect();
        for _ in 0..400 {
            let ray = ray(&mut random, &mesh);
            let mut nearest = Nearest::new(&ray);
            for id in 0..mesh.triangle_count() as u32 {
                nearest.consider(id, &mesh.vertices(id));
            }
            let expected = nearest.found();
            for tree in &trees {
                assert_eq!(
                    tree.intersect(&ray, &Uncounted),
                    expected,
                    "{:?} {ray:?} {:?}",
                    tree.level,
                    mesh.bounds()
                );
                assert_eq!(tree.occluded(&ray, &Uncounted), expected.is_some(), "{:?} {ray:?}", tree.level);
            }
            if expected.is_some() { hits += 1 } else { misses += 1 }
        }
    }
    assert!(hits > 1000 && misses > 1000, "{hits} hits, {misses} misses");
}

/// Rays of one packet: side by side from one place, from many places to one, or each for itself; some lanes empty.
fn packet(random: &mut Random, mesh: &Mesh) -> (RayPacket, u32) {
    let size = mesh.bounds().diagonal();
    let first = ray(random, mesh);
    let mut packet = RayPacket::splat(&first);
    let (sort, spread) = (random.below(4), [1e-6, 1e-3, 0.03, 0.3][random.below(4)]);
    for lane in 0..RayPacket::LANES {
        let around = random.point(spread);
        packet.set(
            lane,
            &match sort {
                0 => Ray { direction: first.direction + around * first.direction.length(), ..first },
                1 => {
                    let origin = first.origin + around * size;
                    Ray { origin, direction: first.at(1.0) - origin, t_max: 1.0 }
                }
                2 => Ray { origin: first.origin + around * size, ..first },
                _ => ray(random, mesh),
            },
        );
    }
    let wanted = [0xffff, 0xffff, 0x00ff, 0x8421, 0x0013, random.below(1 << 16) as u32][random.below(6)];
    (packet, wanted)
}

#[test]
fn packets_find_what_each_of_their_rays_finds_alone() {
    let mut random = Random::new(4);
    let mut hits = [0; 2];
    for mesh in meshes() {
        let trees: Vec<_> = levels().map(|level| build(&mesh, level)).collect();
        for _ in 0..120 {
            let (packet, wanted) = packet(&mut random, &mesh);
            let mut ready = ReadyRays::default();
            ready.rays = packet.clone();
            // Also for more than the mesh: one among others of its space.
            let bounds = mesh.bounds();
            let more = bounds.diagonal() * random.between(0.0, 30.0) * random.between(0.0, 1.0).round();
            ready.prepare(&Bounds::new(bounds.min - more, bounds.max + more * 0.5));
            for tree in &trees {
                let nearest = tree.intersect_packet(&ready, wanted);
                let occluded = tree.occluded_packet(&ready, wanted, &[None; RayPacket::LANES]);
                assert_eq!(occluded & !wanted, 0);
                for lane in 0..RayPacket::LANES {
                    let is_wanted = wanted >> lane & 1 == 1;
                    let alone = tree.intersect(&packet.ray(lane), &Uncounted).filter(|_| is_wanted);
                    assert_eq!(
                        nearest.at(lane).found(),
                        alone,
                        "{:?} {:?} {wanted:x}",
                        tree.level,
                        packet.ray(lane)
                    );
                    assert_eq!(
                        occluded >> lane & 1 == 1,
                        alone.is_some(),
                        "{:?} {:?}",
                        tree.level,
                        packet.ray(lane)
                    );
                    hits[usize::from(alone.is_some())] += 1;
                }
            }
        }
    }
    assert!(hits[0] > 10_000 && hits[1] > 10_000, "{hits:?}");
}

#[test]
fn a_ray_along_an_axis_just_inside_of_the_bounds_hits() {
    let mesh = Mesh::new(grid(1)).unwrap();
    for level in levels() {
        let tree = build(&mesh, level);
        for (distance, inside) in [(0.1, 1e-15), (1.0, 1e-15), (5.0, 1e-13), (1e3, 1e-13), (1e5, 1e-13)] {
            for edge in [0.5 - inside, inside - 0.5] {
                let ray = Ray::new(DVec3::new(edge, distance, 0.1), DVec3::NEG_Y);
                let hit = tree.intersect(&ray, &Uncounted).map(|hit| hit.t);
                assert!(
                    hit.is_some_and(|t| (t - distance).abs() < 1e-12 * distance),
                    "{level:?} {ray:?}: {hit:?}"
                );
            }
        }
    }
}

#[test]
fn most_rays_are_settled_without_the_canonical_test() {
    // Not a matter of right or wrong, but of all the speed: a bound that is far too loose would pass every other
    // test. Counted at a ball of 20,000 triangles seen from outside.
    let mesh = Mesh::new(ball(100, 100)).unwrap();
    let tree = build(&mesh, Level::new());
    let mut random = Random::new(2);
    let (mut tested, mut unsure) = (0, 0);
    for _ in 0..2000 {
        let origin = random.direction() * 3.0;
        let ray = Ray { t_max: 1e9, ..Ray::new(origin, random.point(0.7) - origin) };
        let Narrowed::Ready(narrow) = NarrowRay::prepare(&ray, &tree.bounds) else { continue };
        dispatch!(tree.level, simd => {
            let block_ray = block::TestRays::new(simd, &narrow);
            walk(simd, &tree.nodes, &narrow, &Uncounted, &mut |leaf: Child| {
                for (block, count) in block::blocks_of(leaf) {
                    let verdict = tree.blocks[block].test(simd, &block_ray, count, narrow.end);
                    tested += count;
                    unsure += (verdict.maybe & !verdict.sure).count_ones();
                }
                narrow.end
            });
        });
    }
    assert!(tested > 5000, "{tested}");
    assert!(u64::from(unsure) * 200 < tested as u64, "{unsure} of {tested} tests are too close to tell");
}

#[test]
fn a_leafs_bound_on_its_triangles_elevation_holds() {
    // Directions from points near a soup of triangles, with all of the triangles in reach: what the fan finds for
    // each must be what the canonical test finds, whatever the bounds on elevation leave out.
    let mut random = Random::new(3);
    for (triangles, scale) in [(3, 1.0), (40, 1.0), (400, 1.0), (40, 2e-9), (40, 1e8)] {
        let mesh = moved(soup(5, triangles).data().clone(), scale, 0.0);
        let scale = f64::from(scale);
        for level in levels() {
            let tree = build(&mesh, level);
            for _ in 0..60 {
                let normal = random.direction();
                let point = random.point(1.0) * scale;
                let fan = fan_around(normal, &mut random);
                let reach = [0.2, 1.0, 10.0, f64::INFINITY][random.below(4)] * scale;
                let receiver = Receiver {
                    point,
                    normal,
                    from_world: crate::geometry::DMat3::IDENTITY,
                    reach,
                    own: None,
                };
                let ray = |i: usize| Ray { origin: point, direction: fan.direction(i), t_max: reach };
                let decide = |i: usize, triangle: &[[f32; 3]; 3]| Canonical::new(&ray(i)).hits(triangle);
                let found = tree
                    .occluded_fan(
                        &receiver,
                        &fan,
                        fan.all(),
                        &mut MeshFanScratch::default(),
                        &Uncounted,
                        decide,
                    )
                    .unwrap();
                for i in 0..fan.count {
                    let ray = ray(i);
                    let mut canonical = Canonical::new(&ray);
                    let expected =
                        (0..mesh.triangle_count() as u32).any(|id| canonical.hits(&mesh.vertices(id)));
                    assert_eq!(found >> i & 1 == 1, expected, "{level:?} {ray:?}");
                }
            }
        }
    }
}

#[test]
fn the_few_directions_that_meet_a_crowd_of_boxes_find_what_rays_do() {
    let mesh = Mesh::new(diagonals(60_000)).unwrap();
    let mut random = Random::new(4);
    let mut hits = [0; 2];
    for level in levels() {
        let tree = build(&mesh, level);
        for _ in 0..10 {
            let normal = random.direction();
            let point = normal * -random.between(4.0, 5.0);
            let fan = fan_around(normal, &mut random);
            let from_world = crate::geometry::DMat3::IDENTITY;
            let receiver = Receiver { point, normal, from_world, reach: 10.0, own: None };
            let ray = |i: usize| Ray { origin: point, direction: fan.direction(i), t_max: 10.0 };
            let decide = |i: usize, triangle: &[[f32; 3]; 3]| Canonical::new(&ray(i)).hits(triangle);
            let found = tree
                .occluded_fan(&receiver, &fan, fan.all(), &mut MeshFanScratch::default(), &Uncounted, decide)
                .unwrap();
            for i in 0..fan.count {
                let expected = tree.occluded(&ray(i), &Uncounted);
                assert_eq!(found >> i & 1 == 1, expected, "{level:?} {:?}", ray(i));
                hits[usize::from(expected)] += 1;
            }
        }
    }
    assert!(hits[0] > 500 && hits[1] > 0, "{hits:?}");
}

fn fan_around(normal: DVec3, random: &mut Random) -> DirectionFan {
    let lattice = crate::sampling::HemisphereLattice::new(20 + random.below(100) as u32);
    let mut stream = crate::sampling::Key::camera(random.below(1000) as u32, 0, 0).stream();
    lattice.around(normal, &mut stream).next().unwrap()
}
