use super::*;
use proptest::prelude::*;

const VIEWPORT: DVec2 = DVec2::new(1300.0, 900.0);
const MIDDLE: DVec2 = DVec2::new(650.0, 450.0);
const PAN: Gesture = Gesture::Pan;
const DOLLY: Gesture = Gesture::Dolly;
const ROTATE: Gesture = Gesture::Rotate;

fn pixel_of(camera: Camera, point: DVec3) -> DVec2 {
    let (x, y, _) = camera.project(1300, 900).unwrap().pixel_of(point).expect("the point is ahead");
    DVec2::new(x, y)
}

/// The point at a distance behind a pixel.
fn point_at(camera: Camera, pixel: DVec2, distance: f64) -> DVec3 {
    let ray = camera.project(1300, 900).unwrap().ray(pixel.x, pixel.y);
    ray.origin + ray.direction * distance
}

fn drag(navigator: &mut Navigator, gesture: Gesture, by: DVec2) {
    navigator.begin(gesture, MIDDLE, VIEWPORT, None);
    navigator.drag_to(MIDDLE + by);
    navigator.end();
}

fn assert_near(a: DVec3, b: DVec3) {
    assert!((a - b).length() < 1e-12 * (1.0 + a.length()), "{a} is not {b}");
}

#[test]
fn home_is_the_very_camera_that_it_was_given() {
    let home = Camera { eye: DVec3::new(0.3, 2.0, 7.1), fov: 33.3, ..Camera::default() };
    let mut navigator = Navigator::new(home);
    assert_eq!(navigator.camera(), home);
    drag(&mut navigator, ROTATE, DVec2::new(31.0, 7.0));
    assert_ne!(navigator.camera(), home);
    navigator.home();
    assert_eq!((navigator.camera(), navigator.point_of_interest()), (home, home.target));
}

#[test]
fn dragging_right_turns_the_front_to_the_right_and_dragging_down_shows_the_top() {
    let mut navigator = Navigator::new(Camera::default());
    drag(&mut navigator, ROTATE, DVec2::new(450.0, 0.0));
    assert_near(navigator.camera().eye, DVec3::new(-5.0, 0.0, 0.0));
    navigator.home();
    drag(&mut navigator, ROTATE, DVec2::new(0.0, 450.0));
    assert_near(navigator.camera().eye, DVec3::new(0.0, 5.0, 0.0));
    assert_near(navigator.camera().frame().unwrap()[1], DVec3::NEG_Z);
}

#[test]
fn dragging_over_the_pole_and_on_is_one_smooth_turn_that_ends_upside_down() {
    let mut navigator = Navigator::new(Camera::default());
    navigator.begin(ROTATE, MIDDLE, VIEWPORT, None);
    for pixel in 0..=900 {
        let before = navigator.camera().frame().unwrap();
        navigator.drag_to(MIDDLE + DVec2::new(0.0, f64::from(pixel)));
        let after = navigator.camera().frame().unwrap();
        assert_near(after[0], DVec3::X);
        assert!((after[1] - before[1]).length() < 0.004, "the picture jumps at pixel {pixel}");
    }
    assert_near(navigator.camera().eye, DVec3::new(0.0, 0.0, -5.0));
    assert_near(navigator.camera().up, DVec3::NEG_Y);
}

#[test]
fn upside_down_what_is_in_front_still_follows_the_hand() {
    let mut navigator = Navigator::new(Camera::default());
    drag(&mut navigator, ROTATE, DVec2::new(0.0, 900.0));
    let front = navigator.camera().eye.normalize();
    let before = pixel_of(navigator.camera(), front);
    drag(&mut navigator, ROTATE, DVec2::new(20.0, 0.0));
    assert!(pixel_of(navigator.camera(), front).x > before.x);
}

#[test]
fn the_camera_says_the_vertical_as_its_up_except_near_the_poles() {
    let mut navigator = Navigator::new(Camera::default());
    drag(&mut navigator, ROTATE, DVec2::new(123.0, 321.0));
    assert_eq!(navigator.camera().up, DVec3::Y);
    navigator.look_along(Axis::Y, false);
    assert_eq!(navigator.camera().up, DVec3::NEG_Z);
}

#[test]
fn a_picture_that_leans_turns_about_its_own_vertical_and_keeps_leaning() {
    let up = DVec3::new(1.0, 1.0, 0.0).normalize();
    let mut navigator = Navigator::new(Camera { up, ..Camera::default() });
    drag(&mut navigator, ROTATE, DVec2::new(200.0, 100.0));
    assert_near(navigator.camera().up, up);
}

