//! The errors of the mechanics, and the reasons that they name.

use thiserror::Error as ThisError;

use crate::profile::MOST_CELLS;
use crate::range::quantity::Quantity;
use crate::range::unit_prefix::{in_unit, short};

/// What a move can do whose target is beyond the limit of friction.
const WITHIN_LIMIT: &str = ": the largest tangential force that this move can meet is just below it";

/// A request that has no answer. Nothing has changed when one is returned.
#[derive(Clone, Debug, PartialEq, ThisError)]
pub enum Error {
    /// A number outside what is accepted.
    #[error("{quantity} = {} is out of range: allowed is {allowed}", short(*value))]
    OutOfRange {
        /// The given value.
        quantity: Quantity,
        /// Its value, in its SI unit.
        value: f64,
        /// The range, in words.
        allowed: String,
    },
    /// The contact would outgrow what is known of the profile: a table's last radius, the radius of the exact sphere.
    #[error("{}{} m, where the profile ends", beyond(*radius, *limit), short(*limit))]
    BeyondProfile {
        /// The contact radius needed, m; the limit itself if none would do.
        radius: f64,
        /// Where the profile ends, m.
        limit: f64,
    },
    /// The half-width of a line contact would come near the length that fixes its displacements.
    #[error(
        "a half-width of {} is not below {}, nine tenths of reference_length: displacements of a line contact are \
         defined only within that length", in_unit(*half_width, "m"), in_unit(*limit, "m")
    )]
    BeyondReferenceLength {
        /// The half-width needed, m; the limit itself if none would do.
        half_width: f64,
        /// The largest half-width, m.
        limit: f64,
    },
    /// A bulk stress under which the stick zones of a history would not be nested.
    #[error(
        "stress_per_force = {} {}", in_unit(*stress_per_force, "Pa/N"), if *largest > 0.0 {
            format!(
                "is too large: allowed is up to {} in both signs; beyond that, slip begins on both sides in opposite \
                 directions", in_unit(*largest, "Pa/N")
            )
        } else {
            "is not available with this profile: the stick zone that it shifts is known for a cylinder only".to_owned()
        }
    )]
    BulkTooLarge {
        /// The stress of the body over the tangential force, Pa/N.
        stress_per_force: f64,
        /// The largest that is taken, Pa/N.
        largest: f64,
    },
    /// A normal target of a contact whose bulk stress moves the stick zone.
    #[error("a bulk stress needs a constant normal force: leave the normal target out")]
    BulkNeedsConstantLoad,
    /// A load that changes while a contact with a shear strength carries shear.
    #[error(
        "with a shear strength the load must stay constant while the contact carries shear stress: change the load \
         before"
    )]
    LoadMustBeConstant,
    /// What knows Coulomb's law alone.
    #[error("{0} is not available with a shear strength")]
    ShearStrength(&'static str),
    /// What knows elastic bodies alone.
    #[error("{0} is not available for bodies with memory (`prony`)")]
    Viscoelastic(&'static str),
    /// A fluid that is held under a load for some time, in which it flows.
    #[error("the ratios of `prony` add up to 1: such a body flows under a load, so prescribe the indentation in time")]
    FluidUnderLoad,
    /// A move that takes time, of elastic bodies.
    #[error("a move takes time only where the bodies have memory: leave `duration` out, or give the contact `prony`")]
    NoMemory,
    /// What knows bodies that do not adhere alone.
    #[error("{0} is not available with adhesion")]
    Adhesive(&'static str),
    /// What knows contacts that are not twisted alone.
    #[error("{0} is not available for a contact that is twisted")]
    Twisted(&'static str),
    /// Twist and shift of one contact.
    #[error("twist and tangential motion of one contact are not available together: lift it off in between")]
    TwistWithShift,
    /// Twist of bodies whose shear moduli are not known.
    #[error("twist needs the bodies, or `shear_modulus` beside the reduced moduli")]
    ShearModulusNeeded,
    /// Twist of a profile of too many pieces.
    #[error("twist needs a profile of at most {MOST_CELLS} pieces inside the contact: smooth the table")]
    TooManyCells,
    /// No torque as large as this is carried.
    #[error(
        "friction holds a torque of no more than {}, but {} was asked for", in_unit(*limit, "N m"),
        in_unit(*target, "N m")
    )]
    TorqueExceedsFriction {
        /// The torque that the move was to lead to, N m.
        target: f64,
        /// That of gross slip, N m.
        limit: f64,
    },
    /// Coulomb's law under tension.
    #[error(
        "friction times pressure has no sense under tension: with adhesion `friction` must be 0, and `shear_strength` \
         is what holds against sliding"
    )]
    FrictionWithAdhesion,
    /// Places along x where there are radii alone.
    #[error("{0} is available for line contacts only")]
    RoundContact(&'static str),
    /// What is defined for round contacts alone.
    #[error("{0} is not available for a line contact")]
    LineContact(&'static str),
    /// g falls beyond some radius: the contact would be a ring.
    #[error("the profile is not convex enough for a contact without a gap: g falls at the radius {} m", short(*radius))]
    NotConvexEnough {
        /// The first radius at which g falls, m.
        radius: f64,
    },
    /// The part of the surface that wears reaches beyond what is known of the profile.
    #[error(
        "the worn part reaches beyond the radius {} m, where the profile ends, or g of the profile falls: give the \
         surface further out",
        short(*limit)
    )]
    WornBeyondProfile {
        /// Where the profile ends, m.
        limit: f64,
    },
    /// A table that is not one.
    #[error("the table is not usable: {fault} at index {index}")]
    Table {
        /// The fault.
        fault: TableFault,
        /// The first point at which it is.
        index: usize,
    },
    /// Numbers that are no load curve, or no set of asperities.
    #[error("the profile is not usable: {fault} at index {index}")]
    Curve {
        /// The fault.
        fault: CurveFault,
        /// The first number at which it is.
        index: usize,
    },
    /// A part of a sum that is known by its load curve alone, or along a line: only surfaces of revolution add up.
    #[error("part {part} of the sum is no surface of revolution: only such surfaces can be added up")]
    NoSurface {
        /// Its index.
        part: usize,
    },
    /// A stress of a contact that is known by its load curve alone.
    #[error(
        "the profile `{profile}` is known only by its load curve: forces and energies follow from it, stresses do not"
    )]
    NoStressField {
        /// Its type in JSON.
        profile: &'static str,
    },
    /// A contact that carries no tangential force.
    #[error("without friction and without a load nothing slides")]
    NothingSlides,
    /// A profile that does not roll.
    #[error("of round and line contacts, rolling is known for the `cylinder` alone")]
    OnlyCylinder,
    /// Reduced moduli where the bodies must be known.
    #[error("the tangential compliance of an ellipse depends on Poisson's ratio of each body: name the two bodies")]
    BodiesNeeded,
    /// No quasi-static state carries this tangential force: the contact would slide away.
    #[error(
        "friction holds no more than mu F_N = {}{}, but {} was asked for", in_unit(*limit, "N"),
        if target.abs() >= *limit { WITHIN_LIMIT } else { " on the way" },
        in_unit(*target, "N")
    )]
    ForceExceedsFriction {
        /// The tangential force that the move was to lead to, N.
        target: f64,
        /// Friction coefficient times normal force where the tangential force first meets it, N.
        limit: f64,
        /// Where along the move that is, from 0 to 1.
        part: f64,
    },
    /// Moves that do not lead back to where they began, however often they are repeated.
    #[error("the moves are not a closed cycle: they change the {quantity} by {} m each time", short(*drift))]
    OpenCycle {
        /// Displacement or indentation.
        quantity: Quantity,
        /// Its change in the last cycle tried, m.
        drift: f64,
    },
    /// A cycle whose states cannot be held together.
    #[error(
        "the states of this cycle take too much memory: use fewer moves, or moves that are straight in displacement \
         and indentation"
    )]
    CycleTooLarge,
    /// The caller has ended the computation before it was complete.
    #[error("interrupted")]
    Interrupted,
    /// The solver cannot follow this pair of targets.
    #[error("{0}")]
    Unsupported(UnsupportedMove),
}

