//! Normal contact: indentation, contact radius, normal force and pressure, each from the others.
//!
//! d = g(a), F_N = 2 E* int_0^a (d - g) dx = 2 E* int_0^d X(y) dy, p(r) = (E*/pi) int dy/sqrt(X(y)^2 - r^2) over
//! X(y) > r (Popov & Heß 2015; the last form takes in a vertical edge as well).

use std::cmp::Ordering;

use crate::cells::shape::Reach;
use crate::elasticity::Elasticity;
use crate::indenter::Indenter;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::roots::{largest, within};
use crate::profile::Profile;
use crate::profile::{Point, Ring, StressRadius};
use crate::range::Quantity;
use crate::range::error::Error;
use crate::range::unit_prefix::short;

/// Radii of the first scan for the largest pressure.
const PRESSURE_SCAN: usize = 64;
/// Levels of that scan.
const LEVEL_SCAN: usize = 32;
/// The most kinks of a profile that are among its places.
const KINKS: usize = 64;
/// The highest places, and the highest kinks, beside which a maximum is searched for.
const SEARCHED: usize = 3;
const SEARCHED_KINKS: usize = 8;
/// Places between two others at which the pressure is looked at more closely, ever nearer to both.
const FINER: [f64; 7] = [0.001, 0.03, 0.2, 0.5, 0.8, 0.97, 0.999];

/// The normal load at the start. Zero is a contact just touching.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preload {
    /// F_N, N.
    NormalForce(f64),
    /// d, m.
    Indentation(f64),
    /// a, m.
    ContactRadius(f64),
}

/// Moduli, normal contact and limits of gross slip that follow from a definition and a normal load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSummary {
    /// Reduced modulus E*, Pa.
    pub e_star: f64,
    /// Reduced shear modulus G*, Pa.
    pub g_star: f64,
    /// Indentation d, m; below zero a gap.
    pub indentation: f64,
    /// Contact radius a, m.
    pub contact_radius: f64,
    /// Normal force F_N, N.
    pub normal_force: f64,
    /// Largest pressure, Pa; `None` where it is infinite, and of a profile without a stress field.
    pub max_pressure: Option<f64>,
    /// Semi-axes of the contact along x and y, m, of an ellipsoid.
    pub semi_axes: Option<[f64; 2]>,
    /// Displacement of gross slip on first loading, u_max = mu (E*/G*) d, m.
    pub gross_slip_displacement: f64,
    /// Tangential force of gross slip, mu F_N, N.
    pub gross_slip_force: f64,
    /// Electrical conductance, S, if the resistivity of both bodies is known.
    pub electrical_conductance: Option<f64>,
    /// Thermal conductance, W/K, if the conductivity of both bodies is known.
    pub thermal_conductance: Option<f64>,
    /// The load under which an adhesive contact pulls off, N; negative.
    pub pull_off_force: Option<f64>,
    /// The torque of gross slip, N m, where twist was asked for.
    pub gross_slip_torque: Option<f64>,
}

/// ```
#[doc = include_str!("../example.txt")]
/// let summary = contact.summary();
/// assert_eq!(Some(summary.unit_pressure()), summary.max_pressure);
/// assert_eq!(Some(summary.unit_shear()), summary.max_pressure.map(|pressure| 0.5 * pressure));
/// # Ok::<(), Error>(())
/// ```
impl ContactSummary {
    /// The summary of an indentation and its normal force, N.
    pub(crate) fn of(
        indenter: &Indenter,
        elasticity: &Elasticity,
        friction: f64,
        edge: &Point,
        normal_force: f64,
    ) -> ContactSummary {
        let indentation = edge.level.value();
        let conductance = elasticity.conductance(|| if indentation < 0.0 { 0.0 } else { edge.radius });
        ContactSummary {
            e_star: elasticity.e_star(),
            g_star: elasticity.g_star(),
            indentation,
            contact_radius: indenter.edge_radius(edge),
            normal_force,
            max_pressure: max_pressure(indenter, elasticity, edge),
            semi_axes: match indenter.profile() {
                Profile::Ellipsoid(ellipsoid) => Some(ellipsoid.semi_axes(indentation)),
                _ => None,
            },
            gross_slip_displacement: friction * elasticity.e_star() / elasticity.g_star() * indentation.max(0.0),
            gross_slip_force: friction * normal_force,
            electrical_conductance: conductance.electrical,
            thermal_conductance: conductance.thermal,
            pull_off_force: None,
            gross_slip_torque: None,
        }
    }

