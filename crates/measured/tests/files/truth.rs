//! What was written is what is read, whatever the spelling.

use std::f64::consts::TAU;

use stickslip_measured::import::{Mapping, Places, read_loop, read_scan};

use super::for_cases;
use super::writer::{CHARSETS, FORCES, LENGTHS, MISSING, Style, TIMES, one, shuffled};

/// Rows of a table.
const ROWS: usize = 24;
/// Names of the quantities, the plainest first; and other columns, each with a unit.
const DISPLACEMENT: &[&str] = &[
    "Displacement",
    "Linear Position",
    "Position",
    "Weg",
    "Schwingweg",
    "Relative displacement",
    "X Position",
    "Slip",
];
const FORCE: &[&str] =
    &["Friction force", "Force", "Reibkraft", "Tangentialkraft", "Fx", "Ff", "Traction Force", "Kraft"];
const LOAD: &[&str] = &["Normal force", "Fn", "Normalkraft", "Load", "Applied load", "Fz"];
const TIME: &[&str] = &["Time", "Zeit", "Elapsed time", "t"];
const OTHERS: &[(&str, &str)] = &[
    ("Friction coefficient", "-"),
    ("COF", ""),
    ("Reibwert", ""),
    ("Displacement command", "mm"),
    ("Sollweg", "um"),
    ("Force setpoint", "N"),
    ("Velocity", "mm/s"),
    ("Cycle", ""),
    ("Index", ""),
    ("Penetration depth", "um"),
    ("Verschleiss", "um"),
    ("Temperature", ""),
    ("Contact potential", "mV"),
    ("Distance", "m"),
];

/// A column: its name with its unit, and its number in each row.
type Column = (String, Box<dyn Fn(usize) -> f64>);

fn is_near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= 1e-12 * expected.abs().max(1e-12)
}

#[test]
fn every_mark_of_a_missing_number_is_written() {
    let source = include_str!("../../src/import/number.rs");
    let (_, table) = source.split_once("const MISSING: ").unwrap();
    let (_, table) = table.split_once("= [").unwrap();
    let (table, _) = table.split_once("];").unwrap();
    let marks: Vec<String> =
        table.split('"').skip(1).step_by(2).map(|mark| mark.replace("\\u{221e}", "\u{221e}")).collect();
    assert!(marks.len() > 40, "{marks:?}");
    for mark in marks {
        assert!(MISSING.iter().any(|written| written.to_lowercase() == mark), "{mark} is in no random file");
    }
}

#[test]
fn a_loop_is_what_was_written_in_any_unit_encoding_order_and_separator() {
    for_cases(1500, |random| {
        let style = Style::of(random);
        let (length, force, time) = (one(LENGTHS, random), one(FORCES, random), one(TIMES, random));
        let load_unit = one(FORCES, random);
        let load = if random.bool() { 12.5 } else { -12.5 };
        let mut columns: Vec<Column> = vec![
            (style.named(one(DISPLACEMENT, random), length.0), Box::new(move |row| displacement(row) / length.1)),
            (style.named(one(FORCE, random), force.0), Box::new(move |row| tangential(row) / force.1)),
        ];
        let has_time = random.bool();
        if has_time {
            columns.push((style.named(one(TIME, random), time.0), Box::new(move |row| 0.25 * row as f64 / time.1)));
        }
        let has_load = random.bool();
        if has_load {
            columns.push((style.named(one(LOAD, random), load_unit.0), Box::new(move |_| load / load_unit.1)));
        }
        for _ in 0..random.usize(..3) {
            let (name, unit) = one(OTHERS, random);
            let scale = 1.0 + random.f64();
            columns.push((style.named(name, unit), Box::new(move |row| scale * (row % 7) as f64)));
        }
        let order = shuffled(columns.len(), random);
        let names: Vec<String> = order.iter().map(|index| columns[*index].0.clone()).collect();
        let mut rows: Vec<Vec<String>> =
            (0..ROWS).map(|row| order.iter().map(|index| style.number((columns[*index].1)(row))).collect()).collect();
        // A number that is missing where it is needed makes a gap; in the first half of the file there are none.
        let charset = one(CHARSETS, random);
        let gap = ROWS / 2 + random.usize(..ROWS / 2);
        let mut is_gap = false;
        if random.bool() {
            let place = order.iter().position(|index| *index == random.usize(..2)).unwrap_or(0);
            let is_needed = order[place] < 2;
            if is_needed {
                rows[gap][place] = style.missing(charset, random);
                is_gap = true;
            }
        }
        let (text, first) = style.table(&names, &rows);
        let bytes = charset.encode(&text);
        let found = read_loop(&bytes, &Mapping::default(), &|| true)
            .unwrap_or_else(|error| panic!("{error}\n{charset:?}\n{text}"));
        let kept: Vec<usize> = (0..ROWS).filter(|row| !is_gap || *row != gap).collect();
        let context = || format!("{charset:?} {found:?}\n{text}");
        assert_eq!(found.displacement.len(), kept.len(), "{}", context());
        let (u_factor, f_factor) = (found.displacement_unit.unit().to_si(1.0), found.force_unit.unit().to_si(1.0));
        for (index, row) in kept.iter().enumerate() {
            assert!(is_near(found.displacement[index] * u_factor, displacement(*row)), "row {row}: {}", context());
            assert!(is_near(found.force[index] * f_factor, tangential(*row)), "row {row}: {}", context());
            if let Some(times) = &found.time {
                assert!(is_near(times[index], 0.25 * *row as f64), "row {row}: {}", context());
            }
        }
        assert_eq!(found.time.is_some(), has_time, "{}", context());
        assert_eq!(found.load.is_some(), has_load, "{}", context());
        assert!(found.load.is_none_or(|load| is_near(load, 12.5)), "{}", context());
        // Every line is a row of the reply or is counted.
        assert_eq!(kept.len() + found.preview.rows_left_out.len(), first - 1 + ROWS, "{}", context());
        let used = found.preview.columns.iter().filter(|column| column.quantity.is_some()).count();
        let reasons = found.preview.columns.iter().filter(|column| column.left_out.is_some()).count();
        assert_eq!(
            (used, used + reasons),
            (2 + usize::from(has_time) + usize::from(has_load), columns.len()),
            "{}",
            context()
        );
    });
}