#[test]
fn a_view_from_the_top_turns_about_the_worlds_vertical() {
    let above = Camera { eye: DVec3::new(0.0, 5.0, 0.0), up: DVec3::NEG_Z, ..Camera::default() };
    let mut navigator = Navigator::new(above);
    drag(&mut navigator, ROTATE, DVec2::new(450.0, 0.0));
    assert_near(navigator.camera().eye, above.eye);
    drag(&mut navigator, ROTATE, DVec2::new(0.0, -450.0));
    assert_near(navigator.camera().eye, DVec3::new(-5.0, 0.0, 0.0));
    assert_near(navigator.camera().up, DVec3::Y);
}

#[test]
fn the_seven_keys_of_3d_programs_look_along_the_axes() {
    let mut navigator = Navigator::new(Camera { eye: DVec3::new(3.0, 4.0, 0.0), ..Camera::default() });
    let looks = [
        (Axis::Z, false, DVec3::Z, DVec3::X),
        (Axis::Z, true, DVec3::NEG_Z, DVec3::NEG_X),
        (Axis::X, false, DVec3::X, DVec3::NEG_Z),
        (Axis::X, true, DVec3::NEG_X, DVec3::Z),
        (Axis::Y, false, DVec3::Y, DVec3::X),
        (Axis::Y, true, DVec3::NEG_Y, DVec3::X),
    ];
    for (axis, negative, toward_eye, right) in looks {
        navigator.look_along(axis, negative);
        let [seen_right, _, backward] = navigator.camera().frame().unwrap();
        assert_near(navigator.camera().eye, toward_eye * 5.0);
        assert_near(backward, toward_eye);
        assert_near(seen_right, right);
    }
}

#[test]
fn panning_moves_the_point_of_interest_along() {
    let mut navigator = Navigator::new(Camera::default());
    drag(&mut navigator, PAN, DVec2::new(90.0, -45.0));
    let moved = navigator.camera().eye - Camera::default().eye;
    assert!(moved.x < 0.0 && moved.y < 0.0 && moved.z == 0.0, "{moved}");
    assert_near(navigator.point_of_interest(), moved);
}

#[test]
fn dollying_changes_the_distance_by_a_factor_and_never_arrives() {
    let mut navigator = Navigator::new(Camera::default());
    drag(&mut navigator, DOLLY, DVec2::new(0.0, -300.0));
    assert_near(navigator.camera().eye, DVec3::new(0.0, 0.0, 2.5));
    assert_near(navigator.point_of_interest(), DVec3::ZERO);
    let mut last = 2.5;
    for _ in 0..50 {
        drag(&mut navigator, DOLLY, DVec2::new(0.0, -300.0));
        let distance = navigator.camera().eye.z;
        assert!(distance > 0.0 && distance < 0.51 * last, "{distance} after {last}");
        last = distance;
    }
}

#[test]
fn the_wheel_goes_past_the_point_of_interest_to_what_is_farther_and_takes_that_in_its_place() {
    let mut navigator = Navigator::new(Camera::default());
    let far = DVec3::new(3.0, 1.0, -40.0);
    let at = pixel_of(navigator.camera(), far);
    for _ in 0..80 {
        navigator.wheel(1.0, at, VIEWPORT, Some(far));
    }
    assert!((navigator.camera().eye - far).length() < 1e-3);
    assert_eq!(navigator.point_of_interest(), far);
}

#[test]
fn the_wheel_leaves_a_point_of_interest_that_is_in_view() {
    let mut navigator = Navigator::new(Camera::default());
    navigator.set_point_of_interest(DVec3::new(0.1, 0.2, 0.3));
    let near = DVec3::new(-0.3, 0.4, 1.0);
    let at = pixel_of(navigator.camera(), near);
    for steps in [3.0, 2.5, -9.0, 20.0] {
        navigator.wheel(steps, at, VIEWPORT, Some(near));
        assert_eq!(navigator.point_of_interest(), DVec3::new(0.1, 0.2, 0.3));
    }
}

#[test]
fn wheel_and_keys_amid_a_drag_leave_the_drag_where_it_is() {
    let mut navigator = Navigator::new(Camera::default());
    navigator.begin(ROTATE, MIDDLE, VIEWPORT, None);
    navigator.drag_to(DVec2::new(600.0, 400.0));
    navigator.wheel(2.0, MIDDLE, VIEWPORT, None);
    let after_wheel = navigator.camera();
    navigator.drag_to(DVec2::new(600.0, 400.0));
    assert_near(navigator.camera().eye, after_wheel.eye);
    assert!(navigator.is_active());
}

