//! What a k-d tree costs against the two numbers that bound it.
//!
//! Steps and tests are counted, so they are the same on every machine; times beside them are not.

use super::{Rays, nanoseconds};
use crate::Failure;
use crate::record::{command_line, median, write};
use crate::speed::scene_of;
use crate::subjects::{Subject, sphereflake};
use lancer_core::accel::kd_tree::{NodeKind, STEP_COST, TEST_COST};
use lancer_core::accel::{Aabb, Accelerator, KdSettings, KdTree};
use lancer_core::render::with_threads;
use lancer_core::scene::Scene;
use lancer_core::shape::triangle::ShearedRay;
use lancer_core::world::{CompileOptions, World};
use serde_json::{Value, json};
use std::path::Path;

/// Most triangles in a leaf; the depth is the automatic one.
const LEAVES: [u32; 11] = [1, 2, 3, 4, 6, 8, 12, 16, 32, 64, 128];
/// Depths; the leaf is the automatic one.
const DEPTHS: [u32; 14] = [4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30];
/// Above this a time is left out: the rays would take minutes.
const MOST_TESTS: f64 = 2000.0;

/// The tree's bounds, its size, and its cost for a ray.
struct Row {
    settings: KdSettings,
    depth: u32,
    nodes: usize,
    references: usize,
    /// Steps and tests that the heuristic expects of a line through the box that nothing stops.
    expected: Cost,
    /// Those of the rays, up to their nearest hit.
    counted: Cost,
    nanoseconds: Option<f64>,
}

#[derive(Clone, Copy, Default)]
struct Cost {
    steps: f64,
    tests: f64,
}

impl Cost {
    /// In steps.
    fn total(self) -> f64 {
        f64::from(STEP_COST) * self.steps + f64::from(TEST_COST) * self.tests
    }
}

#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(crate) fn measure(triangles: u32, runs: usize, data: Option<&Path>) -> Result<(), Failure> {
    let subject = sphereflake(triangles)?;
    let scene = scene_of(&subject);
    let rays = Rays::new(&scene)?;
    println!(
        "{}, {} triangles, {} camera rays and as many mirror rays, one thread",
        subject.name,
        subject.mesh.triangle_count(),
        rays.camera.len()
    );
    println!(
        "{:>6} {:>6} {:>6} {:>9} {:>10} {:>8} {:>8} {:>8} {:>9} {:>8}",
        "leaf", "bound", "depth", "nodes", "references", "steps", "tests", "cost", "expected", "ns/ray"
    );
    let bounds = (LEAVES.map(|leaf| KdSettings { leaf: Some(leaf), depth: None }).into_iter())
        .chain(DEPTHS.map(|depth| KdSettings { leaf: None, depth: Some(depth) }))
        .chain([KdSettings::default()]);
    let mut rows = Vec::new();
    for settings in bounds {
        let row = Row::measure(&subject, &scene, &rays, settings, runs)?;
        println!("{}", row.line());
        rows.push(row.to_json());
    }
    if let Some(path) = data {
        let triangles = subject.mesh.triangle_count();
        write(
            path,
            json!({ "command": command_line(), "mesh": subject.name, "triangles": triangles, "rows": rows }),
        )?;
    }
    Ok(())
}

impl Row {
    fn measure(
        subject: &Subject,
        scene: &Scene,
        rays: &Rays,
        settings: KdSettings,
        runs: usize,
    ) -> Result<Self, Failure> {
        let tree = KdTree::build(subject.mesh.as_ref(), settings)?;
        let counted = counted(&tree, subject, rays);
        let options =
            CompileOptions { accelerator: Accelerator::KdTree, kd: settings, ..CompileOptions::default() };
        let world = World::compile(scene, &options)?;
        let times = || (0..runs).map(|_| nanoseconds(&world, rays.all())).collect::<Vec<_>>();
        let is_short = counted.tests <= MOST_TESTS;
        Ok(Self {
            settings,
            depth: tree.depth(),
            nodes: tree.node_count(),
            references: tree.reference_count(),
            expected: expected(&tree),
            counted,
            nanoseconds: is_short.then(|| with_threads(1, times)).transpose()?.map(|times| median(&times)),
        })
    }

    fn line(&self) -> String {
        let bound = |bound: Option<u32>| bound.map_or_else(|| "auto".to_owned(), |bound| bound.to_string());
        format!(
            "{:>6} {:>6} {:>6} {:>9} {:>10} {:>8.2} {:>8.2} {:>8.2} {:>9.2} {:>8}",
            bound(self.settings.leaf),
            bound(self.settings.depth),
            self.depth,
            self.nodes,
            self.references,
            self.counted.steps,
            self.counted.tests,
            self.counted.total(),
            self.expected.total(),
            self.nanoseconds.map_or_else(|| "-".to_owned(), |time| format!("{time:.0}")),
        )
    }

    fn to_json(&self) -> Value {
        json!({
            "leaf": self.settings.leaf,
            "depth_bound": self.settings.depth,
            "depth": self.depth,
            "nodes": self.nodes,
            "references": self.references,
            "steps": self.counted.steps,
            "tests": self.counted.tests,
            "cost": self.counted.total(),
            "expected_cost": self.expected.total(),
            "nanoseconds": self.nanoseconds,
        })
    }
}

/// The mean over the rays, each up to its nearest hit.
fn counted(tree: &KdTree, subject: &Subject, rays: &Rays) -> Cost {
    let (mut steps, mut tests, mut count) = (0_u64, 0_u64, 0_u64);
    for ray in rays.all() {
        let sheared = ShearedRay::new(ray);
        let mut nearest = ray.t_max;
        let visit = |triangles: &[u32]| {
            tests += triangles.len() as u64;
            for &triangle in triangles {
                let hit = sheared.intersect(&subject.mesh.vertices(triangle));
                nearest = hit.filter(|hit| hit.t > 0.0).map_or(nearest, |hit| nearest.min(hit.t));
            }
            nearest
        };
        tree.visit_steps_and_leaves(ray, || steps += 1, visit);
        count += 1;
    }
    Cost { steps: steps as f64 / count as f64, tests: tests as f64 / count as f64 }
}

/// The sums of the surface area heuristic over the whole tree: a convex cell is met by as many of the lines that meet
/// the box as its share of the box's area.
fn expected(tree: &KdTree) -> Cost {
    let half_area = |cell: &Aabb| {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(cell.max[axis]) - f64::from(cell.min[axis]));
        x * y + y * z + z * x
    };
    let whole = half_area(&tree.bounds());
    let mut cost = Cost::default();
    tree.visit_nodes(|_, node| {
        let share = half_area(&node.bounds) / whole;
        match node.kind {
            NodeKind::Inner { .. } => cost.steps += share,
            NodeKind::Leaf(triangles) => cost.tests += share * triangles.len() as f64,
        }
    });
    cost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_of_one_leaf_costs_one_test_a_triangle_and_no_step() {
        let subject = sphereflake(4000).unwrap();
        let tree = KdTree::build(subject.mesh.as_ref(), KdSettings { leaf: None, depth: Some(0) }).unwrap();
        let rays = Rays::new(&scene_of(&subject)).unwrap();
        let rays = Rays { camera: rays.camera[..10].to_vec(), mirror: Vec::new() };
        let count = subject.mesh.triangle_count() as f64;
        for cost in [expected(&tree), counted(&tree, &subject, &rays)] {
            assert_eq!((cost.steps, cost.tests), (0.0, count));
        }
    }
}
