//! Numbers of 106 bits as unevaluated sums of two `f64`.
//!
//! Source: Joldes, Muller, Popescu, "Tight and rigorous error bounds for basic building blocks of double-word
//! arithmetic", ACM TOMS 44(2), 2017: algorithms 6 (addition, relative error 3u^2 + 13u^3 with u = 2^-53) and
//! 11 (multiplication, 5u^2), the product's low part by Dekker's splitting so that no CPU needs a fused multiply-add.

use std::ops::{Add, Mul, Sub};

/// `high + low`, with `|low|` at most half an ulp of `high`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// Bounds the relative error of one operation, `5u^2 + O(u^3)` rounded up to `8u^2 = 2^-103`.
    pub(crate) const UNIT_ROUNDOFF: f64 = f64::EPSILON * f64::EPSILON * 2.0;

    /// The exact difference of two numbers.
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        Self::sum(a, -b)
    }

    /// The exact sum (Knuth's TwoSum: no condition on the magnitudes).
    fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let b_part = high - a;
        let a_part = high - b_part;
        Self { high, low: (a - a_part) + (b - b_part) }
    }

    /// The exact sum where `|a| >= |b|` (Dekker's Fast2Sum).
    fn ordered_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        Self { high, low: b - (high - a) }
    }

    /// The exact product (Dekker 1971). The magnitudes here, products of a few `f32`, are far from overflow.
    fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        let (a_high, a_low) = split(a);
        let (b_high, b_low) = split(b);
        let low = ((a_high * b_high - high) + a_high * b_low + a_low * b_high) + a_low * b_low;
        Self { high, low }
    }

    /// The nearest `f64`.
    pub(crate) fn to_f64(self) -> f64 {
        self.high
    }
}

/// Veltkamp's split of a number into two of at most 26 bits.
fn split(a: f64) -> (f64, f64) {
    const FACTOR: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = FACTOR * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let high = Self::sum(self.high, other.high);
        let low = Self::sum(self.low, other.low);
        let first = Self::ordered_sum(high.high, high.low + low.high);
        Self::ordered_sum(first.high, low.low + first.low)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self { high: -other.high, low: -other.low }
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        Self::ordered_sum(product.high, product.low + cross)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use proptest::prelude::*;

    fn exact(value: DoubleDouble) -> BigRational {
        BigRational::from_float(value.high).unwrap() + BigRational::from_float(value.low).unwrap()
    }

    /// `|computed - truth| <= bound * scale`.
    fn within(computed: DoubleDouble, truth: &BigRational, scale: &BigRational) -> bool {
        let bound = BigRational::from_float(DoubleDouble::UNIT_ROUNDOFF).unwrap() * scale;
        magnitude(&(exact(computed) - truth)) <= bound
    }

    fn magnitude(value: &BigRational) -> BigRational {
        let zero = BigRational::from_integer(BigInt::from(0));
        if *value < zero { -value.clone() } else { value.clone() }
    }

    proptest! {
        #[test]
        fn operations_stay_within_their_bound(
            a in -1e30f32..1e30,
            b in -1e-20f32..1e-20,
            c in -1e10f32..1e10,
            d in -1f32..1.0,
        ) {
            let x = DoubleDouble::difference(f64::from(a), f64::from(b));
            let y = DoubleDouble::difference(f64::from(c), f64::from(d));
            let (rx, ry) = (exact(x), exact(y));
            prop_assert_eq!(&rx, &(BigRational::from_float(a).unwrap() - BigRational::from_float(b).unwrap()));
            let product = &rx * &ry;
            prop_assert!(within(x * y, &product, &magnitude(&product)));
            let sum = &rx + &ry;
            prop_assert!(within(x + y, &sum, &magnitude(&sum)));
            let difference = &rx - &ry;
            prop_assert!(within(x - y, &difference, &magnitude(&difference)));
        }
    }
}
