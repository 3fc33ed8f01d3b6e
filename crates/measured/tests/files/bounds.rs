//! What a file may cost: it ends when it is told to, and has no more cells than it may.

use std::cell::Cell;

use stickslip_measured::import::{Mapping, read_loop, read_scan};

#[test]
fn reading_ends_when_it_is_told_to() {
    let text: String = (0..40_000).map(|row| format!("{row};{}.5\n", row % 7)).collect();
    let matrix: String = (0..40).map(|_| "1.5;".repeat(8000) + "2\n").collect();
    for text in [&text, &matrix] {
        let asked = Cell::new(0_usize);
        let proceed = || {
            asked.set(asked.get() + 1);
            asked.get() < 3
        };
        assert!(read_loop(text.as_bytes(), &Mapping::default(), &proceed).unwrap_err().is_stopped);
        assert_eq!(asked.get(), 3);
        let asked = Cell::new(0_usize);
        let proceed = || {
            asked.set(asked.get() + 1);
            asked.get() < 3
        };
        assert!(read_scan(text.as_bytes(), &Mapping::default(), 0, &proceed).unwrap_err().is_stopped);
    }
}

#[test]
fn more_cells_than_a_file_may_have_are_refused_with_their_number() {
    let row = "1,".repeat(8192) + "\n";
    let text = row.repeat(2050);
    let error = read_scan(text.as_bytes(), &Mapping::parse("spacing:1").unwrap(), 0, &|| true).unwrap_err();
    assert!(error.fault.contains("16777216 cells") && error.line == Some(2048), "{error}");
}

/// `cargo test --release -p stickslip-measured --test files costs -- --ignored --nocapture` prints the time of files.
#[test]
#[ignore = "prints times, and judges nothing"]
fn costs() {
    let time = |what: &str, text: &str, is_loop: bool| {
        let start = std::time::Instant::now();
        let spacing = Mapping::parse("spacing:1").unwrap();
        let is_read = if is_loop {
            read_loop(text.as_bytes(), &Mapping::default(), &|| true).map(|_| ())
        } else {
            read_scan(text.as_bytes(), &spacing, 300_000, &|| true).map(|_| ())
        };
        println!("{what}: {} MB in {:.3} s, {:?}", text.len() >> 20, start.elapsed().as_secs_f64(), is_read.err());
    };
    let rows: String = (0..500_000)
        .map(|row| {
            format!(
                "{:.4};{:.5};{:.4}\n",
                f64::from(row) * 1e-3,
                f64::from(row % 97) * 0.011,
                f64::from(row % 89) * 0.13
            )
        })
        .collect();
    time("a loop of numbers", &format!("Time (s);Displacement (um);Force (N)\n{rows}"), true);
    let stamps: String = (0..400_000)
        .map(|row: u32| {
            format!(
                "2026-06-01 {:02}:{:02}:{:02}.000;{:.5};{:.4}\n",
                row / 3600 % 24,
                row / 60 % 60,
                row % 60,
                f64::from(row % 97) * 0.011,
                f64::from(row % 89) * 0.13
            )
        })
        .collect();
    time("a loop with stamps", &format!("Time;Displacement (um);Force (N)\n{stamps}"), true);
    for width in [8000, 16_000, 32_000] {
        let row: Vec<String> = (0..width).map(|column| format!("{:.2}", f64::from(column % 83) * 0.37)).collect();
        time(
            &format!("a matrix of {width} columns"),
            &(row.join(",") + "\n").repeat(3_200_000 / width as usize),
            false,
        );
    }
}