    /// The pressure that stresses are related to, Pa: the largest, or the mean where that is infinite.
    #[must_use]
    pub fn unit_pressure(&self) -> f64 {
        self.max_pressure.unwrap_or_else(|| mean_pressure(self.normal_force, self.contact_radius))
    }

    /// mu times [`ContactSummary::unit_pressure`], Pa: what residual stresses are relative to. Not finite without a
    /// load.
    #[must_use]
    pub fn unit_shear(&self) -> f64 {
        self.gross_slip_force / self.normal_force * self.unit_pressure()
    }
}

impl Profile {
    /// Prepares what a contact with this preload needs, while `keep_going` returns true: of a table whose slope never
    /// falls, the part that the contact reaches. Without it that is prepared when it is first needed.
    ///
    /// # Errors
    /// [`Error::Interrupted`] once `keep_going` has returned false.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert!(setup.profile.prepare_for(&setup.preload, &setup.elasticity, &|| true).is_ok());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn prepare_for(
        &self,
        preload: &Preload,
        elasticity: &Elasticity,
        keep_going: &dyn Fn() -> bool,
    ) -> Result<(), Error> {
        let Some(shape) = self.shape() else { return Ok(()) };
        let reach = match *preload {
            Preload::NormalForce(force) => Reach::Load(force.max(0.0) / (2.0 * elasticity.e_star())),
            Preload::Indentation(depth) => Reach::Level(depth.max(0.0)),
            Preload::ContactRadius(radius) => Reach::Radius(radius),
        };
        shape.cells_while(reach, keep_going).map(drop).ok_or(Error::Interrupted)
    }
}

/// F_N/(pi a^2), Pa; not finite without a contact.
pub(crate) fn mean_pressure(normal_force: f64, contact_radius: f64) -> f64 {
    normal_force / (std::f64::consts::PI * contact_radius * contact_radius)
}

/// The ring from the centre to `edge`: the whole contact.
pub(crate) fn whole(indenter: &Indenter, edge: &Point) -> Ring {
    Ring::between(indenter.point(DoubleDouble::ZERO), *edge)
}

/// int X dy, m^2, over a ring: its share of F_N/(2 E*).
pub(crate) fn load(indenter: &Indenter, ring: &Ring) -> f64 {
    if ring.depth <= 0.0 {
        return 0.0;
    }
    ring.inner.radius * ring.depth + indenter.moments(ring).first
}

/// Normal force, N, of the contact that ends at `edge`.
pub(crate) fn force(indenter: &Indenter, elasticity: &Elasticity, edge: &Point) -> f64 {
    2.0 * elasticity.e_star() * load(indenter, &whole(indenter, edge))
}

/// Indentation, m, that carries `normal_force`, N.
pub(crate) fn indentation(indenter: &Indenter, elasticity: &Elasticity, normal_force: f64) -> f64 {
    indenter.indentation_for(normal_force / (2.0 * elasticity.e_star()))
}

