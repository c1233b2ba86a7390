//! The layers of every built-in scene add up to its picture.

use lancer_core::film::Image;
use lancer_core::render::passes::{Layer, Pass, Samples, render_passes, select};
use lancer_core::render::{Control, render};
use lancer_core::scene::{AmbientOcclusion, Settings};
use lancer_core::world::{CompileOptions, World};
use lancer_gallery::SCENES;

#[test]
fn terms_and_lights_of_every_scene_add_up_to_its_picture_exactly() {
    for builtin in SCENES {
        let scene = builtin.build();
        let ao = AmbientOcclusion { samples: scene.settings.ao.samples.min(2), ..scene.settings.ao };
        let settings = Settings { width: 40, height: 30, samples: 2, ao, ..scene.settings };
        let world = World::compile(&scene, &CompileOptions::default()).unwrap();
        let plain = render(&world, &scene.camera, &settings, None, &Control::default()).unwrap();
        for scale in [1.0, 1.7] {
            let beauty = plain.image.map(|pixel| pixel.map(|channel| channel * scale));
            for set in ["terms", "lights"] {
                let passes = select([set], world.lights()).unwrap();
                let control = Control::default();
                let found =
                    render_passes(&world, &scene.camera, &settings, None, &passes, scale, &control).unwrap();
                assert!(found.render == plain, "{}", builtin.name());
                let forward = sum(found.layers.iter(), &beauty);
                let backward = sum(found.layers.iter().rev(), &beauty);
                assert!(forward == beauty, "{set} of {} times {scale}", builtin.name());
                assert!(backward == beauty, "{set} of {} times {scale}, backward", builtin.name());
            }
        }
    }
}

/// The sum of layers in single precision, in the order given.
fn sum<'a>(layers: impl Iterator<Item = &'a Layer>, like: &Image) -> Image {
    let mut sum = vec![[0.0_f32; 3]; like.pixels().len()];
    for Layer { pass, samples } in layers {
        let Samples::Color(values) = samples else { panic!("{pass:?} is no colour") };
        for (sum, value) in sum.iter_mut().zip(values) {
            assert!(value.iter().all(|&channel| channel >= 0.0), "{pass:?} has {value:?}");
            sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += value);
        }
    }
    let mut image = Image::black(like.width(), like.height());
    image.put(0, 0, like.width(), &sum);
    image
}

#[test]
fn every_light_of_the_gallery_can_be_named() {
    for builtin in SCENES {
        let scene = builtin.build();
        let lights = select(["lights"], &scene.lights).unwrap();
        let lights = lights.iter().filter(|pass| matches!(pass, Pass::Light(_))).count();
        assert_eq!(lights, scene.lights.len(), "{}", builtin.name());
    }
}
