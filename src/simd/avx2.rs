//! AVX2 with FMA: one register of eight floats.

use std::arch::x86_64::*;

use super::floats::Pair;
use super::{LANES, Simd, SimdKernel};

/// Proof that the CPU has AVX2 and FMA, and the operations on bits that came with them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Avx2(());

impl Avx2 {
    pub(crate) fn detect() -> Option<Self> {
        let is_there = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt");
        is_there.then_some(Self(()))
    }
}

impl Simd for Avx2 {
    type F32x8 = __m256;
    type F64x3 = __m256d;

    frames!(Avx2, "avx2,fma,bmi1,bmi2,lzcnt,popcnt");

    #[inline(always)]
    fn splat(self, value: f32) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_set1_ps(value) }
    }

    #[inline(always)]
    fn load(self, values: &[f32; LANES]) -> __m256 {
        // SAFETY: as above, and eight floats are there; no alignment is asked for.
        unsafe { _mm256_loadu_ps(values.as_ptr()) }
    }

    #[inline(always)]
    fn transpose(self, [a, b, c, d, e, f, g, h]: [&[f32; 4]; LANES]) -> [__m256; 3] {
        // SAFETY: as above, and each pointer has four floats; no alignment is asked for.
        unsafe {
            let ae = _mm256_loadu2_m128(e.as_ptr(), a.as_ptr());
            let bf = _mm256_loadu2_m128(f.as_ptr(), b.as_ptr());
            let cg = _mm256_loadu2_m128(g.as_ptr(), c.as_ptr());
            let dh = _mm256_loadu2_m128(h.as_ptr(), d.as_ptr());
            let (low, high) = (_mm256_unpacklo_ps(ae, bf), _mm256_unpacklo_ps(cg, dh));
            let (third_low, third_high) = (_mm256_unpackhi_ps(ae, bf), _mm256_unpackhi_ps(cg, dh));
            [
                _mm256_shuffle_ps::<0b01_00_01_00>(low, high),
                _mm256_shuffle_ps::<0b11_10_11_10>(low, high),
                _mm256_shuffle_ps::<0b01_00_01_00>(third_low, third_high),
            ]
        }
    }

    #[inline(always)]
    fn store(self, a: __m256) -> [f32; LANES] {
        let mut values = [0.0; LANES];
        // SAFETY: as above, and there is room for eight floats.
        unsafe { _mm256_storeu_ps(values.as_mut_ptr(), a) };
        values
    }

    #[inline(always)]
    fn div(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_div_ps(a, b) }
    }

    #[inline(always)]
    fn mul_add(self, a: __m256, b: __m256, c: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has FMA.
        unsafe { _mm256_fmadd_ps(a, b, c) }
    }

    #[inline(always)]
    fn mul_sub(self, a: __m256, b: __m256, c: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has FMA.
        unsafe { _mm256_fmsub_ps(a, b, c) }
    }

    #[inline(always)]
    fn less(self, a: __m256, b: __m256) -> u32 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b)) as u32 }
    }

    #[inline(always)]
    fn less_or_equal(self, a: __m256, b: __m256) -> u32 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b)) as u32 }
    }

    #[inline(always)]
    fn add(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_add_ps(a, b) }
    }

    #[inline(always)]
    fn sub(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_sub_ps(a, b) }
    }

    #[inline(always)]
    fn mul(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_mul_ps(a, b) }
    }

    #[inline(always)]
    fn min(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_min_ps(a, b) }
    }

    #[inline(always)]
    fn max(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_max_ps(a, b) }
    }

    #[inline(always)]
    fn and(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_and_ps(a, b) }
    }

    #[inline(always)]
    fn or(self, a: __m256, b: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_or_ps(a, b) }
    }

    #[inline(always)]
    fn splat3(self, value: f32) -> __m256d {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_cvtps_pd(_mm_set1_ps(value)) }
    }

    #[inline(always)]
    fn widen3(self, [x, y, z]: [f32; 3]) -> __m256d {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_cvtps_pd(_mm_setr_ps(x, y, z, x)) }
    }

    #[inline(always)]
    fn add3(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_add_pd(a, b) }
    }

    #[inline(always)]
    fn sub3(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_sub_pd(a, b) }
    }

    #[inline(always)]
    fn mul3(self, a: __m256d, b: __m256d) -> __m256d {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_mul_pd(a, b) }
    }

    #[inline(always)]
    fn abs3(self, a: __m256d) -> __m256d {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe { _mm256_andnot_pd(_mm256_set1_pd(-0.0), a) }
    }

    #[inline(always)]
    fn second_first(self, a: __m256d) -> __m256d {
        // SAFETY: the token proves that the CPU has AVX2.
        unsafe { _mm256_permute4x64_pd::<0b01_00_10_01>(a) }
    }

    #[inline(always)]
    fn third_first(self, a: __m256d) -> __m256d {
        // SAFETY: the token proves that the CPU has AVX2.
        unsafe { _mm256_permute4x64_pd::<0b10_01_00_10>(a) }
    }

    #[inline(always)]
    fn values3(self, a: __m256d) -> [f64; 3] {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe {
            let low = _mm256_castpd256_pd128(a);
            let high = _mm256_extractf128_pd::<1>(a);
            [_mm_cvtsd_f64(low), _mm_cvtsd_f64(_mm_unpackhi_pd(low, low)), _mm_cvtsd_f64(high)]
        }
    }

    #[inline(always)]
    fn beyond3(self, a: __m256d, bound: f64) -> bool {
        // SAFETY: the token proves that the CPU has AVX.
        let (is_beyond, is_negative) = unsafe {
            let is_beyond = _mm256_cmp_pd::<_CMP_GT_OQ>(self.abs3(a), _mm256_set1_pd(bound));
            (_mm256_movemask_pd(is_beyond), _mm256_movemask_pd(a))
        };
        // No bit of the sum is left where all signs are equal.
        (is_beyond ^ 0xF) | ((is_negative + 1) & 0xE) == 0
    }

    /// Each half by the optimal network for four, one of them ascending, then a bitonic merge, so that lanes change
    /// halves once.
    #[inline(always)]
    fn sort_descending(self, a: __m256) -> __m256 {
        /// Compares neighbours at the distance of a shuffle; a bit says that its lane keeps the greater.
        macro_rules! exchange {
            ($a:expr, $partner:expr, $greater:literal) => {{
                let (a, partner) = ($a, $partner);
                _mm256_blend_epi32::<$greater>(_mm256_min_epi32(a, partner), _mm256_max_epi32(a, partner))
            }};
        }
        // SAFETY: the token proves that the CPU has AVX2.
        unsafe {
            let a = _mm256_castps_si256(a);
            let a = exchange!(a, _mm256_shuffle_epi32::<0b01_00_11_10>(a), 0b1100_0011);
            let a = exchange!(a, _mm256_shuffle_epi32::<0b10_11_00_01>(a), 0b1010_0101);
            let a = exchange!(a, _mm256_shuffle_epi32::<0b11_01_10_00>(a), 0b0100_0010);
            let a = exchange!(a, _mm256_permute2x128_si256::<0x01>(a, a), 0b0000_1111);
            let a = exchange!(a, _mm256_shuffle_epi32::<0b01_00_11_10>(a), 0b0011_0011);
            let a = exchange!(a, _mm256_shuffle_epi32::<0b10_11_00_01>(a), 0b0101_0101);
            _mm256_castsi256_ps(a)
        }
    }

    #[inline(always)]
    fn compress_lanes(self, a: __m256, mask: u32) -> __m256 {
        let lanes = &super::COMPRESSED[mask as usize & 0xFF];
        // SAFETY: the token proves that the CPU has AVX2; the table has eight bytes a mask.
        unsafe { _mm256_permutevar8x32_ps(a, _mm256_cvtepu8_epi32(_mm_loadl_epi64(lanes.as_ptr().cast()))) }
    }

    #[inline(always)]
    fn order_two(self, a: __m256) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX2.
        unsafe {
            let a = _mm256_castps_si256(a);
            let swapped = _mm256_shuffle_epi32::<0b11_10_00_01>(a);
            let (least, greatest) = (_mm256_min_epi32(a, swapped), _mm256_max_epi32(a, swapped));
            _mm256_castsi256_ps(_mm256_blend_epi32::<0b0000_0001>(least, greatest))
        }
    }

    #[inline(always)]
    fn gather(self, values: &[u32; LANES], by: __m256) -> [u32; LANES] {
        let mut gathered = [0; LANES];
        // SAFETY: the token proves that the CPU has AVX2; eight values are there, and room for eight.
        unsafe {
            let values = _mm256_loadu_si256(values.as_ptr().cast());
            let lanes = _mm256_permutevar8x32_epi32(values, _mm256_castps_si256(by));
            _mm256_storeu_si256(gathered.as_mut_ptr().cast(), lanes);
        }
        gathered
    }

    #[inline(always)]
    fn compress(self, values: &[u32; LANES], mask: u32) -> [u32; LANES] {
        let lanes = &super::COMPRESSED[mask as usize & 0xFF];
        // SAFETY: the token proves that the CPU has AVX2; the table has eight bytes a mask.
        let by = unsafe { _mm256_cvtepu8_epi32(_mm_loadl_epi64(lanes.as_ptr().cast())) };
        // SAFETY: the token proves that the CPU has AVX.
        self.gather(values, unsafe { _mm256_castsi256_ps(by) })
    }

    #[inline(always)]
    fn transpose_eights(self, [a, b, c, d, e, f, g, h]: [__m256; LANES]) -> [__m256; LANES] {
        // SAFETY: the token proves that the CPU has AVX.
        unsafe {
            // Halves of two rows each, then of four, then of eight.
            let (ab, cd) = (_mm256_unpacklo_ps(a, b), _mm256_unpacklo_ps(c, d));
            let (ab_high, cd_high) = (_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d));
            let (ef, gh) = (_mm256_unpacklo_ps(e, f), _mm256_unpacklo_ps(g, h));
            let (ef_high, gh_high) = (_mm256_unpackhi_ps(e, f), _mm256_unpackhi_ps(g, h));
            let upper = [
                _mm256_shuffle_ps::<0b01_00_01_00>(ab, cd),
                _mm256_shuffle_ps::<0b11_10_11_10>(ab, cd),
                _mm256_shuffle_ps::<0b01_00_01_00>(ab_high, cd_high),
                _mm256_shuffle_ps::<0b11_10_11_10>(ab_high, cd_high),
            ];
            let lower = [
                _mm256_shuffle_ps::<0b01_00_01_00>(ef, gh),
                _mm256_shuffle_ps::<0b11_10_11_10>(ef, gh),
                _mm256_shuffle_ps::<0b01_00_01_00>(ef_high, gh_high),
                _mm256_shuffle_ps::<0b11_10_11_10>(ef_high, gh_high),
            ];
            let first = |at: usize| _mm256_permute2f128_ps::<0x20>(upper[at], lower[at]);
            let second = |at: usize| _mm256_permute2f128_ps::<0x31>(upper[at], lower[at]);
            [first(0), first(1), first(2), first(3), second(0), second(1), second(2), second(3)]
        }
    }

    #[inline(always)]
    fn blend(self, a: __m256, b: __m256, mask: u32) -> __m256 {
        // SAFETY: the token proves that the CPU has AVX2.
        unsafe {
            let bits = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
            let set = _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(mask as i32), bits), bits);
            _mm256_blendv_ps(a, b, _mm256_castsi256_ps(set))
        }
    }

    pairs!();
}
