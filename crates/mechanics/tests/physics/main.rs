//! The physics tests, one program: each module holds the solver against closed forms, laws or an independent reference.

mod accuracy;
mod curved_moves;
mod curved_tolerance;
mod digits;
mod double_double;
mod elasticity;
mod equal_peaks;
mod exactness;
mod extrema;
mod hard_cases;
mod laws;
mod minimax;
mod packed;
mod paper;
mod profiles;
mod protocol_search;
mod protocols;
mod relative_moves;
mod slip_history;
mod springs;
mod springs_estimate;
mod sums_of_tables;
mod support;
mod tables;
