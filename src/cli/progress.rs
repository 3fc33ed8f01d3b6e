//! Progress on standard error, drawn only if that is a terminal.

use std::io::{self, IsTerminal as _};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// How often a bar moves that has nothing new to show.
const TICK: Duration = Duration::from_millis(200);

pub fn is_shown() -> bool {
    io::stderr().is_terminal()
}

/// A bar of `length` steps, with the time that the rest takes. The words name the steps.
pub fn bar(length: u64, steps: &str) -> ProgressBar {
    drawn(
        ProgressBar::new(length),
        &format!("[{{bar:40}}] {{human_pos}} of {{human_len}} {steps}, {{eta}} left {{msg}}"),
    )
}

/// The same for bytes.
pub fn bar_of_bytes() -> ProgressBar {
    drawn(ProgressBar::new(0), "[{bar:40}] {bytes} of {total_bytes}, {eta} left")
}

/// A bar in a style that is written in this file, and so is valid.
fn drawn(bar: ProgressBar, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template).map(|style| style.progress_chars("=> "));
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    // Once at least, however soon the work ends.
    bar.tick();
    bar.enable_steady_tick(TICK);
    bar
}
