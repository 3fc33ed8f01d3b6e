//! What the commands share: a file or standard input, JSON, and standard output.

use std::fmt::Display;
use std::fs::File;
use std::io::{self, Read as _, Write};
use std::path::Path;

use serde_json::Value;
use tokio::signal::unix::{SignalKind, signal};

/// The content of a file, or of standard input for `-`.
pub fn read(file: &Path) -> Result<Vec<u8>, String> {
    let mut body = Vec::new();
    let read = if file.as_os_str() == "-" {
        io::stdin().lock().read_to_end(&mut body)
    } else {
        File::open(file).and_then(|mut file| file.read_to_end(&mut body))
    };
    read.map(|_| body).map_err(|error| format!("cannot read {}: {error}", file.display()))
}

/// Has a write beyond the limit of the size of files (`ulimit -f`) fail, as on a full disk: without a handler, the
/// signal that comes with it ends the process. The handler is never removed.
pub fn survive_file_size_limit() -> Result<(), String> {
    let kind = SignalKind::from_raw(rustix::process::Signal::XFSZ.as_raw());
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let handled = runtime.and_then(|runtime| runtime.block_on(async { signal(kind) }));
    handled.map(drop).map_err(|error| format!("cannot listen for signals: {error}"))
}

/// A value as indented JSON.
pub fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).unwrap_or_else(|error| error.to_string())
}

pub fn print(text: impl Display) -> Result<(), String> {
    write(|out| writeln!(out, "{text}"))
}

/// Prints to standard error how a file was interpreted. If that fails, the result still counts.
pub fn say(file: &Path, sentences: &[String]) {
    let mut err = io::stderr().lock();
    for sentence in sentences {
        writeln!(err, "{}: {sentence}", file.display()).ok();
    }
}

/// Writes to standard output. A reader that closes the pipe early, such as `head`, is no error.
pub fn write(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), String> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(format!("cannot write: {error}")),
        _ => Ok(()),
    }
}

pub fn parsed(text: &[u8]) -> Result<Value, String> {
    serde_json::from_slice(text).map_err(|error| format!("not valid JSON: {error}"))
}
