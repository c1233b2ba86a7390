//! Polygons to triangles.
//!
//! In: the corners of a polygon in space, roughly in a plane. Out: triangles of its corners that cover it
//! once, wound as it is. It knows no file and no mesh.
//!
//! Source: G. H. Meisters, "Polygons have ears", 1975, and Newell's plane for the normal.

use lancer_core::geometry::{DVec2, DVec3};

/// The most corners of a polygon that needs ears clipped, whose time grows with the square of this: here
/// half a second. Polygons in which a fan will do have no bound.
pub(super) const MAX_CLIPPED_CORNERS: usize = 1 << 14;

/// The most that all polygons of a file may need together, as the sum of the squares of their corners: some two
/// seconds, and more than a thousand polygons of a thousand corners.
const MOST_WORK: u64 = 1 << 30;

/// A polygon that cannot be cut into triangles in reasonable time.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct TooManyCorners;

/// Triangulates polygons one after another, in memory that it keeps.
#[derive(Default)]
pub(super) struct Triangulator {
    points: Vec<DVec2>,
    previous: Vec<u32>,
    next: Vec<u32>,
    blunt: Vec<u32>,
    /// Which corners are known to be no ears.
    refused: Vec<bool>,
    /// How many corners have been held against triangles for the polygon at hand.
    tests: u64,
    triangles: Vec<[u32; 3]>,
    /// The sum of the squares of the corners of those whose ears were clipped.
    work: u64,
}

impl Triangulator {
    /// Triangles of a polygon of at least three corners, by the corners' places in it.
    ///
    /// n corners give n - 2 triangles, whatever their positions. Where the polygon crosses itself or has no
    /// area, the triangles are some that use its corners.
    pub(super) fn triangulate(&mut self, corners: &[DVec3]) -> Result<&[[u32; 3]], TooManyCorners> {
        self.triangles.clear();
        let count = corners.len() as u32;
        if count > 3 {
            self.project(corners);
        }
        if count <= 3 || self.fan_covers() {
            self.triangles.extend((2..count).map(|i| [0, i - 1, i]));
        } else {
            self.work += u64::from(count) * u64::from(count);
            if corners.len() > MAX_CLIPPED_CORNERS || self.work > MOST_WORK {
                return Err(TooManyCorners);
            }
            self.clip_ears();
        }
        Ok(&self.triangles)
    }

    /// Drops the axis along which the polygon's normal is longest, so that it runs counter-clockwise.
    fn project(&mut self, corners: &[DVec3]) {
        let origin = corners[0];
        let normal = newell_normal(corners);
        let size = normal.abs();
        let flat = |p: DVec3| {
            if size.x >= size.y && size.x >= size.z {
                DVec2::new(p.y * normal.x.signum(), p.z)
            } else if size.y >= size.z {
                DVec2::new(p.z * normal.y.signum(), p.x)
            } else {
                DVec2::new(p.x * normal.z.signum(), p.y)
            }
        };
        self.points.clear();
        self.points.extend(corners.iter().map(|&corner| flat(corner - origin)));
    }

    /// Whether all triangles of the fan about corner 0 face the polygon's way, as in every convex polygon.
    fn fan_covers(&self) -> bool {
        let points = &self.points;
        (2..points.len()).all(|i| turn(points[0], points[i - 1], points[i]) > 0.0)
    }

    fn clip_ears(&mut self) {
        let count = self.points.len() as u32;
        self.previous.clear();
        self.previous.extend((0..count).map(|i| (i + count - 1) % count));
        self.next.clear();
        self.next.extend((0..count).map(|i| (i + 1) % count));
        self.blunt = (0..count).filter(|&i| self.turn_at(i) <= 0.0).collect();

        self.refused.clear();
        self.refused.resize(count as usize, false);
        self.tests = 0;
        let most_tests = TESTS_PER_SQUARE * u64::from(count) * u64::from(count);

        let (mut corner, mut remaining, mut passed) = (0, count, 0);
        let mut is_second_look = false;
        while remaining > 3 {
            // Without an ear on the whole way round, the polygon crosses or touches itself. Then what was refused before
            // may be an ear by now, and if none is, any corner will do.
            let is_stuck = passed >= remaining;
            if is_stuck && !is_second_look && self.tests < most_tests {
                self.refused.fill(false);
                (passed, is_second_look) = (0, true);
            } else if is_stuck || self.is_ear(corner) {
                corner = self.clip(corner);
                (remaining, passed, is_second_look) = (remaining - 1, 0, false);
            } else {
                corner = self.next[corner as usize];
                passed += 1;
            }
        }
        self.triangles.push(self.ear_at(corner));
    }

