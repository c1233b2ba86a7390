//! Metadata as Exif: a TIFF directory without a picture, as JPEG and WebP carry it.
//!
//! In: [`Metadata`]. Out: bytes. Every field is ASCII but the title, which is UTF-8, as most programs write it.
//! Source: CIPA DC-008 (Exif 3.0), 4.6; TIFF 6.0, section 2.

use super::metadata::Metadata;

/// Fields, in the order in which a directory lists them.
const DOCUMENT_NAME: u16 = 0x010d;
pub(super) const IMAGE_DESCRIPTION: u16 = 0x010e;
const X_RESOLUTION: u16 = 0x011a;
const Y_RESOLUTION: u16 = 0x011b;
const RESOLUTION_UNIT: u16 = 0x0128;
const SOFTWARE: u16 = 0x0131;

/// Types of fields.
const ASCII: u16 = 2;
const SHORT: u16 = 3;
const RATIONAL: u16 = 5;

/// The head: byte order, version, and where the directory is.
const HEAD: &[u8] = b"II\x2a\0\x08\0\0\0";

struct Field {
    tag: u16,
    kind: u16,
    count: u32,
    value: Vec<u8>,
}

/// The metadata, lower bytes first.
pub(super) fn write(metadata: &Metadata) -> Vec<u8> {
    let fields = fields(metadata);
    // Beside the count and the link to the next directory, 12 bytes a field; longer values follow.
    let values_at = HEAD.len() + 2 + 12 * fields.len() + 4;
    let (mut directory, mut values) = (HEAD.to_vec(), Vec::new());
    directory.extend((fields.len() as u16).to_le_bytes());
    for Field { tag, kind, count, mut value } in fields {
        directory.extend(tag.to_le_bytes());
        directory.extend(kind.to_le_bytes());
        directory.extend(count.to_le_bytes());
        if value.len() <= 4 {
            value.resize(4, 0);
            directory.extend(value);
        } else {
            directory.extend(((values_at + values.len()) as u32).to_le_bytes());
            values.extend(value);
            // Values begin at even places.
            values.resize(values.len().next_multiple_of(2), 0);
        }
    }
    directory.extend([0; 4]);
    directory.extend(values);
    directory
}

fn fields(metadata: &Metadata) -> Vec<Field> {
    let mut fields = Vec::new();
    if !metadata.title.is_empty() {
        fields.push(text(DOCUMENT_NAME, &metadata.title));
    }
    fields.extend(metadata.provenance.as_deref().map(|provenance| text(IMAGE_DESCRIPTION, provenance)));
    if let Some(dpi) = metadata.dpi {
        let value = [u32::from(dpi).to_le_bytes(), 1_u32.to_le_bytes()].concat();
        fields.push(Field { tag: X_RESOLUTION, kind: RATIONAL, count: 1, value: value.clone() });
        fields.push(Field { tag: Y_RESOLUTION, kind: RATIONAL, count: 1, value });
        // 2 is the inch.
        fields.push(Field { tag: RESOLUTION_UNIT, kind: SHORT, count: 1, value: vec![2, 0] });
    }
    fields.push(text(SOFTWARE, &metadata.software));
    fields
}

fn text(tag: u16, text: &str) -> Field {
    let mut value = text.replace('\0', " ").into_bytes();
    value.push(0);
    Field { tag, kind: ASCII, count: value.len() as u32, value }
}

/// The text of a field of the first directory; `None` where there is none, or the bytes are no Exif.
pub(super) fn read_text(bytes: &[u8], tag: u16) -> Option<String> {
    let bytes = bytes.strip_prefix(b"Exif\0\0").unwrap_or(bytes);
    let is_little = match bytes.get(..4)? {
        b"II\x2a\0" => true,
        b"MM\0\x2a" => false,
        _ => return None,
    };
    let short = |at: usize| -> Option<u16> {
        let bytes = bytes.get(at..at.checked_add(2)?)?.try_into().ok()?;
        Some(if is_little { u16::from_le_bytes(bytes) } else { u16::from_be_bytes(bytes) })
    };
    let long = |at: usize| -> Option<usize> {
        let bytes = bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        Some(if is_little { u32::from_le_bytes(bytes) } else { u32::from_be_bytes(bytes) } as usize)
    };
    let directory = long(4)?;
    let entries = (0..usize::from(short(directory)?)).map(|index| directory + 2 + 12 * index);
    let mut found = entries.filter(|&at| short(at) == Some(tag) && short(at + 2) == Some(ASCII));
    let at = found.next()?;
    let count = long(at + 4)?;
    let value_at = if count <= 4 { at + 8 } else { long(at + 8)? };
    let value = bytes.get(value_at..value_at.checked_add(count)?)?;
    let end = value.iter().position(|&byte| byte == 0).unwrap_or(value.len());
    String::from_utf8(value[..end].to_vec()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_read() {
        let metadata = Metadata {
            title: "Bâtiment".into(),
            provenance: Some("{\"a\": 1}".into()),
            dpi: Some(300),
            ..Metadata::default()
        };
        let bytes = write(&metadata);
        assert_eq!(read_text(&bytes, IMAGE_DESCRIPTION), metadata.provenance);
        assert_eq!(read_text(&bytes, SOFTWARE).as_ref(), Some(&metadata.software));
        assert_eq!(read_text(&bytes, DOCUMENT_NAME).as_ref(), Some(&metadata.title));
        assert_eq!(read_text(&bytes, X_RESOLUTION), None);
        let with_head = [b"Exif\0\0", bytes.as_slice()].concat();
        assert_eq!(read_text(&with_head, IMAGE_DESCRIPTION), metadata.provenance);
    }

    #[test]
    fn every_cut_and_every_wrong_byte_is_read_as_something_or_nothing() {
        let whole = write(&Metadata { provenance: Some("provenance".into()), ..Metadata::default() });
        for length in 0..whole.len() {
            let _ = read_text(&whole[..length], IMAGE_DESCRIPTION);
            for value in [0, 1, 127, 255] {
                let mut wrong = whole.clone();
                wrong[length] = value;
                let _ = read_text(&wrong, IMAGE_DESCRIPTION);
            }
        }
    }
}
