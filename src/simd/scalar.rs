//! Plain arrays, which a compiler can vectorise for whatever CPU it compiles for.

use super::floats::Pair;
use super::{LANES, Simd, SimdKernel};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Scalar;

#[inline(always)]
fn lanewise(mut a: [f32; LANES], b: [f32; LANES], op: impl Fn(f32, f32) -> f32) -> [f32; LANES] {
    for lane in 0..LANES {
        a[lane] = op(a[lane], b[lane]);
    }
    a
}

#[inline(always)]
fn mask(a: [f32; LANES], b: [f32; LANES], holds: impl Fn(f32, f32) -> bool) -> u32 {
    let mut bits = 0;
    for lane in 0..LANES {
        bits |= u32::from(holds(a[lane], b[lane])) << lane;
    }
    bits
}

impl Simd for Scalar {
    type F32x8 = [f32; LANES];
    type F64x3 = [f64; 3];

    #[inline(always)]
    fn vectorize<K: SimdKernel>(self, kernel: K) -> K::Output {
        // A frame as the others have, so that a query that does not take it does not pay for its stack.
        #[inline(never)]
        fn frame<K: SimdKernel>(simd: Scalar, kernel: K) -> K::Output {
            kernel.run(simd)
        }
        frame(self, kernel)
    }

    #[inline(always)]
    fn vectorize_batch<K: SimdKernel>(self, kernel: K) -> K::Output {
        #[inline(never)]
        fn frame<K: SimdKernel>(simd: Scalar, kernel: K) -> K::Output {
            kernel.run(simd)
        }
        frame(self, kernel)
    }

    #[inline(always)]
    fn vectorize_build<K: SimdKernel>(self, kernel: K) -> K::Output {
        kernel.run(self)
    }

    plain_doubles!();

    plain_orders!();

    pairs!();

    #[inline(always)]
    fn splat(self, value: f32) -> [f32; LANES] {
        [value; LANES]
    }

    #[inline(always)]
    fn load(self, values: &[f32; LANES]) -> [f32; LANES] {
        *values
    }

    #[inline(always)]
    fn transpose(self, fours: [&[f32; 4]; LANES]) -> [[f32; LANES]; 3] {
        let mut rows = [[0.0; LANES]; 3];
        for (lane, four) in fours.into_iter().enumerate() {
            (rows[0][lane], rows[1][lane], rows[2][lane]) = (four[0], four[1], four[2]);
        }
        rows
    }

    #[inline(always)]
    fn store(self, a: [f32; LANES]) -> [f32; LANES] {
        a
    }

    #[inline(always)]
    fn add(self, a: [f32; LANES], b: [f32; LANES]) -> [f32; LANES] {
        lanewise(a, b, |a, b| a + b)
    }

    #[inline(always)]
    fn sub(self, a: [f32; LANES], b: [f32; LANES]) -> [f32; LANES] {
        lanewise(a, b, |a, b| a - b)
    }

    #[inline(always)]
    fn mul(self, a: [f32; LANES], b: [f32; LANES]) -> [f32; LANES] {
        lanewise(a, b, |a, b| a * b)
    }

    #[inline(always)]
    fn div(self, a: [f32; LANES], b: [f32; LANES]) -> [f32; LANES] {
        lanewise(a, b, |a, b| a / b)
    }

    #[inline(always)]
    fn mul_add(self, a: [f32; LANES], b: [f32; LANES], c: [f32; LANES]) -> [f32; LANES] {
        self.add(self.mul(a, b), c)
    }

    #[inline(always)]
    fn mul_sub(self, a: [f32; LANES], b: [f32; LANES], c: [f32; LANES]) -> [f32; LANES] {
        self.sub(self.mul(a, b), c)
    }

    #[inline(always)]
    fn min(self, a: [f32; LANES], b: [f32; LANES]) -> [f32; LANES] {
        lanewise(a, b, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn max(self, a: [f32; LANES], b: [f32; LANES]) -> [f32; LANES] {
        lanewise(a, b, |a, b| if a > b { a } else { b })
    }

    #[inline(always)]
    fn less(self, a: [f32; LANES], b: [f32; LANES]) -> u32 {
        mask(a, b, |a, b| a < b)
    }

    #[inline(always)]
    fn less_or_equal(self, a: [f32; LANES], b: [f32; LANES]) -> u32 {
        mask(a, b, |a, b| a <= b)
    }

    #[inline(always)]
    fn and(self, a: [f32; LANES], b: [f32; LANES]) -> [f32; LANES] {
        lanewise(a, b, |a, b| f32::from_bits(a.to_bits() & b.to_bits()))
    }

    #[inline(always)]
    fn or(self, a: [f32; LANES], b: [f32; LANES]) -> [f32; LANES] {
        lanewise(a, b, |a, b| f32::from_bits(a.to_bits() | b.to_bits()))
    }
}
