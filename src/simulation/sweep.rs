//! Many simulations that differ in a few numbers, over all threads that are free.
//!
//! A sweep is computed in slices of some milliseconds. Between two slices it has no thread, so that whoever else needs one
//! waits for a slice and not for a sweep; and its threads have a lower priority than those that serve connections.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use rayon::ThreadPool;
use serde::Deserialize as _;
use serde_json::{Value, json};

use stickslip_mechanics::Setup;
use stickslip_wire::check::{Fault, Faults, JsonPath};
use stickslip_wire::json_value::Pointer;
use stickslip_wire::pointer_lookup::{Lookup, lookup};
use stickslip_wire::simulate::Simulation;
use stickslip_wire::sweep::CheckedSweep;
use stickslip_wire::{
    Code, ContactDefinition, Document as _, PointFailure, Rejection, SimulateReply, SimulateRequest, parse_value,
};

use super::cost;
use super::rows::Rows;
use super::shape::shape;
use super::{Failure, simulate};
use crate::admission::Nanoseconds;
use crate::admission::{Pool, PoolError, Stop};

/// How long a sweep keeps its threads.
const SLICE: Duration = Duration::from_millis(25);
/// Work that a thread takes at a time.
const BATCH: Nanoseconds = 1_000_000;
/// The most points of it.
const BATCH_POINTS: u64 = 64;
/// Work that is stored at a time: what a killed process loses.
const CHUNK: Nanoseconds = 1_000_000_000;
/// Numbers that are stored at a time, at the most.
const CHUNK_NUMBERS: usize = 65_536;
/// Pieces that a sweep is stored in, roughly, at the most.
const CHUNKS: usize = 10_000;
/// How much lower the priority of the threads is.
const NICE: i32 = 10;
/// Bytes that a value in a body takes once it is parsed, for each byte that it is written with; twice, as it is turned into a
/// request.
const VALUE_BYTES: usize = 32;

/// A sweep whose axes stay within the ranges of their fields and whose outputs exist.
#[derive(Debug)]
pub struct Sweep {
    draft: CheckedSweep,
    base: Value,
    /// The contact, where no axis changes it: a table is not to be read anew for each point.
    contact: Option<(ContactDefinition, Setup)>,
    each: Nanoseconds,
    bytes: usize,
}

/// Threads for sweeps. Clones are handles on the same.
#[derive(Clone, Debug)]
pub struct Workers(Arc<ThreadPool>);

/// Why a sweep was not computed to its end.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SweepError {
    /// It was stopped, or took too long.
    #[error(transparent)]
    Failure(#[from] Failure),
    /// No thread became free, or one panicked.
    #[error(transparent)]
    Pool(#[from] PoolError),
}

impl Workers {
    /// So many threads.
    ///
    /// # Errors
    /// Why the system gives none.
    pub fn new(threads: usize) -> Result<Workers, String> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.max(1))
            .thread_name(|index| format!("sweep-{index}"))
            // A system that knows no priorities does without.
            .start_handler(|_| {
                let _ = rustix::process::nice(NICE);
            })
            .build();
        pool.map(|pool| Workers(Arc::new(pool))).map_err(|error| error.to_string())
    }
}

impl Sweep {
    /// Looks at the corners of the sweep, where its numbers are smallest and largest.
    ///
    /// # Errors
    /// [`Rejection::Invalid`] if an axis leaves the range of its field, the base is at fault whatever the axes say, or an
    /// output does not exist; [`Rejection::Refused`] if the mechanics takes none of the corners.
    pub fn plan(draft: CheckedSweep) -> Result<Sweep, Rejection> {
        let mut document = draft.request.base.0.clone();
        let mut sweep = Sweep { draft, base: Value::Null, contact: None, each: 0, bytes: 0 };
        let mut outputs = vec![Lookup::Nothing; sweep.draft.outputs.len()];
        let (mut faults, mut taken, mut refused) = (Vec::new(), 0, None);
        for point in sweep.corners() {
            sweep.draft.put(&mut document, point);
            let checked = parse_value::<SimulateRequest>(&document).map_err(|fault| Rejection::Invalid(vec![fault]));
            match checked.and_then(SimulateRequest::check) {
                Ok(simulation) => {
                    taken += 1;
                    sweep.look(simulation, &mut outputs);
                }
                Err(Rejection::Invalid(found)) => faults.extend(found),
                Err(other) => refused = Some(other),
            }
        }
        sweep.refuse(faults, taken, refused)?;
        if taken > 0 {
            sweep.check_outputs(&outputs)?;
        }
        let written = document.to_string().len();
        if sweep.contact.is_some() {
            document["contact"] = stand_in();
        }
        sweep.base = document;
        sweep.bytes += written * VALUE_BYTES;
        Ok(sweep)
    }

