//! From a ray to the leaves that it crosses, near before far.
//!
//! Every decision is conservative: distances to planes are widened by a bound on their rounding, and on that of
//! the test that will decide the hit, so that a tree never hides what brute force would find.

use super::KdTree;
use super::node::Kind;
use crate::geometry::error::UNIT_ROUNDOFF;
use crate::geometry::{DVec3, Ray};
use arrayvec::ArrayVec;

/// A ray made ready for a tree.
struct Crossing {
    origin: [f64; 3],
    inverse: [f64; 3],
    /// By how much t may be wrong at a plane of each axis.
    slack: [f64; 3],
}

/// A subtree to visit later, and the stretch of the ray inside of it.
#[derive(Clone, Copy)]
struct Pending {
    node: u32,
    enter: f64,
    exit: f64,
}

/// Rounded operations between a ray and a plane, or a triangle beside it. More only visits a few more leaves.
const SLACK_OPERATIONS: f64 = 64.0;

/// A direction's least component. It keeps 0 * infinity out: where the origin lies in a plane and the
/// direction along it, the slack is then huge, and both sides are visited.
const LEAST_COMPONENT: f64 = 1e-290;

impl Crossing {
    fn new(ray: &Ray, tree: &KdTree) -> Self {
        let away_from_zero = |x: f64| if x.abs() < LEAST_COMPONENT { LEAST_COMPONENT.copysign(x) } else { x };
        let d = ray.direction;
        let inverse = DVec3::new(away_from_zero(d.x), away_from_zero(d.y), away_from_zero(d.z)).recip();
        let magnitude = ray.origin.abs() + tree.bounds.to_bounds().magnitude();
        let slack = magnitude * inverse.abs() * (SLACK_OPERATIONS * UNIT_ROUNDOFF);
        Self { origin: ray.origin.to_array(), inverse: inverse.to_array(), slack: slack.to_array() }
    }

    /// The stretch of the ray in the tree's box, if there is one.
    fn clip(&self, tree: &KdTree, t_max: f64) -> Option<(f64, f64)> {
        let bounds = tree.bounds.to_bounds();
        let [origin, inverse, slack] = [self.origin, self.inverse, self.slack].map(DVec3::from_array);
        let a = (bounds.min - origin) * inverse;
        let b = (bounds.max - origin) * inverse;
        let enter = (a.min(b) - slack).max_element().max(0.0);
        let exit = (a.max(b) + slack).min_element().min(t_max);
        (enter <= exit).then_some((enter, exit))
    }
}

impl KdTree {
    /// Calls `visit` with the primitives of each leaf that the ray crosses, near before far, until nothing nearer
    /// than what it returned is left.
    ///
    /// `visit` returns the t up to which hits still count: `ray.t_max` or the nearest hit's, or
    /// `f64::NEG_INFINITY` to end. Leaves that begin exactly there are still visited. A primitive that spans
    /// several leaves may come several times; some that the ray misses may come too.
    #[inline]
    pub fn visit_leaves(&self, ray: &Ray, visit: impl FnMut(&[u32]) -> f64) {
        self.visit_steps_and_leaves(ray, || (), visit);
    }

    /// As [`KdTree::visit_leaves`], and calls `step` for each inner node on the way. Steps and primitives in leaves are what
    /// the surface area heuristic weighs against each other, so that whoever counts them sees whether it is right.
    #[inline]
    pub fn visit_steps_and_leaves(
        &self,
        ray: &Ray,
        mut step: impl FnMut(),
        mut visit: impl FnMut(&[u32]) -> f64,
    ) {
        let crossing = Crossing::new(ray, self);
        let Some((mut enter, mut exit)) = crossing.clip(self, ray.t_max) else { return };
        let mut t_max = ray.t_max;
        let mut node = 0_u32;
        // One entry a level at most, and no tree is deeper.
        let mut pending = ArrayVec::<Pending, { Self::MAX_DEPTH as usize }>::new();
        loop {
            match self.nodes[node as usize].kind() {
                Kind::Inner { axis, position, above } => {
                    step();
                    let t = (f64::from(position) - crossing.origin[axis]) * crossing.inverse[axis];
                    let (earliest, latest) = (t - crossing.slack[axis], t + crossing.slack[axis]);
                    let rising = crossing.inverse[axis] > 0.0;
                    let (near, far) = if rising { (node + 1, above) } else { (above, node + 1) };
                    if earliest > exit {
                        node = near;
                    } else if latest < enter {
                        node = far;
                    } else {
                        pending.push(Pending { node: far, enter: earliest.max(enter), exit });
                        node = near;
                        exit = latest.min(exit);
                    }
                }
                Kind::Leaf { first, count } => {
                    if count > 0 {
                        t_max = visit(&self.references[first as usize..][..count as usize]);
                    }
                    loop {
                        let Some(next) = pending.pop() else { return };
                        if next.enter <= t_max {
                            (node, enter, exit) = (next.node, next.enter, next.exit.min(t_max));
                            break;
                        }
                    }
                }
            }
        }
    }
}
