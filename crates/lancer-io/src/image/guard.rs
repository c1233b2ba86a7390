//! Decoders of other authors, kept from doing harm.

use ::image::ImageFormat;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What a decoder makes of a file. One that panics (zune-jpeg 0.5 does on some files) has met a broken one.
pub(super) fn decoded<T>(decode: impl FnOnce() -> T) -> Result<T, String> {
    let broken = |_| "is a broken image: its decoder cannot go on with it".to_owned();
    catch_unwind(AssertUnwindSafe(decode)).map_err(broken)
}

/// How many times the bytes of its pixels a decoder holds of a file: that of JPEG keeps the coefficients of all scans of a
/// progressive file, two bytes each.
pub(super) fn times_held(format: ImageFormat, bytes: &[u8]) -> u64 {
    if format == ImageFormat::Jpeg && is_progressive(bytes) { 3 } else { 1 }
}

/// Whether a JPEG's frame is one of a progressive file: its header is the first of those from C0 to CF but for three that
/// mean other things.
fn is_progressive(bytes: &[u8]) -> bool {
    let mut rest = &bytes[2.min(bytes.len())..];
    loop {
        // Anything may stand between segments.
        let Some(mark) = rest.iter().position(|&byte| byte == 0xff) else { return false };
        rest = &rest[mark + 1..];
        match rest.first() {
            None | Some(0xda) => return false,
            Some(0xc4 | 0xc8 | 0xcc) => {}
            Some(kind @ 0xc0..=0xcf) => return kind & 0b11 == 2,
            Some(0 | 0x01 | 0xd0..=0xd9 | 0xff) => continue,
            Some(_) => {}
        }
        let length =
            rest.get(1..3).map_or(0, |length| usize::from(u16::from_be_bytes([length[0], length[1]])));
        rest = rest.get(1 + length..).unwrap_or_default();
    }
}

/// Holds the fields of a TIFF's first directory against the file's length: its decoder makes room for them, up to
/// 256 MiB, before any limit can be set. What is no TIFF is left to the decoder.
///
/// Source: TIFF 6.0, section 2; for BigTIFF, the libtiff documentation.
pub(super) fn check_tiff(bytes: &[u8]) -> Result<(), String> {
    let is_little = bytes.starts_with(b"II");
    let number = |at: u64, size: usize| -> Option<u64> {
        let at = usize::try_from(at).ok()?;
        let digits = bytes.get(at..at.checked_add(size)?)?.iter();
        let append = |number: u64, &byte: &u8| number << 8 | u64::from(byte);
        Some(if is_little { digits.rev().fold(0, append) } else { digits.fold(0, append) })
    };
    // The sizes of a link, of the number of fields, and of a field.
    let (link, count, field) = if number(2, 2) == Some(43) { (8, 8, 20) } else { (4, 2, 12) };
    let Some(directory) = number(link, link as usize) else { return Ok(()) };
    for index in 0..number(directory, count).unwrap_or(0) {
        let at = index
            .checked_mul(field)
            .and_then(|offset| offset.checked_add(directory)?.checked_add(count as u64));
        let Some(at) = at else { return Ok(()) };
        let (Some(kind), Some(values)) =
            (number(at.saturating_add(2), 2), number(at.saturating_add(4), link as usize))
        else {
            return Ok(());
        };
        let size = match kind {
            1 | 2 | 6 | 7 => 1,
            3 | 8 => 2,
            4 | 9 | 11 | 13 => 4,
            5 | 10 | 12 | 16..=18 => 8,
            _ => continue,
        };
        if values.saturating_mul(size) > bytes.len() as u64 {
            return Err("is a broken image: a field of its directory is longer than the file".to_owned());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_a_broken_image() {
        let broken = decoded(|| -> () { panic!("a test's panic") });
        assert_eq!(broken, Err("is a broken image: its decoder cannot go on with it".to_owned()));
    }

    #[test]
    fn progressive_files_are_known_by_their_frame() {
        let file = |frame: u8| {
            let other = [0xff, 0xe0, 0, 4, 0xff, 0xc2, 0xff, 0xc4, 0, 2];
            [&[0xff, 0xd8][..], &other, &[0xff, frame, 0, 17], &[0; 15], &[0xff, 0xda, 0xff, 0xc2]].concat()
        };
        assert!(is_progressive(&file(0xc2)) && is_progressive(&file(0xca)));
        assert!(!is_progressive(&file(0xc0)) && !is_progressive(&file(0xc1)));
        assert!(
            !is_progressive(&[])
                && !is_progressive(&[0xff, 0xd8, 0xff])
                && !is_progressive(&[0xff, 0xd8, 0xff, 0xe0, 9])
        );
    }

    #[test]
    fn fields_longer_than_the_file_are_refused_in_both_orders_and_sizes() {
        let little = |values: u32| {
            let field = [
                &700_u16.to_le_bytes()[..],
                &1_u16.to_le_bytes(),
                &values.to_le_bytes(),
                &8_u32.to_le_bytes(),
            ];
            [b"II\x2a\0\x08\0\0\0\x01\0", &field.concat()[..]].concat()
        };
        assert!(check_tiff(&little(22)).is_ok());
        assert!(check_tiff(&little(23)).is_err());
        let big = |values: u64| {
            let head = b"MM\0\x2b\0\x08\0\0\0\0\0\0\0\0\0\x10\0\0\0\0\0\0\0\x01";
            let field = [&700_u16.to_be_bytes()[..], &12_u16.to_be_bytes(), &values.to_be_bytes(), &[0; 8]];
            [&head[..], &field.concat()].concat()
        };
        assert!(check_tiff(&big(5)).is_ok());
        assert!(check_tiff(&big(6)).is_err());
        assert!(check_tiff(&big(u64::MAX)).is_err());
    }

    #[test]
    fn what_is_cut_off_is_left_to_the_decoder() {
        let whole = b"II\x2a\0\x08\0\0\0\xff\xff\0\x01\x01\0\0\0\0\0\0\0\0\0";
        (0..=whole.len()).for_each(|length| assert!(check_tiff(&whole[..length]).is_ok()));
        assert!(check_tiff(b"II\x2b\0\x08\0\0\0\xff\xff\xff\xff\xff\xff\xff\xff").is_ok());
    }
}
