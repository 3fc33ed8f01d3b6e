//! The report as files: Markdown, CSV, JSON and charts.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;
use std::{fs, io};

use stickslip_plot::{Curve, Picture as _, Plot};

use super::{Report, Row};

/// Smaller errors are drawn as this one: a logarithmic axis has no zero.
const SMALLEST_ERROR: f64 = 1e-17;
/// The head of each table.
const HEAD: &str = "| scene | solver | springs | × exact | force error | stress error | at kinks | median, s | \
    quartiles, s | least, s | runs |\n|---|---|---|---|---|---|---|---|---|---|---|\n";

/// The scene of the charts, or else the first one that was measured: the others look alike, and the tables have them.
const CHARTED: &str = "reversals_20";

/// Writes `report.md`, `report.csv`, `report.json`, `stress.svg` and `force.svg` into `dir`, which is created if it
/// does not exist.
///
/// # Errors
/// An error of the file system; a chart that cannot be drawn is [`io::ErrorKind::Other`].
pub fn write(dir: &Path, report: &Report) -> io::Result<()> {
    fs::create_dir_all(dir)?;
    fs::write(dir.join("report.md"), markdown(report))?;
    fs::write(dir.join("report.csv"), csv(&report.rows))?;
    let json = serde_json::to_value(report)?;
    fs::write(dir.join("report.json"), format!("{json:#}\n"))?;
    for (name, what, error) in [
        ("stress", "largest error of the shear stress / mu p_max", stress as fn(&Row) -> f64),
        ("force", "largest error of the force / mu F_N", |row: &Row| row.force_error),
    ] {
        let svg = chart(&report.rows, charted(report), what, error).svg().map_err(io::Error::other)?;
        fs::write(dir.join(format!("{name}.svg")), svg)?;
    }
    Ok(())
}

/// The error at random radii. At a kink, rounding the radius alone costs the root of the rounding error.
fn stress(row: &Row) -> f64 {
    row.stress_error
}

/// The scenes in the order in which they were measured.
fn scenes(report: &Report) -> Vec<&str> {
    let mut seen = BTreeSet::new();
    report.rows.iter().map(|row| row.scene.as_str()).filter(|scene| seen.insert(*scene)).collect()
}

/// The scene of the charts.
fn charted(report: &Report) -> &str {
    let scenes = scenes(report);
    scenes.iter().find(|scene| **scene == CHARTED).or(scenes.first()).copied().unwrap_or(CHARTED)
}

fn markdown(report: &Report) -> String {
    let mut page = format!(
        "# Speed against error\n\n{} It took {:.0} s.\n\nTimes are processor times of one thread, so that other work \
            on the machine is not counted. Ratios are medians over pairs, each of a run of a solver and a run of the \
            exact solver just before it; quartiles in brackets. Errors are the largest: of the force over the path, \
            relative to μ F_N; of the shear stress at 1000 random radii and at the kinks, relative to μ p_max (to μ \
            times the mean pressure for the cone).\n\n",
        report.machine, report.seconds
    );
    if !report.external_solvers.is_empty() {
        let _ = writeln!(page, "External solvers: {}.\n", report.external_solvers.join("; "));
    }
    let _ = write!(page, "The scene {}:\n\n![Error of the shear stress over the time](stress.svg)\n", charted(report));
    let _ = write!(page, "![Error of the force over the time](force.svg)\n\n");
    for scene in scenes(report) {
        let _ = write!(page, "## {scene}\n\n{HEAD}");
        for row in report.rows.iter().filter(|row| row.scene == scene) {
            let Row { solver, force_error, stress_error, kink_error, median, lower, upper, least, runs, .. } = row;
            let (ratio, ratio_lower, ratio_upper) = (short(row.ratio), short(row.ratio_lower), short(row.ratio_upper));
            let springs = row.springs.map(|count| count.to_string()).unwrap_or_default();
            // Writing to a string cannot fail.
            let _ = writeln!(
                page,
                "| {scene} | {solver} | {springs} | **{ratio}** ({ratio_lower} to {ratio_upper}) | {force_error:.1e} | \
                    {stress_error:.1e} | {kink_error:.1e} | {median:.2e} | {lower:.2e} to {upper:.2e} | {least:.2e} | \
                    {runs} |"
            );
        }
        let _ = writeln!(page);
    }
    if !report.missing.is_empty() {
        let _ = write!(page, "## Not measured\n\n| scene | solver | why |\n|---|---|---|\n");
        for missing in &report.missing {
            let _ = writeln!(page, "| {} | {} | {} |", missing.scene, missing.solver, missing.reason);
        }
    }
    page
}

/// Two or three digits, with an exponent for small values alone.
fn short(value: f64) -> String {
    if value >= 100.0 {
        format!("{value:.0}")
    } else if value >= 0.1 {
        format!("{value:.2}")
    } else {
        format!("{value:.1e}")
    }
}

fn csv(rows: &[Row]) -> String {
    let mut csv =
        "scene,solver,springs,ratio,force_error,stress_error,kink_error,median,lower,upper,least,runs,ratio_lower,\
                   ratio_upper\n"
            .to_owned();
    for row in rows {
        let Row {
            scene, solver, ratio, force_error, stress_error, kink_error, median, lower, upper, least, runs, ..
        } = row;
        let springs = row.springs.map(|count| count.to_string()).unwrap_or_default();
        let _ = writeln!(
            csv,
            "{scene},{solver},{springs},{ratio},{force_error:e},{stress_error:e},{kink_error:e},{median:e},{lower:e},\
             {upper:e},{least:e},{runs},{},{}",
            row.ratio_lower, row.ratio_upper
        );
    }
    csv
}

fn chart(rows: &[Row], scene: &str, what: &'static str, error: fn(&Row) -> f64) -> Plot {
    let rows = || rows.iter().filter(move |row| row.scene == scene && row.solver != "reference");
    let mut seen = BTreeSet::new();
    let mut solvers: Vec<&str> = rows().map(|row| row.solver.as_str()).filter(|solver| seen.insert(*solver)).collect();
    // Its one dot lies on top of the lines.
    solvers.sort_by_key(|solver| *solver == "exact");
    let series = solvers.into_iter().map(|solver| {
        let points = rows().filter(|row| row.solver == solver).map(|row| (row.median, error(row).max(SMALLEST_ERROR)));
        Curve { dots: solver == "exact", ..Curve::line(solver.to_owned(), None, points) }
    });
    Plot { over_decades: true, ..Plot::of_numbers(scene, "processor time, s", what, series.collect()) }
}

/// Processor, cores, system, compiler and optimisation.
pub(super) fn describe_machine(compiler: &str) -> String {
    let read = |path: &str| fs::read_to_string(path).unwrap_or_default();
    let cpus = read("/proc/cpuinfo");
    let model = cpus.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": ").map(|(_, name)| name));
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let system = read("/proc/sys/kernel/osrelease");
    let load = read("/proc/loadavg");
    let busy = load.split_whitespace().next().unwrap_or("unknown");
    let build = if cfg!(debug_assertions) { "unoptimised build" } else { "release build" };
    format!(
        "{}, {cores} cores, Linux {}, rustc {compiler}, {build}; load average {busy} at the start.",
        model.unwrap_or("unknown processor"),
        system.trim()
    )
}