/// Indentation, m, at which the contact has this radius, m.
///
/// # Errors
/// [`Error::OutOfRange`] for a radius that is not that of one load alone: below a flat end, or from a vertical edge on.
pub(crate) fn indentation_at(indenter: &Indenter, radius: f64) -> Result<f64, Error> {
    let allowed = |allowed: String| Error::OutOfRange { quantity: Quantity::ContactRadius, value: radius, allowed };
    indenter.check_radius(radius)?;
    let flat = indenter.contact_radius(0.0);
    if radius < flat {
        return Err(allowed(format!("from the radius of the flat end, {} m, on", short(flat))));
    }
    if let Some(rim) = indenter.rim_radius()
        && radius >= rim
    {
        return Err(allowed(format!(
            "below the radius of the punch, {} m, from which on it does not determine the load",
            short(rim)
        )));
    }
    Ok(indenter.level_at_edge(radius))
}

/// Pressure, Pa, at radius r; zero outside the contact.
pub(crate) fn pressure(indenter: &Indenter, elasticity: &Elasticity, edge: &Point, at: &StressRadius) -> f64 {
    let ring = whole(indenter, edge);
    if ring.depth <= 0.0 {
        return 0.0;
    }
    elasticity.e_star() / std::f64::consts::PI * indenter.kernel(at, &ring)
}

/// [`pressure`] at each of `radii`, m: faster than one by one.
pub(crate) fn pressures(indenter: &Indenter, elasticity: &Elasticity, edge: &Point, radii: &[f64]) -> Vec<f64> {
    let ring = whole(indenter, edge);
    if ring.depth <= 0.0 {
        return vec![0.0; radii.len()];
    }
    let unit = elasticity.e_star() / std::f64::consts::PI;
    indenter.kernel_sums(&[(ring, 1.0)], radii).into_iter().map(|sum| unit * sum).collect()
}

/// The largest pressure, Pa; `None` where it is infinite or not known.
pub(crate) fn max_pressure(indenter: &Indenter, elasticity: &Elasticity, edge: &Point) -> Option<f64> {
    let (face, edge) = indenter.on_face(edge)?;
    let at = |at: &StressRadius| pressure(face, elasticity, &edge, at);
    let mut spikes = face.singular().filter(|spike| spike.square <= edge.square);
    if edge.level.value() > 0.0 && (face.is_upright(&edge) || spikes.any(|spike| at(&spike).is_infinite())) {
        return None;
    }
    if face.falls(0.0, edge.radius).least > 0.0 {
        return Some(at(&StressRadius::new(0.0))).filter(|most| most.is_finite());
    }
    // A scan, then a search about its largest values: a profile that is steep outside has its maximum off the centre.
    // Beside a flat end that hardly exceeds the contact it lies within the thin annulus beyond the flat, which may be
    // narrower than a unit in the last place of a radius: so radii at even steps of the level are scanned too, and
    // distinguished by their squares.
    let whole = [(whole(face, &edge), elasticity.e_star() / std::f64::consts::PI)];
    let radius = |index: usize| edge.radius * index as f64 / PRESSURE_SCAN as f64;
    let level = |index: usize| edge.level * (index as f64 / LEVEL_SCAN as f64);
    // At a kink the derivative is infinite, so that even radii miss a maximum beside it.
    let places = face.kinks().iter().map(|kink| kink.at.square).take_while(|square| *square < edge.square);
    let kinks = scanned(face, &whole, places.collect());
    let mut highest = kinks.clone();
    highest.sort_by(|one, other| other.pressure.total_cmp(&one.pressure));
    let mut places: Vec<DoubleDouble> = (0..PRESSURE_SCAN)
        .map(|index| DoubleDouble::square_of(radius(index)))
        .chain((0..LEVEL_SCAN).map(|index| face.point(level(index)).square))
        .chain(highest.iter().take(KINKS).map(|kink| kink.square))
        .filter(|square| *square < edge.square)
        .collect();
    places.sort_by(|a, b| a.partial_cmp(b).unwrap_or(Ordering::Equal));
    places.dedup();
    let mut scan = scanned(face, &whole, places);
    scan.push(Scanned { square: edge.square, pressure: 0.0 });
    // Between two places, kinks among them, the pressure has one maximum. It is beside a place that is higher than its
    // neighbours or, where the pressure rises infinitely steeply, beside a kink.
    let mut beside = hills(&scan);
    let of_kink = |kink: &Scanned| scan.iter().position(|place| place.square == kink.square);
    beside.extend(highest.iter().take(SEARCHED_KINKS).filter_map(of_kink));
    let mut stretches: Vec<usize> = beside.into_iter().flat_map(|index| [index.saturating_sub(1), index]).collect();
    stretches.sort_unstable();
    stretches.dedup();
    stretches.retain(|index| index + 1 < scan.len());
    let finer = stretches.iter().flat_map(|&index| {
        let (low, width) = (scan[index].square, scan[index + 1].square - scan[index].square);
        FINER.map(|share| low + width * share)
    });
    scan.extend(scanned(face, &whole, finer.collect()));
    scan.sort_by(|a, b| a.square.partial_cmp(&b.square).unwrap_or(Ordering::Equal));
    let mut most = scan.iter().map(|place| place.pressure).fold(0.0, f64::max);
    let inside = |square: DoubleDouble| at(&StressRadius { radius: square.value().sqrt(), square });
    for index in hills(&scan).into_iter().flat_map(|index| [index.saturating_sub(1), index]) {
        if let Some(high) = scan.get(index + 1) {
            let (low, width) = (scan[index].square, high.square - scan[index].square);
            most = most.max(largest([0.0, 1.0], 1e-7, |share| inside(low + width * share)).1);
        }
    }
    most.is_finite().then_some(most)
}

