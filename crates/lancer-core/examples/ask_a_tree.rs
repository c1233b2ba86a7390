//! Builds a k-d tree over anything that has boxes, and asks it what a ray may meet:
//! `cargo run -p lancer-core --example ask_a_tree`

use lancer_core::accel::{Aabb, KdSettings, KdTree, Primitives};
use lancer_core::geometry::{Bounds, DVec3, Ray};
use std::error::Error;
use std::io::Write;

/// Balls of radius 0.1.
struct Balls(Vec<DVec3>);

impl Primitives for Balls {
    fn count(&self) -> usize {
        self.0.len()
    }

    fn bounds(&self, ball: u32) -> Aabb {
        let center = self.0[ball as usize];
        Aabb::around(&Bounds::new(center - DVec3::splat(0.1), center + DVec3::splat(0.1)))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let corner = |i: u32| DVec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100));
    let balls = Balls((0..1000).map(corner).collect());
    let tree = KdTree::build(&balls, KdSettings { leaf: Some(1), depth: None })?;
    tree.validate(balls.count())?;

    let mut out = std::io::stdout().lock();
    writeln!(out, "{} nodes, {} deep, {} bytes", tree.node_count(), tree.depth(), tree.bytes())?;
    let ray = Ray::new(DVec3::new(-5.0, 3.0, 7.0), DVec3::X);
    let mut candidates = Vec::new();
    tree.visit_leaves(&ray, |leaf| {
        candidates.extend_from_slice(leaf);
        // Nothing nearer than this would count: the ray is followed to its end.
        ray.t_max
    });
    // A primitive that several leaves share may come more than once.
    candidates.dedup();
    writeln!(out, "along the ray, near before far: {candidates:?}")?;
    Ok(())
}
