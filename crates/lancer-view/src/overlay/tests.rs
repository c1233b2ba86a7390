use super::*;
use lancer_core::geometry::Transform;
use lancer_core::render::{CancelToken, render_features};
use lancer_core::scene::{Node, Scene, Shape};
use lancer_core::world::CompileOptions;
use proptest::prelude::*;

const NOTHING: OverlayOptions = OverlayOptions {
    grid: false,
    axes: false,
    lights: false,
    bounds: false,
    tree_level: None,
    interest: false,
};

/// A view from (0, 0, 10) of a unit sphere at the origin.
fn ball() -> (World, Camera) {
    let mut scene = Scene::new("a ball");
    scene.add(Node::shape("ball", Shape::Sphere));
    world_of(&scene)
}

fn world_of(scene: &Scene) -> (World, Camera) {
    let camera = Camera { eye: DVec3::Z * 10.0, ..Camera::default() };
    (World::compile(scene, &CompileOptions::default()).unwrap(), camera)
}

fn features(world: &World, camera: &Camera, width: u32, height: u32) -> Features {
    render_features(world, camera, width, height, &CancelToken::default()).unwrap()
}

fn input<'a>(
    world: &'a World,
    features: &'a Features,
    camera: &'a Camera,
    options: &'a OverlayOptions,
) -> OverlayInput<'a> {
    OverlayInput {
        world,
        features,
        camera,
        width: features.width(),
        height: features.height(),
        options,
        selected: &[],
        selected_light: None,
        interest: DVec3::ZERO,
        pixels_per_point: 1.0,
        dark: true,
    }
}

fn alpha(image: &OverlayImage, x: u32, y: u32) -> u8 {
    image.pixels[(y * image.width + x) as usize][3]
}

/// One line, 2 pixels wide.
fn line(camera: &Camera, features: &Features, [width, height]: [u32; 2], a: DVec3, b: DVec3) -> OverlayImage {
    let lens = Lens::new(camera, width, height).unwrap();
    let surfaces = Surfaces::new(features, camera, width, height).unwrap();
    let mut pen = Pen { canvas: Canvas::new(width, height), lens, surfaces, scale: 1.0 };
    pen.draw(Style { color: [255; 3], casing: None, alpha: 1.0, width: 2.0 }, |strokes| strokes.line(a, b));
    pen.canvas.into_image()
}

#[test]
fn a_line_behind_a_sphere_is_faint_exactly_where_the_sphere_covers_it() {
    let (world, camera) = ball();
    let features = features(&world, &camera, 301, 201);
    let (a, b) = (DVec3::new(-9.0, 0.0, -2.0), DVec3::new(9.0, 0.0, -2.0));
    let image = line(&camera, &features, [301, 201], a, b);
    for x in 0..301 {
        let covered = features.object(x, 100).is_some();
        let expected = if covered { 50..70 } else { 255..256 };
        assert!(expected.contains(&i32::from(alpha(&image, x, 100))), "column {x}");
        assert_eq!(alpha(&image, x, 90), 0);
    }
}

#[test]
fn lines_before_a_sphere_and_on_a_floor_are_full_at_any_resolution_of_what_is_seen() {
    let mut scene = Scene::new("a ball on a floor");
    scene.add(Node::shape("ball", Shape::Sphere));
    scene.add(Node::shape("floor", Shape::Plane).with_transform(Transform::translate(DVec3::NEG_Y)));
    let (world, camera) = world_of(&scene);
    let lines = [
        (DVec3::new(-2.0, 0.2, 2.0), DVec3::new(2.0, 0.2, 2.0)),
        (DVec3::new(1.5, -1.0, 4.0), DVec3::new(9.0, -1.0, -30.0)),
        (DVec3::new(-2.0, -1.0, 1.5), DVec3::new(2.0, -1.0, 1.5)),
    ];
    let projection = camera.project(300, 200).unwrap();
    for features in [1, 4].map(|coarse| features(&world, &camera, 300 / coarse, 200 / coarse)) {
        for (a, b) in lines {
            let image = line(&camera, &features, [300, 200], a, b);
            for step in 1..100 {
                let (x, y, _) = projection.pixel_of(a + (b - a) * (f64::from(step) / 100.0)).unwrap();
                assert!(alpha(&image, x as u32, y as u32) > 200, "faint at {x}, {y}");
            }
        }
    }
}