    /// The points where each axis is at one of its ends.
    fn corners(&self) -> Vec<usize> {
        let mut corners = vec![0];
        for axis in &self.draft.axes {
            let with = |index: usize| corners.iter().map(move |corner| corner * axis.count() + index);
            let [least, most] = axis.ends();
            corners = if least == most { with(least).collect() } else { with(least).chain(with(most)).collect() };
        }
        corners
    }

    fn look(&mut self, simulation: Simulation, outputs: &mut [Lookup]) {
        self.each = self.each.max(cost::of_simulation(&simulation));
        self.bytes = self.bytes.max(cost::bytes_of_simulation(&simulation));
        let reply = shape(&simulation);
        for (output, found) in self.draft.outputs.iter().zip(outputs) {
            if !matches!(found, Lookup::Number(_)) {
                *found = lookup(&reply, &any_peak(output));
            }
        }
        let fixed = |axis: &stickslip_wire::sweep::AxisValues| {
            axis.pointer.segments().first().is_none_or(|first| first != "contact")
        };
        if self.draft.axes.iter().all(fixed) {
            self.contact = Some((simulation.definition, simulation.setup));
        }
    }

    /// Refuses what is wrong whatever the point, and values out of the range of their field.
    fn refuse(&self, found: Vec<Fault>, taken: usize, refused: Option<Rejection>) -> Result<(), Rejection> {
        let mut faults = Faults::default();
        let mut seen = Vec::new();
        for fault in found {
            let place = self.draft.place_of(&fault.pointer);
            if (taken == 0 || !place.starts_with("/base")) && !seen.contains(&place) {
                faults.add(JsonPath::Pointer(&place), fault.detail);
                seen.push(place);
            }
        }
        match (faults.is_empty(), refused) {
            (true, Some(Rejection::Refused { pointer, error })) if taken == 0 => {
                Err(Rejection::Refused { pointer: self.draft.place_of(&pointer), error })
            }
            _ => faults.done(Some(())),
        }
    }

    fn check_outputs(&self, found: &[Lookup]) -> Result<(), Rejection> {
        let (mut faults, at) = (Faults::default(), JsonPath::Root.member("outputs"));
        for (index, found) in found.iter().enumerate() {
            match found {
                Lookup::Number(_) => {}
                Lookup::Nothing => faults.add(at.index(index), "the reply to the base has nothing there"),
                Lookup::Other => faults.add(at.index(index), "the reply to the base has no number there"),
            }
        }
        faults.done(Some(()))
    }

    /// The sweep as it was asked for, with its axes.
    #[must_use]
    pub fn draft(&self) -> &CheckedSweep {
        &self.draft
    }

    /// How many points.
    #[must_use]
    pub fn points(&self) -> usize {
        self.draft.points
    }

    /// What all of it costs, at the most.
    #[must_use]
    pub fn cost(&self) -> Nanoseconds {
        self.each.saturating_mul(self.draft.points as u64)
    }

    /// Numbers that come out of so many points.
    #[must_use]
    pub fn numbers(&self, points: usize) -> usize {
        points * self.draft.outputs.len()
    }

    /// Bytes that it takes to compute on so many threads, beside what comes out.
    #[must_use]
    pub fn bytes(&self, threads: usize) -> usize {
        self.bytes.saturating_mul(threads + 1)
    }

    /// Points that are stored at a time.
    #[must_use]
    pub fn chunk(&self) -> usize {
        let worth = usize::try_from(CHUNK / self.each.max(1)).unwrap_or(usize::MAX);
        let most = CHUNK_NUMBERS / self.draft.outputs.len().max(1);
        worth.max(self.draft.points.div_ceil(CHUNKS)).clamp(1, most)
    }

