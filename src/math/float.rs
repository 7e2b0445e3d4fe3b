//! Rounding error of `f32` arithmetic.

/// Unit roundoff of `f32`, `u = 2^-24`: the largest relative error of one rounding to nearest.
pub(crate) const UNIT_ROUNDOFF: f32 = f32::EPSILON * 0.5;

/// `gamma(n) = n u / (1 - n u)` bounds the relative error of `n` chained roundings.
///
/// Source: Higham, "Accuracy and Stability of Numerical Algorithms", 2nd edition, lemma 3.1.
pub(crate) const fn gamma(n: u32) -> f32 {
    let nu = n as f32 * UNIT_ROUNDOFF;
    nu / (1.0 - nu)
}

/// The same number. A conversion would read a denormal one as 0 where the host has denormals-are-zero set.
#[inline(always)]
pub(crate) fn widen(value: f32) -> f64 {
    const EXPONENT: u32 = 0x7F80_0000;
    let bits = value.to_bits();
    if bits & EXPONENT != 0 { f64::from(value) } else { widen_denormal(bits) }
}

#[cold]
fn widen_denormal(bits: u32) -> f64 {
    const LEAST: f64 = 1.0 / (1u128 << 127) as f64 / (1u32 << 22) as f64;
    let magnitude = f64::from(bits & 0x007F_FFFF) * LEAST;
    if bits >> 31 == 0 { magnitude } else { -magnitude }
}

/// The power of two `s` with `s * magnitude` in `[1, 2)` or as near to it as a normal `s` comes. `magnitude` is
/// positive and finite.
pub(crate) fn scale_by_power_of_two_near(magnitude: f32) -> f32 {
    // Through f64, where every positive f32 is normal, so that the exponent field says it all.
    let exponent = ((f64::from(magnitude).to_bits() >> 52) & 0x7FF) as i32 - 1023;
    // 2^127 is the largest power of two, 2^-126 the smallest normal one.
    let scale = (-exponent).clamp(-126, 127);
    f32::from_bits(((scale + 127) as u32) << 23)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gamma_of_one_is_just_above_the_unit_roundoff() {
        assert!(gamma(1) >= UNIT_ROUNDOFF && gamma(1) < 1.001 * UNIT_ROUNDOFF);
    }

    #[test]
    fn widen_keeps_every_number() {
        for bits in [0, 1, 0x0000_FFFF, 0x007F_FFFF, 0x0080_0000, 0x3F80_0001, 0x7F7F_FFFF, 0x7F80_0000] {
            for value in [f32::from_bits(bits), -f32::from_bits(bits)] {
                assert_eq!(widen(value).to_bits(), f64::from(value).to_bits(), "{value:e}");
            }
        }
        assert!(widen(f32::NAN).is_nan());
    }

    #[test]
    fn scale_brings_every_magnitude_near_one() {
        for bits in [0x0000_0001, 0x0000_FFFF, 0x0080_0000, 0x3F80_0000, 0x4049_0FDB, 0x7F7F_FFFF] {
            let magnitude = f32::from_bits(bits);
            let scale = scale_by_power_of_two_near(magnitude);
            assert_eq!(scale.to_bits() & 0x007F_FFFF, 0, "not a power of two for {magnitude:e}");
            let scaled = f64::from(magnitude) * f64::from(scale);
            let least = if magnitude < f32::MIN_POSITIVE { f64::from(2.0_f32.powi(-22)) } else { 1.0 };
            assert!((least..4.0).contains(&scaled), "{magnitude:e} became {scaled:e}");
        }
    }
}
