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

/// A line of `/proc/self/status`, in bytes.
fn status(name: &str) -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix(name)).unwrap();
    line.trim_start_matches(':').trim_end_matches("kB").trim().parse::<usize>().unwrap() * 1024
}

/// Files of so many bytes, each with its name and whether it is a loop.
fn files(size: usize) -> Vec<(String, String, bool)> {
    let filled = |head: &str, row: &dyn Fn(u32) -> String| {
        let mut text = head.to_owned();
        let mut next = (0..).map(row);
        while text.len() < size {
            text += &next.next().unwrap();
        }
        text
    };
    let number = |row: u32, of: u32, step: f64| f64::from(row % of) * step;
    let plain =
        |row: u32| format!("{:.4};{:.5};{:.4}\n", f64::from(row) * 1e-3, number(row, 97, 0.011), number(row, 89, 0.13));
    let stamped = |row: u32| {
        let (hour, minute, second) = (row / 3600 % 24, row / 60 % 60, row % 60);
        let day = 1 + row / 86_400;
        let [u, f] = [number(row, 97, 0.011), number(row, 89, 0.13)];
        format!("2026-06-{day:02} {hour:02}:{minute:02}:{second:02}.000;{u:.5};{f:.4}\n")
    };
    let mut all = vec![
        ("a loop of numbers".to_owned(), filled("Time (s);Displacement (um);Force (N)\n", &plain), true),
        ("a loop with times of day".to_owned(), filled("Time;Displacement (um);Force (N)\n", &stamped), true),
        ("a map of points".to_owned(), filled("X (um);Y (um);Z (um)\n", &plain), false),
    ];
    for width in [8000, 16_000, 32_000] {
        let row: Vec<String> = (0..width).map(|column| format!("{:.2}", number(column, 83, 0.37))).collect();
        let row = row.join(",") + "\n";
        all.push((format!("a matrix of {width} columns"), filled("", &|_| row.clone()), false));
    }
    all
}

/// The processor time of this process, s, in steps of 10 ms.
fn processor_time() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
    // Behind the name, which may have blanks.
    let fields: Vec<&str> = stat.rsplit_once(')').unwrap().1.split_whitespace().collect();
    fields[11..13].iter().map(|ticks| ticks.parse::<f64>().unwrap()).sum::<f64>() / 100.0
}

/// `cargo test --locked --workspace --test files costs -- --ignored --nocapture` prints what files of 16 MiB cost: the
/// processor time, and the most memory beside the file itself over its size. `FILE_MIB` is another size. Four lines of
/// many columns follow, with the shortest time of nine.
#[test]
#[ignore = "prints what files cost, for a process of its own"]
fn costs() {
    let size = std::env::var("FILE_MIB").map_or(16, |size| size.parse().unwrap()) << 20;
    for (name, text, is_loop) in files(size) {
        // From here on the peak of the process is counted anew.
        std::fs::write("/proc/self/clear_refs", "5").unwrap();
        let (before, start) = (status("VmRSS"), processor_time());
        let fault = if is_loop {
            read_loop(text.as_bytes(), &Mapping::default(), &|| true).err()
        } else {
            read_scan(text.as_bytes(), &Mapping::parse("spacing:1").unwrap(), 300_000, &|| true).err()
        };
        let (seconds, memory) = (processor_time() - start, status("VmHWM").saturating_sub(before));
        assert_eq!(fault, None, "{name}");
        println!("{name}: {seconds:.2} s, memory {:.2} times the file", memory as f64 / text.len() as f64);
    }
    for width in [8000, 16_000, 32_000] {
        let text = ("1,".repeat(width - 1) + "1\n").repeat(4);
        let time = |read: &dyn Fn()| {
            let times = (0..9).map(|_| {
                let start = std::time::Instant::now();
                read();
                start.elapsed().as_secs_f64()
            });
            1e3 * times.fold(f64::INFINITY, f64::min)
        };
        let scan = time(&|| drop(read_scan(text.as_bytes(), &Mapping::default(), 300_000, &|| true)));
        let measured = time(&|| drop(read_loop(text.as_bytes(), &Mapping::default(), &|| true)));
        println!("4 lines of {width} columns: as a scan {scan:.1} ms, as a loop {measured:.1} ms");
    }
}

/// In a process of its own, where nothing else takes memory.
#[test]
fn reading_takes_no_more_than_eight_times_the_file() {
    let mut alone = std::process::Command::new(std::env::current_exe().unwrap());
    alone.args(["--ignored", "--exact", "bounds::costs", "--nocapture"]).env("FILE_MIB", "4");
    let output = alone.output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    let part = |line: &str| line.split_once("memory ")?.1.split_once(' ')?.0.parse::<f64>().ok();
    let parts: Vec<f64> = said.lines().filter_map(part).collect();
    assert_eq!(parts.len(), 6, "{said}");
    assert!(parts.iter().all(|part| *part <= 8.0), "{said}");
}