    /// Computes points, giving way to others between slices. A point may take as long as `allowed`, or as `stop` lets it.
    ///
    /// # Errors
    /// [`SweepError`]; what has been computed is lost then.
    pub async fn compute(
        self: &Arc<Self>,
        points: Range<usize>,
        pool: &Pool,
        workers: &Workers,
        stop: &Stop,
        allowed: Option<Duration>,
    ) -> Result<Rows, SweepError> {
        let (mut rows, mut next) = (Rows::default(), points.start);
        while next < points.end {
            let (sweep, workers, stop) = (Arc::clone(self), workers.clone(), stop.clone());
            let rest = next..points.end;
            let slice = pool.share(move |width| sweep.slice(rest, &workers, width, &stop, allowed)).await??;
            next += slice.values.len() / self.draft.outputs.len().max(1);
            rows.append(slice);
        }
        Ok(rows)
    }

    /// Computes the first of these points on so many threads, as many as can be done in a slice.
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
    ) -> Result<Rows, Failure> {
        let batch = usize::try_from((BATCH / self.each.max(1)).clamp(1, BATCH_POINTS)).unwrap_or(1);
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
                        let rows = self.rows(&mut document, first..points.end.min(first + batch), stop, allowed);
                        let stopped = rows.is_err();
                        mine.push((first, rows));
                        if stopped || begin.elapsed() >= SLICE {
                            break;
                        }
                    }
                    done.lock().unwrap_or_else(PoisonError::into_inner).extend(mine);
                });
            }
        });
        let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
        done.sort_by_key(|(first, _)| *first);
        done.into_iter().try_fold(Rows::default(), |mut rows, (_, next)| {
            rows.append(next?);
            Ok(rows)
        })
    }

    fn rows(
        &self,
        document: &mut Value,
        points: Range<usize>,
        stop: &Stop,
        allowed: Option<Duration>,
    ) -> Result<Rows, Failure> {
        let mut rows = Rows::default();
        let outputs = self.draft.outputs.len();
        for point in points {
            stop.check()?;
            let own = allowed.map_or_else(|| stop.clone(), |allowed| stop.child_deadline(allowed));
            match self.point(document, point, &own) {
                Ok(reply) => rows.values.extend(self.draft.outputs.iter().map(|output| match lookup(&reply, output) {
                    Lookup::Number(Some(value)) => value,
                    Lookup::Number(None) | Lookup::Nothing | Lookup::Other => f64::NAN,
                })),
                Err(failure) => {
                    stop.check()?;
                    let index = point as u64;
                    rows.fail(outputs, PointFailure { index, ..failure });
                }
            }
        }
        Ok(rows)
    }

    /// The reply to a point.
    fn point(&self, document: &mut Value, point: usize, stop: &Stop) -> Result<SimulateReply, PointFailure> {
        self.draft.put(document, point);
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
        Failure::MemoryFull { pointer, .. } | Failure::TooLong { pointer, .. } => failure(code, pointer, detail),
        Failure::Stopped => failure(code, String::new(), detail),
    }
}

fn failure(code: Code, pointer: String, detail: String) -> PointFailure {
    PointFailure { index: 0, code: code.as_str().to_owned(), pointer, detail }
}

/// How many peaks there are is not known before; so any of them may be asked for.
fn any_peak(output: &Pointer) -> Pointer {
    match output.segments() {
        [residual, peaks, index, rest @ ..]
            if residual == "residual" && peaks == "peaks" && stickslip_wire::json_value::index(index).is_some() =>
        {
            let first = format!("/residual/peaks/0{}", rest.iter().map(|part| format!("/{part}")).collect::<String>());
            Pointer::parse(&first).unwrap_or_else(|| output.clone())
        }
        _ => output.clone(),
    }
}

/// A contact that is soon read, in place of one that has been read already.
fn stand_in() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 1.0}, "material": {"effective": {"e_star": 1.0, "g_star": 1.0}},
        "friction": 0.5, "preload": {"normal_force": 1.0}
    })
}
