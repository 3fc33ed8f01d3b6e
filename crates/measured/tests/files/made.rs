//! Files as many programs write them, made at random with what they hold: heads of one to four lines in any order,
//! figures and second tables below, two channels of the load, times in several formats. What is read is right, and a
//! refusal has a way out that leads to what is right.
//!
//! `STICKSLIP_TEST_CASES=20000 cargo test --locked --workspace --test files made -- --nocapture` is the long run, and
//! prints how many of the files that leave nothing open were read.

use std::cell::Cell;

use fastrand::Rng;
use stickslip_measured::import::{ImportError, LoopFile, Mapping, read_loop};

use super::for_cases;
use super::writer::{one, shuffled};

const ROWS: usize = 24;
/// Of the files that a person would read without a question, those that are.
const LEAST_READ: f64 = 0.9;

const SEPARATORS: [char; 12] = [';', '\t', ',', '|', '!', '&', '~', '\u{a7}', '/', ':', '\u{a6}', '\u{1f}'];
const LENGTHS: [(&str, f64); 4] = [("um", 1e-6), ("nm", 1e-9), ("mm", 1e-3), ("\u{b5}m", 1e-6)];
const FORCES: [(&str, f64); 3] = [("N", 1.0), ("mN", 1e-3), ("kN", 1e3)];
const SECONDS: [(&str, f64); 3] = [("s", 1.0), ("ms", 1e-3), ("min", 60.0)];
const DISPLACEMENTS: [&str; 6] =
    ["Displacement", "Weg", "D\u{e9}placement", "Desplazamiento", "\u{4f4d}\u{79fb}", "Position"];
const TANGENTIAL: [&str; 6] =
    ["Friction force", "Reibkraft", "Force tangentielle", "\u{6469}\u{64e6}\u{529b}", "Ft", "Force"];
const LOADS: [[&str; 2]; 6] = [
    ["Normal force left", "Normal force right"],
    ["Fz raw", "Fz tared"],
    ["Load cell 1", "Load cell 2"],
    ["Fn", "Load"],
    ["Normalkraft links", "Normalkraft rechts"],
    ["Force normale A", "Force normale B"],
];
const REMARKS: [&str; 5] = ["Double", "AI", "ist", "Sensor-A", "raw"];

/// What a file holds, and what is open about it.
struct Made {
    text: String,
    dt: Option<f64>,
    /// The load, N, or none if there is none or if it is open.
    load: Option<f64>,
    /// Why it has to be asked about, if it has to.
    question: Option<&'static str>,
    has_two_tables: bool,
}

fn displacement(row: usize) -> f64 {
    3e-7 * (std::f64::consts::TAU * row as f64 / ROWS as f64).cos() + 1.7e-8
}

fn force(row: usize) -> f64 {
    2.5 * (std::f64::consts::TAU * row as f64 / ROWS as f64).sin() + 0.31
}

