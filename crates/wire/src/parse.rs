//! Parses bytes into a typed document, with a pointer to each fault.

use serde::de::{DeserializeOwned, IgnoredAny};
use serde_path_to_error::{Deserializer, Path, Segment, Track};

use super::check::escaped;
use crate::prelude::*;

/// Longest detail or pointer of a fault: both can quote the body, which may be long.
const LONGEST_TEXT: usize = 400;

/// How a body in UTF-8 may begin, and how one in UTF-16 does.
const MARK: &[u8] = b"\xef\xbb\xbf";
const WIDE_MARKS: [&[u8]; 2] = [b"\xff\xfe", b"\xfe\xff"];
/// Where motion in the plane has a place, for the documents that have none.
const IN_PLANE: &str = ": motion in the plane, a pair [x, y] in `moves` or an `ellipse`, needs `/simulate` or `/sweep`";
/// Values that are no JSON, in lower case and without a sign.
const NOT_NUMBERS: [&str; 3] = ["nan", "inf", "infinity"];

/// Parses a body, which may begin with a byte order mark.
///
/// # Errors
/// [`Rejection::NotJson`] if it is not JSON, [`Rejection::Invalid`] with one fault if it is not the expected document.
pub fn parse<T: DeserializeOwned>(body: &[u8]) -> Result<T, Rejection> {
    let body = body.strip_prefix(MARK).unwrap_or(body);
    let mut json = serde_json::Deserializer::from_slice(body);
    let mut track = Track::new();
    let parsed = T::deserialize(Deserializer::new(&mut json, &mut track));
    match parsed.and_then(|value| json.end().map(|()| value)) {
        Ok(value) => Ok(value),
        // serde_json calls some well-formed documents a syntax error too (1e999, an array longer than expected), and
        // reports a wrong member before it reaches a broken end; so check again whether it is JSON at all.
        Err(error) => match well_formed(body) {
            Err(broken) => Err(Rejection::NotJson(broken)),
            Ok(()) => Err(Rejection::Invalid(vec![fault(&track.path(), &error.to_string())])),
        },
    }
}

/// Parses a document that has been read as a value already.
///
/// # Errors
/// The fault if it is not the expected document.
pub fn parse_value<T: DeserializeOwned>(value: &Value) -> Result<T, Fault> {
    let mut track = Track::new();
    let parsed = T::deserialize(Deserializer::new(value, &mut track));
    parsed.map_err(|error| fault(&track.path(), &error.to_string()))
}

fn well_formed(body: &[u8]) -> Result<(), String> {
    if WIDE_MARKS.iter().any(|mark| body.starts_with(mark)) {
        return Err("the body is in UTF-16: send it in UTF-8".to_owned());
    }
    let text = std::str::from_utf8(body).map_err(|error| error.to_string())?;
    serde_json::from_str::<IgnoredAny>(text).map(|_| ()).map_err(|error| {
        let line = text.lines().nth(error.line().saturating_sub(1)).unwrap_or("");
        let hint = if is_not_a_number(line, error.column()) {
            ": only finite numbers are JSON, write `null` where one is missing"
        } else {
            ""
        };
        format!("{error}{hint}")
    })
}

/// Whether the word around a column of a line, from 1 on, stands for a number that is not finite.
fn is_not_a_number(line: &str, column: usize) -> bool {
    let bytes = line.as_bytes();
    let is_letter = |index: &usize| bytes.get(*index).is_some_and(u8::is_ascii_alphabetic);
    let at = column.saturating_sub(1).min(bytes.len());
    let start = (0..at).rev().take_while(is_letter).last().unwrap_or(at);
    let start = if is_letter(&start) { start } else { start.saturating_add(1) };
    let end = (start..bytes.len()).take_while(is_letter).last().map_or(start, |last| last.saturating_add(1));
    line.get(start..end).is_some_and(|word| NOT_NUMBERS.contains(&word.to_lowercase().as_str()))
}

/// The fault that a message of serde describes.
fn fault(path: &Path, message: &str) -> Fault {
    let message = message.rsplit_once(" at line ").map_or(message, |(text, _)| text);
    let mut pointer = pointer(path);
    // An unknown member is mostly part of the path already; its name may hold any character.
    let unknown = match path.iter().next_back() {
        Some(Segment::Map { key }) => message.starts_with(&format!("unknown field `{key}`")),
        _ => false,
    };
    // serde reports these three at the object; the member is the better place.
    for prefix in ["missing field `", "duplicate field `", "unknown field `"] {
        if let Some((name, _)) = message.strip_prefix(prefix).and_then(|rest| rest.split_once('`'))
            && !unknown
        {
            pointer.push_str(&format!("/{}", escaped(name)));
        }
    }
    let name = path.iter().rev().find_map(|segment| if let Segment::Map { key } = segment { Some(key) } else { None });
    let tangential = name.is_some_and(|name| ["displacement", "force"].contains(&name.as_str()));
    let is_pair = tangential && message.starts_with("invalid type: sequence, expected f64");
    let hint = if is_pair || message.starts_with("unknown variant `ellipse`") { IN_PLANE } else { "" };
    Fault::new(shortened(pointer), shortened(in_json_terms(message) + hint))
}

fn pointer(path: &Path) -> String {
    path.iter().fold(String::new(), |mut pointer, segment| {
        match segment {
            Segment::Map { key } => pointer.push_str(&format!("/{}", escaped(key))),
            Segment::Seq { index } => pointer.push_str(&format!("/{index}")),
            Segment::Enum { variant } => pointer.push_str(&format!("/{}", escaped(variant))),
            Segment::Unknown => {}
        }
        pointer
    })
}

/// Replaces Rust's names of types in messages of serde by JSON's.
fn in_json_terms(message: &str) -> String {
    let text = message.replacen("invalid type: map", "invalid type: object", 1);
    let mut text = text.replacen("invalid type: sequence", "invalid type: array", 1);
    if let Some((head, tail)) = text.rsplit_once(", expected ") {
        let plain = match tail {
            "f64" => "a number",
            "usize" | "u64" => "a whole number, not negative",
            "a sequence" => "an array",
            "a boolean" => "true or false",
            _ if tail.contains("enum ") => "a string",
            _ => tail,
        };
        text = format!("{head}, expected {plain}");
    }
    text
}

fn shortened(mut text: String) -> String {
    if let Some((cut, _)) = text.char_indices().nth(LONGEST_TEXT) {
        text.truncate(cut);
        text.push('…');
    }
    text
}
