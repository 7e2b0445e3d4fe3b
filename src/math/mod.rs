//! Floating-point facts and error-free arithmetic that the geometry is built on.

mod double_double;
mod error_free;
mod expansion;
mod float;
mod quotient;

pub(crate) use double_double::DoubleDouble;
pub(crate) use expansion::Expansion;
pub(crate) use float::{UNIT_ROUNDOFF, gamma, scale_by_power_of_two_near, widen};
pub(crate) use quotient::{nearest_quotient, rounds_alike};
