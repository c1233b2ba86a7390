//! GLB: a glTF document and its bytes in one file.
//!
//! Source: Khronos Group, "glTF 2.0 specification", chapter 4.

/// The parts of a file.
#[derive(Debug)]
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// What a buffer without a URI means.
    pub(super) binary: Option<&'a [u8]>,
}

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BINARY: u32 = u32::from_le_bytes(*b"BIN\0");

impl<'a> Container<'a> {
    /// The parts of a GLB file; anything else is taken for the document itself.
    pub(super) fn parse(bytes: &'a [u8]) -> Result<Self, String> {
        const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
        if !bytes.starts_with(MAGIC) {
            return Ok(Self { json: bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes), binary: None });
        }
        let ([version, length], mut rest) =
            words(&bytes[MAGIC.len()..]).ok_or("ends in the header of a GLB file")?;
        if version != 2 {
            return Err(format!("is a GLB file of version {version}; 2 is read"));
        }
        let all = bytes.len();
        let beyond = all.checked_sub(length as usize);
        let beyond =
            beyond.ok_or_else(|| format!("has {all} of the {length} bytes that its header promises"))?;
        rest = &rest[..rest.len().saturating_sub(beyond)];
        let (mut json, mut binary) = (None, None);
        while !rest.is_empty() {
            let at = length as usize - rest.len();
            let ([length, kind], data) =
                words(rest).ok_or_else(|| format!("ends in the chunk at byte {at}"))?;
            let (chunk, after) = data.split_at_checked(length as usize).ok_or_else(|| {
                format!("the chunk at byte {at} is {length} bytes long, but only {} follow", data.len())
            })?;
            match kind {
                JSON if json.is_none() => json = Some(chunk),
                BINARY if binary.is_none() => binary = Some(chunk),
                // Readers must pass over chunks that they do not know.
                _ => {}
            }
            rest = after;
        }
        Ok(Self { json: json.ok_or("has no JSON chunk")?, binary })
    }
}

/// Two numbers, and what follows.
fn words(bytes: &[u8]) -> Option<([u32; 2], &[u8])> {
    let (first, rest) = bytes.split_first_chunk::<4>()?;
    let (second, rest) = rest.split_first_chunk::<4>()?;
    Some(([u32::from_le_bytes(*first), u32::from_le_bytes(*second)], rest))
}