fn made(random: &mut Rng) -> Made {
    let separator = one(&SEPARATORS, random);
    let has_commas = separator != ',' && random.bool();
    let digits = random.usize(4..8);
    let (length, newton, second) = (one(&LENGTHS, random), one(&FORCES, random), one(&SECONDS, random));
    type Value = Box<dyn Fn(usize) -> String>;
    let mut columns: Vec<(String, String, Value)> = Vec::new();
    let mut question = None;
    let of = |scale: f64, value: fn(usize) -> f64| move |row: usize| value(row) / scale;
    let (u, f) = (of(length.1, displacement), of(newton.1, force));
    let style = (separator, has_commas, digits);
    let written = move |value: f64| {
        let (_, has_commas, digits) = style;
        let text =
            if value.abs() < 1e-2 && value != 0.0 { format!("{value:.digits$e}") } else { format!("{value:.digits$}") };
        if has_commas { text.replace('.', ",") } else { text }
    };
    columns.push((one(&DISPLACEMENTS, random).to_owned(), length.0.to_owned(), Box::new(move |row| written(u(row)))));
    columns.push((one(&TANGENTIAL, random).to_owned(), newton.0.to_owned(), Box::new(move |row| written(f(row)))));
    let mut dt = None;
    // A colon between cells leaves times of day without a place.
    match random.usize(..if separator == ':' { 3 } else { 6 }) {
        0 => {}
        1 | 2 => {
            dt = Some(0.25);
            columns.push((
                "Time".to_owned(),
                second.0.to_owned(),
                Box::new(move |row| written(0.25 * row as f64 / second.1)),
            ));
        }
        3 => {
            dt = Some(2.0);
            let zone = one(&["", "Z", "+02:00"], random);
            let stamp = move |row: usize| format!("2026-06-01T14:15:{:02}.000{zone}", 2 * row);
            columns.push(("Time".to_owned(), String::new(), Box::new(stamp)));
        }
        4 => {
            dt = Some(2.0);
            let is_said = random.bool();
            question = (!is_said).then_some("time");
            let name = if is_said { "Time (mm:ss)" } else { "Time" };
            columns.push((name.to_owned(), String::new(), Box::new(|row| format!("00:{:02}", 2 * row))));
        }
        _ => {
            dt = Some(0.5);
            columns.push((
                "Timestamp".to_owned(),
                String::new(),
                Box::new(move |row| {
                    let text = format!("{:.9}", 46_174.5 + 0.5 * row as f64 / 86_400.0);
                    if style.1 { text.replace('.', ",") } else { text }
                }),
            ));
        }
    }
    let mut load = None;
    match random.usize(..5) {
        0 => {}
        1 | 2 => {
            load = Some(10.0);
            columns.push(("Normal force".to_owned(), newton.0.to_owned(), Box::new(move |_| written(10.0 / newton.1))));
        }
        3 => {
            question = question.or(Some("load"));
            for name in one(&LOADS, random) {
                columns.push((name.to_owned(), newton.0.to_owned(), Box::new(move |_| written(5.0 / newton.1))));
            }
        }
        _ => {
            question = question.or(Some("load"));
            columns.push(("Normal load".to_owned(), "kg".to_owned(), Box::new(move |_| written(1.02))));
        }
    }
    if random.bool() {
        columns.push((
            "Friction coefficient".to_owned(),
            String::new(),
            Box::new(move |row| written(force(row) / 10.0)),
        ));
    }
    let order = shuffled(columns.len(), random);
    let columns: Vec<_> = {
        let mut all: Vec<Option<_>> = columns.into_iter().map(Some).collect();
        order.into_iter().map(|index| all[index].take().unwrap()).collect()
    };
    let is_numbered = random.usize(..4) == 0;
    let line = |cells: Vec<String>, first: &str| {
        let all: Vec<String> = is_numbered.then(|| first.to_owned()).into_iter().chain(cells).collect();
        all.join(&separator.to_string())
    };
    let names = |form: usize| {
        let named = |(name, unit, _): &(String, String, Value)| match form {
            _ if unit.is_empty() => name.clone(),
            0 => format!("{name} ({unit})"),
            1 => format!("{name} [{unit}]"),
            _ => name.clone(),
        };
        columns.iter().map(named).collect::<Vec<_>>()
    };
    let mut head: Vec<String> = Vec::new();
    let form = random.usize(..3);
    head.push(line(names(form), "Nr."));
    if form == 2 {
        let brackets = one(&[["", ""], ["[", "]"], ["(", ")"]], random);
        let units = columns.iter().map(|(_, unit, _)| {
            if unit.is_empty() { String::new() } else { format!("{}{unit}{}", brackets[0], brackets[1]) }
        });
        let at = random.usize(..2);
        head.insert(at, line(units.collect(), ""));
    }
    for _ in 0..random.usize(..3) {
        let remark = one(&REMARKS, random);
        head.push(line(columns.iter().map(|_| remark.to_owned()).collect(), ""));
    }
    let mut lines: Vec<String> = [&["Versuch vom Juni"][..], &["# Run: 7"], &[]][random.usize(..3)]
        .iter()
        .map(|line| (*line).to_owned())
        .collect();
    lines.extend(head);
    for row in 0..ROWS {
        lines.push(line(columns.iter().map(|(.., value)| value(row)).collect(), &(row + 1).to_string()));
    }
    let mut has_two_tables = false;
    match random.usize(..6) {
        0 => {
            for word in ["Mean", "Max", "Std"] {
                let figures: Vec<String> =
                    columns.iter().skip(usize::from(!is_numbered)).map(|_| written(0.5)).collect();
                let first = if is_numbered { Vec::new() } else { vec![word.to_owned()] };
                lines.push(line(first.into_iter().chain(figures).collect(), word));
            }
        }
        1 => {
            has_two_tables = true;
            lines.push(String::new());
            let mut reversed: Vec<usize> = (0..columns.len()).collect();
            reversed.reverse();
            let named = names(0);
            lines.push(line(reversed.iter().map(|index| named[*index].clone()).collect(), "Nr."));
            for row in 0..ROWS / 2 {
                lines.push(line(
                    reversed.iter().map(|index| (columns[*index].2)(row)).collect(),
                    &(row + 1).to_string(),
                ));
            }
        }
        _ => {}
    }
    let end = one(&["\n", "\r\n"], random);
    Made { text: lines.join(end) + end, dt, load, question, has_two_tables }
}