#[test]
fn scrolling_moves_as_dragging_does() {
    let mut scrolled = Navigator::new(Camera::default());
    let mut dragged = scrolled.clone();
    for gesture in [PAN, ROTATE] {
        scrolled.scroll(gesture, DVec2::new(40.0, 9.0), MIDDLE, VIEWPORT, None);
        drag(&mut dragged, gesture, DVec2::new(40.0, 9.0));
        assert_eq!(scrolled.camera(), dragged.camera());
    }
}

#[test]
fn cameras_points_and_boxes_that_make_no_sense_change_nothing() {
    let mut navigator = Navigator::new(Camera::default());
    navigator.set_camera(Camera { fov: 0.0, ..Camera::default() });
    navigator.set_home(Camera { up: DVec3::ZERO, ..Camera::default() });
    navigator.set_point_of_interest(DVec3::NAN);
    for bounds in [Bounds::EMPTY, Bounds::UNBOUNDED] {
        navigator.frame(bounds, 1.5);
    }
    navigator.frame(Bounds::new(DVec3::ZERO, DVec3::ONE), f64::NAN);
    navigator.wheel(f64::NAN, MIDDLE, VIEWPORT, None);
    navigator.nudge(PAN, f64::INFINITY, 0.0);
    navigator.home();
    assert_eq!(navigator.camera(), Camera::default());
    assert_eq!(Navigator::new(Camera { eye: DVec3::NAN, ..Camera::default() }).camera(), Camera::default());
}

fn points(radius: f64) -> impl Strategy<Value = DVec3> {
    [-radius..radius, -radius..radius, -radius..radius].prop_map(DVec3::from_array)
}

fn pixels() -> impl Strategy<Value = DVec2> {
    (0.0..1300.0, 0.0..900.0).prop_map(|(x, y)| DVec2::new(x, y))
}

