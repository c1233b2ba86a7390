//! The tree's shape, and that it hides nothing. That pictures do not depend on it is tested with the world.

use super::*;
use crate::geometry::{DVec3, Ray};
use crate::mesh::{Mesh, MeshData};
use crate::shape::triangle::ShearedRay;
use crate::testing::{Random, ball, soup};
use std::sync::atomic::{AtomicUsize, Ordering};

/// All triangles that a ray hits, with their t, by the tree.
fn hits_by_tree(tree: &KdTree, mesh: &Mesh, ray: &Ray) -> Vec<(u32, u64)> {
    let mut candidates = Vec::new();
    tree.visit_leaves(ray, |leaf| {
        candidates.extend_from_slice(leaf);
        ray.t_max
    });
    candidates.sort_unstable();
    candidates.dedup();
    hits(candidates.into_iter(), mesh, ray)
}

fn hits(triangles: impl Iterator<Item = u32>, mesh: &Mesh, ray: &Ray) -> Vec<(u32, u64)> {
    let sheared = ShearedRay::new(ray);
    triangles
        .filter_map(|triangle| Some((triangle, sheared.intersect(&mesh.vertices(triangle))?.t)))
        .filter(|&(_, t)| t > 0.0 && t < ray.t_max)
        .map(|(triangle, t)| (triangle, t.to_bits()))
        .collect()
}

fn build(mesh: &Mesh, settings: KdSettings) -> KdTree {
    let tree = KdTree::build(mesh, settings).unwrap();
    assert_eq!(tree.validate(mesh.triangle_count()), Ok(()));
    tree
}

/// 20 meshes, 5,000 rays each, with every hit compared and not only the nearest.
#[test]
fn the_tree_hides_no_hit_that_brute_force_finds() {
    for seed in 0..20 {
        let mesh = if seed % 4 == 3 { Mesh::new(ball(12, 24)).unwrap() } else { soup(seed, 300) };
        let settings = [
            KdSettings::default(),
            KdSettings { leaf: Some(1), depth: Some(40) },
            KdSettings { leaf: Some(20), depth: None },
            KdSettings { leaf: None, depth: Some(3) },
        ][seed as usize % 4];
        let tree = build(&mesh, settings);
        let mut random = Random::new(100 + seed);
        for _ in 0..5000 {
            let mut ray = random.ray(2.0);
            if random.below(2) == 0 {
                ray.t_max = random.between(0.0, 2.0);
            }
            if random.below(4) == 0 {
                // Through a vertex, from a place that shares a coordinate with it.
                let vertex = mesh.corners(random.below(mesh.triangle_count()) as u32)[0];
                ray.origin[random.below(3)] = vertex[random.below(3)];
                ray.direction = vertex - ray.origin;
            }
            if ray.direction == DVec3::ZERO {
                continue;
            }
            let all = hits(0..mesh.triangle_count() as u32, &mesh, &ray);
            assert_eq!(hits_by_tree(&tree, &mesh, &ray), all, "mesh {seed}, {ray:?}");
        }
    }
}

#[test]
fn leaves_are_visited_near_before_far_and_end_at_the_nearest_hit() {
    let mesh = soup(7, 2000);
    let tree = build(&mesh, KdSettings::default());
    let mut random = Random::new(8);
    let (mut visited, mut all) = (0, 0);
    for _ in 0..500 {
        let ray = random.ray(2.0);
        let nearest = hits(0..2000, &mesh, &ray).into_iter().map(|(_, t)| f64::from_bits(t)).reduce(f64::min);
        let sheared = ShearedRay::new(&ray);
        let mut best = f64::INFINITY;
        tree.visit_leaves(&ray, |leaf| {
            visited += 1;
            for &triangle in leaf {
                if let Some(hit) = sheared.intersect(&mesh.vertices(triangle)).filter(|hit| hit.t > 0.0) {
                    best = best.min(hit.t);
                }
            }
            best
        });
        assert_eq!(best, nearest.unwrap_or(f64::INFINITY));
        tree.visit_leaves(&ray, |_| {
            all += 1;
            f64::INFINITY
        });
    }
    assert!(2 * visited < all, "{visited} of {all} leaves were visited");
}

#[test]
fn a_ray_in_the_split_plane_visits_both_children() {
    // Two squares that touch in the plane x = 0, where the tree splits.
    let square = |x0: f32, x1: f32| [[x0, 0.0, 0.0], [x1, 0.0, 0.0], [x1, 1.0, 0.0], [x0, 1.0, 0.0]];
    let data = MeshData {
        positions: [square(-1.0, 0.0), square(0.0, 1.0)].concat(),
        indices: vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
        ..MeshData::default()
    };
    let mesh = Mesh::new(data).unwrap();
    let tree = build(&mesh, KdSettings { leaf: Some(1), depth: None });
    let ray = Ray::new(DVec3::new(0.0, 0.5, 1.0), DVec3::NEG_Z);
    assert_eq!(hits_by_tree(&tree, &mesh, &ray).len(), 2);
}

