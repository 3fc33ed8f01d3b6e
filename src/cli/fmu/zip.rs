//! A ZIP archive without compression (APPNOTE 6.3.10), the same bytes for the same files.

/// The first of January 1980, the first day of the format.
const DATE: u16 = 0x21;
/// What a reader must know: folders, and nothing later.
const VERSION: u16 = 20;
/// Names are in UTF-8.
const FLAGS: u16 = 0x0800;

/// The archive of files, by their names.
pub fn archive(files: &[(String, Vec<u8>)]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let place = length(&bytes);
        let mut about = Vec::new();
        for number in [VERSION, FLAGS, 0, 0, DATE] {
            about.extend(number.to_le_bytes());
        }
        for number in [crc32fast::hash(content), length(content), length(content), length(name.as_bytes())] {
            about.extend(number.to_le_bytes());
        }
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&about);
        bytes.extend(name.as_bytes());
        bytes.extend(content);
        directory.extend(b"PK\x01\x02");
        directory.extend(VERSION.to_le_bytes());
        directory.extend(&about);
        // Comment, disk and attributes.
        directory.extend([0; 10]);
        directory.extend(place.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (place, size) = (length(&bytes), length(&directory));
    let count = files.len() as u16;
    bytes.extend(directory);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    for number in [count, count] {
        bytes.extend(number.to_le_bytes());
    }
    for number in [size, place] {
        bytes.extend(number.to_le_bytes());
    }
    bytes.extend([0; 2]);
    bytes
}

/// Of less than 4 GiB: a library and texts.
fn length(bytes: &[u8]) -> u32 {
    bytes.len() as u32
}
