//! `stickslip backup` and `stickslip check`: a store is copied, and looked over.

use std::path::PathBuf;

use clap::Args;
use stickslip::sessions::{self, Finding};
use stickslip::store;

use super::print;
use super::settings::ConfigFile;

/// Copy the store to a file, while the service runs or not.
#[derive(Args)]
pub struct Backup {
    #[command(flatten)]
    _file: ConfigFile,
    /// The file to make; one that is there is left as it is.
    file: PathBuf,
    /// The store, `sqlite:PATH`.
    #[arg(long, env = "STICKSLIP_STORE", default_value = "sqlite:stickslip.db")]
    store: String,
}

/// Look whether a store is sound: make every contact again from its moves, and compare. Nothing is written.
#[derive(Args)]
pub struct Check {
    #[command(flatten)]
    _file: ConfigFile,
    /// The store, `sqlite:PATH` or `postgres://…`; the service may be running.
    #[arg(long, env = "STICKSLIP_STORE", default_value = "sqlite:stickslip.db")]
    store: String,
    /// How far recorded states may differ from replayed ones, relatively; nought means not in a single bit. Moves made by
    /// another version of the engine may differ by 1e-12.
    #[arg(long, env = "STICKSLIP_CHECK_TOLERANCE", default_value_t = 0.0)]
    tolerance: f64,
}

impl Backup {
    /// Copies.
    pub fn run(&self) -> Result<(), String> {
        let bytes = store::backup(&self.store, &self.file).map_err(|error| error.to_string())?;
        print(format_args!("{} holds the store, {bytes} bytes", self.file.display()))
    }
}

impl Check {
    /// Looks, and says what it finds.
    pub fn run(&self) -> Result<(), String> {
        let runtime = tokio::runtime::Builder::new_multi_thread().enable_all().build();
        let runtime = runtime.map_err(|error| format!("cannot start: {error}"))?;
        let checked = runtime.block_on(async {
            let store = store::open_to_read(&self.store).await.map_err(|error| error.to_string())?;
            // A finding that cannot be printed counts all the same.
            let mut report = |finding: &Finding| drop(print(finding));
            sessions::check(&*store, self.tolerance, &mut report).await.map_err(|error| error.to_string())
        })?;
        print(checked)?;
        if checked.findings == 0 { Ok(()) } else { Err("the store is not sound".to_owned()) }
    }
}
