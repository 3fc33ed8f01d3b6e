//! The end of a process that serves: the signals for it, and its one deadline.

use std::sync::{Arc, OnceLock};
use std::thread;
use std::time::{Duration, Instant};

use tokio::signal::unix::{Signal, SignalKind, signal};

use super::log_queue::LogQueue;
use crate::server::connection_limits::{GRACE, LAST};

/// The signals that stop the process.
pub struct StopSignals {
    terminate: Signal,
    interrupt: Signal,
}

impl StopSignals {
    /// Listens for them, and for the one to read files again, the other value.
    pub fn listen() -> Result<(StopSignals, Signal), String> {
        // A write beyond the limit of the size of files (`ulimit -f`) fails as on a full disk: without a handler, the
        // signal that comes with it ends the process. A handler is never removed.
        let beyond = SignalKind::from_raw(rustix::process::Signal::XFSZ.as_raw());
        match [SignalKind::terminate(), SignalKind::interrupt(), SignalKind::hangup(), beyond].map(signal) {
            [Ok(terminate), Ok(interrupt), Ok(hangup), Ok(_)] => Ok((StopSignals { terminate, interrupt }, hangup)),
            _ => Err("cannot listen for signals".to_owned()),
        }
    }

    /// Waits for one of them.
    pub async fn wait(&mut self) {
        tokio::select! {
            _ = self.terminate.recv() => {}
            _ = self.interrupt.recv() => {}
        }
    }
}

/// The one deadline of all that a stop takes. Clones share it.
#[derive(Clone)]
pub struct Stopping {
    allowed: Duration,
    end: Arc<OnceLock<Instant>>,
    /// The lines of the log that are yet to be written.
    pub log: LogQueue,
}

impl Stopping {
    pub fn new(drain: Duration, log: LogQueue) -> Stopping {
        Stopping { allowed: drain + GRACE + LAST, end: Arc::default(), log }
    }

    /// The deadline, which is counted from the first call. What has not ended then ends with the process: all that was
    /// acknowledged is stored.
    pub fn begin(&self) -> Instant {
        *self.end.get_or_init(|| {
            let (allowed, log) = (self.allowed, self.log.clone());
            // Without a thread for it the stop takes as long as its parts do.
            let _ = thread::Builder::new().name("stop".to_owned()).spawn(move || {
                thread::sleep(allowed);
                tracing::warn!("the stop has taken too long: the process ends now");
                log.finish(Instant::now() + Duration::from_millis(50));
                std::process::exit(0);
            });
            Instant::now() + allowed
        })
    }
}
