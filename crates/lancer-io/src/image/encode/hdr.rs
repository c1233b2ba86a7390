//! Radiance HDR: linear, a mantissa of 8 bits for each channel and one exponent for all three.
//!
//! Written here because the known encoders take the exponent from the platform's logarithm, whose last bit decides
//! where a channel is a power of two. Source: Ward, "Real Pixels", Graphics Gems II, 1991; Radiance's `color.c`.

use super::Metadata;
use lancer_core::film::Image;
use std::io::{self, Write};

/// Rows of this length are packed; others are not, by the format.
const PACKED_WIDTHS: std::ops::RangeInclusive<u32> = 8..=0x7fff;

/// The longest run, and the longest stretch without one, that a byte can count.
const LONGEST_RUN: usize = 127;
const LONGEST_STRETCH: usize = 128;

/// Runs that are shorter cost more than they save.
const SHORTEST_RUN: usize = 4;

pub(super) fn write(image: &Image, metadata: &Metadata, mut out: impl Write) -> io::Result<()> {
    writeln!(out, "#?RADIANCE\nSOFTWARE={}", metadata.software)?;
    if let Some(provenance) = &metadata.provenance {
        writeln!(out, "{}={provenance}", super::super::HDR_PROVENANCE)?;
    }
    write!(out, "FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height(), image.width())?;
    let is_packed = PACKED_WIDTHS.contains(&image.width());
    for row in image.pixels().chunks_exact(image.width() as usize) {
        let row = row.iter().map(|&pixel| rgbe(pixel)).collect::<Vec<_>>();
        if is_packed {
            out.write_all(&packed(&row))?;
        } else {
            out.write_all(row.as_flattened())?;
        }
    }
    Ok(())
}

/// Three mantissas and the exponent. What is negative or no number becomes 0; what is too large, the largest.
fn rgbe(pixel: [f32; 3]) -> [u8; 4] {
    /// 2^127, the first value that is too large, and 2^-128, below which there is no exponent.
    const TOO_LARGE: f64 = f64::from_bits((1023 + 127) << 52);
    const TOO_SMALL: f64 = f64::from_bits((1023 - 128) << 52);
    /// The largest value below it that has a mantissa of 8 bits.
    const LARGEST: f64 = TOO_LARGE * (255.0 / 256.0);
    let pixel = pixel.map(|channel| f64::from(channel.max(0.0)).min(LARGEST));
    let greatest = pixel.into_iter().fold(0.0, f64::max);
    if greatest < TOO_SMALL {
        return [0; 4];
    }
    // greatest = m 2^exponent with m in [0.5, 1): what `frexp` tells, from the bits themselves.
    let exponent_of = |value: f64| (value.to_bits() >> 52) as i32 - 1022;
    let scale_of = |exponent: i32| f64::from_bits(((1023 + 8 - exponent) as u64) << 52);
    let mut exponent = exponent_of(greatest);
    if (greatest * scale_of(exponent)).round() > 255.0 {
        exponent += 1;
    }
    let [r, g, b] = pixel.map(|channel| (channel * scale_of(exponent)).round() as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// A row channel by channel, each in runs and stretches.
fn packed(row: &[[u8; 4]]) -> Vec<u8> {
    let [high, low] = (row.len() as u16).to_be_bytes();
    let mut bytes = vec![2, 2, high, low];
    for channel in 0..4 {
        let values = row.iter().map(|pixel| pixel[channel]).collect::<Vec<_>>();
        pack(&values, &mut bytes);
    }
    bytes
}

fn pack(values: &[u8], bytes: &mut Vec<u8>) {
    let mut rest = values;
    let mut stretch = 0;
    // `rest[..stretch]` is seen and not yet written.
    while stretch < rest.len() {
        let run = run_at(&rest[stretch..]);
        if run < SHORTEST_RUN {
            stretch += run;
            continue;
        }
        put_stretch(&rest[..stretch], bytes);
        bytes.extend([128 + run as u8, rest[stretch]]);
        rest = &rest[stretch + run..];
        stretch = 0;
    }
    put_stretch(rest, bytes);
}

/// How many values are the same as the first one.
fn run_at(values: &[u8]) -> usize {
    values.iter().take(LONGEST_RUN).take_while(|&&value| value == values[0]).count()
}

fn put_stretch(values: &[u8], bytes: &mut Vec<u8>) {
    for part in values.chunks(LONGEST_STRETCH) {
        bytes.push(part.len() as u8);
        bytes.extend_from_slice(part);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lancer_core::geometry::portable;

    fn value([r, g, b, e]: [u8; 4]) -> [f64; 3] {
        let unit = portable::exp2(f64::from(e) - 136.0);
        [r, g, b].map(|mantissa| f64::from(mantissa) * unit)
    }

    #[test]
    fn every_channel_is_within_half_a_step_of_the_greatest_ones() {
        for i in 0..10_000_u32 {
            let greatest = f32::from_bits(0x3080_0000 + i * 100_003);
            let pixel = [greatest, greatest * 0.37, greatest * 0.001];
            for (found, expected) in value(rgbe(pixel)).into_iter().zip(pixel) {
                assert!((found - f64::from(expected)).abs() <= f64::from(greatest) / 255.5, "{pixel:?}");
            }
        }
    }

    #[test]
    fn powers_of_two_are_exact() {
        for exponent in -120..127 {
            let power = portable::exp2(f64::from(exponent)) as f32;
            assert_eq!(value(rgbe([power; 3])), [f64::from(power); 3], "2^{exponent}");
        }
    }

    #[test]
    fn what_the_format_cannot_hold_is_the_nearest_that_it_can() {
        assert_eq!(rgbe([-1.0, f32::NAN, 0.0]), [0; 4]);
        assert_eq!(rgbe([f32::INFINITY, 0.0, -0.0]), [255, 0, 0, 255]);
        assert_eq!(rgbe([f32::MAX; 3]), [255, 255, 255, 255]);
        assert_eq!(rgbe([1e-45; 3]), [0; 4]);
        // Rounds up to 256, which is one exponent further.
        assert_eq!(rgbe([0.9999; 3]), [128, 128, 128, 129]);
    }
}
