//! What cannot be read for certain is refused at its place, and nothing makes the reader fail otherwise.

use stickslip_measured::import::{ImportError, Mapping, Places, read_loop, read_scan};

use super::for_cases;
use super::writer::{CHARSETS, Charset, NO_UNITS, Style, one, shuffled};

/// A table of a loop with numbers, with names as they are given, in some order.
fn table(style: &Style, names: [String; 3], order: &[usize]) -> (Vec<String>, Vec<Vec<String>>) {
    let number = |row: usize, column: usize| style.number((row * (column + 1)) as f64 * 0.1 + 0.05);
    let rows = (0..9).map(|row| order.iter().map(|index| number(row, *index)).collect()).collect();
    (order.iter().map(|index| names[*index].clone()).collect(), rows)
}

#[test]
fn a_unit_that_is_not_known_is_named_with_its_line_and_column() {
    for_cases(600, |random| {
        let style = Style::of(random);
        let text = one(NO_UNITS, random);
        let is_force = random.bool();
        // A text in its place as a unit: brackets, not the end of a name.
        let bad = |name: &str| format!("\"{name} ({text})\"");
        let good = |name: &str, unit: &str| format!("\"{name} ({unit})\"");
        let names = if is_force {
            [good("Displacement", "um"), bad("Force"), good("Time", "s")]
        } else {
            [bad("Displacement"), good("Force", "N"), good("Time", "s")]
        };
        let order = shuffled(3, random);
        let (names, rows) = table(&style, names, &order);
        let (file, first) = style.table(&names, &rows);
        let charset = loop {
            let charset = one(CHARSETS, random);
            if !matches!(charset, Charset::Micro(_) | Charset::Utf8Twice) || text.is_ascii() {
                break charset;
            }
        };
        let error = read_loop(&charset.encode(&file), &Mapping::default(), &|| true).unwrap_err();
        let column = order.iter().position(|index| *index == usize::from(is_force)).map(|index| index + 1);
        let ImportError { line, column: found, unknown_unit, fault, .. } = &error;
        assert_eq!((*line, *found), (Some(first - 1), column), "{error}\n{file}");
        assert_eq!(unknown_unit.as_deref(), Some(text), "{error}\n{file}");
        assert!(
            fault.contains(text) && fault.contains(if is_force { "force_unit" } else { "displacement_unit" }),
            "{error}"
        );
    });
}

#[test]
fn a_cell_that_is_not_a_number_is_named_and_no_row_is_lost() {
    for_cases(600, |random| {
        let style = Style::of(random);
        let names = ["Displacement (um)", "Force (N)", "Time (s)"].map(|name| format!("\"{name}\""));
        let order = shuffled(3, random);
        let (names, mut rows) = table(&style, names, &order);
        let (row, column) = (random.usize(..rows.len()), random.usize(..3));
        let bad =
            one(&["1.2.3", "four", "0x1F", "1;2".split(';').next().unwrap_or(""), "12a", "1e", "3,4,5.6"], random);
        rows[row][column] = format!("\"{bad}\"");
        let (file, first) = style.table(&names, &rows);
        let read = read_loop(file.as_bytes(), &Mapping::default(), &|| true);
        match read {
            Err(error) => {
                assert_eq!((error.line, error.column), (Some(first + row), Some(column + 1)), "{error}\n{file}");
                assert!(error.fault.contains(bad), "{error}\n{file}");
            }
            Ok(found) => assert!(bad == "1" && found.displacement.len() == rows.len(), "{found:?}\n{file}"),
        }
    });
}

#[test]
fn no_bytes_make_the_reader_fail_and_what_it_reads_is_finite_and_complete() {
    let files: Vec<Vec<u8>> = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/lab_files"))
        .unwrap()
        .map(|entry| std::fs::read(entry.unwrap().path()).unwrap())
        .filter(|bytes| bytes.len() < 8000)
        .collect();
    assert!(files.len() > 20);
    for_cases(4000, |random| {
        let mut bytes = files[random.usize(..files.len())].clone();
        for _ in 0..random.usize(1..6) {
            let at = random.usize(..bytes.len());
            match random.usize(..5) {
                0 => bytes[at] = random.u8(..),
                1 => bytes.truncate(at.max(1)),
                2 => bytes.insert(at, one(b";,\t\n\r\"'?-e.0#\x1a\0", random)),
                3 => {
                    bytes.remove(at);
                    bytes.push(b'\n');
                }
                _ => {
                    let other = &files[random.usize(..files.len())];
                    let from = random.usize(..other.len());
                    let part = &other[from..(from + random.usize(1..200)).min(other.len())];
                    bytes.splice(at..at, part.iter().copied());
                }
            }
        }
        if let Ok(found) = read_loop(&bytes, &Mapping::default(), &|| true) {
            let count = found.displacement.len();
            assert_eq!((found.force.len(), found.time.as_ref().map_or(count, Vec::len)), (count, count));
            assert!(found.displacement.iter().chain(&found.force).all(|value| value.is_finite()));
            assert!(count <= found.preview.rows);
        }
        if let Ok(found) = read_scan(&bytes, &Mapping::default(), 1000, &|| true) {
            let heights: Vec<Option<f64>> = match found.places {
                Places::Line { x, z } => {
                    assert_eq!(x.len(), z.len());
                    z
                }
                Places::Points { x, y, z } => {
                    assert_eq!((x.len(), y.len()), (z.len(), z.len()));
                    z
                }
                Places::Map { dx, dy, z } => {
                    assert!(dx > 0.0 && dy > 0.0 && z.iter().all(|row| row.len() == z[0].len()));
                    z.into_iter().flatten().collect()
                }
            };
            assert!(heights.len() <= 1000 && heights.iter().flatten().all(|height| height.is_finite()));
        }
    });
}
