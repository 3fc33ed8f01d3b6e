//! JSON from the schemas of the OpenAPI document, and what can be done to it.

use serde_json::{Map, Value, json};

use super::common::kill::Random;

/// Elements of an array beyond the fewest that it may have.
const MORE: u64 = 4;
/// Most counts are small, since large ones only take longer.
const COUNT: u64 = 40;

/// A document that makes values.
pub struct Schemas {
    document: Value,
}

impl Schemas {
    pub fn new(document: &str) -> Schemas {
        Schemas { document: serde_json::from_str(document).unwrap() }
    }

    /// All calls: path, method, and the description of the operation.
    pub fn operations(&self) -> Vec<(String, String, Value)> {
        let paths = self.document["paths"].as_object().unwrap().iter();
        let operations = paths.flat_map(|(path, item)| {
            item.as_object()
                .unwrap()
                .iter()
                .map(|(method, operation)| (path.clone(), method.to_uppercase(), operation.clone()))
        });
        operations.collect()
    }

    /// The examples of a request body.
    pub fn examples(&self, operation: &Value) -> Vec<Value> {
        let content = &operation["requestBody"]["content"]["application/json"];
        let named = content["examples"].as_object().into_iter().flat_map(Map::values).map(|named| &named["value"]);
        named.chain(content.get("example")).cloned().collect()
    }

    /// A value that a schema allows, or nearly so.
    pub fn value(&self, schema: &Value, random: &mut Random) -> Value {
        if let Some(reference) = schema["$ref"].as_str() {
            let found = self.document.pointer(reference.trim_start_matches('#'));
            return self.value(found.unwrap_or_else(|| panic!("{reference} is missing")), random);
        }
        if let Some(names) = schema["enum"].as_array() {
            return pick(names, random).clone();
        }
        if let Some(all) = schema["allOf"].as_array() {
            let mut parts: Vec<Value> = all.iter().map(|part| self.value(part, random)).collect();
            parts.push(self.members(schema, random));
            return merged(parts.into_iter());
        }
        if let Some(choices) = schema["oneOf"].as_array().or(schema["anyOf"].as_array()) {
            let chosen = self.value(pick(choices, random), random);
            return if chosen.is_object() {
                merged([chosen, self.members(schema, random)].into_iter())
            } else {
                chosen
            };
        }
        let kind = schema["type"].as_array().map_or(&schema["type"], |kinds| pick(kinds, random));
        match kind.as_str() {
            Some("number") => json!(number(schema, random)),
            Some("integer") => json!(count(schema, random)),
            Some("boolean") => json!(random.below(2) == 0),
            Some("string") => json!(text(schema, random)),
            Some("array") => {
                let least = schema["minItems"].as_u64().unwrap_or(0);
                let length = (least + random.below(MORE)).min(schema["maxItems"].as_u64().unwrap_or(u64::MAX));
                (0..length).map(|_| self.value(&schema["items"], random)).collect()
            }
            Some("object") => self.members(schema, random),
            _ => Value::Null,
        }
    }

    fn members(&self, schema: &Value, random: &mut Random) -> Value {
        let required = schema["required"].as_array();
        let mut members = Map::new();
        for (name, property) in schema["properties"].as_object().into_iter().flatten() {
            let needed = required.is_some_and(|names| names.iter().any(|needed| needed == name));
            if needed || random.below(3) == 0 {
                members.insert(name.clone(), self.value(property, random));
            }
        }
        Value::Object(members)
    }
}

fn merged(parts: impl Iterator<Item = Value>) -> Value {
    let objects = parts.filter_map(|part| if let Value::Object(members) = part { Some(members) } else { None });
    Value::Object(objects.flatten().collect())
}

pub fn pick<'a, T>(all: &'a [T], random: &mut Random) -> &'a T {
    &all[random.below(all.len() as u64) as usize]
}

pub fn word<'a>(all: &[&'a str], random: &mut Random) -> &'a str {
    all[random.below(all.len() as u64) as usize]
}

/// Anywhere in the range, on a logarithmic scale as a rule, or at its very ends.
fn number(schema: &Value, random: &mut Random) -> f64 {
    let least = schema["minimum"].as_f64().unwrap_or(-1e9);
    let most = schema["maximum"].as_f64().unwrap_or(1e9);
    let any = match random.below(8) {
        0 => least,
        1 => most,
        2 => 0.0,
        3 => random.number(),
        _ => random.number().signum() * 10f64.powf(-9.0 + 12.0 * random.number().abs()),
    };
    any.clamp(least, most)
}