#[test]
fn an_axis_is_where_the_camera_says() {
    let (world, _) = ball();
    let camera = Camera { eye: DVec3::new(3.0, 4.0, 6.0), ..Camera::default() };
    let features = features(&world, &camera, 400, 300);
    let options = OverlayOptions { axes: true, ..NOTHING };
    let image = draw(&input(&world, &features, &camera, &options));
    let projection = camera.project(400, 300).unwrap();
    for (axis, channel) in [(DVec3::X, 0), (DVec3::Y, 1), (DVec3::Z, 2)] {
        // The sphere ends at 1, and the axis at 0.3 times the distance.
        for distance in [1.1, 1.5, 2.0, 2.3] {
            let (x, y, _) = projection.pixel_of(axis * distance).unwrap();
            let pixel = image.pixels[y as usize * 400 + x as usize];
            assert!(pixel[3] > 120, "nothing of {axis} at {x}, {y}");
            assert_eq!(pixel[..3].iter().max(), Some(&pixel[channel]), "{axis} is {pixel:?}");
        }
    }
}

/// In pixels of 300 rows. The rays that touch the sphere leave the eye at an angle whose sine is 1/10.
fn radius_of_the_ball(camera: &Camera) -> f64 {
    Lens::new(camera, 300, 300).unwrap().pixels * 0.1 / 0.99_f64.sqrt()
}

#[test]
fn the_outline_surrounds_a_disc_and_nothing_else() {
    let (world, camera) = ball();
    let features = features(&world, &camera, 300, 300);
    let selected = [features.object(150, 150).unwrap()];
    let image = draw(&OverlayInput { selected: &selected, ..input(&world, &features, &camera, &NOTHING) });
    let radius = radius_of_the_ball(&camera);
    for (index, pixel) in image.pixels.iter().enumerate() {
        let (x, y) = (index % 300, index / 300);
        let from_middle = DVec2::new(x as f64 + 0.5 - 150.0, y as f64 + 0.5 - 150.0).length();
        match (from_middle - radius).abs() {
            off if off < 0.5 => assert!(pixel[3] > 180, "a gap at {x}, {y}: {pixel:?}"),
            off if off > 3.5 => assert_eq!(pixel[3], 0, "too far at {x}, {y}"),
            _ => {}
        }
    }
}

#[test]
fn the_outline_of_coarse_features_is_at_the_same_place() {
    let (world, camera) = ball();
    let coarse = features(&world, &camera, 75, 75);
    let selected = [coarse.object(37, 37).unwrap()];
    let input = input(&world, &coarse, &camera, &NOTHING);
    let image = draw(&OverlayInput { selected: &selected, width: 300, height: 300, ..input });
    let radius = radius_of_the_ball(&camera);
    let strongest = (150..300).max_by_key(|&x| alpha(&image, x, 150)).unwrap();
    assert!((f64::from(strongest) + 0.5 - 150.0 - radius).abs() < 4.0, "{strongest} for {radius}");
}

