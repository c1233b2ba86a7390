//! Every format that is written, read back; and files that mean harm.

use lancer_core::film::{Image, Tone, ToneCurve};
use lancer_io::image::encode::write;
use lancer_io::image::{
    Compression, Encoding, EncodingChoice, ImageFormat, Metadata, Picture, Window, decode_picture,
    provenance_of,
};
use std::io::Cursor;
use std::path::Path;

const MOST_PIXELS: u64 = 1 << 26;

/// Colours of all kinds, some beyond what displays show.
fn picture(width: u32, height: u32) -> Image {
    let mut image = Image::black(width, height);
    for y in 0..height {
        for x in 0..width {
            let (u, v) = (x as f32 / width as f32, y as f32 / height as f32);
            // Flat parts, slopes and grain, so that every packer has something of each.
            let grain = (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503)) % 97;
            let pixel = if x < width / 3 { [0.25; 3] } else { [u * 1.2, v, grain as f32 / 97.0] };
            image.put(x, y, 1, &[pixel]);
        }
    }
    image
}

fn described() -> Metadata {
    Metadata {
        title: "Été \u{1f30d}".into(),
        provenance: Some("{\"some\":\"text in ASCII\"}".into()),
        dpi: Some(300),
        ..Metadata::default()
    }
}

#[test]
fn an_exr_of_a_part_lies_where_it_does_in_the_whole() {
    let image = picture(5, 3);
    let window = Some(Window { x: 7, y: 2, width: 40, height: 30 });
    for (metadata, position, whole) in
        [(Metadata { window, ..described() }, (7, 2), (40, 30)), (described(), (0, 0), (5, 3))]
    {
        for bits in [16, 32] {
            let bytes =
                encoded(encoding(ImageFormat::Exr, Some(bits), None), &image, Tone::default(), &metadata);
            let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(&bytes), true).unwrap();
            let [header] = meta.headers.as_slice() else { panic!("{} headers", meta.headers.len()) };
            assert_eq!(header.own_attributes.layer_position, position.into());
            assert_eq!(header.layer_size, (5, 3).into());
            assert_eq!(header.shared_attributes.display_window.size, whole.into());
            assert_eq!(header.shared_attributes.display_window.position, (0, 0).into());
            let read = decode_picture(Path::new("a.exr"), &bytes, 100).unwrap();
            assert_eq!((read.values.width(), read.values.height()), (5, 3));
            assert!(bits == 16 || read.values == image);
        }
    }
}

fn encoding(format: ImageFormat, bits: Option<u8>, compression: Option<Compression>) -> Encoding {
    Encoding::new(format, EncodingChoice { bits, compression, quality: None }).unwrap()
}

fn encoded(encoding: impl Into<Encoding>, image: &Image, tone: Tone, metadata: &Metadata) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(encoding, image, tone, metadata, &mut bytes).unwrap();
    bytes
}

