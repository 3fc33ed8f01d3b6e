//! Random records of all that a bench may do. The truth is the closed loop of a ball behind a spring (Cattaneo 1938,
//! Mindlin 1949), without this library.

use stickslip_measured::loops::{Error, LoopFit, Noise, Parameter, Record, Start, fit};

use crate::bench::{Bench, Normal, rigid};

pub const DRIVES: usize = 5;

/// How a machine goes back and forth, each with its share of the cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Drive {
    Triangle,
    /// Rests at either end for this share of the cycle.
    Trapezoid(f64),
    /// A triangle whose corners are parabolas over this share of the cycle.
    RoundedTriangle(f64),
    /// Rises for this share of the cycle.
    Sawtooth(f64),
    Sine,
}

impl Drive {
    fn random(index: usize, random: &mut fastrand::Rng) -> Drive {
        let mut within = |low: f64, high: f64| low + (high - low) * random.f64();
        match index % DRIVES {
            0 => Drive::Triangle,
            1 => Drive::Trapezoid(within(0.02, 0.2)),
            2 => Drive::RoundedTriangle(within(0.02, 0.2)),
            3 => Drive::Sawtooth(within(0.7, 0.95)),
            _ => Drive::Sine,
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Drive::Triangle => "triangle",
            Drive::Trapezoid(_) => "trapezoid",
            Drive::RoundedTriangle(_) => "rounded triangle",
            Drive::Sawtooth(_) => "sawtooth",
            Drive::Sine => "sine",
        }
    }

    /// The displacement over the amplitude, and whether it rises, at a phase in cycles.
    pub fn at(self, phase: f64) -> (f64, bool) {
        let phase = phase.rem_euclid(1.0);
        // Half a cycle that rises from -1 to 1 is mirrored.
        let (half, rises) = (2.0 * (phase % 0.5), phase < 0.5);
        let way = match self {
            Drive::Triangle => 2.0 * half - 1.0,
            Drive::Trapezoid(rest) => {
                let rest = 2.0 * rest;
                (2.0 * (half - 0.5 * rest) / (1.0 - rest) - 1.0).clamp(-1.0, 1.0)
            }
            Drive::RoundedTriangle(round) => {
                // Within `round` of an end a parabola; the straight part between has the slope of the parabola's end.
                let edge = half.min(1.0 - half);
                let full = 1.0 - round;
                let rise = if edge < round { edge * edge / round } else { 2.0 * edge - round };
                (rise / full - 1.0) * if half < 0.5 { 1.0 } else { -1.0 }
            }
            Drive::Sawtooth(share) => {
                return if phase < share {
                    (2.0 * phase / share - 1.0, true)
                } else {
                    (1.0 - 2.0 * (phase - share) / (1.0 - share), false)
                };
            }
            Drive::Sine => -(std::f64::consts::PI * half).cos(),
        };
        (if rises { way } else { -way }, rises)
    }
}

/// What a record is made of; displacements in units of gross slip, forces in those of the friction force.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    pub drive: Drive,
    pub points: f64,
    pub cycles: f64,
    pub phase: f64,
    pub amplitude: f64,
    pub noise: [f64; 2],
    pub told: bool,
    /// Compliance over that of the contact; sought where it is not zero.
    pub machine: f64,
    /// Share of the amplitude a cycle; sought where it is not zero.
    pub drift: f64,
    /// Share of the points that are not there.
    pub left_out: f64,
}

