//! Sums and products of two `f64` with their rounding errors, both exact. No CPU needs a fused multiply-add for them.

/// The rounded sum and its error (Knuth's TwoSum: no condition on the magnitudes).
pub(super) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    let a_part = sum - b_part;
    (sum, (a - a_part) + (b - b_part))
}

/// The same where `|a| >= |b|` (Dekker's Fast2Sum).
pub(super) fn fast_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// The rounded product and its error (Dekker 1971). Exact as long as nothing overflows 2^996 or falls below 2^-1022:
/// the factors here are products of a few `f32`.
pub(super) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let (a_high, a_low) = split(a);
    let (b_high, b_low) = split(b);
    (product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low)
}

/// Veltkamp's split of a number into two of at most 26 bits.
fn split(a: f64) -> (f64, f64) {
    const FACTOR: f64 = 134_217_729.0; // 2^27 + 1
    let scaled = FACTOR * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}
