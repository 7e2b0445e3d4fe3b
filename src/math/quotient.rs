//! The float nearest to an exact quotient.

use std::cmp::Ordering;

use super::Expansion;

/// The `f32` nearest to `numerator / denominator`, of two as near the even one; of a quotient beyond all of them an infinity, and
/// of what rounds to zero the positive one. The denominator is not zero.
pub(crate) fn nearest_quotient(numerator: &Expansion, denominator: &Expansion) -> f32 {
    let quotient = numerator.to_f64() / denominator.to_f64();
    // Expansions are off by an ulp each, and the division rounds once; so is the candidate by one place at the most.
    let candidate = nearest(quotient);
    let below = half_way(place(candidate) - 1);
    let above = half_way(place(candidate));
    let error = quotient.abs() * (4.0 * f64::EPSILON);
    if below + error < quotient && quotient < above - error {
        return at(place(candidate));
    }
    let compare = |boundary: f64| {
        let difference = numerator.clone() - denominator * &Expansion::from(boundary);
        if denominator.sign() == Ordering::Less { difference.sign().reverse() } else { difference.sign() }
    };
    let is_odd = place(candidate) % 2 != 0;
    match (compare(below), compare(above)) {
        (Ordering::Less, _) => at(place(candidate) - 1),
        (Ordering::Equal, _) if is_odd => at(place(candidate) - 1),
        (_, Ordering::Greater) => at(place(candidate) + 1),
        (_, Ordering::Equal) if is_odd => at(place(candidate) + 1),
        _ => at(place(candidate)),
    }
}

/// Whether all within `error` of `value` round to the same float, which is not zero. False for NaN.
#[inline(always)]
pub(crate) fn rounds_alike(value: f64, error: f64) -> bool {
    let (low, high) = ((value - error) as f32, (value + error) as f32);
    (low == high) & (low != 0.0)
}

/// The order of floats as numbers; both zeros are 0, the infinities the last ones.
fn place(value: f32) -> i32 {
    let magnitude = (value.to_bits() & 0x7FFF_FFFF) as i32;
    if value.is_sign_negative() { -magnitude } else { magnitude }
}

fn at(place: i32) -> f32 {
    let magnitude = f32::from_bits(place.unsigned_abs().min(f32::INFINITY.to_bits()));
    if place < 0 { -magnitude } else { magnitude }
}

/// The number at a place; where an infinity is, the power of two after the last number.
fn number(place: i32) -> f64 {
    let magnitude = f32::from_bits(place.unsigned_abs());
    let magnitude = if magnitude.is_finite() { super::float::widen(magnitude) } else { (1u128 << 127) as f64 * 2.0 };
    if place < 0 { -magnitude } else { magnitude }
}

/// Between a place and the next one; beyond the last place infinite.
fn half_way(place: i32) -> f64 {
    let last = f32::INFINITY.to_bits() as i32;
    if place >= last {
        f64::INFINITY
    } else if place < -last {
        f64::NEG_INFINITY
    } else {
        0.5 * (number(place) + number(place + 1))
    }
}

/// As a conversion rounds, also where the host flushes denormals to zero.
fn nearest(value: f64) -> f32 {
    const PER_LEAST: f64 = (1u128 << 127) as f64 * (1u32 << 22) as f64;
    if value.abs() >= f64::from(f32::MIN_POSITIVE) {
        return value as f32;
    }
    at((value * PER_LEAST).round_ties_even() as i32)
}

#[cfg(test)]
mod tests {
    use num_bigint::BigInt;
    use num_rational::BigRational;
    use proptest::prelude::*;

    use super::*;

    fn any_float() -> impl Strategy<Value = f32> {
        any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |value| value.is_finite())
    }

    fn rational(place: i32) -> BigRational {
        BigRational::from_float(number(place)).expect("finite")
    }

    /// By bisection among all floats, in rationals.
    fn exact(truth: &BigRational) -> f32 {
        let last = f32::INFINITY.to_bits() as i32;
        let (mut low, mut high) = (-last, last);
        while low + 1 < high {
            let middle = low.midpoint(high);
            if rational(middle) <= *truth { low = middle } else { high = middle }
        }
        let double = |value: &BigRational| value * BigRational::from_integer(BigInt::from(2));
        match double(truth).cmp(&(rational(low) + rational(high))) {
            Ordering::Less => at(low),
            Ordering::Greater => at(high),
            Ordering::Equal => at(if low % 2 == 0 { low } else { high }),
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(500))]

        #[test]
        fn the_nearest_float_is_found(a in any_float(), b in any_float(), c in any_float(), d in any_float()) {
            let (numerator, denominator) = (Expansion::difference(a, b), Expansion::difference(c, d));
            prop_assume!(denominator.sign() != Ordering::Equal);
            let difference = |a, b| BigRational::from_float(a).unwrap() - BigRational::from_float(b).unwrap();
            let truth = difference(a, b) / difference(c, d);
            prop_assert_eq!(nearest_quotient(&numerator, &denominator), exact(&truth));
        }

        #[test]
        fn half_way_between_floats_the_even_one_is_taken(bits in 0u32..0x7F80_0000, factor in any_float()) {
            prop_assume!(factor != 0.0);
            let place = bits as i32;
            let denominator = Expansion::difference(factor, 0.0);
            let half_way = Expansion::from(half_way(place));
            let even = at(place + place % 2);
            prop_assert_eq!(nearest_quotient(&(&half_way * &denominator), &denominator), even);
            // The least that there is more or less of it.
            let crumb = Expansion::difference(factor.signum() * f32::from_bits(1), 0.0);
            let crumb = &crumb * &Expansion::difference(f32::from_bits(1), 0.0);
            let above = &half_way * &denominator + crumb.clone();
            prop_assert_eq!(nearest_quotient(&above, &denominator), at(place + 1));
            let below = &half_way * &denominator - crumb;
            prop_assert_eq!(nearest_quotient(&below, &denominator), at(place));
        }
    }
}
