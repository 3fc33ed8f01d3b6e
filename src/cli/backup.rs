//! `stickslip backup`: copies a store to a file.

use std::path::PathBuf;

use clap::Args;

use super::io::{print, survive_file_size_limit};
use super::progress;
use crate::store;

/// The store and the copy.
#[derive(Args)]
pub struct Backup {
    /// The file to create; an existing file is never overwritten.
    file: PathBuf,
    /// The store, `sqlite:PATH`.
    #[arg(long, env = "STICKSLIP_STORE", default_value = "sqlite:stickslip.db")]
    store: String,
}

impl Backup {
    /// Copies the store, with progress on a terminal.
    pub fn run(&self) -> Result<(), String> {
        survive_file_size_limit()?;
        let bar = progress::bar(0, "{bytes} of {total_bytes}");
        let show = |copied: u64, whole: u64| {
            bar.set_length(whole);
            bar.set_position(copied.min(whole));
        };
        let copied = store::backup(&self.store, &self.file, show);
        bar.finish_and_clear();
        let bytes = copied.map_err(|error| error.to_string())?;
        print(format_args!("copied the store to {}, {bytes} bytes", self.file.display()))
    }
}
