//! The log on its way out: lines wait in a bounded queue for a thread that writes many at a time. A reader of the log
//! that stops holds up nothing else: beyond the bound lines are lost, and counted.

use std::io::{self, Write};
use std::sync::Arc;
use std::thread::{Builder, sleep};
use std::time::{Duration, Instant};

use parking_lot::{Condvar, Mutex};
use tracing_subscriber::fmt::MakeWriter;

/// Bytes of lines that may wait.
const CAPACITY: usize = 1024 * 1024;
/// How long lines gather after a write, so that one write takes many of them.
const GATHERING: Duration = Duration::from_millis(5);

/// The queue. Clones share it.
#[derive(Clone, Default)]
pub struct LogQueue(Arc<Shared>);

#[derive(Default)]
struct Shared {
    waiting: Mutex<Waiting>,
    /// Notified when lines come to an empty queue.
    came: Condvar,
    /// Notified when all lines have been written.
    written: Condvar,
}

#[derive(Default)]
struct Waiting {
    lines: Vec<u8>,
    /// Lines that found no room since this was last said.
    lost: u64,
    /// Whether the thread has lines that it has not written.
    writing: bool,
}

impl LogQueue {
    /// A queue whose lines a thread writes to `out`, until the process ends.
    ///
    /// # Errors
    /// If the system has no thread for it.
    pub fn to(out: impl Write + Send + 'static) -> io::Result<LogQueue> {
        let queue = LogQueue::default();
        let own = queue.clone();
        Builder::new().name("log".to_owned()).spawn(move || own.write_on(out))?;
        Ok(queue)
    }

    fn write_on(self, mut out: impl Write) {
        let mut lines = Vec::new();
        loop {
            let mut waiting = self.0.waiting.lock();
            waiting.writing = false;
            if waiting.lines.is_empty() {
                self.0.written.notify_all();
                self.0.came.wait_while(&mut waiting, |waiting| waiting.lines.is_empty());
            }
            std::mem::swap(&mut waiting.lines, &mut lines);
            let lost = std::mem::take(&mut waiting.lost);
            waiting.writing = true;
            drop(waiting);
            // Nobody can be told of a log that cannot be written.
            let _ = out.write_all(&lines).and_then(|()| out.flush());
            lines.clear();
            if lost > 0 {
                tracing::warn!(lost, "lines of the log were lost: its reader is too slow");
            }
            sleep(GATHERING);
        }
    }

    /// Waits until all lines are written, but not beyond `end`.
    pub fn finish(&self, end: Instant) {
        let mut waiting = self.0.waiting.lock();
        let unwritten = |waiting: &mut Waiting| waiting.writing || !waiting.lines.is_empty();
        self.0.written.wait_while_until(&mut waiting, unwritten, end);
    }
}

impl<'a> MakeWriter<'a> for LogQueue {
    type Writer = &'a LogQueue;

    fn make_writer(&'a self) -> &'a LogQueue {
        self
    }
}

impl Write for &LogQueue {
    /// Takes a line, or loses it.
    fn write(&mut self, line: &[u8]) -> io::Result<usize> {
        let mut waiting = self.0.waiting.lock();
        if waiting.lines.len() + line.len() > CAPACITY {
            waiting.lost += 1;
        } else {
            let was_empty = waiting.lines.is_empty();
            waiting.lines.extend_from_slice(line);
            drop(waiting);
            if was_empty {
                self.0.came.notify_one();
            }
        }
        Ok(line.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::{self, Write};
    use std::sync::mpsc::{Receiver, Sender, channel};
    use std::time::{Duration, Instant};

    use super::{CAPACITY, LogQueue};

    /// Says what it is given, and waits for leave before it takes it.
    struct Slow(Sender<Vec<u8>>, Receiver<()>);

    impl Write for Slow {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.send(bytes.to_vec()).unwrap();
            self.1.recv().map_err(io::Error::other)?;
            Ok(bytes.len())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_reader_that_stops_holds_up_nobody_and_many_lines_are_one_write() {
        let ((said, says), (leave, waits)) = (channel(), channel());
        let queue = LogQueue::to(Slow(said, waits)).unwrap();
        let line = [b'x'; 1_000];
        (&queue).write_all(b"first\n").unwrap();
        // From here on the reader has stopped.
        assert_eq!(says.recv().unwrap(), b"first\n");
        for _ in 0..2 * CAPACITY / line.len() {
            (&queue).write_all(&line).unwrap();
        }
        assert_eq!(queue.0.waiting.lock().lost as usize, 2 * CAPACITY / line.len() - CAPACITY / line.len());
        // Nor is its end waited for longer than it may be.
        queue.finish(Instant::now() + Duration::from_millis(10));
        leave.send(()).unwrap();
        assert_eq!(says.recv().unwrap().len(), CAPACITY / line.len() * line.len(), "many lines to a write");
        leave.send(()).unwrap();
        queue.finish(Instant::now() + Duration::from_secs(60));
        assert!(queue.0.waiting.lock().lines.is_empty());
    }
}