impl Scene {
    pub fn random(index: usize, random: &mut fastrand::Rng) -> Scene {
        let drive = Drive::random(index, random);
        let mut within = |low: f64, high: f64| low + (high - low) * random.f64();
        Scene {
            drive,
            points: within(30.0_f64.ln(), 1000.0_f64.ln()).exp(),
            cycles: if within(0.0, 1.0) < 0.8 { within(1.0, 4.0) } else { within(4.0, 15.0) },
            // Some records begin at a turn.
            phase: if within(0.0, 1.0) < 0.8 { within(0.0, 1.0) } else { 0.0 },
            amplitude: if within(0.0, 1.0) < 0.6 { within(1.15, 2.5) } else { within(0.5, 0.95) },
            noise: [
                within(0.001_f64.ln(), 0.05_f64.ln()).exp(),
                if within(0.0, 1.0) < 0.4 { 0.0 } else { within(0.001_f64.ln(), 0.03_f64.ln()).exp() },
            ],
            told: within(0.0, 1.0) < 0.5,
            machine: if within(0.0, 1.0) < 0.6 { 0.0 } else { within(0.1, 0.6) },
            drift: if within(0.0, 1.0) < 0.6 { 0.0 } else { within(-0.15, 0.15) },
            left_out: if within(0.0, 1.0) < 0.8 { 0.0 } else { within(0.0, 0.2) },
        }
    }

    /// First loading of a ball behind its machine: force over displacement.
    fn first_loading(&self, displacement: f64) -> f64 {
        let own = |s: f64| if s < 1.0 { 1.0 - (1.0 - s).powf(1.5) } else { 1.0 };
        // The initial stiffness is 1.5 in these units.
        let machine = self.machine / 1.5;
        let (mut low, mut high) = (0.0, displacement);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if middle + machine * own(middle) > displacement { high = middle } else { low = middle }
        }
        own(0.5 * (low + high))
    }

    /// The record that a bench shows: a steady loop, sampled evenly in time, one second a point.
    pub fn record(&self, bench: &Bench, random: &mut Normal) -> Record {
        let (unit, limit) = (bench.gross_slip(), bench.friction * bench.normal_force);
        let amplitude = self.amplitude * (1.0 + self.machine / 1.5);
        let last = self.first_loading(amplitude);
        let (mut displacement, mut force, mut time) = (vec![], vec![], vec![]);
        for second in 0..(self.points * self.cycles) as usize {
            if random.0.f64() < self.left_out {
                continue;
            }
            let phase = self.phase + second as f64 / self.points;
            let (way, rises) = self.drive.at(phase);
            let sign = if rises { 1.0 } else { -1.0 };
            let exact = sign * (2.0 * self.first_loading(0.5 * amplitude * (1.0 + sign * way)) - last);
            let drift = self.drift * amplitude * second as f64 / self.points;
            displacement.push(unit * (amplitude * way + drift + self.noise[1] * random.next()));
            force.push(limit * (exact + self.noise[0] * random.next()));
            time.push(second as f64);
        }
        let start = Some(Start::Steady);
        let time = (self.drift != 0.0 || self.told).then_some(time);
        Record { displacement, force, time, normal_force: Some(bench.normal_force), start, weight: 1.0 }
    }

    /// What is sought, with the truth.
    pub fn sought(&self, bench: &Bench) -> Vec<(Parameter, f64)> {
        let (unit, limit) = (bench.gross_slip(), bench.friction * bench.normal_force);
        let mut sought = vec![(Parameter::Friction, bench.friction), (Parameter::GStar, bench.g_star)];
        if self.machine > 0.0 {
            sought.push((Parameter::MachineCompliance, self.machine / 1.5 * unit / limit));
        }
        if self.drift != 0.0 {
            let amplitude = self.amplitude * (1.0 + self.machine / 1.5);
            sought.push((Parameter::Drift, self.drift * amplitude * unit / self.points));
        }
        sought
    }

    pub fn fitted(&self, bench: &Bench, record: Record) -> Result<LoopFit, Error> {
        let free: Vec<Parameter> = self.sought(bench).iter().map(|(parameter, _)| *parameter).collect();
        let mut task = bench.task(vec![record], &free);
        let (unit, limit) = (bench.gross_slip(), bench.friction * bench.normal_force);
        if self.told {
            task.noise = Noise { force: Some(self.noise[0] * limit), displacement: Some(self.noise[1] * unit) };
        }
        if self.machine <= 0.0 {
            task.known.push(rigid());
        }
        fit(&task, &|| true)
    }
}
