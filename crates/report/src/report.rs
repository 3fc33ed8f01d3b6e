//! What the reports share: why there is none, tables in Markdown, and processor times.

use std::hint::black_box;

use rustix::time::{ClockId, clock_gettime};

/// Why there is no report: an error of the mechanics, of a fit, of a chart or of the file system.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// A table of rows under the names of its columns, with bars between them.
pub fn table(names: &str, rows: impl IntoIterator<Item = String>) -> String {
    let rows: String = rows.into_iter().map(|row| row + "\n").collect();
    format!("| {names} |\n|{}\n{rows}", "---|".repeat(names.split('|').count()))
}

/// A result, and the processor time of this thread for it, s: on a busy machine, wall-clock time grows for long runs
/// and not for short ones, which fit between two interruptions.
pub fn timed<T>(run: impl FnOnce() -> T) -> (T, f64) {
    let now = || {
        let now = clock_gettime(ClockId::ThreadCPUTime);
        now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
    };
    let begin = now();
    let found = black_box(run());
    (found, now() - begin)
}
