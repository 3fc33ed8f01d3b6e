//! Shear stress at any radius, and all its extrema.
//!
//! tau(r) = -(G* m/pi) sum over pieces of slope_i int dy/sqrt(X(y)^2 - r^2): each piece adds its slope times its ring's
//! kernel (eq. 19 of Kraft & Pohrt 2016, by parts over the levels). The search for extrema is in `extrema`.

use crate::contact::Contact;
use crate::profile::{Ring, StressRadius};

/// Terms of stresses that are summed between two questions whether to go on.
const TERMS_PER_QUESTION: usize = 1 << 20;
/// The fewest radii that are summed together, because they share a preparation.
const FEWEST_AT_ONCE: usize = 64;
/// The share of a square that is lost where it is rounded with its radius.
const ROUNDING: f64 = 1e-15;

/// A local extremum of the shear stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// Its radius, m.
    pub radius: f64,
    /// The shear stress there, Pa, signed.
    pub shear: f64,
}

/// The extrema of the shear stress in the present state.
#[derive(Clone, Debug, PartialEq)]
pub struct Residual {
    /// Shear stress at r = 0, Pa; `None` where it is infinite.
    pub centre: Option<f64>,
    /// The local extrema for 0 < r < a, from the centre outward.
    pub peaks: Vec<Peak>,
    /// Largest magnitude over the whole contact, Pa, the centre included; `None` where it is infinite.
    pub max: Option<f64>,
    /// Smallest magnitude of a peak, Pa.
    pub min: Option<f64>,
    /// Mean magnitude of the peaks, Pa.
    pub mean: Option<f64>,
}

impl Residual {
    /// From the shear stress at the centre, the local extrema, and the largest magnitude where the profile is singular,
    /// Pa.
    pub(crate) fn of(centre: f64, peaks: Vec<Peak>, elsewhere: f64) -> Residual {
        let sizes = || peaks.iter().map(|peak| peak.shear.abs());
        let max =
            (elsewhere.is_finite() && centre.is_finite()).then(|| sizes().fold(centre.abs().max(elsewhere), f64::max));
        let (min, mean) = if peaks.is_empty() {
            (None, None)
        } else {
            (Some(sizes().fold(f64::INFINITY, f64::min)), Some(sizes().sum::<f64>() / peaks.len() as f64))
        };
        Residual { centre: centre.is_finite().then_some(centre), max, min, mean, peaks }
    }
}

