//! Why there is no such light.

use thiserror::Error;

/// Each variant says the cause, its fields the values; its text is one sentence.
#[derive(Clone, Debug, Error, PartialEq)]
#[expect(missing_docs, reason = "the texts say it, and the fields are named in them")]
pub enum RadiometryError {
    #[error(
        "a spectrum needs a power for each of at least one wavelength: {wavelength_count} wavelengths, {power_count} powers"
    )]
    SpectrumLength { wavelength_count: usize, power_count: usize },

    #[error("wavelength {index} is {wavelength_nm} nm, not finite, above 0 and above the one before it")]
    Wavelength { index: usize, wavelength_nm: f64 },

    #[error("spectral power {index} is {power}, not a finite number from 0 on")]
    SpectralPower { index: usize, power: f64 },

    #[error("the spectrum has no power at any wavelength")]
    DarkSpectrum,

    #[error(
        "inner_cone_rad is {inner_cone_rad} and outer_cone_rad {outer_cone_rad}, not 0 <= inner < outer <= pi / 2 (KHR_lights_punctual)"
    )]
    Cone { inner_cone_rad: f64, outer_cone_rad: f64 },

    #[error("{what} is {value}, not {expected}")]
    Value { what: &'static str, value: f64, expected: &'static str },

    #[error("{what} is ({}, {}, {}), which is {problem}", value[0], value[1], value[2])]
    Vector { what: &'static str, value: [f32; 3], problem: &'static str },

    #[error("{kind} source {index}: {cause}")]
    Source { kind: &'static str, index: usize, cause: Box<RadiometryError> },

    #[error("triangle {triangle}: {cause}")]
    Triangle { triangle: usize, cause: Box<RadiometryError> },

    #[error("index {index} is out of range, there are {vertex_count} vertices")]
    IndexOutOfRange { index: u32, vertex_count: usize },

    #[error("{triangle_count} triangles without indices need three vertices each, there are {vertex_count}")]
    TooFewVertices { triangle_count: usize, vertex_count: usize },

    #[error("the receiver lies at the source, where there is no irradiance")]
    AtReceiver,

    #[error("there is no memory for {count} {what}")]
    OutOfMemory { what: &'static str, count: usize },
}

impl RadiometryError {
    pub(super) fn of_source(self, kind: &'static str, index: usize) -> Self {
        Self::Source { kind, index, cause: Box::new(self) }
    }

    pub(super) fn of_triangle(self, triangle: usize) -> Self {
        Self::Triangle { triangle, cause: Box::new(self) }
    }
}
