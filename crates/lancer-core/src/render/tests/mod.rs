//! Pictures: the same bytes whatever traces them, and the parts of one.

mod features;
mod occlusion;
mod passes;
mod switches;

use super::*;
use crate::Rgb;
use crate::accel::{Accelerator, KdSettings};
use crate::camera::Camera;
use crate::geometry::{DVec3, Transform};
use crate::integrator::{Silent, Whitted};
use crate::mesh::Mesh;
use crate::sampling::Key;
use crate::scene::{AmbientOcclusion, Material, Node, Scene, Settings, Shape};
use crate::simd::InstructionSet;
use crate::testing::ball;
use crate::world::{CompileOptions, Media, World};

/// Every kind of ray over every kind of geometry.
fn scene() -> Scene {
    let mut scene = Scene::new("all kinds");
    scene.camera = Camera { eye: DVec3::new(1.0, 2.0, 7.0), target: DVec3::Y * 0.7, ..Camera::default() };
    scene.ambient = Rgb::grey(0.3);
    scene.background = Rgb::new(0.2, 0.3, 0.5);
    scene.add_light(DVec3::new(4.0, 6.0, 5.0), Rgb::grey(150.0));
    scene.settings = Settings {
        width: 61,
        height: 47,
        samples: 2,
        depth: 4,
        ao: AmbientOcclusion { samples: 8, distance: 1.5 },
        ..Settings::default()
    };
    let glass = scene.add_material(Material {
        diffuse: Rgb::grey(0.1),
        reflect: Rgb::grey(0.2),
        transmit: Rgb::grey(0.7),
        ..Material::named("glass")
    });
    let place = |x: f64, z: f64| Transform::translate(DVec3::new(x, 1.0, z));
    scene.add(Node::shape("floor", Shape::Plane));
    scene.add(Node::shape("glass", Shape::Sphere).with_material(glass).with_transform(place(0.5, 1.5)));
    scene.add(
        Node::shape("cube", Shape::Cube)
            .with_transform(Transform::rotate(DVec3::Y, 30.0).then(place(-2.0, 0.0))),
    );
    let mesh = scene.insert(Node::mesh("mesh", Mesh::new(ball(10, 20)).unwrap()));
    for i in 0..3 {
        scene.add(Node::group("copy", [mesh]).with_transform(place(2.0 - f64::from(i), -2.0)));
    }
    scene
}

fn picture(options: &CompileOptions, region: Option<Region>, tile_size: u32) -> Render {
    let scene = scene();
    let world = World::compile(&scene, options).unwrap();
    let control = Control { tile_size, ..Control::default() };
    render(&world, &scene.camera, &scene.settings, region, &control).unwrap()
}

fn bits(render: &Render) -> Vec<[u32; 3]> {
    render.image.pixels().iter().map(|pixel| pixel.map(f32::to_bits)).collect()
}

#[test]
fn image_is_identical_for_any_threads_tiles_and_accelerator() {
    let reference = picture(&CompileOptions::default(), None, 32);
    assert!(reference.image.pixels().iter().flatten().all(|channel| channel.is_finite()));
    for threads in [1, 2, 8] {
        let other = with_threads(threads, || picture(&CompileOptions::default(), None, 32)).unwrap();
        assert_eq!(bits(&other), bits(&reference), "{threads} threads");
        assert_eq!(other.rays, reference.rays, "{threads} threads");
    }
    for tile_size in [1, 7, 1000] {
        let other = picture(&CompileOptions::default(), None, tile_size);
        assert_eq!(bits(&other), bits(&reference), "tiles of {tile_size}");
    }
    for kd in [KdSettings { leaf: Some(1), depth: None }, KdSettings { leaf: Some(50), depth: Some(4) }] {
        let other = picture(
            &CompileOptions { accelerator: Accelerator::KdTree, kd, ..CompileOptions::default() },
            None,
            32,
        );
        assert_eq!(bits(&other), bits(&reference), "{kd:?}");
    }
    for accelerator in Accelerator::ALL {
        let options = CompileOptions { accelerator, ..CompileOptions::default() };
        assert_eq!(bits(&picture(&options, None, 32)), bits(&reference), "{accelerator:?}");
    }
}

