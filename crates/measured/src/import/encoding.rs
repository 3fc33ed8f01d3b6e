//! From the bytes of a file to its text.

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// How many bytes are looked at for the zeros of UTF-16 without a byte order mark.
const LOOKED_AT: usize = 4096;

/// The text of a file, and the name of its encoding: that of its byte order mark, UTF-16 by its zeros, UTF-8, or
/// Windows' Latin-1, in which any bytes are a text.
pub(super) fn decode(bytes: &[u8]) -> (String, &'static str) {
    let guess = Encoding::for_bom(bytes).map_or_else(|| without_mark(bytes), |(encoding, _)| encoding);
    let (text, encoding, _) = guess.decode(bytes);
    (text.into_owned(), encoding.name())
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
    use super::decode;

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
            assert_eq!(decode(&bytes), (text.to_owned(), name));
        }
    }
}
