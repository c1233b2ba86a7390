//! Layers beside the picture.

use super::*;
use crate::render::passes::*;

fn all_passes(world: &World) -> Vec<Pass> {
    select(["all"], world.lights()).unwrap()
}

/// The scene with a second light and a mirror, so that every term is somewhere.
fn rich() -> Scene {
    let mut scene = scene();
    scene.add_light(DVec3::new(-5.0, 3.0, 2.0), Rgb::new(20.0, 60.0, 40.0));
    let mirror = scene.add_material(Material {
        reflect: Rgb::new(0.8, 0.7, 0.6),
        specular: Rgb::grey(0.1),
        shininess: 20.0,
        ..Material::named("mirror")
    });
    let at = Transform::scale(DVec3::splat(0.5)).then(Transform::translate(DVec3::new(-1.0, 1.0, 3.0)));
    scene.add(Node::shape("mirror", Shape::Sphere).with_material(mirror).with_transform(at));
    scene
}

fn passes_of(scene: &Scene, options: &CompileOptions, wanted: &[&str], scale: f32) -> PassRender {
    let world = World::compile(scene, options).unwrap();
    let passes = select(wanted.iter().copied(), world.lights()).unwrap();
    let control = Control::default();
    render_passes(&world, &scene.camera, &scene.settings, None, &passes, scale, &control).unwrap()
}

fn color(picture: &PassRender, pass: Pass) -> &[[f32; 3]] {
    match picture.layers.iter().find(|layer| layer.pass == pass).map(|layer| &layer.samples) {
        Some(Samples::Color(values)) => values,
        other => panic!("{pass:?} is {other:?}"),
    }
}