#[test]
fn image_is_identical_for_every_instruction_set_of_this_processor() {
    let options = CompileOptions { accelerator: Accelerator::BruteForce, ..CompileOptions::default() };
    let reference = bits(&picture(&options, None, 32));
    for instructions in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
        let options = CompileOptions { instructions: Some(instructions), ..CompileOptions::default() };
        assert_eq!(bits(&picture(&options, None, 32)), reference, "{instructions:?}");
    }
}

#[test]
fn a_region_has_the_pixels_of_the_whole() {
    let whole = picture(&CompileOptions::default(), None, 32);
    let region = Region { x: 13, y: 21, width: 17, height: 5 };
    let part = picture(&CompileOptions::default(), Some(region), 4);
    assert_eq!((part.image.width(), part.image.height()), (17, 5));
    for (x, y) in (0..17).flat_map(|x| (0..5).map(move |y| (x, y))) {
        assert_eq!(part.image.pixel(x, y), whole.image.pixel(x + 13, y + 21));
    }
}

#[test]
fn regions_that_leave_the_image_are_refused() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    for (x, y, width, height) in [(0, 0, 0, 1), (60, 0, 2, 1), (0, 47, 1, 1), (u32::MAX, 0, 2, 1)] {
        let region = Region { x, y, width, height };
        let result = render(&world, &scene.camera, &scene.settings, Some(region), &Control::default());
        assert_eq!(result, Err(RenderError::Region { region, width: 61, height: 47 }));
    }
}

#[test]
fn a_pixel_is_the_mean_of_its_subpixels() {
    let mut scene = scene();
    scene.settings.ao.samples = 0;
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let of = |settings: &Settings| {
        render(&world, &scene.camera, settings, None, &Control::default()).unwrap().image
    };
    let coarse = of(&Settings { samples: 3, ..scene.settings });
    let fine = of(&Settings { samples: 1, width: 61 * 3, height: 47 * 3, ..scene.settings });
    for (x, y) in (0..61).flat_map(|x| (0..47).map(move |y| (x, y))) {
        for channel in 0..3 {
            let subpixels = (0..3).flat_map(|j| (0..3).map(move |i| (3 * x + i, 3 * y + j)));
            let mean = subpixels.map(|(x, y)| f64::from(fine.pixel(x, y)[channel])).sum::<f64>() / 9.0;
            let found = f64::from(coarse.pixel(x, y)[channel]);
            assert!((found - mean).abs() < 1e-5 * mean.max(1.0), "pixel {x},{y}: {found} is not {mean}");
        }
    }
}

#[test]
fn pixels_are_sums_in_the_order_of_their_subpixels_whichever_are_traced_together() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let media = Media::around(&world, scene.camera.eye);
    let region = Region { x: 25, y: 20, width: 7, height: 5 };
    let projection = scene.camera.project(61, 47).unwrap();
    for samples in [1, 2, 3, 5] {
        let settings = Settings { samples, ..scene.settings };
        let found = render(&world, &scene.camera, &settings, Some(region), &Control::default()).unwrap();
        let integrator = Whitted::new(&world, &settings);
        for (x, y) in (0..7).flat_map(|x| (0..5).map(move |y| (x, y))) {
            let mut sum = Rgb::BLACK;
            for subpixel in 0..samples * samples {
                let center = |i: u32| (f64::from(i) + 0.5) / f64::from(samples);
                let (across, down) = (center(subpixel % samples), center(subpixel / samples));
                let ray = projection.ray(f64::from(x + 25) + across, f64::from(y + 20) + down);
                let key = Key::camera(x + 25, y + 20, subpixel);
                let (mut scratch, mut counts) = Default::default();
                sum += integrator.radiance(ray, &media, key, &mut scratch, &mut counts, &mut Silent);
            }
            let mean = (sum * (1.0 / f64::from(samples * samples))).to_array().map(|channel| channel as f32);
            assert_eq!(found.image.pixel(x, y), mean, "pixel {x},{y} of {samples} x {samples} subpixels");
        }
    }
}

#[test]
fn a_cancelled_render_ends_without_a_picture() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let cancel = CancelToken::default();
    let stop = cancel.clone();
    let control = Control { cancel, on_tile: &|_, _| stop.cancel(), tile_size: 4 };
    let result = render(&world, &scene.camera, &scene.settings, None, &control);
    assert_eq!(result, Err(RenderError::Cancelled));
}

