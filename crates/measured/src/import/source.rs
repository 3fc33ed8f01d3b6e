//! From the bytes of a file to its text.

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

use super::error::ImportError;
use super::kinds;
#[cfg(feature = "spreadsheets")]
use super::spreadsheet;

/// How a zip archive begins.
const ZIP: &[u8] = b"PK\x03\x04";
/// How many bytes are looked at for the zeros of UTF-16 without a byte order mark.
const LOOKED_AT: usize = 4096;

/// A file as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Source {
    pub(super) text: String,
    /// The name of the encoding, or the kind of a spreadsheet with its sheet.
    pub(super) encoding: String,
    /// What there is to say of it.
    pub(super) remark: Option<String>,
}

impl Source {
    /// The text of a file: that of its byte order mark, UTF-16 by its zeros, UTF-8, or Windows' Latin-1, in which any
    /// bytes are a text; of a spreadsheet that of a sheet.
    ///
    /// # Errors
    /// [`ImportError`] if it is a file of another kind, with the way to read it.
    pub(super) fn of(bytes: &[u8], sheet: Option<&str>) -> Result<Source, ImportError> {
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
        let guess = Encoding::for_bom(bytes).map_or_else(|| without_mark(bytes), |(encoding, _)| encoding);
        if let Some(refusal) = (guess != UTF_16LE && guess != UTF_16BE).then(|| kinds::binary(bytes)).flatten() {
            return Err(ImportError::of_file(refusal));
        }
        let (text, encoding, _) = guess.decode(bytes);
        Ok(Source { text: text.into_owned(), encoding: encoding.name().to_owned(), remark: None })
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
        _ => WINDOWS_1252,
    }
}

#[cfg(test)]
mod tests {
    use super::Source;

    #[test]
    fn the_same_text_is_read_from_every_encoding() {
        let text = "Höhe (µm)\n1,5;2\n";
        let wide = |order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        let marked = |mark: &[u8], rest: Vec<u8>| [mark, &rest].concat();
        let latin: Vec<u8> = text.chars().map(|letter| u8::try_from(u32::from(letter)).unwrap()).collect();
        for (bytes, name) in [
            (text.as_bytes().to_vec(), "UTF-8"),
            (marked(b"\xef\xbb\xbf", text.as_bytes().to_vec()), "UTF-8"),
            (wide(u16::to_le_bytes), "UTF-16LE"),
            (wide(u16::to_be_bytes), "UTF-16BE"),
            (marked(b"\xff\xfe", wide(u16::to_le_bytes)), "UTF-16LE"),
            (marked(b"\xfe\xff", wide(u16::to_be_bytes)), "UTF-16BE"),
            (latin, "windows-1252"),
        ] {
            let source = Source::of(&bytes, None).unwrap();
            assert_eq!((source.text.as_str(), source.encoding.as_str()), (text, name));
        }
    }
}
