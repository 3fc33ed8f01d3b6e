//! Long work of every kind asks whether to go on, however long it lasts, and ends at the answer no. Nothing here is
//! compared with a time: questions are counted, and stretches between them are parts of the same work.

use std::sync::Mutex;
use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};
use serde_json::{Value, json};
use stickslip_compute::computations::{DisplayOptions, compute};
use stickslip_compute::formats::Format;
use stickslip_compute::{Flag, Interrupted, Stop};
use stickslip_wire::Code;

/// The time limit that refusals name.
const ALLOWED: Duration = Duration::from_secs(7);

/// The part of the whole work that is done without a question at most, and after the answer no.
const LARGEST_PART: f64 = 0.15;

/// Grants so many questions, and measures the processor time between them.
struct Questions {
    flag: Flag,
    granted: u64,
    seen: Mutex<Seen>,
}

#[derive(Default)]
struct Seen {
    asked: u64,
    first: Option<Duration>,
    last: Duration,
    longest: Duration,
    refused: Option<Duration>,
}

impl Questions {
    fn granting(granted: u64) -> Questions {
        Questions { flag: Flag::default(), granted, seen: Mutex::default() }
    }

    /// What was seen until now, when the work has ended.
    fn end(self) -> Seen {
        let mut seen = self.seen.into_inner().unwrap();
        seen.advance();
        seen
    }
}

impl Seen {
    fn advance(&mut self) {
        let now = Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap();
        if self.first.is_none() {
            (self.first, self.last) = (Some(now), now);
        }
        self.longest = self.longest.max(now - self.last);
        self.last = now;
    }
}

impl Stop for Questions {
    fn flag(&self) -> &Flag {
        &self.flag
    }

    fn check_after(&self, _: Duration) -> Result<(), Interrupted> {
        let mut seen = self.seen.lock().unwrap();
        seen.advance();
        seen.asked += 1;
        if seen.asked <= self.granted {
            return Ok(());
        }
        let now = seen.last;
        seen.refused.get_or_insert(now);
        Err(Interrupted::TimeLimit(ALLOWED))
    }
}

fn ball() -> Value {
    json!({
        "profile": {"type": "sphere", "radius": 0.01},
        "material": {"bodies": [{"youngs_modulus": 2.1e11, "poisson_ratio": 0.3}, "rigid"]},
        "friction": 0.3,
        "preload": {"normal_force": 10.0}
    })
}

/// The body of a request: a contact, and members beside it.
fn of(contact: &Value, mut rest: Value) -> Value {
    rest["contact"] = contact.clone();
    rest
}

/// The ball with members of this value in place of its own.
fn ball_with(members: Value) -> Value {
    let mut ball = ball();
    ball.as_object_mut().unwrap().extend(members.as_object().unwrap().clone());
    ball
}

/// A ball whose profile is the sum of so many tables.
fn tables(number: usize, points: u32) -> Value {
    let table = |number: usize| {
        let radii: Vec<_> = (0..points).map(|index| 1e-3 / f64::from(points) * f64::from(index)).collect();
        let heights: Vec<_> = radii.iter().map(|r| r * r / (0.02 + 1e-3 * number as f64)).collect();
        json!({"type": "tabulated", "r": radii, "z": heights})
    };
    ball_with(json!({"profile": {"type": "sum", "parts": (0..number).map(table).collect::<Vec<_>>()}}))
}

