//! Exact numbers as sums of `f64` that do not overlap.
//!
//! Source: Shewchuk 1997, "Adaptive precision floating-point arithmetic and fast robust geometric predicates",
//! section 2: GROW-EXPANSION with zero elimination, and products as sums of scaled expansions.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

use super::error_free::{two_product, two_sum};
use super::float::widen;

/// The components do not overlap, none is zero, and each is larger than those before it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Expansion {
    components: Vec<f64>,
}

impl Expansion {
    /// The exact difference.
    pub(crate) fn difference(a: f32, b: f32) -> Self {
        let mut difference = Self::default();
        difference.grow(widen(a));
        difference.grow(-widen(b));
        difference
    }

    fn grow(&mut self, addend: f64) {
        let mut carried = addend;
        let mut kept = 0;
        for index in 0..self.components.len() {
            let (sum, error) = two_sum(carried, self.components[index]);
            carried = sum;
            if error != 0.0 {
                self.components[kept] = error;
                kept += 1;
            }
        }
        self.components.truncate(kept);
        if carried != 0.0 {
            self.components.push(carried);
        }
    }

    /// Below, at or above zero.
    pub(crate) fn sign(&self) -> Ordering {
        self.components.last().map_or(Ordering::Equal, |largest| largest.total_cmp(&0.0))
    }

    /// Within an ulp, with the right sign; 0 for 0 alone.
    pub(crate) fn to_f64(&self) -> f64 {
        self.components.iter().sum()
    }
}

impl From<f64> for Expansion {
    fn from(value: f64) -> Self {
        let mut expansion = Self::default();
        expansion.grow(value);
        expansion
    }
}

impl Add for Expansion {
    type Output = Self;

    fn add(mut self, other: Self) -> Self {
        other.components.iter().for_each(|&component| self.grow(component));
        self
    }
}

impl Sub for Expansion {
    type Output = Self;

    fn sub(mut self, other: Self) -> Self {
        other.components.iter().for_each(|&component| self.grow(-component));
        self
    }
}

impl Mul for &Expansion {
    type Output = Expansion;

    fn mul(self, other: Self) -> Expansion {
        let mut product = Expansion::default();
        for &a in &self.components {
            for &b in &other.components {
                let (high, low) = two_product(a, b);
                product.grow(low);
                product.grow(high);
            }
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::*;

    fn exact(expansion: &Expansion) -> BigRational {
        let zero = BigRational::from_integer(BigInt::from(0));
        expansion.components.iter().fold(zero, |sum, &component| sum + BigRational::from_float(component).unwrap())
    }

    /// Any finite float, denormal and huge ones as often as others.
    fn any_float() -> impl Strategy<Value = f32> {
        any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |value| value.is_finite())
    }

    proptest! {
        #[test]
        fn arithmetic_is_exact(a in any_float(), b in any_float(), c in any_float(), d in any_float(), e in any_float()) {
            let rational = |value: f32| BigRational::from_float(value).unwrap();
            let (x, y, z) = (Expansion::difference(a, b), Expansion::difference(c, d), Expansion::difference(e, a));
            let (rx, ry, rz) = (rational(a) - rational(b), rational(c) - rational(d), rational(e) - rational(a));
            let product = &(&x * &y) * &z;
            prop_assert_eq!(exact(&product), &rx * &ry * &rz);
            prop_assert_eq!(exact(&(x.clone() + y.clone())), &rx + &ry);
            let difference = &x * &y - &y * &z;
            let truth = &rx * &ry - &ry * &rz;
            prop_assert_eq!(exact(&difference), truth.clone());
            let zero = BigRational::from_integer(BigInt::from(0));
            prop_assert_eq!(difference.to_f64() > 0.0, truth > zero);
            prop_assert_eq!(difference.to_f64() < 0.0, truth < zero);
        }
    }
}