/// The beginning of the message for a contact that needs this radius, m: how far it would lead beyond `limit`, m, is
/// not always known.
fn beyond(radius: f64, limit: f64) -> String {
    if radius > limit {
        format!("a contact radius of {} m is not below ", short(radius))
    } else {
        "the contact would reach the radius ".to_owned()
    }
}

/// Why two columns of radii r and heights z are not a profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ThisError)]
pub enum TableFault {
    /// The columns differ in length.
    #[error("r and z differ in length")]
    LengthsDiffer,
    /// The first radius is not zero.
    #[error("r does not begin at 0")]
    FirstRadiusNotZero,
    /// A radius is not above the one before it.
    #[error("r does not rise")]
    RadiusNotRising,
    /// No height is above the one at the centre.
    #[error("z does not rise anywhere")]
    HeightNeverRises,
}

/// Why columns of numbers are not a load curve, or not a set of asperities.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ThisError)]
pub enum CurveFault {
    /// The columns differ in length.
    #[error("the columns differ in length")]
    LengthsDiffer,
    /// The first point is not the first touch.
    #[error("the curve does not begin at an indentation and a force of 0")]
    NotFromZero,
    /// An indentation is not clearly above the one before it.
    #[error("the indentation does not rise by 1e-15 m")]
    IndentationNotRising,
    /// The second point carries nothing.
    #[error("the force does not rise")]
    ForceNotRising,
    /// The curve is not convex.
    #[error("the slope of the force over the indentation falls before the point")]
    SlopeFalls,
}

/// A pair of targets that the spring foundation has no rule for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ThisError)]
pub enum UnsupportedMove {
    /// A normal force together with a tangential target.
    #[error("springs follow a normal force only without a tangential target")]
    NormalForceWithTangentialTarget,
    /// A tangential force while the indentation changes.
    #[error("springs follow a tangential force only at constant indentation")]
    TangentialForceWithNormalTarget,
}

#[cfg(test)]
mod tests {
    use crate::Error;

    #[test]
    fn a_contact_beyond_the_profile_is_told_where_that_ends() {
        let message = |radius: f64| Error::BeyondProfile { radius, limit: 1.25e-4 }.to_string();
        assert_eq!(message(2e-4), "a contact radius of 2e-4 m is not below 1.25e-4 m, where the profile ends");
        // The radius that a load needs is sought up to the end alone.
        assert_eq!(message(1.25e-4), "the contact would reach the radius 1.25e-4 m, where the profile ends");
    }

    #[test]
    fn a_force_that_friction_cannot_hold_is_told_the_largest_that_it_can() {
        let message = |target: f64, limit: f64| Error::ForceExceedsFriction { target, limit, part: 0.5 }.to_string();
        assert_eq!(
            message(2000.0, 3.0),
            "friction holds no more than mu F_N = 3 N: the largest tangential force that this move can meet is just \
             below it, but 2 kN was asked for"
        );
        assert!(
            message(-25.0, 0.012_345_678).contains("mu F_N = 12.3457 mN:")
                && message(-25.0, 3.0).ends_with("-25 N was asked for")
        );
        // Where the load falls on the way, the target itself may be held.
        assert!(message(2.82, 7.4).starts_with("friction holds no more than mu F_N = 7.4 N on the way, but 2.82 N"));
    }
}
