//! Every column of every table has the values that the document of the same reply has under its name.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Map, Value};
use stickslip_compute::Flag;
use stickslip_compute::computations::{CheckedTask, DisplayOptions, Entry, Written, entries};
use stickslip_compute::formats::Format;
use stickslip_wire::PrepareAnew;

/// Columns that no member of the document is named after: the computation, the column, and the place of its values in
/// the document, or what it shows.
const OTHERS: [(&str, &str, &str); 10] = [
    ("fit", "fitted", "/curve/0/force"),
    ("fit", "loop", "the number of the loop"),
    ("fit", "residual", "the difference of two columns"),
    ("fit", "used", "a truth as 0 or 1"),
    ("profile", "height", "`used`, `left_out` and the fitted curve, one after another"),
    ("profile", "part", "which of them"),
    ("profile", "radius", "`used`, `left_out` and the fitted curve, one after another"),
    ("simulate", "kind", "whether a peak is a maximum, by its neighbours"),
    ("wear", "height_after", "/shape/after"),
    ("wear", "height_before", "/shape/before"),
];

fn result(entry: &Entry, body: &Value) -> Box<dyn Written> {
    let document = (entry.request.parse)(body.to_string().as_bytes()).unwrap();
    let task = document.check(&PrepareAnew).unwrap().downcast::<Box<dyn CheckedTask>>().unwrap_or_else(|_| panic!());
    task.run(&Flag::default()).unwrap()
}

fn written(result: &dyn Written, options: DisplayOptions) -> Option<Value> {
    let text = result.write(&options, &Flag::default()).unwrap().ok()?;
    Some(serde_json::from_slice(&text).unwrap())
}

/// Arrays of values by the last names of their paths in the document, joined by `_`: that of `{"pressure": {"after":
/// [..]}}` by `after` and by `pressure_after`, and one that is called `values` by the name above it. An array of
/// objects has one for each path within them. The numbers of a pair are called `_x` and `_y`, the objects of a list
/// `_1` and so on.
type Series = BTreeMap<String, Vec<Vec<Value>>>;

fn add(path: &[String], values: &[Value], found: &mut Series) {
    let path = if path.last().is_some_and(|last| last == "values") { &path[..path.len() - 1] } else { path };
    for start in 0..path.len() {
        found.entry(path[start..].join("_")).or_default().push(values.to_vec());
    }
}

fn collect(value: &Value, path: &[String], found: &mut Series) {
    match value {
        Value::Object(members) => {
            members
                .iter()
                .for_each(|(name, member)| collect(member, &[path, std::slice::from_ref(name)].concat(), found));
        }
        Value::Array(items) => {
            add(path, items, found);
            let rows: Vec<BTreeMap<Vec<String>, Value>> = items.iter().map(leaves).collect();
            let names: BTreeSet<&Vec<String>> = rows.iter().flat_map(BTreeMap::keys).collect();
            for name in names.into_iter().filter(|name| !name.is_empty()) {
                let values: Vec<Value> = rows.iter().map(|row| row.get(name).cloned().unwrap_or_default()).collect();
                // The place in a pair goes with the name of the pair.
                let whole = if name[0].starts_with('_') && !path.is_empty() {
                    let (last, before) = path.split_last().unwrap();
                    [before, &[last.clone() + &name[0]]].concat()
                } else {
                    [path, name].concat()
                };
                add(&whole, &values, found);
            }
            items.iter().for_each(|item| collect(item, path, found));
        }
        _ => {}
    }
}

/// The values in an item of an array, by their paths.
fn leaves(item: &Value) -> BTreeMap<Vec<String>, Value> {
    let mut found = BTreeMap::new();
    match item {
        Value::Object(members) => {
            for (name, member) in members {
                for (path, value) in leaves(member) {
                    let whole = match path.split_first() {
                        Some((first, rest)) if first.starts_with('_') => [&[name.clone() + first], rest].concat(),
                        _ => [std::slice::from_ref(name), &*path].concat(),
                    };
                    found.insert(whole, value);
                }
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate().take(3) {
                for (mut path, value) in leaves(item) {
                    match path.last_mut() {
                        Some(last) => *last = format!("{last}_{}", index + 1),
                        None => path = vec![["_x", "_y", "_z"][index].to_owned()],
                    }
                    found.insert(path, value);
                }
            }
        }
        value => {
            found.insert(Vec::new(), value.clone());
        }
    }
    found
}

#[test]
fn columns_have_the_values_of_the_document_under_their_names() {
    let (mut wrong, mut compared) = (Vec::new(), 0);
    for entry in entries() {
        let name = entry.about.name;
        for example in (entry.examples)() {
            let result = result(&entry, &example.value);
            let mut found = Series::new();
            let document = written(&*result, DisplayOptions::in_format(Format::Columns)).unwrap();
            collect(&document, &[], &mut found);
            let choices = entry.about.choice.map_or(&[][..], |choice| choice.words);
            for choice in choices.iter().map(|word| Some(*word)).chain([None]) {
                let options = DisplayOptions { choice, ..DisplayOptions::in_format(Format::Rows) };
                let Some(Value::Array(rows)) = written(&*result, options) else { continue };
                let rows: Vec<Map<String, Value>> =
                    rows.into_iter().map(|row| row.as_object().unwrap().clone()).collect();
                for column in rows.first().map(|row| row.keys().cloned().collect::<Vec<_>>()).unwrap_or_default() {
                    let values: Vec<Value> = rows.iter().map(|row| row[&column].clone()).collect();
                    let other = OTHERS.iter().find(|(of, other, _)| *of == name && *other == column);
                    let is_right = match other {
                        Some((.., place)) if place.starts_with('/') => {
                            document.pointer(place).and_then(Value::as_array) == Some(&values)
                        }
                        Some(_) => continue,
                        None => found.get(&column).is_some_and(|series| series.contains(&values)),
                    };
                    compared += 1;
                    if !is_right {
                        let shown = Value::from(values.into_iter().take(3).collect::<Vec<_>>());
                        wrong.push(format!("{name}, {}, {choice:?}: {column} {shown}", example.name));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(compared > 100, "{compared}");
}
