//! Damages to the text of a request.

use proptest::prelude::*;
use proptest::sample::select;
use serde_json::Value;

/// A damage to the text of a request.
#[derive(Clone, Debug)]
pub enum Damage {
    /// Another byte at a place, given as a fraction of the length.
    Byte(f64, u8),
    /// A stretch is cut out.
    Cut(f64, usize),
    /// A stretch is duplicated.
    Duplicate(f64, usize),
    /// A word is inserted.
    Insert(f64, &'static str),
    /// The n-th number becomes something else.
    Number(usize, &'static str),
    /// The n-th value of the document becomes something else.
    Replace(usize, &'static str),
    /// The n-th value of the document is left out.
    Remove(usize),
}

/// Values to put in, and words to insert.
pub const WORDS: &str = r#"
    null true {} [] "rigid" "exact" 1e999 -1e999 1e-999 -0.0 5e-324 1e308 0 -1 9007199254740993
    18446744073709551616 0.1 1e-15 "" "a/b~c" "\u0000" [[]] {"displacement":1e-7} [0,1e-9,1e-9]
"#;

/// Any damage.
pub fn damage() -> impl Strategy<Value = Damage> {
    let place = || 0.0..1.0_f64;
    let word = || select(WORDS.split_whitespace().collect::<Vec<_>>());
    prop_oneof![
        2 => (place(), any::<u8>()).prop_map(|(place, byte)| Damage::Byte(place, byte)),
        1 => (place(), 1..20_usize).prop_map(|(place, length)| Damage::Cut(place, length)),
        1 => (place(), 1..40_usize).prop_map(|(place, length)| Damage::Duplicate(place, length)),
        1 => (place(), word()).prop_map(|(place, word)| Damage::Insert(place, word)),
        4 => (0..60_usize, word()).prop_map(|(index, word)| Damage::Number(index, word)),
        3 => (0..60_usize, word()).prop_map(|(index, word)| Damage::Replace(index, word)),
        2 => (0..60_usize).prop_map(Damage::Remove),
    ]
}

impl Damage {
    /// The text with this damage.
    pub fn apply(&self, mut text: Vec<u8>) -> Vec<u8> {
        let length = text.len();
        let at = |place: f64| ((place * length as f64) as usize).min(length.saturating_sub(1));
        match *self {
            _ if text.is_empty() => {}
            Damage::Byte(place, byte) => text[at(place)] = byte,
            Damage::Cut(place, count) => drop(text.drain(at(place)..(at(place) + count).min(length))),
            Damage::Duplicate(place, count) => {
                let stretch = text[at(place)..(at(place) + count).min(length)].to_vec();
                text.splice(at(place)..at(place), stretch);
            }
            Damage::Insert(place, word) => drop(text.splice(at(place)..at(place), word.bytes())),
            Damage::Number(index, word) => {
                let numbers = numbers(&text);
                if let Some(stretch) = numbers.get(index % numbers.len().max(1)) {
                    text.splice(stretch.clone(), word.bytes());
                }
            }
            Damage::Replace(index, word) => {
                if let (Ok(mut document), Ok(word)) = (serde_json::from_slice(&text), serde_json::from_str(word)) {
                    change(&mut document, index, Some(word));
                    text = document.to_string().into_bytes();
                }
            }
            Damage::Remove(index) => {
                if let Ok(mut document) = serde_json::from_slice(&text) {
                    change(&mut document, index, None);
                    text = document.to_string().into_bytes();
                }
            }
        }
        text
    }
}

/// The ranges of the numbers in a text.
fn numbers(text: &[u8]) -> Vec<std::ops::Range<usize>> {
    let belongs = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'-' | b'+' | b'.' | b'e');
    let mut found = Vec::new();
    let mut index = 0;
    while index < text.len() {
        let end = text[index..].iter().position(|byte| !belongs(*byte)).map_or(text.len(), |more| index + more);
        if text[index..end].iter().any(u8::is_ascii_digit) {
            found.push(index..end);
        }
        index = end + 1;
    }
    found
}

/// The pointers of all values of a document.
fn places(value: &Value) -> Vec<String> {
    let inner: Vec<(String, &Value)> = match value {
        Value::Array(elements) => elements.iter().enumerate().map(|(at, one)| (at.to_string(), one)).collect(),
        Value::Object(members) => members.iter().map(|(name, member)| (name.clone(), member)).collect(),
        _ => Vec::new(),
    };
    let within = |(name, value): (String, &Value)| {
        places(value).into_iter().map(|below| format!("/{name}{below}")).collect::<Vec<_>>()
    };
    std::iter::once(String::new()).chain(inner.into_iter().flat_map(within)).collect()
}

/// Replaces the n-th value of a document, or removes it.
fn change(document: &mut Value, index: usize, by: Option<Value>) {
    let places = places(document);
    let place = &places[index % places.len()];
    if let Some(by) = by {
        document.pointer_mut(place).into_iter().for_each(|value| *value = by.clone());
        return;
    }
    let (parent, name) = place.rsplit_once('/').unwrap_or_default();
    match document.pointer_mut(parent) {
        Some(Value::Object(members)) => drop(members.remove(name)),
        Some(Value::Array(elements)) if !name.is_empty() => drop(elements.remove(name.parse().unwrap())),
        _ => {}
    }
}
