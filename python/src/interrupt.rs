//! Long work on a thread of its own, while this one listens for the signals that Python knows.

use std::panic::resume_unwind;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::PyMemoryError;
use pyo3::prelude::*;
use stickslip_compute::{Flag, Stop};

/// How often a signal is looked for.
const LOOK: Duration = Duration::from_millis(50);

/// Does the work without the lock of the interpreter; a signal handler that raises ends it.
///
/// # Errors
/// What the handler raises, such as `KeyboardInterrupt`, or a failure to start a thread.
pub fn interruptible<T: Send>(py: Python<'_>, work: impl FnOnce(&dyn Stop) -> T + Send) -> PyResult<T> {
    let stop = Flag::default();
    py.detach(|| {
        thread::scope(|scope| {
            let (sender, receiver) = channel();
            let flag = &stop;
            let begun = thread::Builder::new().spawn_scoped(scope, move || {
                // The receiver is there until the thread is joined.
                sender.send(work(flag)).ok();
            });
            let thread = begun.map_err(|error| PyMemoryError::new_err(error.to_string()))?;
            let (mut result, mut raised) = (None, None);
            loop {
                match receiver.recv_timeout(LOOK) {
                    Ok(done) => result = Some(done),
                    Err(RecvTimeoutError::Disconnected) => break,
                    Err(RecvTimeoutError::Timeout) => {
                        if raised.is_none()
                            && let Err(error) = Python::attach(|py| py.check_signals())
                        {
                            raised = Some(error);
                            stop.raise();
                        }
                    }
                }
            }
            if let Err(panic) = thread.join() {
                resume_unwind(panic);
            }
            match (raised, result) {
                (None, Some(done)) => Ok(done),
                (Some(error), _) => Err(error),
                (None, None) => Err(PyMemoryError::new_err("the work ended without a result")),
            }
        })
    })
}
