//! SSE4.2: two registers of four floats.

use std::arch::x86_64::*;

use super::floats::Pair;
use super::{LANES, Simd, SimdKernel};

/// Proof that the CPU has SSE4.2.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sse42(());

impl Sse42 {
    pub(crate) fn detect() -> Option<Self> {
        is_x86_feature_detected!("sse4.2").then_some(Self(()))
    }
}

#[inline(always)]
fn halves(a: [__m128; 2], b: [__m128; 2], op: impl Fn(__m128, __m128) -> __m128) -> [__m128; 2] {
    [op(a[0], b[0]), op(a[1], b[1])]
}

#[inline(always)]
fn mask(bits: [__m128; 2]) -> u32 {
    // SAFETY: SSE is part of x86-64.
    let [low, high] = bits.map(|half| unsafe { _mm_movemask_ps(half) } as u32);
    low | (high << 4)
}

impl Simd for Sse42 {
    type F32x8 = [__m128; 2];
    type F64x3 = [f64; 3];

    frames!(Sse42, "sse4.2");

    plain_doubles!();

    plain_orders!();

    pairs!();

    #[inline(always)]
    fn splat(self, value: f32) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        [unsafe { _mm_set1_ps(value) }; 2]
    }

    #[inline(always)]
    fn load(self, values: &[f32; LANES]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64, and eight floats are there; no alignment is asked for.
        unsafe { [_mm_loadu_ps(values.as_ptr()), _mm_loadu_ps(values.as_ptr().add(4))] }
    }

    #[inline(always)]
    fn transpose(self, [a, b, c, d, e, f, g, h]: [&[f32; 4]; LANES]) -> [[__m128; 2]; 3] {
        /// The same of four of them.
        macro_rules! half {
            ($a:expr, $b:expr, $c:expr, $d:expr) => {{
                let (a, b) = (_mm_loadu_ps($a.as_ptr()), _mm_loadu_ps($b.as_ptr()));
                let (c, d) = (_mm_loadu_ps($c.as_ptr()), _mm_loadu_ps($d.as_ptr()));
                let (low, high) = (_mm_unpacklo_ps(a, b), _mm_unpacklo_ps(c, d));
                let third = _mm_movelh_ps(_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d));
                [_mm_movelh_ps(low, high), _mm_movehl_ps(high, low), third]
            }};
        }
        // SAFETY: SSE is part of x86-64, and each pointer has four floats; no alignment is asked for.
        let ([x, y, z], [u, v, w]) = unsafe { (half!(a, b, c, d), half!(e, f, g, h)) };
        [[x, u], [y, v], [z, w]]
    }

    #[inline(always)]
    fn store(self, a: [__m128; 2]) -> [f32; LANES] {
        let mut values = [0.0; LANES];
        // SAFETY: SSE is part of x86-64, and there is room for eight floats.
        unsafe {
            _mm_storeu_ps(values.as_mut_ptr(), a[0]);
            _mm_storeu_ps(values.as_mut_ptr().add(4), a[1]);
        }
        values
    }

    #[inline(always)]
    fn div(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        halves(a, b, |a, b| unsafe { _mm_div_ps(a, b) })
    }

    #[inline(always)]
    fn mul_add(self, a: [__m128; 2], b: [__m128; 2], c: [__m128; 2]) -> [__m128; 2] {
        self.add(self.mul(a, b), c)
    }

    #[inline(always)]
    fn mul_sub(self, a: [__m128; 2], b: [__m128; 2], c: [__m128; 2]) -> [__m128; 2] {
        self.sub(self.mul(a, b), c)
    }

    #[inline(always)]
    fn less(self, a: [__m128; 2], b: [__m128; 2]) -> u32 {
        // SAFETY: SSE is part of x86-64.
        mask(halves(a, b, |a, b| unsafe { _mm_cmplt_ps(a, b) }))
    }

    #[inline(always)]
    fn less_or_equal(self, a: [__m128; 2], b: [__m128; 2]) -> u32 {
        // SAFETY: SSE is part of x86-64.
        mask(halves(a, b, |a, b| unsafe { _mm_cmple_ps(a, b) }))
    }

    #[inline(always)]
    fn add(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        halves(a, b, |a, b| unsafe { _mm_add_ps(a, b) })
    }

    #[inline(always)]
    fn sub(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        halves(a, b, |a, b| unsafe { _mm_sub_ps(a, b) })
    }

    #[inline(always)]
    fn mul(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        halves(a, b, |a, b| unsafe { _mm_mul_ps(a, b) })
    }

    #[inline(always)]
    fn min(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        halves(a, b, |a, b| unsafe { _mm_min_ps(a, b) })
    }

    #[inline(always)]
    fn max(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        halves(a, b, |a, b| unsafe { _mm_max_ps(a, b) })
    }

    #[inline(always)]
    fn and(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        halves(a, b, |a, b| unsafe { _mm_and_ps(a, b) })
    }

    #[inline(always)]
    fn or(self, a: [__m128; 2], b: [__m128; 2]) -> [__m128; 2] {
        // SAFETY: SSE is part of x86-64.
        halves(a, b, |a, b| unsafe { _mm_or_ps(a, b) })
    }
}