/// The square of a radius, m^2, with the pressure there, Pa.
#[derive(Clone, Copy)]
struct Scanned {
    square: DoubleDouble,
    pressure: f64,
}

/// The pressures at all of these squares, m^2, at once.
fn scanned(face: &Indenter, whole: &[(Ring, f64)], squares: Vec<DoubleDouble>) -> Vec<Scanned> {
    let place = |&square: &DoubleDouble| StressRadius { radius: square.value().sqrt(), square };
    let places: Vec<StressRadius> = squares.iter().map(place).collect();
    let pressures = face.kernel_sums_at(whole, &places);
    squares.into_iter().zip(pressures).map(|(square, pressure)| Scanned { square, pressure }).collect()
}

/// The highest places that are no lower than their neighbours.
fn hills(scan: &[Scanned]) -> Vec<usize> {
    let height = |index: usize| scan.get(index).map_or(0.0, |place| place.pressure);
    let rises = |index: usize| index == 0 || height(index) >= height(index - 1);
    let mut hills: Vec<usize> =
        (0..scan.len()).filter(|&index| rises(index) && height(index) >= height(index + 1)).collect();
    hills.sort_by(|&one, &other| height(other).total_cmp(&height(one)));
    hills.truncate(SEARCHED);
    hills
}

/// The depth below `outer` (or, if `upward`, above `inner`) of the part of a ring whose load int X dy is `load`, m.
///
/// The load is concave in the depth from the outside and convex from the inside, so Newton's step from the side of the
/// smaller slope never passes the root: it converges from any start, even where X vanishes and the slope with it.
pub(crate) fn depth_for(indenter: &Indenter, ring: &Ring, upward: bool, wanted: f64) -> f64 {
    let part = |depth: f64| {
        let depth = DoubleDouble::from(depth);
        if upward {
            Ring::between(ring.inner, indenter.point(ring.inner.level + depth))
        } else {
            Ring::between(indenter.point(ring.outer.level - depth), ring.outer)
        }
    };
    if wanted <= 0.0 {
        return 0.0;
    }
    let start_radius = if upward { ring.inner.radius } else { ring.outer.radius };
    let start = if start_radius > 0.0 { (wanted / start_radius).min(ring.depth) } else { ring.depth };
    within([0.0, ring.depth], start, |depth| {
        let tried = part(depth);
        (load(indenter, &tried) - wanted, if upward { tried.outer.radius } else { tried.inner.radius })
    })
}