/// Cameras from near and far, of all angles, upright and leaning, some of them right above.
fn cameras() -> impl Strategy<Value = Camera> {
    let up = prop_oneof![4 => Just(DVec3::Y), 1 => points(1.0), 1 => Just(DVec3::Z)];
    let offset = prop_oneof![4 => points(20.0), 1 => Just(DVec3::Y * 3.0)];
    let camera = (points(30.0), offset, up, 5.0..150.0).prop_map(|(target, offset, up, fov)| Camera {
        eye: target + offset,
        target,
        up,
        fov,
    });
    camera.prop_filter("a valid camera", |camera| {
        camera.frame().is_ok() && (camera.eye - camera.target).length() > 0.1
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn what_was_grabbed_stays_under_the_cursor(
        camera in cameras(),
        from in pixels(),
        way in prop::collection::vec(pixels(), 1..5),
        distance in 0.1..100.0,
    ) {
        let mut navigator = Navigator::new(camera);
        let grabbed = point_at(camera, from, distance);
        navigator.begin(PAN, from, VIEWPORT, Some(grabbed));
        for to in way {
            navigator.drag_to(to);
            let seen = pixel_of(navigator.camera(), grabbed);
            prop_assert!((seen - to).length() < 1e-6, "at {seen}, the cursor at {to}");
        }
    }

    #[test]
    fn where_nothing_is_grabbed_the_point_of_interests_distance_counts(camera in cameras(), to in pixels()) {
        let mut navigator = Navigator::new(camera);
        navigator.begin(PAN, MIDDLE, VIEWPORT, None);
        navigator.drag_to(to);
        let seen = pixel_of(navigator.camera(), camera.target);
        prop_assert!((seen - to).length() < 1e-6, "at {seen}, the cursor at {to}");
    }

    #[test]
    fn the_wheel_holds_what_is_under_the_cursor_and_is_undone_by_turning_back(
        camera in cameras(),
        at in pixels(),
        distance in 0.5..100.0,
        steps in -10.0..10.0,
    ) {
        let mut navigator = Navigator::new(camera);
        let under = point_at(camera, at, distance);
        navigator.wheel(steps, at, VIEWPORT, Some(under));
        let seen = pixel_of(navigator.camera(), under);
        prop_assert!((seen - at).length() < 1e-6, "at {seen}, the cursor at {at}");
        navigator.wheel(-steps, at, VIEWPORT, Some(under));
        prop_assert!((navigator.camera().eye - camera.eye).length() < 1e-9);
    }

    #[test]
    fn rotation_keeps_the_point_of_interests_distance_and_its_place_in_the_picture(
        camera in cameras(),
        pixel in pixels(),
        distance in 0.5..50.0,
        way in prop::collection::vec(pixels(), 1..5),
    ) {
        let mut navigator = Navigator::new(camera);
        let interest = point_at(camera, pixel, distance);
        navigator.set_point_of_interest(interest);
        prop_assert_eq!(navigator.camera(), camera);
        for to in way {
            navigator.begin(ROTATE, MIDDLE, VIEWPORT, None);
            navigator.drag_to(to);
            let camera = navigator.camera();
            prop_assert!(((camera.eye - interest).length() - distance).abs() < 1e-9);
            prop_assert!((pixel_of(camera, interest) - pixel).length() < 1e-6);
        }
    }

    #[test]
    fn a_drag_back_to_where_it_began_leads_back(
        camera in cameras(),
        gesture in prop::sample::select(vec![PAN, DOLLY, ROTATE]),
        way in prop::collection::vec(pixels(), 1..5),
    ) {
        let mut navigator = Navigator::new(camera);
        navigator.begin(gesture, MIDDLE, VIEWPORT, None);
        for to in way {
            navigator.drag_to(to);
        }
        navigator.drag_to(MIDDLE);
        let back = navigator.camera();
        prop_assert!((back.eye - camera.eye).length() < 1e-9);
        for (a, b) in back.frame().unwrap().into_iter().zip(camera.frame().unwrap()) {
            prop_assert!((a - b).length() < 1e-9);
        }
    }

    #[test]
    fn the_horizon_stays_level_through_any_rotation(way in prop::collection::vec(pixels(), 1..20)) {
        let mut navigator = Navigator::new(Camera::default());
        for to in way {
            drag(&mut navigator, ROTATE, to - MIDDLE);
            prop_assert!(navigator.camera().frame().unwrap()[0].y.abs() < 1e-9);
        }
    }

    #[test]
    fn framing_shows_all_eight_corners_and_no_more_room_than_its_margin(
        camera in cameras(),
        min in points(50.0),
        extent in [1.0..20.0, 1.0..20.0, 1.0..20.0].prop_map(DVec3::from_array),
    ) {
        let bounds = Bounds::of_points([min, min + extent]);
        let mut navigator = Navigator::new(camera);
        navigator.frame(bounds, VIEWPORT.x / VIEWPORT.y);
        let from_middle = |corner| ((pixel_of(navigator.camera(), corner) - MIDDLE) / MIDDLE).abs();
        let reach = bounds.corners().map(from_middle).into_iter().fold(DVec2::ZERO, DVec2::max);
        // At wide angles a box may look smaller than its nearest corner, to which one keeps some distance.
        let least = if camera.fov < 60.0 { 0.94 } else { 0.0 };
        prop_assert!((least..1.0).contains(&reach.max_element()), "the corners reach {reach}");
        let [before, after] = [camera, navigator.camera()].map(|camera| camera.frame().unwrap()[2]);
        prop_assert!((before - after).length() < 1e-9);
    }

    #[test]
    fn no_sequence_of_gestures_makes_an_invalid_camera(
        camera in cameras(),
        acts in prop::collection::vec((0..12_u32, points(1e4), any::<f64>(), points(100.0)), 1..60),
    ) {
        let mut navigator = Navigator::new(camera);
        for (act, place, number, point) in acts {
            let at = place.truncate();
            match act {
                0 => navigator.begin(PAN, at, VIEWPORT, Some(point)),
                1 => navigator.begin(DOLLY, at, VIEWPORT, None),
                2 => navigator.begin(ROTATE, at, DVec2::new(0.0, number), None),
                3 => navigator.drag_to(at),
                4 => navigator.drag_to(DVec2::new(number, place.x)),
                5 => navigator.end(),
                6 => navigator.wheel(place.x, at, VIEWPORT, Some(point)),
                7 => navigator.wheel(number, at, VIEWPORT, None),
                8 => navigator.frame(Bounds::of_points([point, place]), 1.0 + number.abs()),
                9 => navigator.look_along(Axis::Y, place.x < 0.0),
                10 => navigator.set_point_of_interest(point),
                _ => navigator.nudge(ROTATE, place.x, number),
            }
            let frame = navigator.camera().frame();
            prop_assert!(frame.is_ok(), "{:?} after act {act}", frame);
            prop_assert!(navigator.point_of_interest().is_finite());
        }
    }
}
