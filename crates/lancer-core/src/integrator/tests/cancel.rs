//! The end of a camera ray's tree before it is complete.

use super::*;
use crate::cancel::CancelToken;

/// Cancels when a ray is about to be traced.
struct CancelAt(RayId, CancelToken);

impl Listener for CancelAt {
    fn begin_ray(&mut self, id: RayId, _: RayKind, _: Rgb, _: &Ray) {
        if id == self.0 {
            self.1.cancel();
        }
    }
}

fn cancelled_at(world: &World, settings: &Settings, ray: u32) -> RayCounts {
    let cancel = CancelToken::default();
    let integrator = Whitted::new(world, settings).until(&cancel);
    let mut counts = RayCounts::default();
    let mut listener = CancelAt(RayId(ray), cancel);
    let key = Key::camera(0, 0, 0);
    let scratch = &mut Scratch::default();
    integrator.radiance(DOWN, &Media::default(), key, scratch, &mut counts, &mut listener);
    counts
}

#[test]
fn a_tree_of_reflections_ends_with_the_ray_during_which_it_is_cancelled() {
    let world = world(&facing_mirrors(1.0));
    for ray in [0, 7, 5000] {
        let counts = cancelled_at(&world, &settings(10_000, 0, 1.0), ray);
        assert_eq!((counts.primary, counts.reflection), (1, u64::from(ray)));
    }
}

#[test]
fn no_direction_of_ambient_occlusion_is_traced_after_the_cancel() {
    let world = world(&facing_mirrors(1.0));
    let complete = 10_u64 * (1 << 14) / 2;
    let counts = cancelled_at(&world, &settings(100, 1 << 14, 1.0), 10);
    assert!(counts.ao.abs_diff(complete) <= 10, "{} directions are not those of 10 rays", counts.ao);
}