#[test]
fn no_tile_is_handed_out_after_the_cancel() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let cancel = CancelToken::default();
    let (stop, tiles) = (cancel.clone(), std::sync::atomic::AtomicU32::new(0));
    let on_tile = |_: &Tile, _: &crate::integrator::RayCounts| {
        stop.cancel();
        tiles.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    };
    let control = Control { cancel, on_tile: &on_tile, tile_size: 4 };
    let alone = with_threads(1, || render(&world, &scene.camera, &scene.settings, None, &control));
    assert_eq!(alone.unwrap(), Err(RenderError::Cancelled));
    assert_eq!(tiles.into_inner(), 1);
}

#[test]
fn tiles_cover_the_image_once_and_count_all_rays() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let seen = std::sync::Mutex::new((vec![0_u32; 61 * 47], 0_u64));
    let on_tile = |tile: &Tile, counts: &crate::integrator::RayCounts| {
        let mut seen = seen.lock().unwrap();
        for (x, y) in (0..tile.width).flat_map(|x| (0..tile.height).map(move |y| (x, y))) {
            seen.0[((tile.y + y) * 61 + tile.x + x) as usize] += 1;
        }
        seen.1 += counts.total();
    };
    let control = Control { on_tile: &on_tile, tile_size: 10, ..Control::default() };
    let render = render(&world, &scene.camera, &scene.settings, None, &control).unwrap();
    let (pixels, rays) = seen.into_inner().unwrap();
    assert!(pixels.iter().all(|&times| times == 1));
    assert_eq!(rays, render.rays.total());
    assert_eq!(render.rays.primary, 61 * 47 * 4);
}

#[test]
fn one_pixel_makes_an_image_and_absurd_sizes_are_refused_before_anything_is_allocated() {
    let scene = scene();
    let world = World::compile(&scene, &CompileOptions::default()).unwrap();
    let of = |width: u32, height: u32| {
        let settings = Settings { width, height, ..scene.settings };
        render(&world, &scene.camera, &settings, None, &Control::default())
    };
    assert!(of(1, 1).is_ok());
    for (width, height) in [(0, 1), (1, 0), (65_535, 65_535), (u32::MAX, u32::MAX), (65_536, 1)] {
        assert!(matches!(of(width, height), Err(RenderError::Settings(_))), "{width} x {height}");
    }
}

/// No light leaks, whether the room is one shape or six slabs that touch.
#[test]
fn no_light_enters_a_closed_room() {
    let slab = |axis: usize, sign: f64| {
        let mut scale = DVec3::splat(2.0);
        scale[axis] = 0.5;
        let mut place = DVec3::ZERO;
        place[axis] = sign * 1.5;
        Transform::scale(scale).then(Transform::translate(place))
    };
    let slabs = (0..3).flat_map(|axis| [slab(axis, 1.0), slab(axis, -1.0)]).collect::<Vec<_>>();
    for (size, distance) in [(1.0, 0.0), (1e-3, 1e4), (1e3, 1e4)] {
        for walls in [vec![Transform::IDENTITY], slabs.clone()] {
            let place = Transform::rotate(DVec3::new(1.0, 2.0, 3.0), 40.0)
                .then(Transform::scale(DVec3::splat(size)))
                .then(Transform::translate(DVec3::new(0.6, 0.0, 0.8) * distance));
            let mut scene = Scene::new("room");
            scene.background = Rgb::grey(1e9);
            for wall in walls {
                scene.add(Node::shape("wall", Shape::Cube).with_transform(wall.then(place)));
            }
            for direction in [DVec3::X, DVec3::NEG_Y, DVec3::new(1.0, 1.0, 1.0), DVec3::new(-1.0, 2.0, 0.1)] {
                scene.add_light(place.point(direction * 9.0), Rgb::grey(1e12));
            }
            scene.camera = Camera {
                eye: place.point(DVec3::new(0.3, 0.2, 0.9)),
                target: place.point(DVec3::new(-0.2, -0.3, -1.0)),
                up: DVec3::Y,
                fov: 120.0,
            };
            let world = World::compile(&scene, &CompileOptions::default()).unwrap();
            let settings = Settings { width: 200, height: 200, depth: 0, ..Settings::default() };
            let image = render(&world, &scene.camera, &settings, None, &Control::default()).unwrap().image;
            let lit = image.pixels().iter().filter(|pixel| **pixel != [0.0; 3]).count();
            assert_eq!(lit, 0, "size {size}, distance {distance}, {} walls", scene.roots().len());
        }
    }
}