fn decoded(bytes: &[u8]) -> Picture {
    decode_picture(Path::new("it"), bytes, MOST_PIXELS).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(bytes: &[u8]) -> String {
    let error = decode_picture(Path::new("it"), bytes, MOST_PIXELS).unwrap_err().to_string();
    assert!(error.starts_with("it: "), "{error}");
    error
}

fn all_encodings() -> Vec<Encoding> {
    let mut all = Vec::new();
    for format in ImageFormat::ALL {
        for &bits in format.bits() {
            let compressions = format.compressions().iter().copied().map(Some);
            let choices = if format.compressions().is_empty() { vec![None] } else { compressions.collect() };
            all.extend(choices.into_iter().map(|compression| encoding(format, Some(bits), compression)));
        }
    }
    all
}

#[test]
fn formats_for_displays_hold_every_code_of_the_tone() {
    let image = picture(67, 45);
    for curve in ToneCurve::ALL {
        let tone = Tone { exposure: 0.3, curve };
        for encoding in all_encodings() {
            if encoding.is_linear() || encoding.format() == ImageFormat::Jpeg {
                continue;
            }
            let found = decoded(&encoded(encoding, &image, tone, &Metadata::default()));
            assert!(!found.is_linear);
            let codes = |pixel: &[f32; 3], most: f32| pixel.map(|value| (value * most).round() as u16);
            match encoding.bits() {
                8 => {
                    let expected = tone.to_codes8(&image);
                    let expected = expected.iter().map(|pixel| pixel.map(u16::from));
                    assert!(
                        found.values.pixels().iter().map(|p| codes(p, 255.0)).eq(expected),
                        "{encoding:?}"
                    );
                }
                _ => {
                    let found = found.values.pixels().iter().map(|pixel| codes(pixel, 65535.0));
                    assert!(found.eq(tone.to_codes16(&image)), "{encoding:?}");
                }
            }
        }
    }
}

#[test]
fn formats_of_floats_hold_every_bit_of_the_exposed_radiance() {
    let mut image = picture(67, 45);
    image.put(3, 4, 1, &[[1e30, -7.25, f32::MIN_POSITIVE]]);
    let tone = Tone { exposure: 1.0, curve: ToneCurve::Filmic };
    for encoding in all_encodings().into_iter().filter(|encoding| encoding.bits() == 32) {
        let found = decoded(&encoded(encoding, &image, tone, &Metadata::default()));
        assert!(found.is_linear && found.values == tone.expose(&image), "{encoding:?}");
    }
}

#[test]
fn halves_are_the_nearest_and_never_infinite() {
    let mut image = picture(67, 45);
    image.put(0, 0, 2, &[[70_000.0, f32::INFINITY, -1e9], [0.1, 1e-7, 65_504.0]]);
    for compression in ImageFormat::Exr.compressions() {
        let encoding = encoding(ImageFormat::Exr, Some(16), Some(*compression));
        let found = decoded(&encoded(encoding, &image, Tone::default(), &Metadata::default())).values;
        assert_eq!(found.pixel(0, 0), [65_504.0, 65_504.0, -65_504.0]);
        assert_eq!(found.pixel(1, 0)[2], 65_504.0);
        for (found, expected) in
            found.pixels()[2..].iter().flatten().zip(image.pixels()[2..].iter().flatten())
        {
            assert!((found - expected).abs() <= expected.abs() / 2048.0 + 3e-8, "{found} is not {expected}");
        }
    }
}

#[test]
fn radiance_in_hdr_is_within_half_a_step_of_its_brightest_channel() {
    // Wide enough to be packed, too narrow, and of one row.
    for (width, height) in [(67, 45), (7, 5), (300, 1)] {
        let image = picture(width, height);
        let bytes = encoded(ImageFormat::Hdr, &image, Tone::default(), &Metadata::default());
        let found = decoded(&bytes);
        assert!(found.is_linear);
        for (found, expected) in found.values.pixels().iter().zip(image.pixels()) {
            // A mantissa that would round up to 256 takes the next exponent, and a step twice as wide.
            let step = expected.iter().copied().fold(0.0, f32::max) / 127.75;
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() <= step / 2.0, "{found} is not {expected}");
            }
        }
    }
}

#[test]
fn jpeg_is_near_and_keeps_its_colors_at_full_resolution() {
    let mut image = picture(64, 48);
    // Stripes of one pixel: with half the colours, they would be grey.
    for x in 0..64 {
        let stripe = if x % 2 == 0 { [0.6, 0.1, 0.1] } else { [0.1, 0.1, 0.6] };
        for y in 0..48 {
            image.put(x, y, 1, &[stripe]);
        }
    }
    let choice = EncodingChoice { quality: Some(95), ..EncodingChoice::default() };
    let bytes = encoded(
        Encoding::new(ImageFormat::Jpeg, choice).unwrap(),
        &image,
        Tone::default(),
        &Metadata::default(),
    );
    let frame = bytes.windows(2).position(|marker| marker == [0xff, 0xc0]).unwrap();
    let factors = [0, 1, 2].map(|component| bytes[frame + 11 + 3 * component]);
    assert_eq!(factors, [0x11; 3]);
    let (found, expected) = (decoded(&bytes), Tone::default().to_codes8(&image));
    for (found, expected) in found.values.pixels().iter().flatten().zip(expected.as_flattened()) {
        assert!((found * 255.0 - f32::from(*expected)).abs() < 12.0, "{found} is not {expected}");
    }
}

#[test]
fn a_better_jpeg_is_nearer_and_longer() {
    let image = picture(64, 48);
    let expected = Tone::default().to_codes8(&image);
    let (mut last_error, mut last_length) = (f32::INFINITY, 0);
    for quality in [10, 50, 92, 100] {
        let choice = EncodingChoice { quality: Some(quality), ..EncodingChoice::default() };
        let encoding = Encoding::new(ImageFormat::Jpeg, choice).unwrap();
        let bytes = encoded(encoding, &image, Tone::default(), &Metadata::default());
        let found = decoded(&bytes);
        let pairs = found.values.pixels().iter().flatten().zip(expected.as_flattened());
        let error = pairs.map(|(found, expected)| (found * 255.0 - f32::from(*expected)).abs()).sum::<f32>();
        assert!(error < last_error && bytes.len() > last_length, "{quality}");
        (last_error, last_length) = (error, bytes.len());
    }
}

