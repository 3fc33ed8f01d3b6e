//! From the bytes of a file to its text.

use encoding_rs::{
    BIG5, EUC_JP, EUC_KR, Encoding, GBK, KOI8_R, SHIFT_JIS, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1250, WINDOWS_1251,
    WINDOWS_1252,
};

use std::borrow::Cow;

use super::error::ImportError;
use super::head::is_named;
use super::kinds;
#[cfg(feature = "spreadsheets")]
use super::spreadsheet;

/// How a zip archive begins.
const ZIP: &[u8] = b"PK\x03\x04";
/// How many bytes are looked at for the zeros of UTF-16 and UTF-32 without a byte order mark, and for words.
const LOOKED_AT: usize = 4096;
/// Encodings in which the names of columns may be words, where they are none in Windows' Latin-1.
const OTHERS: [&Encoding; 8] = [SHIFT_JIS, GBK, EUC_JP, EUC_KR, BIG5, WINDOWS_1251, KOI8_R, WINDOWS_1250];

/// A file, or a sheet of one, as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Source<'a> {
    pub(super) text: Cow<'a, str>,
    /// The name of the encoding, or the kind of a spreadsheet.
    pub(super) encoding: String,
    /// The name of the sheet, its number from 1 on, and how many there are, of a spreadsheet.
    pub(super) sheet: Option<(String, usize, usize)>,
    /// Whether a sheet has formulas without their values.
    pub(super) has_bare_formulas: bool,
}

impl Source<'_> {
    /// The text of a file, or of each sheet: that of its byte order mark, UTF-16 and UTF-32 by their zeros, UTF-8, the
    /// encoding in which the first lines have names of columns, or Windows' Latin-1, in which any bytes are a text.
    ///
    /// # Errors
    /// [`ImportError`] if it is a file of another kind, with the way to read it.
    pub(super) fn all<'a>(bytes: &'a [u8], sheet: Option<&str>) -> Result<Vec<Source<'a>>, ImportError> {
        if bytes.starts_with(ZIP) {
            #[cfg(feature = "spreadsheets")]
            return spreadsheet::read(bytes, sheet);
            #[cfg(not(feature = "spreadsheets"))]
            return Err(ImportError::of_file("this program is built without spreadsheets: save the file as CSV"));
        }
        if let Some(refusal) = kinds::refusal(bytes) {
            return Err(ImportError::of_file(refusal));
        }
        if sheet.is_some() {
            return Err(ImportError::of_file("only a spreadsheet has sheets: leave `sheet` out"));
        }
        let (text, name) = match utf_32(bytes) {
            Some((text, name)) => (Cow::Owned(text), name),
            None => {
                let guess = Encoding::for_bom(bytes).map_or_else(|| without_mark(bytes), |(encoding, _)| encoding);
                let is_wide = guess == UTF_16LE || guess == UTF_16BE;
                if let Some(refusal) = (!is_wide).then(|| kinds::binary(bytes)).flatten() {
                    return Err(ImportError::of_file(refusal));
                }
                (guess.decode(bytes).0, guess.name())
            }
        };
        let too_long = |_| ImportError::of_file("the file is too long: more than 4 GiB of text");
        u32::try_from(text.len()).map_err(too_long)?;
        Ok(vec![Source { text, encoding: name.to_owned(), sheet: None, has_bare_formulas: false }])
    }
}

fn without_mark(bytes: &[u8]) -> &'static Encoding {
    let zeros = |parity: usize| bytes.iter().take(LOOKED_AT).skip(parity).step_by(2).filter(|byte| **byte == 0).count();
    // Digits and separators have a zero in every second byte of UTF-16, and text in other encodings has none.
    let pairs = bytes.len().min(LOOKED_AT) / 2;
    match (zeros(0), zeros(1)) {
        (0, low) if 2 * low > pairs => UTF_16LE,
        (high, 0) if 2 * high > pairs => UTF_16BE,
        _ if std::str::from_utf8(bytes).is_ok() => UTF_8,
        _ => by_words(bytes),
    }
}

