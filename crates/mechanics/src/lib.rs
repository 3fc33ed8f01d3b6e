//! The frictional contact of two elastic bodies, solved exactly, in plain numbers.
//!
//! A [`Contact`] is made from a [`Setup`] and moved by [`Contact::apply`]; it has a [`State`], stresses and a
//! [`Residual`]. `README.md` has a complete example.
//!
//! # The theory in a page
//!
//! Two elastic bodies, rotationally symmetric about the z axis, are pressed together over a circle of radius a and
//! moved sideways by U. Coulomb friction bounds the shear stress by mu times the pressure. By the method of
//! dimensionality reduction (Popov & Heß 2015) the contact is that of a row of independent springs along x with a
//! plane profile g(x):
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | f(r), g(x) | gap of the undeformed bodies; g(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr | m |
//! | d = g(a), a, F_N | indentation, contact radius, normal force | m, m, N |
//! | E*, G*, mu | reduced modulus, reduced shear modulus, coefficient of friction | Pa, Pa, – |
//! | m = mu E*/G* | scale of tangential against normal displacement | – |
//! | U, W = U/m | tangential displacement of the indenter, and scaled | m |
//! | u_x, w = u_x/m | tangential displacement of a spring, and scaled | m |
//! | y = g(x), X(y) | level of a spring, and its radius | m |
//!
//! A spring at level y is pressed in by d - y, and slips where |w| = d - y. The slip history is w over y, held as a
//! stack of straight pieces, which is exact for every path that is straight in (d, U) from move to move. From the
//! pieces follow
//!
//! - the tangential force F_x = 2 G* m int_0^a w dx,
//! - the shear stress tau(r) = -(G*/pi) int_r^a u_x'(x)/sqrt(x^2 - r^2) dx,
//! - the elastic energy G* m^2 int_0^a w^2 dx, and the friction work of each move,
//!
//! all as sums over pieces of a few integrals of each [`Profile`]: in closed form on a parabola, else by series over
//! `cells` of radii, to round-off. Under a vertical edge, where u_x(a) is not zero, tau has the edge term (G*/pi)
//! u_x(a)/sqrt(a^2 - r^2) besides, as the pressure has (E*/pi) u_z(a)/sqrt(a^2 - r^2).
//!
//! This is the theory of Cattaneo (1938) and Mindlin (1949), extended to any shape and path by Ciavarella (1998) and
//! Jäger (1998): the shear stress of partial slip is mu times a difference of pressures of the same bodies. Within it
//! the solution is exact. It leaves out the coupling of normal and tangential stress (Dundurs' beta is taken as zero),
//! slip across the motion (friction acts along x alone), and the shape of the bodies away from the contact (each is a
//! half-space).
//!
//! # Why one engine serves every law
//!
//! Under Abel transforms a half-space is pointwise in x: the transform of a traction needs what lies at r > x, that of
//! a displacement what lies at r < x. So every law that is local in r and slips in an outer annulus of one sign is a
//! row of springs with a stiffness k(x) dx, 2 G* dx for shift and 16 G x^2 dx for twist, and a limit of deflection
//! B(x): m (d - g) for Coulomb, its twin for twist, and 2 tau_0 sqrt(a^2 - x^2)/G* for a shear strength tau_0. Where B
//! falls with x and changes by the same amount everywhere (Coulomb under any path), or does not change (any law at a
//! constant load), the slip history above is exact, written over B(0) - B(x) in place of g(x): a law at a constant load
//! is a shape. Where slip leaves the annulus (a strength under a load that grows after partial slip) the law is not
//! local in x, and is refused. Adhesion changes d, F_N and the pressure alone: `contact`.
//!
//! Positive displacement gives positive force and positive shear stress. Energies are those of the tangential problem
//! alone.
//!
//! # Modules
//!
//! From the top down: each imports its own row and those below it.
//!
//! | module | question |
//! |---|---|
//! | [`protocol`], [`wear`] | which paths leave little shear stress? which shape does fretting wear leave in the end? |
//! | [`fatigue`] | how near does a cycle of stresses bring the material to fatigue? |
//! | [`sliders`], [`rolling`] | which springs with friction caps move like a contact? how does a cylinder roll? |
//! | [`rings`], [`springs`] | what does motion in the plane do? what the discrete foundation of the paper? |
//! | [`cycle`], [`closed_cycles`] | what does a contact do in a steady cycle, and which cycles has a path closed? |
//! | [`subsurface`] | what is the stress in the bodies below the contact? |
//! | `surface` | what does the surface carry, how far does it move and slip, where are the extrema? |
//! | `path` | how does a contact move, which displacement gives a force, how are curved moves followed? |
//! | `contact` | what is a contact made of, what are its state, pressure, error and bytes? |
//! | `slip_history` | what is left of the path under a limit law, and what work does a move dissipate? |
//! | `viscoelastic` | what do springs with memory carry, where bodies relax? |
//! | [`Indenter`] | what does a contact ask of a profile, resolved once? |
//! | [`profile`] | what does the shape of the indenter mean for a ring of the contact? |
//! | [`elasticity`], `conductance` | which two moduli do the bodies have together, and how do they conduct? |
//! | `cells` | how are g and its integrals computed for any shape, in cells of radii with one series each? |
//! | [`range`](mod@range) | which numbers are accepted, and what is refused? |
//! | `numerics` | how are differences kept exact, roots found, functions integrated, and what is far away summed? |

mod cells;
pub mod closed_cycles;
mod conductance;
mod contact;
pub mod cycle;
pub mod elasticity;
pub mod fatigue;
mod indenter;
mod numerics;
mod path;
pub mod profile;
pub mod protocol;
pub mod range;
pub mod rings;
pub mod rolling;
pub mod sliders;
mod slip_history;
pub mod springs;
pub mod subsurface;
mod surface;
#[cfg(test)]
mod tests;
mod viscoelastic;
pub mod wear;

/// Runs the example of the README as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use conductance::{Conductance, Conduction};
pub use contact::Contact;
pub use contact::accuracy::ErrorEstimate;
pub use contact::normal::{ContactSummary, Preload};
pub use contact::packed::ENGINE;
pub use contact::state::{Friction, Law, Move, Normal, Regime, Setup, State, Tangential};
pub use elasticity::{Body, Elasticity};
pub use indenter::Indenter;
pub use numerics::double_double::DoubleDouble;
pub use path::curved_move::{DEFAULT_TOLERANCE, MAX_CHORDS};
pub use profile::{Profile, Sphere};
pub use range::error::{CurveFault, Error, TableFault, UnsupportedMove};
pub use range::unit_prefix::{in_unit, unit_prefix};
pub use springs::Springs;
pub use subsurface::Stress;
pub use surface::shear_stress::{Peak, Residual};
pub use viscoelastic::{MOST_TERMS, Prony, PronyTerm};
