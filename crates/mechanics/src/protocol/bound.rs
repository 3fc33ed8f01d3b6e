//! A lower bound on the stress that any sequence of reversals leaves, with its proof.
//!
//! After gross slip and N reversals w is made of N + 1 straight pieces of slope 1 or -1 over the levels. The stress is
//! tau(r) = -(G*/pi) int_r^a u'(x)/sqrt(x^2 - r^2) dx; by Abel's inversion
//! u(x) = (2/G*) int_x^a tau r dr/sqrt(r^2 - x^2). Between two radii x1 < x2 of one piece the difference of u is
//! m (g(x2) - g(x1)). The difference of the two kernels of the inversion, by its magnitude, has the integral
//!
//! B(x1, x2) = 2 sqrt(x2^2 - x1^2) - (sqrt(a^2 - x1^2) - sqrt(a^2 - x2^2)),
//!
//! so that a largest stress E allows no piece with g(x2) - g(x1) > (2/(G* m)) E B(x1, x2) between any two of its radii.
//! From the edge inwards each piece therefore ends at the latest where that first fails against its outer end; if N + 1
//! such pieces do not come as far as the innermost radius of the evaluation range, no N reversals leave as little as E.
//! (A sequence whose piece k begins further out than this one's ends further out too: a pair that fails here would lie
//! within it.)
//!
//! It has the right power of N, and on a sphere is 53 to 74 % of what the equal alternating extrema leave. For few
//! reversals `branch_and_bound` raises it to nearly all of that. That equal extrema are the best for any N is not
//! proven: an argument by the signs of differences (de la Vallée-Poussin's) fails, as the kernel (x^2 - r^2)^(-1/2)
//! does not diminish variation. A study with restarts in `tests/physics/protocols.rs` finds nothing better.

use std::f64::consts::PI;

use super::{EvaluationRange, branch_and_bound};
use crate::contact::Contact;
use crate::indenter::Indenter;
use crate::numerics::roots::turning;

/// Steps of the search from the edge to the centre for the end of a piece.
const STEPS: usize = 4_096;

/// The shear stress, Pa, that some point of the evaluation range carries at least after gross slip and this many
/// reversals, whatever their displacements; zero where nothing is known, as at a vertical edge. `None` if `keep_going`
/// returned false, which is asked at every step of the search for few reversals: on a profile whose stress is a
/// quadrature it can take some tenths of a second.
///
/// ```
#[doc = include_str!("../example.txt")]
/// use stickslip_mechanics::protocol::{lower_bound, minimax};
///
/// let bound = lower_bound(&contact, 3, &|| true).unwrap();
/// for target in minimax(&contact, 3, &|| true).unwrap().displacements {
///     contact.apply(&slide(target))?;
/// }
/// assert!(bound > 0.0 && bound <= contact.residual().max.unwrap());
/// assert!(lower_bound(&contact, 3, &|| false).is_none());
/// # Ok::<(), Error>(())
/// ```
pub fn lower_bound(contact: &Contact, reversals: usize, keep_going: &dyn Fn() -> bool) -> Option<f64> {
    let Some(face) = contact.face() else { return Some(0.0) };
    let contact = &*face;
    let (profile, edge) = (&*contact.indenter, contact.contact_radius());
    let EvaluationRange { from: cutoff, vertical, .. } = EvaluationRange::of(contact);
    if vertical || edge <= cutoff || contact.friction <= 0.0 {
        return Some(0.0);
    }
    let grid = Grid::new(profile, cutoff, edge);
    // One piece from the edge to the cut-off holds below this.
    let high = (grid.levels[0] - grid.levels[STEPS]) / (edge * edge - cutoff * cutoff).sqrt();
    if !(high > 0.0 && high.is_finite()) {
        return Some(0.0);
    }
    let [low, _] = turning([0.0, high], |limit| grid.reached(limit, reversals + 1));
    let unit = contact.elasticity.g_star() * contact.scale() / PI;
    let raised = branch_and_bound::raise(contact, cutoff, reversals, 0.5 * PI * low, keep_going)?;
    Some(unit * raised)
}

/// Radii from the edge inwards with their levels.
struct Grid {
    radii: Vec<f64>,
    levels: Vec<f64>,
}

impl Grid {
    fn new(profile: &Indenter, cutoff: f64, edge: f64) -> Grid {
        // Even in the square of the radius.
        let square = |index: usize| edge * edge - (edge * edge - cutoff * cutoff) * index as f64 / STEPS as f64;
        let radii: Vec<f64> = (0..=STEPS).map(|index| square(index).max(0.0).sqrt()).collect();
        let levels = radii.iter().map(|radius| profile.level(*radius)).collect();
        Grid { radii, levels }
    }

    /// Whether this many pieces may reach the end of the grid under a largest stress of `limit`, G* m/2. Because
    /// only the radii of the grid are checked, the answer can be yes wrongly, never no.
    fn reached(&self, limit: f64, pieces: usize) -> bool {
        let square = |index: usize| self.radii[index] * self.radii[index];
        let half = |index: usize| (square(0) - square(index)).max(0.0).sqrt();
        let mut outer = 0;
        for _ in 0..pieces {
            let holds = |inner: usize| {
                let kernel = 2.0 * (square(outer) - square(inner)).max(0.0).sqrt() - (half(inner) - half(outer));
                self.levels[outer] - self.levels[inner] <= limit * kernel
            };
            // The first that fails ends the piece, at the latest.
            match (outer + 1..=STEPS).find(|inner| !holds(*inner)) {
                Some(inner) => outer = inner,
                None => return true,
            }
        }
        false
    }
}