/// The encoding in which most cells of the first lines name a quantity; Windows' Latin-1 unless another one has more.
fn by_words(bytes: &[u8]) -> &'static Encoding {
    let begin = &bytes[..bytes.len().min(LOOKED_AT)];
    let named = |encoding: &'static Encoding| {
        let text = encoding.decode_without_bom_handling(begin).0;
        let cells = text.lines().take(20).flat_map(|line| line.split([';', ',', '\t', '|']));
        cells.filter(|cell| is_named(cell)).count()
    };
    let mut best = (named(WINDOWS_1252), WINDOWS_1252);
    for encoding in OTHERS {
        let count = named(encoding);
        if count > best.0 {
            best = (count, encoding);
        }
    }
    best.1
}

/// The text of UTF-32, by its mark or by its zeros.
fn utf_32(bytes: &[u8]) -> Option<(String, &'static str)> {
    let quads = bytes.len().min(LOOKED_AT) / 4;
    let zeros = |place: usize| bytes.iter().take(4 * quads).skip(place).step_by(4).filter(|byte| **byte == 0).count();
    let is_little =
        bytes.starts_with(&[0xff, 0xfe, 0, 0]) || quads > 1 && zeros(2) == quads && zeros(3) == quads && zeros(0) == 0;
    let is_big =
        bytes.starts_with(&[0, 0, 0xfe, 0xff]) || quads > 1 && zeros(0) == quads && zeros(1) == quads && zeros(3) == 0;
    let (read, name): (fn([u8; 4]) -> u32, _) = match (is_little, is_big) {
        (true, _) => (u32::from_le_bytes, "UTF-32LE"),
        (_, true) => (u32::from_be_bytes, "UTF-32BE"),
        _ => return None,
    };
    let letters = bytes.as_chunks::<4>().0.iter().map(|letter| char::from_u32(read(*letter)).unwrap_or('\u{fffd}'));
    Some((letters.collect::<String>().trim_start_matches('\u{feff}').to_owned(), name))
}

#[cfg(test)]
mod tests {
    use super::Source;

    #[test]
    fn the_same_text_is_read_from_every_encoding() {
        let text = "Höhe (µm)\n1,5;2\n";
        let wide = |order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        let wider =
            |order: fn(u32) -> [u8; 4]| text.chars().flat_map(|letter| order(u32::from(letter))).collect::<Vec<u8>>();
        let marked = |mark: &[u8], rest: Vec<u8>| [mark, &rest].concat();
        let latin: Vec<u8> = text.chars().map(|letter| u8::try_from(u32::from(letter)).unwrap()).collect();
        for (bytes, name) in [
            (text.as_bytes().to_vec(), "UTF-8"),
            (marked(b"\xef\xbb\xbf", text.as_bytes().to_vec()), "UTF-8"),
            (wide(u16::to_le_bytes), "UTF-16LE"),
            (wide(u16::to_be_bytes), "UTF-16BE"),
            (marked(b"\xff\xfe", wide(u16::to_le_bytes)), "UTF-16LE"),
            (marked(b"\xfe\xff", wide(u16::to_be_bytes)), "UTF-16BE"),
            (wider(u32::to_le_bytes), "UTF-32LE"),
            (marked(b"\xff\xfe\0\0", wider(u32::to_le_bytes)), "UTF-32LE"),
            (marked(b"\0\0\xfe\xff", wider(u32::to_be_bytes)), "UTF-32BE"),
            (latin, "windows-1252"),
        ] {
            let source = Source::all(&bytes, None).unwrap().remove(0);
            assert_eq!((source.text.as_ref(), source.encoding.as_str()), (text, name));
        }
        let (chinese, _, _) = encoding_rs::GBK.encode("时间(s),位移(μm),摩擦力(N)\n1,2,3\n");
        assert_eq!(Source::all(&chinese, None).unwrap()[0].encoding, "GBK");
    }
}
