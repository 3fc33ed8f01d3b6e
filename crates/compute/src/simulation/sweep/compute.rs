//! Computing a sweep in slices, over all threads that are free.

use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{self, Builder};
use std::time::{Duration, Instant};

use super::{Sweep, SweepResult};
use crate::prelude::*;
use crate::simulation::{Anew, check, simulate_any};
use crate::{Part, Refusal};
use stickslip_wire::PointFailure;
use stickslip_wire::pointer_lookup::{Lookup, lookup};

/// How long a sweep keeps its threads.
const SLICE_TIME: Duration = Duration::from_millis(25);
/// Work that a thread takes at a time.
const BATCH_COST: Nanoseconds = 250_000;
/// The most points that a thread takes at a time.
const BATCH_POINTS: u64 = 16;
/// How much lower the priority of the threads is.
#[cfg(unix)]
const NICE: i32 = 10;

/// The right to a thread for a part of a slice.
pub trait Worker: Send {
    /// Does the work on this thread.
    fn work<T>(self, work: impl FnOnce() -> T) -> T;
}

/// A thread that nobody else waits for.
impl Worker for () {
    fn work<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }
}

fn lower_priority() {
    // Not every system has priorities of threads.
    #[cfg(unix)]
    let _ = rustix::process::nice(NICE);
}

impl Sweep {
    /// Computes all of these points on so many threads of their own.
    ///
    /// # Errors
    /// As [`Sweep::slice`].
    pub fn compute(&self, points: Range<usize>, threads: usize, stop: &dyn Stop) -> Result<SweepResult, Failure> {
        let (mut result, mut next) = (SweepResult::default(), points.start);
        while next < points.end {
            let slice = self.slice(next..points.end, vec![(); threads.max(1)], stop, None)?;
            next += self.points_of(&slice);
            result.append(slice);
        }
        Ok(result)
    }

    /// Points of a result.
    pub fn points_of(&self, result: &SweepResult) -> usize {
        result.values.len() / self.checked.outputs.len().max(1)
    }

    /// Computes the first of these points, as many as fit in a slice, on a thread of its own for each worker. A point
    /// may take as long as `allowed`, or as `stop` permits.
    ///
    /// # Errors
    /// [`Failure`] if it was stopped, or the system has no thread for it.
    ///
    /// # Panics
    /// If a thread does.
    pub fn slice(
        &self,
        points: Range<usize>,
        workers: Vec<impl Worker>,
        stop: &dyn Stop,
        allowed: Option<Duration>,
    ) -> Result<SweepResult, Failure> {
        let batch = usize::try_from((BATCH_COST / self.cost_per_point.max(1)).clamp(1, BATCH_POINTS)).unwrap_or(1);
        let (next, begin) = (AtomicUsize::new(points.start), Instant::now());
        let work = || {
            lower_priority();
            let (mut document, mut mine) = (self.base.clone(), Vec::new());
            loop {
                let first = next.fetch_add(batch, Ordering::Relaxed);
                if first >= points.end {
                    break;
                }
                let result = self.compute_batch(&mut document, first..points.end.min(first + batch), stop, allowed);
                let stopped = result.is_err();
                mine.push((first, result));
                if stopped || begin.elapsed() >= SLICE_TIME {
                    break;
                }
            }
            mine
        };
        let mut done = thread::scope(|scope| {
            // A thread that the system refuses leaves its part to the others.
            let start = |worker| Builder::new().spawn_scoped(scope, || Worker::work(worker, work)).ok();
            let threads: Vec<_> = workers.into_iter().filter_map(start).collect();
            let done = threads.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| resume_unwind(panic)));
            done.flatten().collect::<Vec<_>>()
        });
        if done.is_empty() {
            return Err(Failure::from(Interrupted::Abandoned));
        }
        done.sort_by_key(|(first, _)| *first);
        done.into_iter().try_fold(SweepResult::default(), |mut result, (_, next)| {
            result.append(next?);
            Ok(result)
        })
    }

    fn compute_batch(
        &self,
        document: &mut Value,
        points: Range<usize>,
        stop: &dyn Stop,
        allowed: Option<Duration>,
    ) -> Result<SweepResult, Failure> {
        let mut result = SweepResult::default();
        let outputs = self.checked.outputs.len();
        for point in points {
            stop.check()?;
            let own = Part::of(stop, allowed.or(stop.flag().time_limit()));
            match self.point(document, point, &own) {
                Ok(reply) => {
                    result.values.extend(self.checked.outputs.iter().map(|output| match lookup(&reply, output) {
                        Lookup::Number(Some(value)) => value,
                        Lookup::Number(None) | Lookup::Nothing | Lookup::Other => f64::NAN,
                    }))
                }
                Err(refusal) => {
                    stop.check()?;
                    result.push_failure(outputs, failure(point, refusal));
                }
            }
        }
        Ok(result)
    }

    fn point(&self, document: &mut Value, point: usize, stop: &dyn Stop) -> Result<SimulationReply, Refusal> {
        self.checked.put(document, point);
        let request = SimulateRequest::deserialize(&*document);
        let request = request.map_err(|error| Refusal::at(Code::InvalidInput, "", error.to_string()))?;
        let simulation = check(request, &Anew(stop), stop)??;
        Ok(match &self.shared {
            Some(shared) => shared.simulate(simulation, stop)?,
            None => simulate_any(&simulation, stop)?,
        })
    }
}

/// The first fault of a refusal.
fn failure(point: usize, Refusal { code, detail, errors, .. }: Refusal) -> PointFailure {
    let first = errors.into_iter().next().map(|fault| (fault.pointer, fault.detail));
    let (pointer, detail) = first.unwrap_or((String::new(), detail));
    PointFailure { index: point as u64, code: code.as_str().to_owned(), pointer, detail }
}
