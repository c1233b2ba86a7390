//! Portable float maps.

use super::{Picture, check_size};
use lancer_core::film::Image;

/// Bytes of a channel.
const CHANNEL: usize = 4;

/// The picture of a file that begins with `PF` or `Pf`.
pub(super) fn read(bytes: &[u8], most_pixels: u64) -> Result<Picture, String> {
    let channels = if bytes.starts_with(b"PF") { 3 } else { 1 };
    let mut rest = &bytes[2..];
    let mut words = [""; 3];
    for word in &mut words {
        (*word, rest) = next_word(rest).ok_or("is a broken PFM: its header ends early")?;
    }
    let [width, height, scale] = words;
    let side = |word: &str| {
        let side = word.parse::<u32>().ok().filter(|&side| side > 0);
        side.ok_or_else(|| format!("is a broken PFM: `{word}` is no side"))
    };
    let (width, height) = (side(width)?, side(height)?);
    let scale = scale.parse::<f32>().ok().filter(|scale| scale.is_finite() && *scale != 0.0);
    let scale = scale.ok_or("is a broken PFM: its scale is no number other than 0")?;
    check_size(u64::from(width), u64::from(height), most_pixels)?;

    let row = width as usize * channels * CHANNEL;
    // One byte ends the header; what follows are the pixels.
    let pixels = rest.get(1..).unwrap_or_default();
    if pixels.len() < row * height as usize {
        return Err("is a broken PFM: it ends early".into());
    }
    let float = |bytes: &[u8]| {
        let bytes = bytes.try_into().expect("four bytes make a float");
        if scale < 0.0 { f32::from_le_bytes(bytes) } else { f32::from_be_bytes(bytes) }
    };
    let mut values = Image::black(width, height);
    for (y, row) in (0..height).rev().zip(pixels.chunks_exact(row)) {
        let floats = row.chunks_exact(CHANNEL).map(float).collect::<Vec<_>>();
        let pixels = floats.chunks_exact(channels).map(|pixel| match *pixel {
            [r, g, b] => [r, g, b],
            _ => [pixel[0]; 3],
        });
        values.put(0, y, width, &pixels.collect::<Vec<_>>());
    }
    Ok(Picture { values, is_linear: true, codes: None })
}

/// The next word of the header, and what follows it.
fn next_word(bytes: &[u8]) -> Option<(&str, &[u8])> {
    /// Longer than any number that can be meant.
    const LONGEST: usize = 64;
    let start = bytes.iter().take(LONGEST).position(|byte| !byte.is_ascii_whitespace())?;
    let bytes = &bytes[start..];
    let end = bytes.iter().take(LONGEST).position(u8::is_ascii_whitespace)?;
    Some((std::str::from_utf8(&bytes[..end]).ok()?, &bytes[end..]))
}