impl Contact {
    /// Shear stress, Pa, at a radius (m) of at least zero, or at the x of a line contact; zero outside the contact.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// contact.apply(&slide(1.0))?;
    /// // Gross slip forwards: mu times the pressure, positive.
    /// assert!((contact.shear(0.03) / (0.5 * contact.pressure(0.03)) - 1.0).abs() < 1e-14);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn shear(&self, radius: f64) -> f64 {
        if let Some(contact) = self.tangential() {
            return contact.shear(radius);
        }
        if let Some(line) = self.eccentric() {
            return self.eccentric_shears(line, &[radius])[0];
        }
        self.face().map_or(f64::NAN, |face| face.shear_at(&StressRadius::new(radius.abs())))
    }

    /// [`Contact::shear`] at each of `radii`, m: faster than one by one.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// contact.apply(&slide(0.001))?;
    /// assert_eq!(contact.shears(&[0.05, 0.2]), [contact.shear(0.05), 0.0]);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn shears(&self, radii: &[f64]) -> Vec<f64> {
        if let Some(contact) = self.tangential() {
            return contact.shears(radii);
        }
        if let Some(line) = self.eccentric() {
            return self.eccentric_shears(line, radii);
        }
        let distances: Vec<f64> = radii.iter().map(|radius| radius.abs()).collect();
        match self.face() {
            Some(face) => face.shears_at(&StressRadius::of_all(&distances)),
            None => vec![f64::NAN; radii.len()],
        }
    }

    /// [`Contact::shears`] at radii whose squares have all their digits.
    pub(crate) fn shears_at(&self, radii: &[StressRadius]) -> Vec<f64> {
        let rings: Vec<_> = self.shear_rings().rev().collect();
        self.shears_of(self.indenter.kernel_sums_at(&rings, radii))
    }

    /// Shear stresses, Pa, of weighted sums of kernels.
    fn shears_of(&self, sums: Vec<f64>) -> Vec<f64> {
        let unit = self.shear_unit();
        sums.into_iter().map(|sum| unit * sum).collect()
    }

    /// The rings of the slip history from the edge inward, each with its -dw/dy.
    pub(crate) fn shear_rings(&self) -> impl DoubleEndedIterator<Item = (Ring, f64)> {
        self.history.rings().map(|(ring, line)| (ring, -line.slope.value()))
    }

    /// G* m/pi, Pa.
    fn shear_unit(&self) -> f64 {
        self.elasticity.g_star() * self.scale() / std::f64::consts::PI
    }

    pub(crate) fn shear_at(&self, at: &StressRadius) -> f64 {
        if self.indenter.rim_radius().is_some() {
            // At a vertical edge the rings together have a sign, and each is infinite.
            return self.shears_at(&[*at])[0];
        }
        let mut sum = 0.0;
        for (ring, line) in self.history.rings() {
            // The depth of a thin ring may tell it to be wider than its squares do.
            if ring.outer.square < at.square * (1.0 - ROUNDING) {
                break;
            }
            let slope = line.slope.value();
            if slope.abs() > 0.0 {
                sum -= slope * self.indenter.kernel(at, &ring);
            }
        }
        self.shear_unit() * sum
    }

    /// The extrema of the shear stress with their radii to round-off, and their largest, smallest and mean magnitude.
    ///
    /// After many strokes the history itself says where the stress turns (`extrema/settled.rs`). Where it does not, the
    /// derivative is sampled between two kinks, ever closer to them, and where its size dips between samples of one
    /// sign a pair of roots is looked for: two extrema closer together than that could be missed. Dense searches on
    /// every profile (`tests/physics/extrema.rs`) have found none that was.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// contact.apply(&slide(1.0))?;
    /// contact.apply(&Move { tangential: Some(Tangential::Force(0.0)), ..Move::default() })?;
    /// // Without a force the core is still loaded forwards, and a ring outside it backwards.
    /// let residual = contact.residual();
    /// assert!(residual.centre.unwrap() > 0.0 && residual.peaks[0].shear < 0.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn residual(&self) -> Residual {
        self.residual_while(|| true).unwrap_or_else(|| Residual::of(self.shear(0.0), Vec::new(), f64::NAN))
    }

    /// As [`Contact::residual`], while `keep_going` returns true, which is asked at every kink of the slip history and
    /// knot of the profile, and every few thousand terms between them: the cost grows with the square of its depth.
    /// `None` if it returned false.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// assert!(contact.residual_while(|| false).is_none());
    /// # Ok::<(), Error>(())
    /// ```
    pub fn residual_while(&self, keep_going: impl Fn() -> bool) -> Option<Residual> {
        if let Some(contact) = self.tangential() {
            return contact.residual_while(keep_going);
        }
        if let Some(line) = self.eccentric() {
            return self.eccentric_residual(line, keep_going);
        }
        self.face().map_or(Some(Residual::of(f64::NAN, Vec::new(), f64::NAN)), |face| face.round_residual(keep_going))
    }

    fn round_residual(&self, keep_going: impl Fn() -> bool) -> Option<Residual> {
        let edge = StressRadius::of_point(self.history.edge());
        let spikes = self.indenter.singular().filter(|spike| spike.square <= edge.square).chain([edge]);
        let mut radii: Vec<StressRadius> = [StressRadius::new(0.0)].into_iter().chain(spikes).collect();
        let others = radii.len();
        let found = self.extrema(&keep_going)?;
        radii.extend(found.places);
        let rings: Vec<_> = self.shear_rings().rev().collect();
        let at_once = (TERMS_PER_QUESTION / rings.len().max(1)).max(FEWEST_AT_ONCE);
        let mut shears = Vec::with_capacity(radii.len());
        for some in radii.chunks(at_once) {
            if !keep_going() {
                return None;
            }
            // By the sum that the search has made, so that the rings are gathered once.
            let sums = found.sum.as_ref().map(|sum| sum.sums(some));
            shears.extend(self.shears_of(sums.unwrap_or_else(|| self.indenter.kernel_sums_at(&rings, some))));
        }
        let peak = |(place, &shear): (&StressRadius, &f64)| Peak { radius: place.radius, shear };
        let peaks = radii[others..].iter().zip(&shears[others..]).map(peak).collect();
        // Beside a rim that hardly exceeds the contact an extremum may be nearer to it than squares tell.
        let spikes = &shears[1..others];
        let largest = spikes.iter().fold(0.0_f64, |largest, shear| largest.max(shear.abs()));
        let elsewhere = if spikes.iter().all(|shear| shear.is_finite()) { largest } else { f64::INFINITY };
        Some(Residual::of(shears[0], peaks, elsewhere))
    }
}
