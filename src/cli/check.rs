//! `stickslip check`: verifies a store.

use clap::Args;

use super::io::print;
use super::progress;
use crate::sessions::{self, CheckEvent};
use crate::store;

/// The store, and the allowed difference.
#[derive(Args)]
pub struct Check {
    /// The store, `sqlite:PATH` or `postgres://…`; the service may be running.
    #[arg(long, env = "STICKSLIP_STORE", default_value = "sqlite:stickslip.db")]
    store: String,
    /// Largest relative difference of recorded states from replayed ones; zero requires equality to the last bit. Moves
    /// made by another version of the solver may differ by 1e-12.
    #[arg(long, env = "STICKSLIP_CHECK_TOLERANCE", default_value_t = 0.0, value_parser = tolerance)]
    tolerance: f64,
}

/// A difference below all of a state.
fn tolerance(text: &str) -> Result<f64, String> {
    let tolerance = text.parse().ok().filter(|tolerance| (0.0..1.0).contains(tolerance));
    tolerance.ok_or_else(|| "at least 0 and below 1".to_owned())
}

impl Check {
    /// Replays every contact, and prints the findings, with progress on a terminal.
    pub fn run(&self) -> Result<(), String> {
        let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build();
        let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
        let checked = runtime.block_on(async {
            let store = store::open_to_read(&self.store).await.map_err(|error| error.to_string())?;
            // A store that cannot be listed is a finding of the check itself.
            let moves = if progress::is_shown() { sessions::count_moves(&*store).await.unwrap_or(0) } else { 0 };
            let bar = progress::bar(moves, "{human_pos} of {human_len} moves");
            let mut report = |event: CheckEvent<'_>| match event {
                // A finding that cannot be printed is counted nevertheless.
                CheckEvent::Found(finding) => bar.suspend(|| drop(print(finding))),
                CheckEvent::Progress(checked) => bar.set_position(checked.moves),
            };
            let checked = sessions::check(&*store, self.tolerance, &mut report).await;
            bar.finish_and_clear();
            checked.map_err(|error| error.to_string())
        })?;
        print(checked)?;
        if checked.findings == 0 { Ok(()) } else { Err("the store has faults".to_owned()) }
    }
}
