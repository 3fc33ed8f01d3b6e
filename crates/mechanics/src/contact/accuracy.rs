//! Error estimates of a result: rounding, curved moves, and the interpolation of tables.

use crate::contact::Contact;
use crate::contact::normal::mean_pressure;
use crate::contact::twist::Twist;
use crate::springs::law::SpringLaw;

/// A relative slope of g above this is the edge of a punch, whose radius is exact.
const MAX_STEEPNESS: f64 = 1e4;

/// The error of a stress over mu p_max, over that of the force over mu F_N, if the path begins at another
/// indentation: beside the radii at which slip once stopped the stress is steep.
const STRESS_OF_MOVED: f64 = 5.0;
/// The error of a torque by the points of a table over that of the load, relative.
const TWISTED_TABLE: f64 = 3.0;

/// Estimated errors by rounding, curved moves, the interpolation of a table or a discretisation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Error of the tangential force over mu F_N.
    pub force_error: f64,
    /// The part of it that comes from moves straight in a force.
    pub path_error: f64,
    /// Error of the shear stress over mu p_max, or over mu times the mean pressure where the former is infinite; of no
    /// meaning for a profile without a stress field.
    pub stress_error: f64,
}

impl Contact {
    /// The errors of the present state by rounding, curved moves and the interpolation of a table.
    ///
    /// The force is a sum over pieces, each good to some units in its last place, so that its rounding error scales
    /// with the magnitudes of the terms; so does that of a stress, whose terms are bounded by mu p. Between the points
    /// of a table or a load curve the load F(y) up to a level has an error
    /// ([`InterpolationError`](crate::profile::InterpolationError)), and the tangential force is a sum of F at the
    /// levels at which the slope of w over y jumps: the squares of the errors add up. An error of the initial
    /// indentation, where load or radius is given instead, moves the path. A stress has cusps: the estimate holds for a
    /// radius moved by some units in its last place, or by the error of the force times the contact radius.
    ///
    /// ```
    #[doc = include_str!("../example.txt")]
    /// contact.apply(&slide(0.001))?;
    /// let estimate = contact.accuracy();
    /// assert!(estimate.force_error < 1e-13 && estimate.stress_error < 1e-13);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn accuracy(&self) -> ErrorEstimate {
        if let Some(contact) = self.tangential() {
            return contact.accuracy();
        }
        if let Some(bodies) = &self.viscoelastic {
            let path_error = bodies.rows.path_error;
            let force_error = bodies.rows.force_error(&SpringLaw::Coulomb(self.material(&bodies.prony)));
            return ErrorEstimate { path_error, force_error, stress_error: 0.0 };
        }
        if let Some(Twist { springs: Some(springs), shear_modulus, .. }) = self.twist() {
            let law = self.twist_law(*shear_modulus);
            let unit = self.friction * self.summary().unit_pressure();
            let force_error = springs.force_error(&SpringLaw::Twist(law));
            let stress_error = force_error + springs.hoop_error(&law) / unit;
            return ErrorEstimate { path_error: springs.path_error, force_error, stress_error };
        }
        if let Some(twist) = self.twist() {
            // The limit of twist is an integral over that of pressure: of a table, both have its relative error.
            let load = self.profile().interpolation_error(self.stiffness_radius()).load;
            let unresolved = TWISTED_TABLE * 2.0 * self.elasticity.e_star() * load / self.normal_force;
            let ErrorEstimate { path_error, force_error, stress_error } = twist.contact.accuracy();
            return ErrorEstimate {
                path_error,
                force_error: force_error + unresolved,
                stress_error: stress_error + unresolved,
            };
        }
        // Without a load there is nothing to err; with one, an error that is not known is the largest number.
        let pressed = self.normal_force() > 0.0;
        let known = |value: f64| if pressed && !value.is_nan() { value.min(f64::MAX) } else { 0.0 };
        let carried = self.friction * self.normal_force();
        let summed = self.force_unit() * self.history.force_size();
        let terms = if carried > 0.0 { summed / carried } else { 0.0 };
        let (radius, indentation) = (self.stiffness_radius(), self.indentation());
        // Where g is steep, a rounded radius moves the indentation by this many units.
        let steepness = radius * self.indenter.slope(radius) / indentation;
        let steepness = known(steepness).clamp(0.0, MAX_STEEPNESS);
        let mean_pressure = match self.indenter.line() {
            Some(line) => self.normal_force() / (2.0 * self.contact_radius() * line.length()),
            None => mean_pressure(self.normal_force(), radius),
        };
        let interpolation = self.profile().interpolation_error(radius);
        let kernel = self.elasticity.e_star() / std::f64::consts::PI * (self.path_kernel + 2.0 * interpolation.kernel)
            / mean_pressure;
        let kernel = known(kernel);
        let unit_of_load = 2.0 * self.elasticity.e_star() / self.normal_force();
        let moved = known(unit_of_load * radius * self.indentation_error);
        let unresolved = moved + if interpolation.load > 0.0 { known(unit_of_load * self.load_error()) } else { 0.0 };
        let unit = f64::EPSILON * self.profile().cancellation(radius);
        let force_error = unit * (2.0 + 6.0 * terms + steepness) + self.path_error + unresolved;
        let stress_error = unit * (4.0 + 12.0 * terms + 2.0 * steepness)
            + self.path_error
            + unresolved
            + STRESS_OF_MOVED * moved
            + kernel;
        ErrorEstimate {
            path_error: self.path_error,
            force_error: force_error.min(f64::MAX),
            stress_error: stress_error.min(f64::MAX),
        }
    }

    /// The error of int w dx over the contact, m^2, w in levels, that the points of a table or a load curve leave.
    fn load_error(&self) -> f64 {
        let (mut sum, mut beyond) = (0.0, 0.0);
        for (ring, line) in self.history.rings() {
            let slope = line.slope.value();
            let error = (slope - beyond) * self.profile().interpolation_error(ring.outer.radius).load;
            sum += error * error;
            beyond = slope;
        }
        sum.sqrt()
    }
}
