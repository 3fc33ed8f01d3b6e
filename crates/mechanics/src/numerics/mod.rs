//! Numerics that know no friction and no profile; nothing here imports another module of the crate.
//!
//! | module | question |
//! |---|---|
//! | `double_double` | how do small differences keep their digits? |
//! | `roots` | where is a function zero, or largest? |
//! | `broyden` | where are two functions of two numbers zero? |
//! | `chebyshev` | which series has these values, and its primitive? |
//! | `gauss` | what is an integral, given where the integrand is singular? |
//! | `angle` | what are angles of several numbers side by side, and their tangents less them, to round-off? |
//! | `packing` | how are values written as bytes, and read again? |
//! | `root_kernel` | what is the integral of a power series over sqrt(t^2 - kappa)? |
//! | `cluster_tree`, `multipole` | what do many sources add up to, far away? |

pub(crate) mod angle;
pub(crate) mod broyden;
pub(crate) mod chebyshev;
pub(crate) mod cluster_tree;
pub(crate) mod double_double;
pub(crate) mod gauss;
pub(crate) mod multipole;
pub(crate) mod packing;
pub(crate) mod root_kernel;
pub(crate) mod roots;