#[test]
fn the_user_bounds_leaves_and_depth() {
    let mesh = Mesh::new(ball(40, 80)).unwrap();
    let tree = build(&mesh, KdSettings { leaf: None, depth: Some(5) });
    assert_eq!(tree.depth(), 5);
    let tree = build(&mesh, KdSettings { leaf: None, depth: Some(0) });
    assert_eq!((tree.node_count(), tree.reference_count()), (1, mesh.triangle_count()));
    let large = build(&mesh, KdSettings { leaf: Some(500), depth: None });
    assert!(large.node_count() < build(&mesh, KdSettings::default()).node_count() / 20);
    large.visit_nodes(|_, node| {
        // A node above the bound is split; its children may hold any number.
        if let NodeKind::Leaf(references) = node.kind {
            assert!(references.len() <= 500);
        }
    });
    let deepest = build(&mesh, KdSettings { leaf: Some(0), depth: Some(u32::MAX) });
    assert!(deepest.depth() <= KdTree::MAX_DEPTH);
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let mesh = Mesh::new(ball(120, 240)).unwrap();
    let shape = |threads: usize| {
        crate::render::with_threads(threads, || {
            let tree = build(&mesh, KdSettings::default());
            let mut shape = Vec::new();
            tree.visit_nodes(|_, node| shape.push(format!("{node:?}")));
            shape
        })
        .unwrap()
    };
    let one = shape(1);
    assert_eq!(one, shape(2));
    assert_eq!(one, shape(8));
}

/// Depth bounded, memory linear. Time is measured by the benchmarks, not asserted here.
#[test]
fn hundreds_of_thousands_of_awkward_triangles_build_in_linear_memory() {
    type Corners = [DVec3; 3];
    fn mesh(count: u32, corners: impl Fn(u32) -> Corners) -> Mesh {
        let mut data = MeshData::default();
        for triangle in 0..count {
            data.positions.extend(corners(triangle).map(|corner| corner.as_vec3().to_array()));
            data.indices.push([3 * triangle, 3 * triangle + 1, 3 * triangle + 2]);
        }
        Mesh::new(data).unwrap()
    }
    let n = 200_000;
    let unit = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut random = Random::new(9);
    let scattered = (0..n).map(|_| (random.point(1.0), random.point(1.0))).collect::<Vec<_>>();
    let cases = [
        ("coincident", mesh(n, |_| unit)),
        ("nested", mesh(n, |i| unit.map(|corner| corner * (1.0 + f64::from(i) / f64::from(n))))),
        ("coplanar", mesh(n, |i| unit.map(|corner| (corner * 0.01 + scattered[i as usize].0).with_y(0.5)))),
        ("points", mesh(n, |i| [scattered[i as usize].0; 3])),
        (
            "needles",
            mesh(n, |i| {
                let (a, b) = scattered[i as usize];
                [a, b, b + (a - b) * 1e-6]
            }),
        ),
        ("one point", mesh(n, |_| [DVec3::ONE; 3])),
    ];
    for (name, mesh) in cases {
        let tree = build(&mesh, KdSettings::default());
        let references = tree.reference_count() as f64 / f64::from(n);
        let nodes = tree.node_count() as f64 / f64::from(n);
        assert!(references <= 6.0, "{name}: {references} references a triangle");
        assert!(nodes <= 10.1, "{name}: {nodes} nodes a triangle");
        assert!(tree.depth() <= KdTree::MAX_DEPTH, "{name}");
    }
}

#[test]
fn an_empty_tree_is_crossed_without_a_visit_that_finds_anything() {
    struct Nothing;
    impl Primitives for Nothing {
        fn count(&self) -> usize {
            0
        }
        fn bounds(&self, _: u32) -> Aabb {
            Aabb { min: [0.0; 3], max: [0.0; 3] }
        }
    }
    let tree = KdTree::build(&Nothing, KdSettings::default()).unwrap();
    tree.visit_leaves(&Ray::new(DVec3::NEG_Z, DVec3::Z), |leaf| panic!("a visit of {leaf:?}"));
}

/// Boxes that cancel the build while one of them is cut.
struct Cancelling {
    boxes: Vec<Aabb>,
    cuts: AtomicUsize,
    last: usize,
    cancel: CancelToken,
}

impl Primitives for Cancelling {
    fn count(&self) -> usize {
        self.boxes.len()
    }

    fn bounds(&self, primitive: u32) -> Aabb {
        self.boxes[primitive as usize]
    }

    fn clip(&self, primitive: u32, cell: &Aabb) -> Option<Aabb> {
        if self.cuts.fetch_add(1, Ordering::Relaxed) == self.last {
            self.cancel.cancel();
        }
        self.bounds(primitive).intersection(cell)
    }
}

#[test]
fn a_build_ends_with_the_node_in_which_it_is_cancelled() {
    let mesh = soup(7, 2000);
    let boxes = (0..2000).map(|i| Primitives::bounds(&mesh, i)).collect::<Vec<_>>();
    let build = |last: usize| {
        let cancel = CancelToken::default();
        let primitives = Cancelling { boxes: boxes.clone(), cuts: AtomicUsize::new(0), last, cancel };
        let tree = KdTree::build_with(&primitives, KdSettings::default(), &primitives.cancel);
        (tree.map(drop), primitives.cuts.into_inner())
    };
    let (built, all) = build(usize::MAX);
    assert_eq!(built, Ok(()));
    for last in [0, all / 4, all / 2] {
        let (built, cuts) = build(last);
        assert_eq!(built, Err(BuildError::Cancelled));
        assert!(cuts <= last + 2 * boxes.len() && cuts < all, "{cuts} of {all}");
    }
}

#[test]
fn the_cells_of_a_level_are_those_that_a_visit_finds_there() {
    let mesh = soup(3, 500);
    let tree = build(&mesh, KdSettings::default());
    for level in 0..=tree.depth() + 1 {
        let mut expected = Vec::new();
        tree.visit_nodes(|_, node| expected.extend((node.depth == level).then_some(node.bounds)));
        assert_eq!(tree.cells_at(level, usize::MAX), expected);
        assert_eq!(tree.cells_at(level, 3), expected[..expected.len().min(3)]);
    }
}
