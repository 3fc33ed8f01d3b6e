//! The fields of the page's form for each family of profiles: `UPDATE=1` writes `src/page/families.js` anew.

use std::fmt::Write as _;

use serde_json::json;
use stickslip_mechanics::profile::families;

use crate::python::file;

#[test]
fn the_form_of_the_page_has_every_family() {
    let mut printed = "// The families of shapes whose parameters are plain numbers: printed by `./check print`.\n\n\
        /** @type {Record<string, [string, { name: string; label: string; si: string; example: string }[]]>} */\n\
        // prettier-ignore\nexport const FAMILIES = {\n"
        .to_owned();
    for family in families() {
        writeln!(printed, "  {}: [\n    {},\n    [", family.name, json!(family.title)).unwrap();
        for parameter in family.parameters {
            let (name, label, unit) = (json!(parameter.name), json!(parameter.label), json!(parameter.range.unit));
            let example = json!(parameter.example.to_string());
            writeln!(printed, "      {{ name: {name}, label: {label}, si: {unit}, example: {example} }},").unwrap();
        }
        printed += "    ],\n  ],\n";
    }
    printed += "};\n";
    let path = file("src/page/families.js");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(&path, &printed).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(found, printed, "run `./check print`");
}