/// Requests by the kind of their work: its name, the computation, the format, the body.
fn kinds() -> Vec<(&'static str, &'static str, Format, Value)> {
    let json = Format::Columns;
    let last = |contact: &Value, mut rest: Value| {
        rest["steps"] = json!("last");
        of(contact, rest)
    };
    let falling = |reversals: usize| json!({"falling_amplitude": {"reversals": reversals}});
    let curved =
        |index: u32| json!({"force": 0.1 * f64::from(index % 7), "normal_force": 9.0 + 0.1 * f64::from(index % 9)});
    let curved = json!({"moves": (0..1_000).map(curved).collect::<Vec<_>>()});
    // Where g'/x bends upward, every interval between two kinks is searched.
    let law = ball_with(json!({
        "profile": {"type": "power_law", "exponent": 5.37, "coefficient": 1e9}, "preload": {"indentation": 1e-6}
    }));
    let springs = json!({"springs": {"count": 20_000}});
    let drive = |unit: f64| -> Vec<f64> { (1..=20).map(|index| unit * f64::from(index)).collect() };
    let errors = json!({"amplitude_error": 0.01, "friction_error": 0.05, "samples": 100, "seed": 1});
    let grid = json!({"normal": "y", "offset": 0.0, "x": [-2e-4, 2e-4, 24], "z": [0.0, 2e-4, 24]});
    let criteria = json!({"crossland": {"alpha": 0.3, "limit": 3e8}, "findley": {"k": 0.3}});
    let swing = json!({"normal_force": 1.0, "phase": 1.0});
    let few = tables(4, 1_000);
    vec![
        ("curved moves", "simulate", json, last(&ball(), json!({"path": curved}))),
        ("a search", "simulate", json, last(&law, json!({"path": falling(3_000), "residual": true}))),
        ("stresses", "simulate", json, last(&few, json!({"path": falling(3_000), "stress": {"points": 1_000}}))),
        ("springs", "simulate", json, last(&ball(), json!({"path": falling(200), "solver": springs}))),
        (
            "a force on springs",
            "simulate",
            json,
            last(&ball(), json!({"path": {"force": vec![0.1; 50]}, "solver": springs})),
        ),
        (
            "a search on springs",
            "simulate",
            json,
            last(&ball(), json!({"path": falling(1), "solver": springs, "residual": true})),
        ),
        ("placing springs", "simulate", json, last(&few, json!({"path": falling(1), "solver": springs}))),
        (
            "stresses in depth",
            "simulate",
            json,
            last(&ball(), json!({"path": falling(500), "subsurface": {"body": "first", "plane": grid}})),
        ),
        ("preparing", "simulate", json, last(&tables(16, 2_000), json!({"path": falling(1)}))),
        ("a picture", "simulate", Format::Png, of(&ball(), json!({"path": falling(2_000)}))),
        (
            "a comparison",
            "accuracy",
            json,
            of(&ball(), json!({"path": curved, "solvers": [{"springs": {"count": 2_000}}]})),
        ),
        ("a protocol", "protocol", json, of(&few, json!({"reversals": 30, "robustness": errors}))),
        (
            "an oscillating load",
            "cycle",
            json,
            of(&few, json!({"drive": {"force": drive(0.1)}, "normal": swing, "harmonics": 31})),
        ),
        (
            "best loads",
            "cycle",
            json,
            of(&few, json!({"drive": {"displacement": drive(5e-9)}, "best_load": {"points": 100}})),
        ),
        (
            "a mass",
            "cycle",
            json,
            of(&few, json!({"drive": {"displacement": 1e-8}, "frequency_response": {"mass": 0.1, "drive_force": 1.0}})),
        ),
        (
            "fretting",
            "fretting",
            json,
            of(
                &ball(),
                json!({"body": "first", "path": {"displacement": [1e-7, -1e-7]}, "criteria": criteria, "plane": grid}),
            ),
        ),
    ]
}

#[test]
fn work_of_every_kind_asks_throughout_and_ends_at_the_first_no() {
    let mut failed = Vec::new();
    for (kind, name, format, body) in kinds() {
        let body = body.to_string();
        let run = |granted: u64| {
            let questions = Questions::granting(granted);
            let reply = compute(name, body.as_bytes(), DisplayOptions::in_format(format), &questions);
            (reply, questions.end())
        };
        let (reply, whole) = run(u64::MAX);
        let work = whole.last - whole.first.unwrap();
        let part = |of: Duration| of.as_secs_f64() / work.as_secs_f64();
        println!("{kind}: {} questions, {:.3} of the work between two, {work:?}", whole.asked, part(whole.longest));
        if reply.is_err() || part(whole.longest) > LARGEST_PART {
            failed.push(format!(
                "{kind}: {} of the work between two questions, {:?}",
                part(whole.longest),
                reply.err()
            ));
        }
        for granted in [1, whole.asked / 2, whole.asked - 1] {
            let (reply, seen) = run(granted);
            let refusal = reply.unwrap_err();
            let after = part(seen.last - seen.refused.unwrap());
            if refusal.code != Code::TooMuchWork || !refusal.detail.contains("7 s") || after > LARGEST_PART {
                failed.push(format!("{kind}: {after} of the work after question {granted}, {refusal:?}"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

#[test]
fn stresses_at_many_radii_ask_a_few_times_however_long_the_history_is() {
    // The rings of the history are summed by a tree, which is built anew between two questions.
    let asked = |reversals: usize, points: usize| {
        let stress = json!({"points": points, "fields": ["shear"]});
        let path = json!({"falling_amplitude": {"reversals": reversals}});
        let body = of(&ball(), json!({"path": path, "steps": "last", "stress": stress}));
        let stop = Questions::granting(u64::MAX);
        compute("simulate", body.to_string().as_bytes(), DisplayOptions::in_format(Format::Columns), &stop).unwrap();
        stop.end().asked
    };
    let more = |reversals: usize| asked(reversals, 1_000) - asked(reversals, 2);
    assert_eq!(more(3_000), more(10));
}
