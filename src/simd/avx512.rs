//! AVX-512 on 256-bit vectors: AVX2, but comparisons give masks, and there are twice as many registers.

use std::arch::x86_64::*;

use super::{Avx2, LANES, Simd, SimdKernel};

/// Proof that the CPU has AVX-512 F, VL, DQ and BW, and AVX2 and FMA as well.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx512(Avx2);

impl Avx512 {
    pub(crate) fn detect() -> Option<Self> {
        let avx2 = Avx2::detect()?;
        let is_there = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512bw");
        is_there.then_some(Self(avx2))
    }
}

/// The operations that are those of AVX2.
macro_rules! as_avx2 {
    ($(fn $name:ident($($operand:ident: $type:ty),*) -> $result:ty;)*) => {$(
        #[inline(always)]
        fn $name(self, $($operand: $type),*) -> $result {
            self.0.$name($($operand),*)
        }
    )*};
}

impl Simd for Avx512 {
    type F32x8 = __m256;
    type F64x3 = __m256d;

    frames!(Avx512, "avx2,fma,bmi1,bmi2,lzcnt,popcnt,avx512f,avx512vl,avx512dq,avx512bw");

    as_avx2! {
        fn splat(value: f32) -> __m256;
        fn load(values: &[f32; LANES]) -> __m256;
        fn transpose(fours: [&[f32; 4]; LANES]) -> [__m256; 3];
        fn store(a: __m256) -> [f32; LANES];
        fn add(a: __m256, b: __m256) -> __m256;
        fn sub(a: __m256, b: __m256) -> __m256;
        fn mul(a: __m256, b: __m256) -> __m256;
        fn div(a: __m256, b: __m256) -> __m256;
        fn and(a: __m256, b: __m256) -> __m256;
        fn or(a: __m256, b: __m256) -> __m256;
        fn mul_add(a: __m256, b: __m256, c: __m256) -> __m256;
        fn mul_sub(a: __m256, b: __m256, c: __m256) -> __m256;
        fn min(a: __m256, b: __m256) -> __m256;
        fn max(a: __m256, b: __m256) -> __m256;
        fn splat3(value: f32) -> __m256d;
        fn widen3(values: [f32; 3]) -> __m256d;
        fn add3(a: __m256d, b: __m256d) -> __m256d;
        fn sub3(a: __m256d, b: __m256d) -> __m256d;
        fn mul3(a: __m256d, b: __m256d) -> __m256d;
        fn abs3(a: __m256d) -> __m256d;
        fn second_first(a: __m256d) -> __m256d;
        fn third_first(a: __m256d) -> __m256d;
        fn values3(a: __m256d) -> [f64; 3];
        fn beyond3(a: __m256d, bound: f64) -> bool;
        fn sort_descending(a: __m256) -> __m256;
        fn compress_lanes(a: __m256, mask: u32) -> __m256;
        fn order_two(a: __m256) -> __m256;
        fn gather(values: &[u32; LANES], by: __m256) -> [u32; LANES];
        fn compress(values: &[u32; LANES], mask: u32) -> [u32; LANES];
    }

    #[inline(always)]
    fn less(self, a: __m256, b: __m256) -> u32 {
        // SAFETY: the token proves that the CPU has AVX-512 F and VL.
        u32::from(unsafe { _mm256_cmp_ps_mask::<_CMP_LT_OQ>(a, b) })
    }

    #[inline(always)]
    fn less_or_equal(self, a: __m256, b: __m256) -> u32 {
        // SAFETY: the token proves that the CPU has AVX-512 F and VL.
        u32::from(unsafe { _mm256_cmp_ps_mask::<_CMP_LE_OQ>(a, b) })
    }
}
