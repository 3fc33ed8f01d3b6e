//! The residual stress: the extrema of the shear stress in the present state of a contact.

use stickslip_wire::Peak;

use super::stress::points;
use crate::computations::prelude::*;

/// Extrema that a contact is assumed to have.
const ASSUMED_PEAKS: usize = 1_000;

/// The extrema of which contact.
pub struct ResidualTask {
    /// Where a plot has the shear stress between the extrema.
    pub between: Option<StressRequest>,
}

/// The extrema, and the shear stress between them if it is drawn.
pub struct Extrema {
    title: String,
    reply: Residual,
    between: Vec<(f64, f64)>,
}

impl OnContact for ResidualTask {
    type Outcome = Extrema;

    fn bytes(&self) -> usize {
        bytes::of_stress(ASSUMED_PEAKS + self.between.as_ref().map_or(0, StressRequest::length))
    }

    fn rows(&self) -> (usize, usize) {
        (ASSUMED_PEAKS, bytes::ROW)
    }

    fn cost(&self, profile: &Profile, depth: usize) -> Nanoseconds {
        let radii = self.between.as_ref().map_or(0, StressRequest::length);
        Work { depth, radii, residual: true, ..Work::default() }.cost(profile)
    }

    fn takes_shear_strength(&self) -> bool {
        true
    }

    fn run(self, contact: Contact, sequence: u64, stop: &dyn Stop) -> Result<Extrema, Failure> {
        let reply = simulation::residual(&contact, stop)?;
        let stress = self.between.map(|between| simulation::stresses(&contact, &between, stop)).transpose()?;
        let between = stress.map(|stress| points(stress.places(), &stress.shear)).unwrap_or_default();
        let title = format!("Residual stress after move {sequence}");
        Ok(Extrema { title, reply, between })
    }
}

impl Borrow<Residual> for Extrema {
    fn borrow(&self) -> &Residual {
        &self.reply
    }
}

impl Outcome for Extrema {
    type Reply = Residual;

    fn table(&self, _: &DisplayOptions) -> Option<Table<'_>> {
        Some(table(&self.reply))
    }

    fn picture(&self, _: &DisplayOptions) -> Option<Drawing> {
        Some(Drawing::Plot(plot(self.title.clone(), &self.reply, self.between.clone())))
    }
}

/// A row for each extremum, from the centre outwards.
pub(super) fn table(residual: &Residual) -> Table<'_> {
    let peaks = &residual.peaks;
    let columns = vec![
        Column::floats(if along_line(residual) { "x" } else { "radius" }, "m", |row| peaks[row].place()),
        Column::floats("shear", "Pa", |row| peaks[row].shear),
        Column::words("kind", |row| kind(residual, row)),
    ];
    Table::flat(peaks.len(), columns)
}

fn along_line(residual: &Residual) -> bool {
    residual.peaks.iter().any(|peak| peak.x.is_some())
}

/// Whether an extremum is a `maximum` or a `minimum` of the shear stress: by the next one outwards, the one inside it,
/// the centre or, of an only one whose neighbours are infinite, its sign.
fn kind(residual: &Residual, row: usize) -> &'static str {
    let shear = |row: usize| residual.peaks.get(row)?.shear;
    let inside = if row == 0 { residual.centre } else { shear(row - 1) };
    let is_maximum = match (shear(row), shear(row + 1).or(inside)) {
        (Some(own), Some(neighbour)) => own > neighbour,
        (Some(own), None) => own > 0.0,
        // The sign of an infinite one is not in the reply: it is not that of its neighbour.
        (None, neighbour) => neighbour.is_none_or(|neighbour| neighbour <= 0.0),
    };
    if is_maximum { "maximum" } else { "minimum" }
}

/// The extrema as dots over the shear stress, which leads through them however few the points between them are.
pub(super) fn plot(title: String, residual: &Residual, mut between: Vec<(f64, f64)>) -> Plot {
    let dots = |peak: &Peak| (peak.place(), peak.shear.unwrap_or(f64::NAN));
    let dots: Vec<_> = residual.peaks.iter().map(dots).collect();
    let mut curves = Vec::new();
    if !between.is_empty() {
        between.extend(&dots);
        between.sort_by(|one, two| one.0.total_cmp(&two.0));
        curves.push(Curve::line("shear stress τ", Colour::Blue, between));
    }
    curves.push(Curve::dots("extrema", Colour::Red, dots));
    let axis = super::stress::place_axis(along_line(residual));
    Plot::new(title, axis, vec![Panel { y: Axis::of("shear stress", "Pa"), curves }])
}

#[cfg(test)]
mod tests {
    use super::{Peak, Residual, kind};

    fn residual(centre: Option<f64>, shears: &[Option<f64>]) -> Residual {
        let peaks = shears.iter().map(|shear| Peak { radius: Some(1.0), x: None, shear: *shear }).collect();
        Residual { centre, peaks, max: None, min: None, mean: None, relative: None }
    }

    #[test]
    fn extrema_are_told_by_their_neighbours() {
        let kinds = |of: &Residual| (0..of.peaks.len()).map(|row| kind(of, row)).collect::<Vec<_>>();
        assert_eq!(kinds(&residual(Some(0.0), &[Some(2.0), Some(-1.0), Some(0.5)])), ["maximum", "minimum", "maximum"]);
        // All of one sign: a minimum is above zero.
        assert_eq!(kinds(&residual(Some(3.0), &[Some(1.0), Some(2.0)])), ["minimum", "maximum"]);
        assert_eq!(kinds(&residual(Some(3.0), &[Some(1.0)])), ["minimum"]);
        assert_eq!(kinds(&residual(None, &[Some(-1.0)])), ["minimum"]);
        assert_eq!(kinds(&residual(Some(1.0), &[None, Some(2.0)])), ["minimum", "maximum"]);
    }
}
