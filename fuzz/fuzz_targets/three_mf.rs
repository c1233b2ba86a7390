//! The XML of 3MF files: the model, and after a line of `%%` a part that it may name `/3D/part.model`.
//!
//! The archive around it is made here: a fuzzer does not find checksums.

#![no_main]

use lancer_fuzz::{parts, read};
use libfuzzer_sys::fuzz_target;
use std::io::{Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

fuzz_target!(|input: &[u8]| {
    let (model, part) = parts(input);
    read(&[("model.3mf", &archive_of(&[("3D/3dmodel.model", model), ("3D/part.model", part)]))], Vec::new());
});

fn archive_of(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    for (name, bytes) in files {
        archive.start_file(*name, stored).expect("a file can be begun in memory");
        archive.write_all(bytes).expect("memory can be written to");
    }
    archive.finish().expect("an archive can be ended in memory").into_inner()
}
