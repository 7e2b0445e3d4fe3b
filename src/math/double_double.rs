//! Numbers of 106 bits as unevaluated sums of two `f64`.
//!
//! Source: Joldes, Muller, Popescu, "Tight and rigorous error bounds for basic building blocks of double-word
//! arithmetic", ACM TOMS 44(2), 2017: algorithms 6 (addition, relative error 3u^2 + 13u^3 with u = 2^-53) and
//! 11 (multiplication, 5u^2).

use std::ops::{Add, Mul, Sub};

use super::error_free::{fast_two_sum, two_product, two_sum};

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
        two_sum(a, -b).into()
    }

    /// The nearest `f64`.
    pub(crate) fn to_f64(self) -> f64 {
        self.high
    }
}

impl From<(f64, f64)> for DoubleDouble {
    fn from((high, low): (f64, f64)) -> Self {
        Self { high, low }
    }
}

impl From<f64> for DoubleDouble {
    fn from(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, high_error) = two_sum(self.high, other.high);
        let (low, low_error) = two_sum(self.low, other.low);
        let (high, error) = fast_two_sum(high, high_error + low);
        fast_two_sum(high, low_error + error).into()
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
        let (product, error) = two_product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        fast_two_sum(product, error + cross).into()
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