/// The sum of layers, in the order given.
fn sum(picture: &PassRender, passes: impl IntoIterator<Item = Pass>) -> Vec<[u32; 3]> {
    let mut sum = vec![[0.0_f32; 3]; picture.render.image.pixels().len()];
    for pass in passes {
        for (sum, part) in sum.iter_mut().zip(color(picture, pass)) {
            sum.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
        }
    }
    sum.into_iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

const TERMS: [Pass; 6] =
    [Pass::Ambient, Pass::Diffuse, Pass::Specular, Pass::Reflection, Pass::Transmission, Pass::Background];
const SOURCES: [Pass; 4] = [Pass::AllAmbient, Pass::AllBackground, Pass::Light(0), Pass::Light(1)];

#[test]
fn terms_and_sources_add_up_to_the_picture_exactly() {
    let scene = rich();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let plain = render(&world, &scene.camera, &scene.settings, None, &Control::default()).unwrap();
    for scale in [1.0, 0.37] {
        let picture = passes_of(&scene, &CompileOptions::default(), &["all"], scale);
        let beauty = plain.image.map(|pixel| pixel.map(|channel| channel * scale));
        assert_eq!(picture.render, plain);
        let beauty = beauty.pixels().iter().map(|pixel| pixel.map(f32::to_bits)).collect::<Vec<_>>();
        assert!(sum(&picture, TERMS) == beauty, "terms times {scale}");
        assert!(sum(&picture, TERMS.into_iter().rev()) == beauty, "terms backward times {scale}");
        assert!(sum(&picture, SOURCES) == beauty, "sources times {scale}");
        assert!(sum(&picture, SOURCES.into_iter().rev()) == beauty, "sources backward times {scale}");
        for pass in TERMS.into_iter().chain(SOURCES) {
            assert!(
                color(&picture, pass).iter().flatten().any(|&channel| channel > 0.0),
                "{pass:?} is black"
            );
        }
    }
}

#[test]
fn a_light_has_what_the_picture_has_by_it_alone() {
    let scene = rich();
    let picture = passes_of(&scene, &CompileOptions::default(), &["lights"], 1.0);
    let alone = |change: fn(&mut Scene)| {
        let mut scene = rich();
        (scene.ambient, scene.background) = (Rgb::BLACK, Rgb::BLACK);
        scene.lights.iter_mut().for_each(|light| light.intensity = Rgb::BLACK);
        change(&mut scene);
        let world = World::compile(&scene, &CompileOptions::default()).unwrap();
        render(&world, &scene.camera, &scene.settings, None, &Control::default()).unwrap().image
    };
    let expected = [
        alone(|scene| scene.ambient = rich().ambient),
        alone(|scene| scene.background = rich().background),
        alone(|scene| scene.lights[0].intensity = rich().lights[0].intensity),
        alone(|scene| scene.lights[1].intensity = rich().lights[1].intensity),
    ];
    for (pass, expected) in SOURCES.into_iter().zip(&expected) {
        let pixels = color(&picture, pass).iter().zip(expected.pixels()).zip(picture.render.image.pixels());
        for ((found, expected), whole) in pixels {
            for channel in 0..3 {
                // Rounded to the whole pixel's last place.
                let error = (found[channel] - expected[channel]).abs();
                assert!(error <= whole[channel] * f32::EPSILON, "{pass:?}: {found:?} is not {expected:?}");
            }
        }
    }
}

#[test]
fn layers_are_identical_for_any_threads_tiles_accelerator_and_company() {
    let scene = rich();
    let reference = passes_of(&scene, &CompileOptions::default(), &["all"], 1.0);
    for threads in [1, 3] {
        let other =
            with_threads(threads, || passes_of(&scene, &CompileOptions::default(), &["all"], 1.0)).unwrap();
        assert!(other == reference, "{threads} threads");
    }
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let passes = all_passes(&world);
    for tile_size in [5, 1000] {
        let control = Control { tile_size, ..Control::default() };
        let other = render_passes(&world, &scene.camera, &scene.settings, None, &passes, 1.0, &control);
        assert!(other.unwrap() == reference, "tiles of {tile_size}");
    }
    for accelerator in Accelerator::ALL {
        let options = CompileOptions { accelerator, ..CompileOptions::default() };
        let other = passes_of(&scene, &options, &["all"], 1.0);
        for (layer, expected) in other.layers.iter().zip(&reference.layers) {
            // What a structure costs is its own.
            assert!(layer == expected || layer.pass == Pass::Cost, "{:?} of {accelerator:?}", layer.pass);
        }
    }
    for layer in &reference.layers {
        let control = Control::default();
        let alone = render_passes(&world, &scene.camera, &scene.settings, None, &[layer.pass], 1.0, &control)
            .unwrap();
        assert!(alone.layers[0] == *layer, "{:?} alone", layer.pass);
    }
}

#[test]
fn a_region_has_the_layers_of_the_whole() {
    let scene = rich();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let whole = passes_of(&scene, &CompileOptions::default(), &["all"], 1.0);
    let region = Region { x: 13, y: 9, width: 21, height: 17 };
    let control = Control { tile_size: 8, ..Control::default() };
    let passes = all_passes(&world);
    let part = render_passes(&world, &scene.camera, &scene.settings, Some(region), &passes, 1.0, &control);
    let part = part.unwrap();
    let width = scene.settings.width as usize;
    let places = (0..region.height as usize).flat_map(|y| (0..region.width as usize).map(move |x| (x, y)));
    for (index, (x, y)) in places.enumerate() {
        let place = (y + region.y as usize) * width + x + region.x as usize;
        for (part, whole) in part.layers.iter().zip(&whole.layers) {
            let same = match (&part.samples, &whole.samples) {
                (Samples::Color(a), Samples::Color(b)) | (Samples::Vector(a), Samples::Vector(b)) => {
                    a[index] == b[place]
                }
                (Samples::Coordinates(a), Samples::Coordinates(b)) => a[index] == b[place],
                (Samples::Length(a), Samples::Length(b)) | (Samples::Factor(a), Samples::Factor(b)) => {
                    a[index] == b[place]
                }
                (Samples::Id(a), Samples::Id(b)) => a[index] == b[place],
                (Samples::Counts(a), Samples::Counts(b)) => a[index] == b[place],
                _ => false,
            };
            assert!(same, "{:?} at {x},{y}", part.pass);
        }
    }
}

#[test]
fn occlusion_is_the_picture_of_it_alone() {
    let scene = rich();
    let mut dark = rich();
    dark.ambient = Rgb::BLACK;
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let expected =
        render_occlusion(&world, &scene.camera, &scene.settings, None, &Control::default()).unwrap();
    let expected = expected.image.pixels().iter().map(|pixel| pixel[0]).collect::<Vec<_>>();
    for scene in [scene, dark] {
        let picture = passes_of(&scene, &CompileOptions::default(), &["ao"], 1.0);
        assert_eq!(
            picture.layers,
            [Layer { pass: Pass::Occlusion, samples: Samples::Factor(expected.clone()) }]
        );
    }
}

#[test]
fn what_is_seen_is_what_features_tell_of_the_centre() {
    let scene = rich();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let picture = passes_of(&scene, &CompileOptions::default(), &["all"], 1.0);
    let Settings { width, height, .. } = scene.settings;
    let layer = |pass: Pass| &picture.layers.iter().find(|layer| layer.pass == pass).unwrap().samples;
    let backward = scene.camera.frame().unwrap()[2];
    let (mut surfaces, mut misses) = (0, 0);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let place = (y * width + x) as usize;
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let expected = feature_at(&world, &scene.camera, width, height, x, y).unwrap();
        let number = |pass| match layer(pass) {
            Samples::Length(values) => values[place],
            Samples::Id(values) => values[place] as f32,
            other => panic!("{other:?}"),
        };
        let vector = |pass| match layer(pass) {
            Samples::Vector(values) => values[place],
            other => panic!("{other:?}"),
        };
        let Some(expected) = expected else {
            misses += 1;
            assert_eq!((number(Pass::Depth), number(Pass::Distance)), (f32::INFINITY, f32::INFINITY));
            assert_eq!((number(Pass::ObjectId), number(Pass::MaterialId)), (0.0, 0.0));
            assert_eq!(vector(Pass::Normal), [0.0; 3]);
            continue;
        };
        surfaces += 1;
        let depth = (scene.camera.eye - expected.point).dot(backward);
        assert!((f64::from(number(Pass::Depth)) - depth).abs() < 1e-6 * depth);
        assert_eq!(number(Pass::Distance), expected.distance as f32);
        assert_eq!(vector(Pass::Position), expected.point.as_vec3().to_array());
        assert_eq!(vector(Pass::Normal), expected.shading_normal.as_vec3().to_array());
        assert_eq!(vector(Pass::GeometricNormal), expected.geometric_normal.as_vec3().to_array());
        assert_eq!(number(Pass::ObjectId), (expected.object.index() + 1) as f32);
        assert_eq!(number(Pass::MaterialId), (expected.material.index() + 1) as f32);
    }
    assert!(surfaces > 0 && misses > 0);
}

