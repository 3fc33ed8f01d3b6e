//! The page at `/`, in a real browser. What needs none is tested in `pure.test.js`.

mod axe;
mod browser;
#[path = "../common/mod.rs"]
mod common;
mod comparing;
mod following;
mod forms;
mod journeys;
mod line_contacts;
mod moving;
mod other_laws;
mod plots;
mod scene;
mod views;

/// A number of one to a thousand with four digits, without trailing zeros.
fn four(value: f64) -> String {
    digits(value, 4)
}

/// A number of one to a thousand with three digits, without trailing zeros.
fn three(value: f64) -> String {
    digits(value, 3)
}

fn digits(value: f64, count: usize) -> String {
    let places = count - 1 - value.log10().floor() as usize;
    format!("{value:.places$}").parse::<f64>().unwrap().to_string()
}

/// So many digits in MPa or GPa, as the page shows them.
fn pascals(value: f64, count: usize) -> String {
    let (value, unit) = if value >= 1e9 { (value / 1e9, "GPa") } else { (value / 1e6, "MPa") };
    format!("{} {unit}", digits(value, count))
}

/// The contact radius of a steel ball of a radius on `bodies` that yield, its own among them, by Hertz, in µm as the
/// page shows it.
fn hertz(force: f64, radius: f64, bodies: f64) -> String {
    let modulus = 2.1e11 / (1.0 - 0.3 * 0.3) / bodies;
    format!("{} µm", four(1e6 * (3.0 * force * radius / (4.0 * modulus)).cbrt()))
}
