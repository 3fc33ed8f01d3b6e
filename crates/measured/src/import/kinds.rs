//! Files that are no text: what they are, and how to read them.

/// How formats of instruments are read that are no text.
const PYTHON: &str = "the Python package reads it (`pip install \"stickslip[scans]\"`), or export it as text";
const TEXT: &str = "export its columns as text (CSV)";

/// How a file begins, what it then is, and how it can be read.
const BEGINNINGS: [(&[u8], &str, &str); 32] = [
    (b"DIGITAL SURF", "a surface of Digital Surf (.sur)", PYTHON),
    (b"DSCOMPRESSED", "a surface of Digital Surf (.sur)", PYTHON),
    (b"\x01\x00Directory", "a measurement of a Wyko or Bruker profiler (.opd)", PYTHON),
    (b"GWYP", "a Gwyddion file (.gwy)", PYTHON),
    (b"GWYO", "a Gwyddion file (.gwy)", PYTHON),
    (b"bISO-1.0", "a binary ISO 25178-71 file (.sdf)", "save it as text (aISO-1.0)"),
    (b"\\*File list", "a measurement of a Nanoscope microscope (.spm)", PYTHON),
    (b"\x88\x1b\x03\x6f", "a measurement of a Zygo profiler (.dat)", PYTHON),
    (b"\x88\x1b\x03\x70", "a measurement of a Zygo profiler (.dat)", PYTHON),
    (b"\x88\x1b\x03\x71", "a measurement of a Zygo profiler (.dat)", PYTHON),
    (b"VK4_", "a measurement of a Keyence microscope (.vk4)", PYTHON),
    (b"AliconaImaging", "a measurement of an Alicona microscope (.al3d)", PYTHON),
    (b"TDSm", "a LabVIEW file (.tdms)", "export it as .lvm or CSV, or read it with npTDMS"),
    (b"MATLAB 5.0", "a MATLAB file (.mat)", TEXT),
    (b"\x89HDF", "an HDF5 file", TEXT),
    (b"\x93NUMPY", "a NumPy array (.npy)", "give it to the Python package as an array"),
    (b"PAR1", "a Parquet file", TEXT),
    (b"ARROW1", "an Arrow file", TEXT),
    (b"SQLite format 3", "an SQLite database", TEXT),
    (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an old Excel workbook (.xls)", "save it as .xlsx or CSV"),
    (b"\x1f\x8b", "a file compressed by gzip", "unpack it"),
    (b"BZh", "a file compressed by bzip2", "unpack it"),
    (b"7z\xbc\xaf", "a 7-Zip archive", "unpack it"),
    (b"Rar!", "a RAR archive", "unpack it"),
    (b"\x28\xb5\x2f\xfd", "a file compressed by Zstandard", "unpack it"),
    (b"%PDF", "a PDF document", TEXT),
    (b"\x89PNG", "a picture (PNG)", TEXT),
    (b"\xff\xd8\xff", "a picture (JPEG)", TEXT),
    (b"II*\0", "a picture (TIFF)", "export the heights as text"),
    (b"MM\0*", "a picture (TIFF)", "export the heights as text"),
    (b"{\\rtf", "a rich text document", TEXT),
    (b"\x7fELF", "a program", TEXT),
];

/// Members by which an archive is known, what it then is, and how it can be read.
#[cfg(feature = "spreadsheets")]
const MEMBERS: [(&str, &str, &str); 5] = [
    ("main.xml", "an ISO 25178-72 file (.x3p)", PYTHON),
    ("recipe.txt", "a measurement of a Sensofar profiler (.plux)", PYTHON),
    ("word/document.xml", "a Word document", TEXT),
    ("xl/workbook.bin", "a binary spreadsheet (.xlsb)", "save it as .xlsx or CSV"),
    ("index.xml", "a measurement of a Sensofar profiler (.plux)", PYTHON),
];

/// Bytes in which a zero makes a file binary.
const LOOKED_AT: usize = 65_536;

/// Why a file that begins so is not read; none if it may be a text.
pub(super) fn refusal(bytes: &[u8]) -> Option<String> {
    let begun = BEGINNINGS.iter().find(|(beginning, ..)| bytes.starts_with(beginning));
    let text = bytes.trim_ascii_start();
    let starts = |mark: &[u8]| text.get(..mark.len()).is_some_and(|begin| begin.eq_ignore_ascii_case(mark));
    match begun {
        Some((_, what, how)) => Some(sentence(what, how)),
        None if starts(b"<!doctype html") || starts(b"<html") => Some(sentence("a web page (HTML)", TEXT)),
        None if starts(b"<?xml") => Some(sentence("an XML document", TEXT)),
        None if starts(b"{") && starts_json(text) => {
            Some(sentence("a JSON document", "send it to /fit or /profiles/fit as it is"))
        }
        None => None,
    }
}

/// Why a file is not read whose bytes are no text in any encoding.
pub(super) fn binary(bytes: &[u8]) -> Option<String> {
    let shown = &bytes[..bytes.len().min(LOOKED_AT)];
    let end = shown.iter().rposition(|byte| !matches!(byte, 0 | 0x1a)).map_or(0, |last| last + 1);
    let has_zeros = shown[..end].contains(&0);
    has_zeros.then(|| sentence("a binary file of a kind that is not supported", TEXT))
}

/// Why an archive with these members is not read.
#[cfg(feature = "spreadsheets")]
pub(super) fn archive<'a>(names: impl Iterator<Item = &'a str> + Clone) -> String {
    let has = |member: &str| names.clone().any(|name| name == member);
    let found = MEMBERS.iter().find(|(member, ..)| has(member));
    found.map_or_else(|| sentence("a zip archive", "unpack it"), |(_, what, how)| sentence(what, how))
}

fn sentence(what: &str, how: &str) -> String {
    format!("this is {what}, not columns of text: {how}")
}

fn starts_json(text: &[u8]) -> bool {
    text[1..].trim_ascii_start().starts_with(b"\"")
}