#[test]
fn boxes_lights_and_the_point_of_interest_are_drawn_where_they_are() {
    let mut scene = Scene::new("a ball and a light");
    scene.add(Node::shape("ball", Shape::Sphere));
    scene.add_light(DVec3::new(2.0, 2.0, 0.0), lancer_core::Rgb::WHITE);
    let (world, camera) = world_of(&scene);
    let features = features(&world, &camera, 400, 400);
    let selected = [features.object(200, 200).unwrap()];
    let projection = camera.project(400, 400).unwrap();
    let covers = |options: OverlayOptions, point: DVec3, beside: [f64; 2]| {
        let interest = DVec3::new(-1.5, 1.5, 0.0);
        let input =
            OverlayInput { selected: &selected, interest, ..input(&world, &features, &camera, &options) };
        let (x, y, _) = projection.pixel_of(point).unwrap();
        alpha(&draw(&input), (x + beside[0]) as u32, (y + beside[1]) as u32) > 40
    };
    let (edge, stem, interest) =
        (DVec3::new(1.0, 0.9, 1.0), DVec3::new(2.0, 1.0, 0.0), DVec3::new(-1.5, 1.5, 0.0));
    let everything_but = |change: fn(&mut OverlayOptions)| {
        let mut options = OverlayOptions { lights: true, bounds: true, interest: true, ..NOTHING };
        change(&mut options);
        options
    };
    assert!(covers(everything_but(|_| ()), edge, [0.0; 2]));
    assert!(!covers(everything_but(|options| options.bounds = false), edge, [0.0; 2]));
    assert!(covers(everything_but(|_| ()), stem, [0.0; 2]));
    assert!(!covers(everything_but(|options| options.lights = false), stem, [0.0; 2]));
    assert!(covers(everything_but(|_| ()), interest, [5.0, 0.0]));
    assert!(!covers(everything_but(|_| ()), interest, [5.0, 5.0]));
    assert!(!covers(everything_but(|options| options.interest = false), interest, [5.0, 0.0]));
}

#[test]
fn with_nothing_to_show_nothing_is_covered() {
    let (world, camera) = ball();
    let features = features(&world, &camera, 40, 30);
    let image = draw(&input(&world, &features, &camera, &NOTHING));
    assert_eq!(image, OverlayImage { width: 40, height: 30, pixels: vec![[0; 4]; 1200] });
    let invalid = Camera { fov: 0.0, ..camera };
    let options = OverlayOptions { grid: true, ..NOTHING };
    assert_eq!(draw(&input(&world, &features, &invalid, &options)), image);
}

fn coordinates() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -20.0..20.0, 1 => Just(0.0), 1 => -1e9..1e9, 1 => any::<f64>()]
}

fn points() -> impl Strategy<Value = DVec3> {
    (coordinates(), coordinates(), coordinates()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_camera_size_and_point_of_interest_gives_a_sound_picture(
        eye in points(),
        target in points(),
        fov in 0.01..179.9,
        (width, height) in prop_oneof![Just((1, 1)), (1..80_u32, 1..80_u32)],
        pixels_per_point in prop_oneof![Just(1.0), Just(2.0), any::<f32>()],
        interest in points(),
        light in 0..3_usize,
    ) {
        let mut scene = Scene::new("a ball and a floor");
        scene.add(Node::shape("ball", Shape::Sphere));
        scene.add(Node::shape("floor", Shape::Plane));
        scene.add_light(DVec3::new(1.0, 3.0, 2.0), lancer_core::Rgb::WHITE);
        let (world, valid) = world_of(&scene);
        let camera = Camera { eye, target, fov, ..valid };
        let features = features(&world, &valid, width.div_ceil(2), height.div_ceil(3));
        let selected = features.object(0, 0).into_iter().collect::<Vec<_>>();
        let options = OverlayOptions {
            grid: true, axes: true, lights: true, bounds: true, tree_level: Some(0), interest: true
        };
        for dark in [false, true] {
            let image = draw(&OverlayInput {
                width,
                height,
                selected: &selected,
                selected_light: Some(light),
                interest,
                pixels_per_point,
                dark,
                ..input(&world, &features, &camera, &options)
            });
            prop_assert_eq!(image.pixels.len(), width as usize * height as usize);
            // A colour multiplied by alpha is at most alpha, but for rounding.
            prop_assert!(image.pixels.iter().all(|&[r, g, b, a]| r.max(g).max(b) <= a.saturating_add(2)));
        }
    }
}