#[test]
fn every_format_but_pfm_says_how_it_was_made_and_the_pixels_stay() {
    let (image, metadata) = (picture(20, 10), described());
    for encoding in all_encodings() {
        let bytes = encoded(encoding, &image, Tone::default(), &metadata);
        let plain = encoded(encoding, &image, Tone::default(), &Metadata::default());
        assert_eq!(decoded(&bytes), decoded(&plain), "{encoding:?}");
        assert_eq!(provenance_of(&plain), None, "{encoding:?}");
        let expected = metadata.provenance.clone().filter(|_| encoding.format() != ImageFormat::Pfm);
        assert_eq!(provenance_of(&bytes), expected, "{encoding:?}");
        let names_its_maker = bytes.windows(7).any(|window| window == b"Lancer ");
        assert_eq!(names_its_maker, encoding.format() != ImageFormat::Pfm, "{encoding:?}");
    }
}

#[test]
fn the_resolution_is_in_every_format_that_has_one() {
    let image = picture(20, 10);
    let bytes_of = |format: ImageFormat| encoded(format, &image, Tone::default(), &described());
    let png = bytes_of(ImageFormat::Png);
    let reader = png::Decoder::new(Cursor::new(&png)).read_info().unwrap();
    let dims = reader.info().pixel_dims.unwrap();
    assert_eq!((dims.xppu, dims.yppu, dims.unit), (11_811, 11_811, png::Unit::Meter));
    // JFIF, version 1.2, dots per inch, 300 x 300.
    assert!(bytes_of(ImageFormat::Jpeg)[6..].starts_with(b"JFIF\0\x01\x02\x01\x01\x2c\x01\x2c"));
    let tiff = bytes_of(ImageFormat::Tiff);
    let mut decoder = tiff::decoder::Decoder::new(Cursor::new(&tiff)).unwrap();
    assert_eq!(decoder.get_tag_u32(tiff::tags::Tag::ResolutionUnit).unwrap(), 2);
    assert_eq!(decoder.get_tag_u32_vec(tiff::tags::Tag::XResolution).unwrap(), [300, 1]);
    let exr = bytes_of(ImageFormat::Exr);
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(&exr), true).unwrap();
    assert_eq!(meta.headers[0].own_attributes.horizontal_density, Some(300.0));
}

#[test]
fn a_title_cannot_add_to_a_header() {
    let image = picture(8, 8);
    let metadata = Metadata { title: "a\nLANCER={}\nb\0c".into(), ..described() };
    for format in ImageFormat::ALL {
        let bytes = encoded(format, &image, Tone::default(), &metadata);
        let expected = metadata.provenance.clone().filter(|_| format != ImageFormat::Pfm);
        assert_eq!(provenance_of(&bytes), expected, "{format:?}");
        assert_eq!(decoded(&bytes).values.width(), 8);
    }
}

#[test]
fn a_provenance_of_two_lines_is_refused() {
    for wrong in ["a\nFORMAT=b", "é", "\0"] {
        let metadata = Metadata { provenance: Some(wrong.into()), ..Metadata::default() };
        for format in ImageFormat::ALL {
            assert!(write(format, &picture(8, 8), Tone::default(), &metadata, std::io::sink()).is_err());
        }
    }
}

// Files that mean harm

/// A file, with 100,000 or as much as it can say in place of its width and height.
fn giants() -> Vec<(&'static str, Vec<u8>)> {
    let of = |encoding: Encoding| encoded(encoding, &picture(20, 10), Tone::default(), &Metadata::default());
    let mut jpeg = of(ImageFormat::Jpeg.into());
    let frame = jpeg.windows(2).position(|marker| marker == [0xff, 0xc0]).unwrap();
    jpeg[frame + 5..frame + 9].fill(0xff);

    let mut webp = of(ImageFormat::WebP.into());
    let vp8l = webp.windows(4).position(|chunk| chunk == b"VP8L").unwrap();
    // 14 bits each of width - 1 and height - 1.
    webp[vp8l + 9..vp8l + 12].fill(0xff);
    webp[vp8l + 12] |= 0x0f;
    if let Some(vp8x) = webp.windows(4).position(|chunk| chunk == b"VP8X") {
        webp[vp8x + 12..vp8x + 18].copy_from_slice(&[0xff, 0x3f, 0, 0xff, 0x3f, 0]);
    }

    let mut tiff = of(encoding(ImageFormat::Tiff, Some(8), None));
    for tag in [0x100_u16, 0x101] {
        // A tag of one LONG.
        let entry = [&tag.to_le_bytes()[..], &[4, 0, 1, 0, 0, 0]].concat();
        let at = tiff.windows(8).position(|window| window == entry).unwrap() + 8;
        tiff[at..at + 4].copy_from_slice(&100_000_u32.to_le_bytes());
    }

    let mut exr = of(ImageFormat::Exr.into());
    let window =
        [&0_i32.to_le_bytes()[..], &0_i32.to_le_bytes(), &19_i32.to_le_bytes(), &9_i32.to_le_bytes()];
    let window = window.concat();
    let ends = exr.windows(16).enumerate().filter(|(_, found)| *found == window).map(|(at, _)| at + 8);
    for end in ends.collect::<Vec<_>>() {
        exr[end..end + 4].copy_from_slice(&99_999_i32.to_le_bytes());
        exr[end + 4..end + 8].copy_from_slice(&99_999_i32.to_le_bytes());
    }

    let mut hdr = of(ImageFormat::Hdr.into());
    let line = hdr.windows(12).position(|window| window == b"-Y 10 +X 20\n").unwrap();
    hdr.splice(line..line + 12, *b"-Y 100000 +X 100000\n");

    let mut png = of(ImageFormat::Png.into());
    png[16..24].copy_from_slice(&[0, 1, 0x86, 0xa0, 0, 1, 0x86, 0xa0]);
    let crc = crc32(&png[12..29]).to_be_bytes();
    png[29..33].copy_from_slice(&crc);

    vec![
        ("png", png),
        ("jpeg", jpeg),
        ("webp", webp),
        ("tiff", tiff),
        ("hdr", hdr),
        ("pfm", b"PF\n100000 100000\n-1.0\n".to_vec()),
        ("exr", exr),
    ]
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc: u32, &byte| {
        let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        (0..8).fold(crc ^ u32::from(byte), step)
    })
}

