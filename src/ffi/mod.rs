//! The C interface: pointers become references, one call is made, outputs are written. Nothing is decided here.
//!
//! The manual is `include/gnomon.h`, generated from these comments.
#![expect(unsafe_code, reason = "the door to C: raw pointers come in here and nowhere else")]

mod builder;
mod irradiance;
mod options;
mod photometry;
mod pointers;
mod query;
mod sampling;
mod scene;
mod solid_angle;
mod status;
mod surface_point;
mod types;
mod version;

pub use builder::*;
pub use irradiance::*;
pub use options::*;
pub use photometry::*;
pub use query::*;
pub use sampling::*;
pub use scene::*;
pub use solid_angle::*;
pub use status::*;
pub use surface_point::*;
pub use types::*;
pub use version::*;