fn count(schema: &Value, random: &mut Random) -> u64 {
    let least = schema["minimum"].as_u64().unwrap_or(0);
    let most = schema["maximum"].as_u64().unwrap_or(u64::MAX);
    let beyond = if random.below(50) == 0 { 2_000 } else { COUNT };
    (least + random.below(beyond)).min(most)
}

fn text(schema: &Value, random: &mut Random) -> String {
    let most = schema["maxLength"].as_u64().unwrap_or(20).min(300);
    let letters = ['a', 'Z', '0', ' ', '"', '\\', '/', '\n', '\u{0}', 'é', '𝄞', '\u{202e}'];
    (0..random.below(most + 2)).map(|_| *pick(&letters, random)).collect()
}

/// An unexpected value.
fn odd(random: &mut Random) -> Value {
    let all = [
        Value::Null,
        json!(true),
        json!(-1),
        json!(0),
        json!(-0.0),
        json!(1e308),
        json!(-1e308),
        json!(5e-324),
        json!(u64::MAX),
        json!(i64::MIN),
        json!(0.5),
        json!(""),
        json!("1"),
        json!("NaN"),
        json!("a".repeat(5_000)),
        json!([]),
        json!({}),
        json!([[[[[[]]]]]]),
        json!({"": {"": {}}}),
        json!([1, "1", null]),
        json!({"type": "sphere", "radius": 0.01}),
        json!({"moves": [{"force": 1e9}]}),
        json!(vec![0.0; 2_000]),
    ];
    pick(&all, random).clone()
}

/// Changes one thing somewhere in a value.
pub fn damage(value: &mut Value, random: &mut Random) {
    match value {
        Value::Object(members) if !members.is_empty() && random.below(5) > 0 => {
            let names: Vec<String> = members.keys().cloned().collect();
            let name = pick(&names, random);
            match random.below(6) {
                0 => drop(members.remove(name)),
                1 => drop(
                    members.insert(pick(&["", "a/b", "~", "type", "force", "extra"], random).to_string(), odd(random)),
                ),
                2 => {
                    // Under another name.
                    let moved = members.remove(name).unwrap_or_default();
                    members.insert(pick(&names, random).clone(), moved);
                }
                _ => damage(&mut members[name.as_str()], random),
            }
        }
        Value::Array(elements) if !elements.is_empty() && random.below(4) > 0 => {
            let place = random.below(elements.len() as u64) as usize;
            match random.below(4) {
                0 => drop(elements.remove(place)),
                1 => elements.insert(place, odd(random)),
                _ => damage(&mut elements[place], random),
            }
        }
        Value::Number(number) if random.below(2) == 0 => {
            let factor = pick(&[-1.0, 0.0, 1e-12, 1e6, 1e300, 1.0 + 1e-15, 2.0], random);
            *value = json!(number.as_f64().unwrap_or(1.0) * factor);
        }
        other => *other = odd(random),
    }
}

/// Changes the text of a document; it may no longer be one.
pub fn garble(text: &mut String, random: &mut Random) {
    let boundaries: Vec<usize> = text.char_indices().map(|(place, _)| place).collect();
    let place = boundaries.get(random.below(boundaries.len().max(1) as u64) as usize).copied().unwrap_or(0);
    match random.below(8) {
        0 => text.truncate(place),
        1 => text.insert_str(place, &"[".repeat(100_000)),
        2 => text.insert_str(place, &"{\"contact\":".repeat(20_000)),
        3 => *text = text.replacen("1e-7", "1e999", 1),
        4 => *text = text.replacen("0.01", &"9".repeat(400), 1),
        // The first member of the document a second time.
        5 => {
            let twin = text.trim_start_matches('{').split(',').next().unwrap_or_default().to_owned();
            *text = text.replacen('{', &format!("{{{twin},"), 1);
        }
        6 => text.insert(place, *pick(&['\u{0}', '\u{feff}', '"', ',', '-', '\\', 'N'], random)),
        _ => text.push_str(word(&[" ", "{}", "\0", "//", "\u{feff}"], random)),
    }
}
