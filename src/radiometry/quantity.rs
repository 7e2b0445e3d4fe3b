//! Quantities of light, each a type of its own: watts and lumens, flux and intensity cannot be mixed.
//!
//! ```compile_fail
//! use gnomon::radiometry::{LuminousFlux, RadiantFlux};
//! let _ = RadiantFlux::new(1.0) + LuminousFlux::new(1.0);
//! ```
//! ```compile_fail
//! use gnomon::radiometry::{Illuminance, LuminousIntensity};
//! let _: Illuminance = LuminousIntensity::new(1.0);
//! ```

use std::f64::consts::PI;
use std::fmt;
use std::iter::Sum;
use std::marker::PhantomData;
use std::ops::{Add, Div, Mul, Sub};

use super::luminosity::LuminousEfficacy;
use super::source::Cone;

/// What light carries, in watts.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Radiant;

/// How bright it looks, in lumens.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Luminous;

macro_rules! quantities {
    ($($(#[doc = $doc:literal])* $name:ident, $radiant:ident [$radiant_unit:literal], $luminous:ident [$luminous_unit:literal];)*) => { $(
        $(#[doc = $doc])*
        #[doc = concat!("[", $radiant_unit, "] or [", $luminous_unit, "].")]
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name<System> {
            value: f64,
            system: PhantomData<System>,
        }

        #[doc = concat!("[", $radiant_unit, "]")]
        pub type $radiant = $name<Radiant>;
        #[doc = concat!("[", $luminous_unit, "]")]
        pub type $luminous = $name<Luminous>;

        impl<System> $name<System> {
            #[doc = concat!("From its value in ", $radiant_unit, " or ", $luminous_unit, ".")]
            pub const fn new(value: f64) -> Self {
                Self { value, system: PhantomData }
            }

            #[doc = concat!("In ", $radiant_unit, " or ", $luminous_unit, ".")]
            pub const fn value(self) -> f64 {
                self.value
            }
        }

        impl $name<Radiant> {
            /// How bright that looks.
            pub fn luminous(self, efficacy: LuminousEfficacy) -> $name<Luminous> {
                $name::new(self.value * efficacy.value())
            }
        }

        impl $name<Luminous> {
            /// What it takes to look so bright.
            pub fn radiant(self, efficacy: LuminousEfficacy) -> $name<Radiant> {
                $name::new(self.value / efficacy.value())
            }
        }

        impl<System> Add for $name<System> {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                Self::new(self.value + other.value)
            }
        }

        impl<System> Sub for $name<System> {
            type Output = Self;
            fn sub(self, other: Self) -> Self {
                Self::new(self.value - other.value)
            }
        }

        impl<System> Mul<f64> for $name<System> {
            type Output = Self;
            fn mul(self, factor: f64) -> Self {
                Self::new(self.value * factor)
            }
        }

        impl<System> Div<f64> for $name<System> {
            type Output = Self;
            fn div(self, divisor: f64) -> Self {
                Self::new(self.value / divisor)
            }
        }

        impl<System> Div for $name<System> {
            type Output = f64;
            fn div(self, other: Self) -> f64 {
                self.value / other.value
            }
        }

        impl<System> Sum for $name<System> {
            fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
                parts.fold(Self::new(0.0), Add::add)
            }
        }

        impl fmt::Display for $name<Radiant> {
            fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                fmt::Display::fmt(&self.value, formatter)?;
                formatter.write_str(concat!(" ", $radiant_unit))
            }
        }

        impl fmt::Display for $name<Luminous> {
            fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
                fmt::Display::fmt(&self.value, formatter)?;
                formatter.write_str(concat!(" ", $luminous_unit))
            }
        }
    )* };
}

quantities! {
    /// Energy of light.
    EnergyIn, RadiantEnergy ["J"], LuminousEnergy ["lm s"];
    /// Energy for each second.
    FluxIn, RadiantFlux ["W"], LuminousFlux ["lm"];
    /// Flux for each steradian, in one direction.
    IntensityIn, RadiantIntensity ["W/sr"], LuminousIntensity ["cd"];
    /// Flux that arrives on each square metre.
    IrradianceIn, Irradiance ["W/m^2"], Illuminance ["lx"];
    /// Flux that leaves each square metre.
    ExitanceIn, RadiantExitance ["W/m^2"], LuminousExitance ["lm/m^2"];
    /// Flux for each steradian and square metre across the direction; the same all along a ray.
    RadianceIn, Radiance ["W/(m^2 sr)"], Luminance ["nt"];
}

impl<System> FluxIn<System> {
    /// What it adds up to in that time.
    pub fn energy(self, seconds: f64) -> EnergyIn<System> {
        EnergyIn::new(self.value * seconds)
    }

    /// Of a point that sends it out evenly in all directions: `I = flux / 4 pi`.
    pub fn isotropic_intensity(self) -> IntensityIn<System> {
        IntensityIn::new(self.value / (4.0 * PI))
    }

    /// On the axis of a spot that sends it out: see [`Cone::effective_solid_angle_sr`].
    pub fn spot_intensity(self, cone: Cone) -> IntensityIn<System> {
        IntensityIn::new(self.value / cone.effective_solid_angle_sr())
    }
}

impl<System> IntensityIn<System> {
    /// Of a point with this intensity in all directions.
    pub fn isotropic_flux(self) -> FluxIn<System> {
        FluxIn::new(4.0 * PI * self.value)
    }

