//! Random numbers that belong to a ray, not to a thread.

/// Names one ray of a picture: its pixel, its subpixel, and its path from the camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key(u64);

/// How a ray came from the one before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// It was reflected.
    Reflection,
    /// It was transmitted.
    Transmission,
}

impl Key {
    /// The camera ray of a subpixel; `subpixel` counts row by row.
    pub fn camera(x: u32, y: u32, subpixel: u32) -> Self {
        Self(mix(mix(u64::from(y) << 32 | u64::from(x)) ^ u64::from(subpixel)))
    }

    /// The ray that follows this one.
    #[must_use]
    pub fn child(self, branch: Branch) -> Self {
        let salt = match branch {
            Branch::Reflection => 0x5ef1_ec71,
            Branch::Transmission => 0x7a25_3117,
        };
        Self(mix(self.0 ^ salt))
    }

    /// The random numbers of this ray.
    pub fn stream(self) -> Stream {
        Stream(self.0)
    }
}

/// A stream of independent random numbers.
///
/// Source: SplitMix64, in Steele, Lea, Flood, "Fast splittable pseudorandom number generators" (OOPSLA 2014).
#[derive(Clone, Debug)]
pub struct Stream(u64);

impl Stream {
    /// The next number, uniform in [0, 1), a multiple of 2^-53.
    pub fn next_unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(GOLDEN_GAMMA);
        (finalize(self.0) >> 11) as f64 * (f64::EPSILON * 0.5)
    }
}

/// The odd integer nearest to 2^64 divided by the golden ratio.
const GOLDEN_GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// A bijection of 64-bit words in which every input bit reaches every output bit.
fn mix(word: u64) -> u64 {
    finalize(word.wrapping_add(GOLDEN_GAMMA))
}

fn finalize(word: u64) -> u64 {
    let word = (word ^ word >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ word >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ word >> 31
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn no_two_rays_of_a_picture_share_a_key() {
        let mut seen = HashSet::new();
        for (x, y, subpixel) in
            (0..64).flat_map(|x| (0..64).flat_map(move |y| (0..4).map(move |s| (x, y, s))))
        {
            let key = Key::camera(x, y, subpixel);
            for key in [key, key.child(Branch::Reflection), key.child(Branch::Transmission)] {
                assert!(seen.insert(key.0));
            }
        }
    }

    #[test]
    fn a_stream_is_uniform_to_within_its_standard_error() {
        let n = 100_000;
        let mut stream = Key::camera(3, 4, 5).stream();
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in 0..n {
            let x = stream.next_unit();
            assert!((0.0..1.0).contains(&x));
            sum += x;
            squares += x * x;
        }
        let n = f64::from(n);
        // Five standard errors of the mean of x and of x^2.
        assert!((sum / n - 0.5).abs() < 5.0 * (1.0 / 12.0 / n).sqrt());
        assert!((squares / n - 1.0 / 3.0).abs() < 5.0 * (4.0 / 45.0 / n).sqrt());
    }
}
