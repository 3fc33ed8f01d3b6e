//! The header is printed from the exports: `UPDATE=1 cargo test --workspace --test header` writes it.

use std::fmt::Write as _;

const EXPORTS: &str = include_str!("../src/exports.rs");
const HEAD: &str = "\
/* The contacts of stickslip: frictional contact of two elastic bodies with its slip history, solved exactly.
 *
 * Every function returns SS_OK or another code of those below; ss_last_error has the text. Numbers are in SI units. Any
 * number of threads may call at once, each contact being used by one at a time. No call ends the program. Printed from
 * crates/ffi/src/exports.rs; docs/embedding.md says how to build and install the library. */
#ifndef STICKSLIP_H
#define STICKSLIP_H

#include <stddef.h>

#ifdef __cplusplus
extern \"C\" {
#endif
";
const TAIL: &str = "
#ifdef __cplusplus
}
#endif

#endif
";

fn c_type(rust: &str) -> String {
    let (rest, pointer) = match rust.split_once(' ') {
        Some(("*const", rest)) => (rest, Some("const ")),
        Some(("*mut", rest)) => (rest, Some("")),
        _ => (rust, None),
    };
    match pointer {
        // A pointer to a handle: constant is the array and not the contact.
        Some(constant) if rest.starts_with('*') => format!("{}{constant}*", c_type(rest)),
        Some(constant) => {
            let inner = c_type(rest);
            let gap = if inner.ends_with('*') { "" } else { " " };
            format!("{constant}{inner}{gap}*")
        }
        None => match rest {
            "f64" => "double",
            "usize" => "size_t",
            "c_int" => "int",
            "c_char" => "char",
            "c_void" => "void",
            other => other,
        }
        .to_owned(),
    }
}

fn declared(name: &str, rust: &str) -> String {
    if let Some((item, count)) = rust.strip_prefix('[').and_then(|array| array.strip_suffix(']')?.split_once("; ")) {
        return format!("{} {name}[{count}]", c_type(item));
    }
    let kind = c_type(rust);
    if kind.ends_with('*') { format!("{kind}{name}") } else { format!("{kind} {name}") }
}

fn comment(lines: &[&str], margin: &str) -> String {
    let lines = lines.iter().map(|line| if *line == "# Safety" { "Pointers:" } else { line });
    let lines: Vec<&str> = lines.filter(|line| !line.is_empty()).collect();
    format!("{margin}/* {} */\n", lines.join(&format!("\n{margin} * ")))
}

fn header() -> String {
    let mut text = HEAD.to_owned();
    let mut about: Vec<&str> = Vec::new();
    let mut lines = EXPORTS.lines();
    while let Some(line) = lines.next() {
        let code = line.trim_start();
        if let Some(words) = code.strip_prefix("///") {
            about.push(words.trim());
        } else if let Some(constant) = code.strip_prefix("pub const ") {
            let (name, value) = constant.split_once(": c_int = ").unwrap();
            let value = value.trim_end_matches(';');
            write!(text, "\n{}#define {name} {value}\n", comment(&std::mem::take(&mut about), "")).unwrap();
        } else if let Some(name) = code.strip_prefix("pub struct ").map(|rest| rest.trim_end_matches(" {")) {
            write!(text, "\n{}", comment(&std::mem::take(&mut about), "")).unwrap();
            let mut members = String::new();
            for line in lines.by_ref().map(str::trim).take_while(|line| *line != "}") {
                if let Some(words) = line.strip_prefix("///") {
                    about.push(words.trim());
                } else if let Some((member, kind)) = line.strip_prefix("pub ").and_then(|line| line.split_once(": ")) {
                    let kind = kind.trim_end_matches(',');
                    let words = comment(&std::mem::take(&mut about), "    ");
                    writeln!(members, "{words}    {};", declared(member, kind)).unwrap();
                }
            }
            if members.is_empty() {
                writeln!(text, "typedef struct {name} {name};").unwrap();
            } else {
                writeln!(text, "typedef struct {name} {{\n{members}}} {name};").unwrap();
            }
        } else if let Some((_, rest)) = code.split_once("extern \"C\" fn ").filter(|_| code.starts_with("pub ")) {
            let mut signature = rest.to_owned();
            while !signature.ends_with('{') {
                signature.push_str(lines.next().unwrap().trim());
            }
            let (name, rest) = signature.split_once('(').unwrap();
            let (parameters, result) = rest.rsplit_once(") -> ").unwrap();
            let result = c_type(result.trim_end_matches(" {"));
            let gap = if result.ends_with('*') { "" } else { " " };
            let parameters = parameters.split(',').map(str::trim).filter(|parameter| !parameter.is_empty());
            let parameters: Vec<String> = parameters
                .map(|parameter| parameter.split_once(": ").map(|(name, kind)| declared(name, kind)).unwrap())
                .collect();
            let parameters = if parameters.is_empty() { "void".to_owned() } else { parameters.join(", ") };
            let words = comment(&std::mem::take(&mut about), "");
            write!(text, "\n{words}{result}{gap}{name}({parameters});\n").unwrap();
        } else if !code.starts_with("#[") {
            about.clear();
        }
    }
    text + TAIL
}

#[test]
fn the_header_declares_what_the_library_exports() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/include/stickslip.h");
    let printed = header();
    assert_eq!(printed.matches("\nint ss_").count() + printed.matches("\nconst char *ss_").count(), 17, "{printed}");
    if std::env::var_os("UPDATE").is_some() {
        std::fs::write(path, printed).unwrap();
        return;
    }
    let written = std::fs::read_to_string(path).unwrap();
    assert!(written == printed, "UPDATE=1 cargo test --workspace --test header");
}