fn displacement(row: usize) -> f64 {
    3e-7 * (TAU * row as f64 / ROWS as f64).cos() + 1.7e-8
}

fn tangential(row: usize) -> f64 {
    2.5 * (TAU * row as f64 / ROWS as f64).sin() + 0.31
}

#[test]
fn a_scan_is_what_was_written_in_any_unit_encoding_order_and_separator() {
    for_cases(1500, |random| {
        let style = Style::of(random);
        let (lateral, height) = (one(LENGTHS, random), one(LENGTHS, random));
        let place = |row: usize| 5e-6 * (row as f64 - 11.3);
        let height_of = |row: usize| -place(row).powi(2) / 0.016 - 1e-9;
        let x = one(&["x", "X", "Position", "Lateral", "Weg", "Scan length", "Distance"], random);
        let z = one(&["z", "Z", "Height", "Total Profile", "Profil", "Depth", "raw"], random);
        let mut names = vec![style.named(x, lateral.0), style.named(z, height.0)];
        let has_index = random.bool();
        if has_index {
            names.push(style.named(one(&["Index", "Nr.", "Point"], random), ""));
        }
        let order = shuffled(names.len(), random);
        let names: Vec<String> = order.iter().map(|index| names[*index].clone()).collect();
        let missing = random.usize(1..ROWS - 1);
        let charset = one(CHARSETS, random);
        let mark = style.missing(charset, random);
        let rows: Vec<Vec<String>> = (0..ROWS)
            .map(|row| {
                let cells = [
                    style.number(place(row) / lateral.1),
                    if row == missing { mark.clone() } else { style.number(height_of(row) / height.1) },
                    (row + 1).to_string(),
                ];
                order.iter().map(|index| cells[*index].clone()).collect()
            })
            .collect();
        let (text, first) = style.table(&names, &rows);
        let found = read_scan(&charset.encode(&text), &Mapping::default(), 0, &|| true);
        let found = found.unwrap_or_else(|error| panic!("{error}\n{charset:?}\n{text}"));
        let context = || format!("{charset:?} {found:?}\n{text}");
        let Places::Line { x, z } = &found.places else { panic!("{}", context()) };
        assert_eq!((x.len(), found.preview.rows_left_out.len()), (ROWS, first - 1), "{}", context());
        let (x_factor, z_factor) = (found.lateral.unit().to_si(1.0), found.height.unit().to_si(1.0));
        for row in 0..ROWS {
            assert!(is_near(x[row] * x_factor, place(row)), "row {row}: {}", context());
            assert_eq!(z[row].is_none(), row == missing, "row {row}: {}", context());
            assert!(z[row].is_none_or(|z| is_near(z * z_factor, height_of(row))), "row {row}: {}", context());
        }
    });
}