#[test]
fn rays_of_the_pixels_are_the_rays_of_the_picture() {
    let scene = rich();
    let picture = passes_of(&scene, &CompileOptions::default(), &["cost"], 1.0);
    let Samples::Counts(counts) = &picture.layers[0].samples else { panic!("no counts") };
    assert_eq!(counts.iter().map(|&[rays, ..]| u64::from(rays)).sum::<u64>(), picture.render.rays.total());
}

#[test]
fn trees_look_at_nodes_to_test_fewer_triangles() {
    let scene = rich();
    let totals = |accelerator: Accelerator| {
        let options = CompileOptions { accelerator, ..CompileOptions::default() };
        let picture = passes_of(&scene, &options, &["cost"], 1.0);
        let Samples::Counts(counts) = &picture.layers[0].samples else { panic!("no counts") };
        let total = |place: usize| counts.iter().map(|counts| u64::from(counts[place])).sum::<u64>();
        [total(0), total(1), total(2)]
    };
    let [bvh, kd, none] = [Accelerator::Bvh, Accelerator::KdTree, Accelerator::BruteForce].map(totals);
    assert!(bvh[0] == none[0] && kd[0] == none[0], "{bvh:?} {kd:?} {none:?}");
    assert_eq!(none[1], 0);
    for tree in [bvh, kd] {
        assert!(tree[1] > 0 && tree[2] > 0 && 5 * tree[2] < none[2], "{tree:?} of {none:?}");
    }
}

/// Each ray of a picture of one mesh alone tests all of its triangles, where nothing finds them.
#[test]
fn brute_force_tests_every_triangle_for_every_ray() {
    let mut scene = Scene::new("mesh");
    let mesh = Mesh::new(ball(6, 9)).unwrap();
    let triangles = mesh.triangle_count() as u64;
    scene.add(Node::mesh("mesh", mesh));
    scene.settings = Settings { width: 8, height: 6, ..Settings::default() };
    let options = CompileOptions { accelerator: Accelerator::BruteForce, ..CompileOptions::default() };
    let picture = passes_of(&scene, &options, &["cost"], 1.0);
    let Samples::Counts(counts) = &picture.layers[0].samples else { panic!("no counts") };
    let tested = counts.iter().map(|&[rays, nodes, tested]| (u64::from(rays), nodes, u64::from(tested)));
    assert!(tested.clone().all(|found| found == (1, 0, triangles)), "{:?}", tested.collect::<Vec<_>>());
}

/// A light so bright that its pixels are no `f32`.
#[test]
fn what_was_replaced_by_black_is_in_no_layer() {
    let mut scene = rich();
    scene.settings = Settings { width: 9, height: 7, ..scene.settings };
    scene.lights[0].intensity = Rgb::grey(1e42);
    let picture = passes_of(&scene, &CompileOptions::default(), &["terms", "lights"], 1.0);
    assert!(picture.render.rays.replaced > 0);
    let beauty =
        picture.render.image.pixels().iter().map(|pixel| pixel.map(f32::to_bits)).collect::<Vec<_>>();
    assert_eq!(sum(&picture, TERMS), beauty);
    assert_eq!(sum(&picture, SOURCES), beauty);
}

#[test]
fn more_layers_than_memory_are_refused_before_any_is_made() {
    let mut scene = rich();
    for _ in 0..2000 {
        scene.add_light(DVec3::Y, Rgb::WHITE);
    }
    scene.settings = Settings { width: 2000, height: 1000, ..scene.settings };
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let (passes, control) = (all_passes(&world), Control::default());
    let refused = render_passes(&world, &scene.camera, &scene.settings, None, &passes, 1.0, &control);
    assert!(matches!(refused, Err(RenderError::Layers { bytes }) if bytes > MAX_LAYER_BYTES));
}

#[test]
fn passes_are_cancelled_as_a_picture_is() {
    let scene = rich();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let control = Control::default();
    control.cancel.cancel();
    let passes = all_passes(&world);
    let cancelled = render_passes(&world, &scene.camera, &scene.settings, None, &passes, 1.0, &control);
    assert_eq!(cancelled, Err(RenderError::Cancelled));
}
