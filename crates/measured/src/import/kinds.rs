//! Files that are no text: what they are, and how to read them.

/// How formats of instruments are read that are no text.
const PYTHON: &str = "the Python package reads it (`pip install \"stickslip[scans]\"`), or export it as text";
#[cfg(feature = "spreadsheets")]
const JPK: &str = "export it as text in JPK's data processing, or read it with afmformats";
const TEXT: &str = "export its columns as text (CSV)";

/// How a file begins, what it then is, and how it can be read.
const BEGINNINGS: [(&[u8], &str, &str); 59] = [
    (b"DIGITAL SURF", "a surface of Digital Surf (.sur)", PYTHON),
    (b"DSCOMPRESSED", "a surface of Digital Surf (.sur)", PYTHON),
    (b"\x01\x00Directory", "a measurement of a Wyko or Bruker profiler (.opd)", PYTHON),
    (b"GWYP", "a Gwyddion file (.gwy)", PYTHON),
    (b"GWYO", "a Gwyddion file (.gwy)", PYTHON),
    (b"bBCR-1.0", "a binary BCR file (.sdf, .bcr)", "save it as text (aISO-1.0)"),
    (b"bISO-2.0", "a binary ISO 25178-71 file (.sdf)", "save it as text (aISO-1.0)"),
    (b"bISO-1.0", "a binary ISO 25178-71 file (.sdf)", "save it as text (aISO-1.0)"),
    (b"\\*File list", "a measurement of a Nanoscope microscope (.spm)", PYTHON),
    (b"\x88\x1b\x03\x6f", "a measurement of a Zygo profiler (.dat)", PYTHON),
    (b"\x88\x1b\x03\x70", "a measurement of a Zygo profiler (.dat)", PYTHON),
    (b"\x88\x1b\x03\x71", "a measurement of a Zygo profiler (.dat)", PYTHON),
    (b"VK4_", "a measurement of a Keyence microscope (.vk4)", PYTHON),
    (b"AliconaImaging", "a measurement of an Alicona microscope (.al3d)", PYTHON),
    (b"TDSm", "a LabVIEW file (.tdms)", "export it as .lvm or CSV, or read it with npTDMS"),
    (b"MATLAB 5.0", "a MATLAB file (.mat)", "read it with scipy.io.loadmat, or export its columns as text (CSV)"),
    (b"MATLAB 7.3", "a MATLAB 7.3 file (.mat, in HDF5)", "read it with h5py, or export its columns as text (CSV)"),
    (
        b"MDF     ",
        "a measurement data file (MDF, .mf4 or .mdf)",
        "read it with asammdf, or export its columns as text (CSV)",
    ),
    (
        b"UnFinMF ",
        "a measurement data file (MDF, not finished)",
        "read it with asammdf, or export its columns as text (CSV)",
    ),
    (b"#VRML", "a scene (VRML, .wrl)", "export the heights as text (x, y, z)"),
    (b"solid ", "a body of triangles (STL)", "export the heights as text (x, y, z)"),
    (b"ply\n", "a body of polygons (PLY)", "export the heights as text (x, y, z)"),
    (b"ply\r\n", "a body of polygons (PLY)", "export the heights as text (x, y, z)"),
    (b"ISO-10303-21", "a drawing (STEP)", "export the heights as text (x, y, z)"),
    (b"FEA1", "a Feather file", TEXT),
    (b"CDF\x01", "a netCDF file (.nc)", TEXT),
    (b"CDF\x02", "a netCDF file (.nc)", TEXT),
    (b"SIMPLE  =", "a FITS file", TEXT),
    (b"CPYA ", "an Origin project (.opj)", TEXT),
    (b"CPYUA ", "an Origin project (.opju)", TEXT),
    (b"IGOR\r", "an Igor text file (.itx)", TEXT),
    (b"IGOR\n", "an Igor text file (.itx)", TEXT),
    (
        b"\x80\x04\x95",
        "a pickle of Python",
        "give its arrays to the Python package, or export its columns as text (CSV)",
    ),
    (b"RDX", "data of R (.RData)", "write them with write.csv"),
    (b"$FL2", "an SPSS file (.sav)", TEXT),
    (b"<stata_dta>", "a Stata file (.dta)", TEXT),
    (b"\xfd7zXZ", "a file compressed by xz", "unpack it"),
    (b"RIFF", "a sound or film (RIFF)", TEXT),
    (b"GIF8", "a picture (GIF)", TEXT),
    (b"\x0e\x03\x13\x01", "an HDF4 file", TEXT),
    (b"\x00\x01\x00\x00Standard", "an Access database", TEXT),
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
const MEMBERS: [(&str, &str, &str); 8] = [
    ("segments/0/segment-header.properties", "a JPK archive", JPK),
    ("header.properties", "a force curve or map of JPK (.jpk-force)", JPK),
    ("data-image.force", "a force curve or map of JPK (.jpk-force-map)", JPK),
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
        None if starts(b"{") && is_lines_of_json(text) => Some(sentence(
            "JSON Lines",
            "read it with pandas.read_json(file, lines=True) and give the table to the Python package, or export its \
             columns as text (CSV)",
        )),
        None if is_universal(bytes) => Some(sentence(
            "a universal file (UFF, dataset 58)",
            "read it with pyuff, or export its columns as text (CSV)",
        )),
        None if starts(b"[") && text.get(1..).is_some_and(|rest| rest.trim_ascii_start().starts_with(b"{\"")) => {
            Some(sentence("a JSON document", "read it with pandas.read_json and export its columns as text (CSV)"))
        }
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

/// Whether every line begins an object of its own.
fn is_lines_of_json(text: &[u8]) -> bool {
    let mut lines = text.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii).filter(|line| !line.is_empty());
    let is_object = |line: &[u8]| line.starts_with(b"{") && line.ends_with(b"}");
    lines.next().is_some_and(is_object) && lines.next().is_some_and(|line| line.starts_with(b"{"))
}

/// Whether the first lines are those of a dataset of a universal file: -1, and the number of its kind.
fn is_universal(bytes: &[u8]) -> bool {
    let mut lines = bytes.split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii);
    let is_kind =
        |line: &[u8]| !line.is_empty() && line.len() < 6 && line[..2.min(line.len())].iter().all(u8::is_ascii_digit);
    bytes.starts_with(b"    -1") && lines.next() == Some(b"-1") && lines.next().is_some_and(is_kind)
}

fn starts_json(text: &[u8]) -> bool {
    text[1..].trim_ascii_start().starts_with(b"\"")
}