    /// The corner with its neighbours.
    fn ear_at(&self, corner: u32) -> [u32; 3] {
        [self.previous[corner as usize], corner, self.next[corner as usize]]
    }

    fn turn_at(&self, corner: u32) -> f64 {
        let [a, b, c] = self.ear_at(corner).map(|i| self.points[i as usize]);
        turn(a, b, c)
    }

    /// Whether the corner sticks out and no other corner lies in the triangle with its neighbours.
    ///
    /// Only blunt corners can lie in it. One on its border counts as in it, lest a corner on a straight edge
    /// be left over.
    ///
    /// What was refused stays so until a neighbour is cut off: what lay in its triangle lies there still.
    fn is_ear(&mut self, corner: u32) -> bool {
        if self.refused[corner as usize] {
            return false;
        }
        let ear = self.ear_at(corner);
        let [a, b, c] = ear.map(|i| self.points[i as usize]);
        let is_sharp = turn(a, b, c) > 0.0;
        let lies_in = |&other: &u32| {
            let p = self.points[other as usize];
            let is_corner = p == a || p == b || p == c;
            !is_corner && turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0
        };
        let first = is_sharp.then(|| self.blunt.iter().position(lies_in));
        let tested = first.map_or(0, |first| first.map_or(self.blunt.len(), |place| place + 1));
        self.tests += tested as u64;
        let is_ear = first == Some(None);
        self.refused[corner as usize] = !is_ear;
        is_ear
    }

    /// Cuts a corner off. Returns where to go on: two corners further, so that ears are taken all around the
    /// polygon instead of as a fan of slivers.
    fn clip(&mut self, corner: u32) -> u32 {
        let ear @ [previous, _, next] = self.ear_at(corner);
        self.triangles.push(ear);
        self.next[previous as usize] = next;
        self.previous[next as usize] = previous;
        let mut blunt = std::mem::take(&mut self.blunt);
        // A corner becomes sharper where its neighbour is cut off, never blunter, so none is added.
        blunt.retain(|&i| i != corner && ((i != previous && i != next) || self.turn_at(i) <= 0.0));
        self.blunt = blunt;
        self.refused[previous as usize] = false;
        self.refused[next as usize] = false;
        self.next[next as usize]
    }
}

/// Twice the area of the triangle, above 0 where it turns left.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Twice the area of the polygon along its normal.
fn newell_normal(corners: &[DVec3]) -> DVec3 {
    let origin = corners[0];
    let pairs = corners.windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin));
    pairs.sum()
}

