//! Computing a sweep in slices, over all threads that are free.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use serde::Deserialize as _;
use serde_json::Value;

use super::{Sweep, SweepError, SweepResult};
use crate::admission::{Nanoseconds, Pool, Stop};
use crate::simulation::{Failure, simulate};
use stickslip_wire::check::Fault;
use stickslip_wire::pointer_lookup::{Lookup, lookup};
use stickslip_wire::{Code, Document as _, PointFailure, Rejection, SimulateReply, SimulateRequest};

/// How long a sweep keeps its threads.
const SLICE_TIME: Duration = Duration::from_millis(25);
/// Work that a thread takes at a time.
const BATCH_COST: Nanoseconds = 1_000_000;
/// The most points that a thread takes at a time.
const BATCH_POINTS: u64 = 64;
/// How much lower the priority of the threads is.
const NICE: i32 = 10;

/// Threads for sweeps. Clones are handles on the same.
#[derive(Clone, Debug)]
pub struct Workers(Arc<ThreadPool>);

impl Workers {
    /// This many threads.
    ///
    /// # Errors
    /// The error of the system.
    pub fn new(threads: usize) -> Result<Workers, String> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.max(1))
            .thread_name(|index| format!("sweep-{index}"))
            // Not every system has priorities.
            .start_handler(|_| {
                let _ = rustix::process::nice(NICE);
            })
            .build();
        pool.map(|pool| Workers(Arc::new(pool))).map_err(|error| error.to_string())
    }
}

impl Sweep {
    /// Computes points slice by slice. A point may take as long as `allowed`, or as `stop` permits.
    ///
    /// # Errors
    /// [`SweepError`]; the slices before are lost then.
    pub async fn compute(
        self: &Arc<Self>,
        points: Range<usize>,
        pool: &Pool,
        workers: &Workers,
        stop: &Stop,
        allowed: Option<Duration>,
    ) -> Result<SweepResult, SweepError> {
        let (mut result, mut next) = (SweepResult::default(), points.start);
        while next < points.end {
            let (sweep, workers, stop) = (Arc::clone(self), workers.clone(), stop.clone());
            let rest = next..points.end;
            let slice = pool.share(move |width| sweep.slice(rest, &workers, width, &stop, allowed)).await??;
            next += slice.values.len() / self.checked.outputs.len().max(1);
            result.append(slice);
        }
        Ok(result)
    }

    /// Computes the first of these points on `threads` threads, as many as fit in a slice.
    ///
    /// # Errors
    /// [`Failure`] if it was stopped.
    pub fn slice(
        &self,
        points: Range<usize>,
        workers: &Workers,
        width: usize,
        stop: &Stop,
        allowed: Option<Duration>,
    ) -> Result<SweepResult, Failure> {
        let batch = usize::try_from((BATCH_COST / self.cost_per_point.max(1)).clamp(1, BATCH_POINTS)).unwrap_or(1);
        let (next, begin, done) = (AtomicUsize::new(points.start), Instant::now(), Mutex::new(Vec::new()));
        workers.0.scope(|scope| {
            for _ in 0..width {
                scope.spawn(|_| {
                    let mut document = self.base.clone();
                    let mut mine = Vec::new();
                    loop {
                        let first = next.fetch_add(batch, Ordering::Relaxed);
                        if first >= points.end {
                            break;
                        }
                        let result =
                            self.compute_batch(&mut document, first..points.end.min(first + batch), stop, allowed);
                        let stopped = result.is_err();
                        mine.push((first, result));
                        if stopped || begin.elapsed() >= SLICE_TIME {
                            break;
                        }
                    }
                    done.lock().unwrap_or_else(PoisonError::into_inner).extend(mine);
                });
            }
        });
        let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
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
        stop: &Stop,
        allowed: Option<Duration>,
    ) -> Result<SweepResult, Failure> {
        let mut result = SweepResult::default();
        let outputs = self.checked.outputs.len();
        for point in points {
            stop.check()?;
            let own = allowed.map_or_else(|| stop.clone(), |allowed| stop.child_deadline(allowed));
            match self.point(document, point, &own) {
                Ok(reply) => {
                    result.values.extend(self.checked.outputs.iter().map(|output| match lookup(&reply, output) {
                        Lookup::Number(Some(value)) => value,
                        Lookup::Number(None) | Lookup::Nothing | Lookup::Other => f64::NAN,
                    }))
                }
                Err(failure) => {
                    stop.check()?;
                    let index = point as u64;
                    result.push_failure(outputs, PointFailure { index, ..failure });
                }
            }
        }
        Ok(result)
    }

    /// The reply to a point.
    fn point(&self, document: &mut Value, point: usize, stop: &Stop) -> Result<SimulateReply, PointFailure> {
        self.checked.put(document, point);
        let request = SimulateRequest::deserialize(&*document)
            .map_err(|error| Rejection::Invalid(vec![Fault { pointer: String::new(), detail: error.to_string() }]));
        let mut simulation = request.and_then(SimulateRequest::check).map_err(of_rejection)?;
        if let Some((definition, setup)) = &self.contact {
            (simulation.definition, simulation.setup) = (definition.clone(), setup.clone());
        }
        simulate(&simulation, stop).map_err(of_failure)
    }
}

fn of_rejection(rejection: Rejection) -> PointFailure {
    match rejection {
        Rejection::Refused { pointer, error } => of_failure(Failure::Refused { pointer, error }),
        Rejection::NotJson(detail) => failure(Code::InvalidInput, String::new(), detail),
        Rejection::Invalid(faults) => {
            let first = faults.into_iter().next().unwrap_or(Fault { pointer: String::new(), detail: String::new() });
            failure(Code::InvalidInput, first.pointer, first.detail)
        }
    }
}

fn of_failure(refusal: Failure) -> PointFailure {
    let (code, detail) = (refusal.code(), refusal.to_string());
    match refusal {
        Failure::Refused { pointer, error } => failure(code, pointer, error.to_string()),
        Failure::MemoryFull { pointer, .. } | Failure::TooLong { pointer, .. } | Failure::CycleTooLarge { pointer } => {
            failure(code, pointer, detail)
        }
        Failure::Scan { pointer, .. } => failure(code, pointer.to_owned(), detail),
        Failure::Stopped => failure(code, String::new(), detail),
    }
}

fn failure(code: Code, pointer: String, detail: String) -> PointFailure {
    PointFailure { index: 0, code: code.as_str().to_owned(), pointer, detail }
}
