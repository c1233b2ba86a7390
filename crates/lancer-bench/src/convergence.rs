//! The error of c_a against N: the renderer's lattice beside independent random directions.
//!
//! The sites are points of a floor whose c_a is known in closed form, so that the error is one against the truth
//! and not against another estimate.

use crate::Failure;
use crate::plot::{Curve, Labels, svg};
use crate::record::{command_line, growth, write};
use lancer_core::geometry::{DVec3, Ray, Transform};
use lancer_core::integrator::{AmbientOcclusionSampler, RayCounts};
use lancer_core::sampling::{Key, Stream};
use lancer_core::scene::{AmbientOcclusion, Node, Scene, Shape};
use lancer_core::world::{CompileOptions, Intersection, World};
use serde_json::json;
use std::f64::consts::FRAC_1_PI;
use std::path::Path;

/// Estimates at each site for each N.
const ESTIMATES: u32 = 2000;
/// N = 2^0 to 2^LARGEST.
const LARGEST: u32 = 12;

/// A point with its true c_a.
struct Site {
    world: World,
    at: Intersection,
    distance: f64,
    truth: f64,
}

#[expect(clippy::print_stdout, reason = "the table is what the command is for")]
pub(crate) fn measure(output: &Path, data: Option<&Path>) -> Result<(), Failure> {
    let sites = sites()?;
    let mut lattice =
        Curve { name: "shifted spherical Fibonacci lattice", color: "#0b6e99", points: Vec::new() };
    let mut independent =
        Curve { name: "independent random directions", color: "#c0392b", points: Vec::new() };
    println!("{:>6}  {:>12}  {:>12}  {:>6}", "N", "lattice", "independent", "ratio");
    for n in (0..=LARGEST).map(|exponent| 1 << exponent) {
        let by_lattice = error(&sites, |site, key| lattice_estimate(site, n, key));
        let by_chance = error(&sites, |site, key| independent_estimate(site, n, key));
        println!("{n:>6}  {by_lattice:>12.6}  {by_chance:>12.6}  {:>6.1}", by_chance / by_lattice);
        lattice.points.push((f64::from(n), by_lattice));
        independent.points.push((f64::from(n), by_chance));
    }
    let exponents = [&lattice, &independent].map(|curve| growth(&curve.points));
    println!("error ~ N^e: {:.2} and {:.2}", exponents[0], exponents[1]);
    if let Some(path) = data {
        let rows = lattice.points.iter().zip(&independent.points).map(|(&(n, by_lattice), &(_, by_chance))| {
            json!({ "samples": n, "lattice": by_lattice, "independent": by_chance })
        });
        let rows: Vec<_> = rows.collect();
        write(path, json!({ "command": command_line(), "rows": rows, "exponents": exponents }))?;
    }
    let labels = Labels {
        title: "Ambient occlusion: root mean square error of c_a",
        x: "N, directions on the whole sphere",
        y: "RMS error",
    };
    std::fs::write(output, svg(&[independent, lattice], &labels))?;
    Ok(())
}

/// The root mean square error over all sites.
fn error(sites: &[Site], estimate: impl Fn(&Site, Key) -> f64) -> f64 {
    let mut squares = 0.0;
    for (index, site) in sites.iter().enumerate() {
        for x in 0..ESTIMATES {
            let off = estimate(site, Key::camera(x, index as u32, 0)) - site.truth;
            squares += off * off;
        }
    }
    (squares / (f64::from(ESTIMATES) * sites.len() as f64)).sqrt()
}

fn lattice_estimate(site: &Site, n: u32, key: Key) -> f64 {
    let sampler = AmbientOcclusionSampler::new(&AmbientOcclusion { samples: n, distance: site.distance });
    sampler.factor(&site.world, &site.at, key, &mut RayCounts::default())
}

fn independent_estimate(site: &Site, n: u32, key: Key) -> f64 {
    let mut stream = key.stream();
    let mut sum = 0.0;
    for _ in 0..n {
        let direction = uniform_direction(&mut stream);
        let weight = site.at.facing_normal().dot(direction);
        if weight > 0.0 {
            let ray = Ray { t_max: site.distance, ..site.at.spawn(direction) };
            if !site.world.occluded(&ray) {
                sum += weight;
            }
        }
    }
    4.0 * sum / f64::from(n)
}

fn uniform_direction(stream: &mut Stream) -> DVec3 {
    let z = 1.0 - 2.0 * stream.next_unit();
    let radius = (1.0 - z * z).sqrt();
    let (sin, cos) = lancer_core::geometry::portable::sin_cos(std::f64::consts::TAU * stream.next_unit());
    DVec3::new(radius * cos, radius * sin, z)
}

/// Beside a wall, beside a wall within reach, in a corner, and under a ball.
fn sites() -> Result<Vec<Site>, Failure> {
    let shift = |x: f64, y: f64, z: f64| Transform::translate(DVec3::new(x, y, z));
    let wall_x = Transform::rotate(DVec3::Z, 90.0).then(shift(0.3, 0.0, 0.0));
    let wall_z = Transform::rotate(DVec3::X, 90.0).then(shift(0.0, 0.0, 0.2));
    let ball = Transform::scale(DVec3::splat(0.6)).then(shift(0.0, 1.5, 0.0));
    let k: f64 = 0.3 / 0.5;
    let segment = (lancer_core::geometry::portable::acos(k) - k * (1.0 - k * k).sqrt()) * FRAC_1_PI;
    [
        (vec![(Shape::Plane, wall_x)], f64::INFINITY, 0.5),
        (vec![(Shape::Plane, wall_x)], 0.5, 1.0 - segment),
        (vec![(Shape::Plane, wall_x), (Shape::Plane, wall_z)], f64::INFINITY, 0.25),
        (vec![(Shape::Sphere, ball)], f64::INFINITY, 1.0 - 0.16),
    ]
    .into_iter()
    .map(|(shapes, distance, truth)| site(shapes, distance, truth))
    .collect()
}

fn site(shapes: Vec<(Shape, Transform)>, distance: f64, truth: f64) -> Result<Site, Failure> {
    let mut scene = Scene::new("site");
    scene.add(Node::shape("floor", Shape::Plane));
    for (shape, transform) in shapes {
        scene.add(Node::shape("blocker", shape).with_transform(transform));
    }
    let world = World::compile(&scene, &CompileOptions::default())?;
    let down = Ray::new(DVec3::Y * 0.5, DVec3::NEG_Y);
    let hit = world.intersect(&down).ok_or("the floor is there")?;
    let at = world.intersection(&down, &hit);
    Ok(Site { world, at, distance, truth })
}