/// How many times the square of its corners a polygon may need in tests before it is no longer looked at twice. One that
/// does not cross itself needs less than 2.
const TESTS_PER_SQUARE: u64 = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn area(corners: &[DVec3], triangles: &[[u32; 3]]) -> f64 {
        let double = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| corners[i as usize]);
            (b - a).cross(c - a).length()
        };
        triangles.iter().map(|&triangle| 0.5 * double(triangle)).sum()
    }

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect()
    }

    #[test]
    fn concave_polygons_keep_their_area_in_any_plane_and_order() {
        let arrow = flat(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [3.0, 1.0], [0.0, 0.0], [0.0, 0.0]]);
        let comb = flat(&[
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, 3.0],
            [4.0, 3.0],
            [4.0, 1.0],
            [3.0, 1.0],
            [3.0, 3.0],
            [2.0, 3.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ]);
        for (polygon, expected) in [(arrow, 4.0), (comb, 11.0)] {
            let len = polygon.len();
            for start in 0..len {
                for turned in [
                    polygon.clone(),
                    polygon.iter().rev().copied().collect(),
                    polygon.iter().map(|p| DVec3::new(p.y, p.z, p.x)).collect(),
                    polygon.iter().map(|p| DVec3::new(p.z, p.x, p.y)).collect(),
                ] {
                    let mut turned: Vec<_> = turned;
                    turned.rotate_left(start);
                    let mut triangulator = Triangulator::default();
                    let triangles = triangulator.triangulate(&turned).unwrap();
                    assert_eq!(triangles.len(), len - 2);
                    assert!((area(&turned, triangles) - expected).abs() < 1e-12);
                }
            }
        }
    }

    /// A corridor in zigzag, in which only the two ends ever have ears.
    #[test]
    fn the_work_grows_with_the_square_of_the_corners_where_ears_are_few() {
        let corners = 2000;
        let line = |up: f64| {
            (0..corners / 2)
                .map(move |i| DVec3::new(f64::from(i), if i % 2 == 0 { up } else { up + 10.0 }, 0.0))
        };
        let corridor = line(0.0).chain(line(0.5).rev()).collect::<Vec<_>>();
        let mut triangulator = Triangulator::default();
        let triangles = triangulator.triangulate(&corridor).unwrap();
        let expected = 0.5 * f64::from(corners / 2 - 1);
        assert!((area(&corridor, triangles) - expected).abs() < 1e-6);
        let square = u64::from(corners as u32) * u64::from(corners as u32);
        assert!(triangulator.tests < 2 * square, "{} tests", triangulator.tests);
    }

    #[test]
    fn corners_on_straight_edges_are_not_lost() {
        let square = flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [1.0, 2.0], [0.0, 2.0]]);
        let mut triangulator = Triangulator::default();
        let triangles = triangulator.triangulate(&square).unwrap();
        assert!((area(&square, triangles) - 4.0).abs() < 1e-12);
        for &[a, b, c] in triangles {
            assert!(area(&square, &[[a, b, c]]) > 0.0, "a flat triangle hides a corner");
        }
    }

    #[test]
    fn degenerate_polygons_give_triangles_all_the_same() {
        let mut triangulator = Triangulator::default();
        for polygon in [
            vec![DVec3::ZERO; 7],
            flat(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]),
            flat(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 0.0], [0.5, 0.0]]),
        ] {
            assert_eq!(triangulator.triangulate(&polygon).unwrap().len(), polygon.len() - 2);
        }
    }

    #[test]
    fn only_fans_may_have_any_number_of_corners() {
        let count = MAX_CLIPPED_CORNERS as u32 + 2;
        let parabola = |bend: f64| {
            let point = |i: u32| DVec3::new(f64::from(i), bend * f64::from(i) * f64::from(i), 0.0);
            (0..count).map(point).collect::<Vec<_>>()
        };
        let mut triangulator = Triangulator::default();
        assert!(triangulator.triangulate(&parabola(1.0)).is_ok());
        let zigzag = (0..count).map(|i| DVec3::new(f64::from(i), f64::from(i % 2), 0.0)).collect::<Vec<_>>();
        assert_eq!(triangulator.triangulate(&zigzag).unwrap_err(), TooManyCorners);
    }

    #[test]
    fn many_large_polygons_are_bounded_together() {
        let corners = 1_u32 << 11;
        let zigzag =
            (0..corners).map(|i| DVec3::new(f64::from(i), f64::from(i % 2), 0.0)).collect::<Vec<_>>();
        let mut triangulator = Triangulator { work: MOST_WORK - 3 * (1 << 22), ..Triangulator::default() };
        assert!((0..3).all(|_| triangulator.triangulate(&zigzag).is_ok()));
        assert_eq!(triangulator.triangulate(&zigzag).unwrap_err(), TooManyCorners);
        assert!(triangulator.triangulate(&zigzag[..3]).is_ok());
    }

    proptest! {
        /// A star-shaped polygon about the origin has the area of its sectors.
        #[test]
        fn star_polygons_keep_their_area(radii in prop::collection::vec(0.1_f64..10.0, 4..60)) {
            let step = std::f64::consts::TAU / radii.len() as f64;
            let polygon = radii.iter().enumerate().map(|(i, &radius)| {
                let (sin, cos) = lancer_core::geometry::portable::sin_cos(i as f64 * step);
                DVec3::new(radius * cos, 3.0, -radius * sin)
            }).collect::<Vec<_>>();
            let sector = lancer_core::geometry::portable::sin_cos(step).0;
            let neighbours = radii.iter().zip(radii.iter().cycle().skip(1));
            let expected = neighbours.map(|(a, b)| 0.5 * a * b * sector).sum::<f64>();
            let mut triangulator = Triangulator::default();
            let triangles = triangulator.triangulate(&polygon).unwrap();
            prop_assert!((area(&polygon, triangles) - expected).abs() < 1e-9 * expected);
        }

        #[test]
        fn any_corners_give_two_triangles_fewer(
            corners in prop::collection::vec((-3_i8..3, -3_i8..3, -3_i8..3), 3..40),
        ) {
            let corners = corners.iter().map(|&(x, y, z)| DVec3::new(x.into(), y.into(), z.into()))
                .collect::<Vec<_>>();
            let mut triangulator = Triangulator::default();
            let triangles = triangulator.triangulate(&corners).unwrap();
            prop_assert_eq!(triangles.len(), corners.len() - 2);
        }
    }
}