#[test]
fn pictures_of_ten_thousand_million_pixels_are_refused_by_their_headers() {
    for (name, bytes) in giants() {
        let error = refused(&bytes);
        // WebP may notice first that its two headers disagree, or that there is not enough.
        let is_told = error.contains("pixels are more than") || error.contains("broken");
        assert!(is_told, "{name}: {error}");
        let _ = provenance_of(&bytes);
    }
}

#[test]
fn a_radiance_header_without_an_end_is_refused() {
    let endless = [&b"#?RADIANCE\n"[..], &b"A=b\n".repeat(1 << 20)].concat();
    assert!(refused(&endless).contains("header does not end"));
    assert_eq!(provenance_of(&endless), None);
}

/// The chunk of a PNG, as it is to stand after the header.
fn with_chunk(name: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let mut png = encoded(ImageFormat::Png, &picture(20, 10), Tone::default(), &Metadata::default());
    let body = [&name[..], data].concat();
    let mut chunk = u32::try_from(data.len()).unwrap().to_be_bytes().to_vec();
    chunk.extend(&body);
    chunk.extend(crc32(&body).to_be_bytes());
    png.splice(33..33, chunk);
    png
}

#[test]
fn compressed_texts_and_profiles_that_swell_a_thousandfold_are_not_swollen() {
    // 1 GiB of zeros, as deflate packs them: a megabyte.
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    for _ in 0..64 {
        std::io::Write::write_all(&mut packer, &vec![0; 1 << 24]).unwrap();
    }
    let zeros = packer.finish().unwrap();
    for (name, head) in
        [(b"zTXt", &b"Comment\0\0"[..]), (b"iTXt", b"Comment\0\x01\0\0\0"), (b"iCCP", b"profile\0\0")]
    {
        let bytes = with_chunk(name, &[head, &zeros].concat());
        let _ = decode_picture(Path::new("it"), &bytes, MOST_PIXELS);
        let _ = provenance_of(&bytes);
    }
}

#[test]
fn every_cut_of_every_format_is_a_picture_or_an_error() {
    for encoding in all_encodings() {
        let whole = encoded(encoding, &picture(20, 10), Tone::default(), &described());
        for length in (0..whole.len()).step_by(whole.len() / 200 + 1) {
            let _ = decode_picture(Path::new("it"), &whole[..length], MOST_PIXELS);
            let _ = provenance_of(&whole[..length]);
        }
    }
}

/// Small pictures only, so that a lie about their size within the limits costs little.
#[test]
fn every_format_with_wrong_bytes_is_a_picture_or_an_error() {
    const FEW_PIXELS: u64 = 1 << 16;
    for encoding in all_encodings() {
        let whole = encoded(encoding, &picture(20, 10), Tone::default(), &described());
        let mut state = 0x2545_f491_4f6c_dd1d_u64;
        let mut random = |most: usize| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state % most as u64) as usize
        };
        for _ in 0..400 {
            let mut wrong = whole.clone();
            for _ in 0..1 + random(4) {
                let at = random(wrong.len());
                wrong[at] = [0, 1, 0x7f, 0x80, 0xff, random(256) as u8][random(6)];
            }
            let _ = decode_picture(Path::new("it"), &wrong, FEW_PIXELS);
            let _ = provenance_of(&wrong);
        }
    }
}