fn wrong(found: &LoopFile, made: &Made) -> Option<String> {
    let (u, f) = (found.displacement_unit.unit().to_si(1.0), found.force_unit.unit().to_si(1.0));
    if found.displacement.len() != ROWS {
        return Some(format!("{} rows", found.displacement.len()));
    }
    for row in 0..ROWS {
        if (found.displacement[row] * u - displacement(row)).abs() > 1e-10
            || (found.force[row] * f - force(row)).abs() > 0.051
        {
            return Some(format!("row {row}: {} {}", found.displacement[row] * u, found.force[row] * f));
        }
    }
    if let (Some(load), Some(found)) = (made.load, found.load)
        && (found / load - 1.0).abs() > 0.01
    {
        return Some(format!("a load of {found}"));
    }
    let (Some(dt), Some(times)) = (made.dt, &found.time) else { return None };
    let step = times[ROWS - 1] / (ROWS - 1) as f64;
    ((step / dt - 1.0).abs() > 0.02).then(|| format!("a step of {step} s"))
}

/// Follows every way out of a refusal: each leads somewhere, and one to what is right.
fn follow(bytes: &[u8], error: &ImportError, made: &Made, depth: usize) -> Result<bool, String> {
    if error.candidates.is_empty() || depth == 0 {
        return Err(format!("no way out: {error}"));
    }
    let mut is_right = false;
    for candidate in &error.candidates {
        let mapping = Mapping::parse(&candidate.mapping).map_err(|error| format!("{candidate:?}: {error}"))?;
        is_right |= match read_loop(bytes, &mapping, &|| true) {
            Ok(found) => wrong(&found, made).is_none(),
            Err(next) => follow(bytes, &next, made, depth - 1)?,
        };
    }
    Ok(is_right)
}

#[test]
fn made_files_are_read_right_or_refused_with_a_way_out_that_works() {
    let (plain, read) = (Cell::new(0_usize), Cell::new(0_usize));
    for_cases(600, |random| {
        let made = made(random);
        let bytes = made.text.as_bytes();
        let is_open = made.question.is_some() || made.has_two_tables;
        plain.set(plain.get() + usize::from(!is_open));
        match read_loop(bytes, &Mapping::default(), &|| true) {
            Ok(found) => {
                read.set(read.get() + usize::from(!is_open));
                let fault = wrong(&found, &made);
                assert!(fault.is_none(), "{}\n{:?}\n{}", fault.unwrap(), found.preview, made.text);
                assert!(
                    !is_open,
                    "read without a question ({:?}): {:?}\n{}",
                    made.question, found.preview.assumed, made.text
                );
                let again = read_loop(bytes, &Mapping::parse(&found.preview.mapping).unwrap(), &|| true);
                let again = again.unwrap_or_else(|error| panic!("{}: {error}\n{}", found.preview.mapping, made.text));
                assert_eq!(
                    (&again.displacement, &again.force, &again.time, again.load),
                    (&found.displacement, &found.force, &found.time, found.load),
                    "{}",
                    made.text
                );
                // Every line has a kind.
                let counted: usize = found.preview.lines.iter().map(|(_, count, _)| count).sum();
                assert_eq!(counted, made.text.lines().count(), "{:?}\n{}", found.preview.lines, made.text);
            }
            Err(error) => {
                let is_right = follow(bytes, &error, &made, 4);
                assert_eq!(is_right, Ok(true), "{error}: {:?}\n{}", error.candidates, made.text);
            }
        }
    });
    let share = read.get() as f64 / plain.get() as f64;
    println!("{} of {} files without a question were read", read.get(), plain.get());
    assert!(share >= LEAST_READ, "{share}");
}