    /// Of a spot with this intensity on its axis.
    pub fn spot_flux(self, cone: Cone) -> FluxIn<System> {
        FluxIn::new(self.value * cone.effective_solid_angle_sr())
    }

    /// The inverse square law, and the cosine at which the light arrives.
    pub fn irradiance(self, distance_m: f64, cosine: f64) -> IrradianceIn<System> {
        IrradianceIn::new(self.value * cosine / (distance_m * distance_m))
    }
}

impl<System> IrradianceIn<System> {
    /// What arrives on that area.
    pub fn flux(self, area_m2: f64) -> FluxIn<System> {
        FluxIn::new(self.value * area_m2)
    }
}

impl<System> ExitanceIn<System> {
    /// What leaves that area.
    pub fn flux(self, area_m2: f64) -> FluxIn<System> {
        FluxIn::new(self.value * area_m2)
    }

    /// Of a surface that looks alike from all sides (Lambert): `L = M / pi`.
    pub fn lambertian_radiance(self) -> RadianceIn<System> {
        RadianceIn::new(self.value / PI)
    }
}

impl<System> RadianceIn<System> {
    /// Of a surface with this radiance in all directions of its side: `M = pi L`.
    pub fn lambertian_exitance(self) -> ExitanceIn<System> {
        ExitanceIn::new(PI * self.value)
    }

    /// Of that much solid angle, each part of it weighted by the cosine at which its light arrives.
    pub fn irradiance(self, projected_solid_angle_sr: f64) -> IrradianceIn<System> {
        IrradianceIn::new(self.value * projected_solid_angle_sr)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_led_bulb_of_815_lm_has_64_9_cd() {
        let intensity = LuminousFlux::new(815.0).isotropic_intensity();
        assert_eq!(format!("{intensity:.1}"), "64.9 cd");
        assert!((intensity.isotropic_flux() / LuminousFlux::new(815.0) - 1.0).abs() < 2.0 * f64::EPSILON);
        // On a desk 2 m below: 16.2 lx, and half of it where the light arrives at 60 degrees.
        let below = intensity.irradiance(2.0, 1.0);
        assert_eq!(format!("{below:.1}"), "16.2 lx");
        assert_eq!(intensity.irradiance(2.0, 0.5), below / 2.0);
    }

    #[test]
    fn a_spot_with_its_flux_has_its_intensity() {
        let cone = Cone::new(0.2, 0.5).expect("valid");
        let intensity = LuminousFlux::new(300.0).spot_intensity(cone);
        assert!((intensity.spot_flux(cone).value() - 300.0).abs() < 1e-12);
        assert!(intensity.value() > 300.0 / (4.0 * PI));
    }

    #[test]
    fn a_lambertian_surface_radiates_pi_times_its_radiance() {
        let radiance = Radiance::new(2.0);
        assert_eq!(radiance.lambertian_exitance().value(), 2.0 * PI);
        assert_eq!(radiance.lambertian_exitance().lambertian_radiance(), radiance);
        assert_eq!(radiance.lambertian_exitance().flux(3.0).value(), 6.0 * PI);
        // Beneath an endless sky the projected solid angle is pi, and what arrives is what the sky radiates.
        assert_eq!(radiance.irradiance(PI).value(), radiance.lambertian_exitance().value());
    }

    #[test]
    fn every_quantity_has_its_luminous_counterpart() {
        let green = LuminousEfficacy::new(683.0);
        assert_eq!(RadiantEnergy::new(1.0).luminous(green), LuminousEnergy::new(683.0));
        assert_eq!(RadiantFlux::new(1.0).luminous(green), LuminousFlux::new(683.0));
        // The candela's definition.
        assert_eq!(RadiantIntensity::new(1.0 / 683.0).luminous(green), LuminousIntensity::new(1.0));
        assert_eq!(Irradiance::new(1.0).luminous(green), Illuminance::new(683.0));
        assert_eq!(RadiantExitance::new(1.0).luminous(green), LuminousExitance::new(683.0));
        assert_eq!(Radiance::new(1.0).luminous(green), Luminance::new(683.0));
        assert_eq!(Luminance::new(683.0).radiant(green), Radiance::new(1.0));
    }

    #[test]
    fn quantities_add_up_and_say_their_units() {
        let sum: LuminousFlux = [1.0, 2.0, 3.5].map(LuminousFlux::new).into_iter().sum();
        assert_eq!(sum.to_string(), "6.5 lm");
        assert_eq!((sum - LuminousFlux::new(6.0)).energy(60.0).to_string(), "30 lm s");
        assert_eq!(RadiantFlux::new(2.0).energy(3.0).to_string(), "6 J");
        assert_eq!(RadiantFlux::new(2.0).to_string(), "2 W");
        assert_eq!(RadiantIntensity::new(2.0).to_string(), "2 W/sr");
        assert_eq!(Illuminance::new(2.0).flux(4.0).to_string(), "8 lm");
        assert_eq!(Irradiance::new(2.0).to_string(), "2 W/m^2");
        assert_eq!(LuminousExitance::new(2.0).to_string(), "2 lm/m^2");
        assert_eq!(RadiantExitance::new(2.0).to_string(), "2 W/m^2");
        assert_eq!(Luminance::new(2.0).to_string(), "2 nt");
        assert_eq!(Radiance::new(2.0).to_string(), "2 W/(m^2 sr)");
    }
}
