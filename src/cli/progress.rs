//! Progress on standard error, drawn only if that is a terminal.

use std::io::{self, IsTerminal as _};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

/// How often a bar moves that has nothing new to show.
const TICK: Duration = Duration::from_millis(200);

pub fn is_shown() -> bool {
    io::stderr().is_terminal()
}

/// A bar with what is `counted`, in the placeholders of the library, and the time that the rest takes.
pub fn bar(length: u64, counted: &str) -> ProgressBar {
    let bar = ProgressBar::new(length);
    let style = ProgressStyle::with_template(&format!("[{{bar:40}}] {counted}, {{eta}} left {{msg}}"));
    // The placeholders are written in this folder, and so are valid.
    bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
    // Once at least, however soon the work ends.
    bar.tick();
    bar.enable_steady_tick(TICK);
    bar
}
