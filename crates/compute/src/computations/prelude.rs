//! What most computations are made of.

pub(super) use std::borrow::Borrow;

pub(super) use stickslip_plot::{Axis, Colour, Curve, Drawing, Panel, Plot};

pub(super) use super::{
    About, Choice, Computation, DisplayOptions, Example, OnContact, Outcome, Route, Task, example, example_contact,
    line_contact,
};
pub(super) use crate::formats::{Column, Format, Table};
pub(super) use crate::prelude::*;
