//! Shadows, reflection and refraction, turned off.

use super::*;

#[test]
fn without_shadows_a_hidden_light_adds_what_it_would_in_the_open() {
    let mut scene = floor();
    scene.ambient = Rgb::BLACK;
    let (sin, cos) = sin_cos(PI / 3.0);
    scene.add_light(DVec3::new(0.0, cos, sin) * 4.0, Rgb::grey(10.0));
    let ball = Transform::scale(DVec3::splat(0.4)).then(at(0.0, 2.0 * cos, 2.0 * sin));
    scene.add(Node::shape("blocker", Shape::Sphere).with_transform(ball));
    let world = world(&scene);
    let diffuse = Material::default().diffuse.r;
    let unshadowed = 10.0 / (PI * 16.0) * diffuse * cos;
    let off = Settings { shadows: false, ..settings(0, 0, 1.0) };
    let (seen, counts) = listen(&world, &off, DOWN, &mut Silent);
    assert_same(seen, Rgb::grey(unshadowed));
    assert_eq!(counts.shadow, 0);
    let (seen, counts) = listen(&world, &settings(0, 0, 1.0), DOWN, &mut Silent);
    assert_eq!((seen, counts.shadow), (Rgb::BLACK, 1));
}

#[test]
fn without_shadows_a_light_behind_the_surface_still_adds_nothing() {
    let mut scene = floor();
    scene.ambient = Rgb::BLACK;
    scene.add_light(DVec3::NEG_Y, Rgb::WHITE);
    let off = Settings { shadows: false, ..settings(0, 0, 1.0) };
    assert_eq!(radiance(&world(&scene), &off, DOWN), Rgb::BLACK);
}

/// A surface that both reflects and transmits, before a background of one.
fn half_mirror(fresnel: bool) -> Scene {
    let mut scene = Scene::new("half mirror");
    scene.background = Rgb::WHITE;
    let material = Material { reflect: Rgb::grey(0.25), transmit: Rgb::grey(0.5), fresnel, ..dark() };
    let both = scene.add_material(material);
    scene.add(Node::shape("half mirror", Shape::Plane).with_material(both));
    scene
}

#[test]
fn without_reflection_only_what_is_transmitted_is_left_and_the_other_way_round() {
    let (sin, cos) = sin_cos(1.0);
    let ray = Ray::new(DVec3::Y, DVec3::new(sin, -cos, 0.0));
    let reflectance = fresnel_reflectance(cos, 1.0, 1.5);
    for (fresnel, l_r, l_t) in [(false, 0.25, 0.5), (true, 0.25 * reflectance, 0.5 * (1.0 - reflectance))] {
        let world = world(&half_mirror(fresnel));
        for (reflection, refraction) in [(true, true), (false, true), (true, false), (false, false)] {
            let some = Settings { reflection, refraction, ..settings(3, 0, 1.0) };
            let (seen, counts) = listen(&world, &some, ray, &mut Silent);
            let kept = |term: f64, on: bool| if on { term } else { 0.0 };
            assert_same(seen, Rgb::grey(kept(l_r, reflection) + kept(l_t, refraction)));
            assert_eq!((counts.reflection, counts.refraction), (reflection.into(), refraction.into()));
        }
    }
}

#[test]
fn without_refraction_total_reflection_is_not_traced_either() {
    let mut scene = Scene::new("cube");
    scene.background = Rgb::WHITE;
    let glass = glass(&mut scene, 1.5);
    scene.add(Node::shape("cube", Shape::Cube).with_material(glass));
    let (sin, cos) = sin_cos(PI / 3.0);
    let ray = Ray::new(DVec3::new(0.0, 0.9, 0.0), DVec3::new(0.0, cos, sin));
    let off = Settings { refraction: false, ..settings(9, 0, 1.0) };
    let (seen, counts) = listen(&world(&scene), &off, ray, &mut Silent);
    assert_eq!((seen, counts.total()), (Rgb::BLACK, 1));
}
