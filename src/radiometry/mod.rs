//! Light in real units: quantities, solid angles, sources, and what arrives from these at a point of a scene.
//!
//! Lengths are metres here, as in glTF. Computed in `f64`; of a scene only its queries are used.

mod direction;
mod error;
mod estimate;
mod irradiance;
mod lambert;
mod luminosity;
mod patch;
#[cfg(test)]
mod quadrature;
mod quantity;
mod sampling;
mod solid_angle;
mod source;

pub(crate) use direction::{finite, unit};
pub use error::RadiometryError;
pub use irradiance::{IrradianceEstimate, IrradianceOptions, irradiance};
pub use lambert::{projected_polygon_sr, projected_sphere_sr};
pub use luminosity::{LuminousEfficacy, MAX_LUMINOUS_EFFICACY_LM_PER_W, photopic_luminosity};
pub use quantity::{
    EnergyIn, ExitanceIn, FluxIn, Illuminance, IntensityIn, Irradiance, IrradianceIn, Luminance, Luminous,
    LuminousEnergy, LuminousExitance, LuminousFlux, LuminousIntensity, Radiance, RadianceIn, Radiant, RadiantEnergy,
    RadiantExitance, RadiantFlux, RadiantIntensity,
};
pub use sampling::{
    DirectionSample, sample_cone, sample_cosine_hemisphere, sample_hemisphere, sample_sphere, sample_triangle,
};
pub use solid_angle::{
    SPHERE_SR, box_sr, cap_sr, cone_sr, differential_sr, patch_sr, polygon_sr, sphere_sr, triangle_sr,
};
pub use source::{
    AreaSource, Cone, DirectionalSource, PointSource, Sources, SphereSource, SpotSource, range_attenuation,
};
