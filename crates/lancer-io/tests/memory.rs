//! What reading holds at most: in a program of its own, since it counts every allocation.

use lancer_core::film::{Image, Tone};
use lancer_io::image::encode::write;
use lancer_io::image::{ImageFormat, Metadata, provenance_of};
use peak_alloc::PeakAlloc;

#[global_allocator]
static ALLOCATOR: PeakAlloc = PeakAlloc;

#[test]
fn a_webp_whose_exif_claims_4_gb_is_not_believed() {
    let metadata = Metadata { provenance: Some("{}".into()), ..Metadata::default() };
    let mut bytes = Vec::new();
    write(ImageFormat::WebP, &Image::black(2, 2), Tone::default(), &metadata, &mut bytes).unwrap();
    assert_eq!(provenance_of(&bytes).as_deref(), Some("{}"));
    let chunk = bytes.windows(4).position(|window| window == b"EXIF").unwrap();
    bytes[chunk + 4..chunk + 8].copy_from_slice(&u32::MAX.to_le_bytes());
    ALLOCATOR.reset_peak_usage();
    let before = ALLOCATOR.current_usage();
    assert_eq!(provenance_of(&bytes), None);
    let held = ALLOCATOR.peak_usage() - before;
    assert!(held < 1 << 20, "{held} bytes were held for {}", bytes.len());
}
