//! Eight floats at a time on every instruction set. Knows nothing of rays.
//!
//! A zero-sized token stands for an instruction set; it can be had only where the CPU has the instructions, so
//! holding one is the proof. Code that is generic over [`Simd`] is inlined into one frame per instruction set
//! ([`Simd::vectorize`]), where the compiler may use the instructions: every function between the frame and the
//! operations must be `#[inline(always)]`, or registers travel through memory.
#![expect(unsafe_code, reason = "the door to std::arch: intrinsics are called here and nowhere else")]

/// [`Simd::vectorize`] and its like for a token that proves that the CPU has these features.
#[cfg(target_arch = "x86_64")]
macro_rules! frames {
    ($token:ty, $features:literal) => {
        #[inline(always)]
        fn vectorize<K: SimdKernel>(self, kernel: K) -> K::Output {
            #[target_feature(enable = $features)]
            #[inline(never)]
            fn frame<K: SimdKernel>(simd: $token, kernel: K) -> K::Output {
                kernel.run(simd)
            }
            // SAFETY: the token proves that the CPU has them.
            unsafe { frame(self, kernel) }
        }

        #[inline(always)]
        fn vectorize_batch<K: SimdKernel>(self, kernel: K) -> K::Output {
            #[target_feature(enable = $features)]
            #[inline(never)]
            fn frame<K: SimdKernel>(simd: $token, kernel: K) -> K::Output {
                kernel.run(simd)
            }
            // SAFETY: as above.
            unsafe { frame(self, kernel) }
        }

        #[inline(always)]
        fn vectorize_build<K: SimdKernel>(self, kernel: K) -> K::Output {
            #[target_feature(enable = $features)]
            #[inline(never)]
            fn frame<K: SimdKernel>(simd: $token, kernel: K) -> K::Output {
                kernel.run(simd)
            }
            // SAFETY: as above.
            unsafe { frame(self, kernel) }
        }
    };
}

/// Doubles on plain arrays.
macro_rules! plain_doubles {
    () => {
        #[inline(always)]
        fn splat3(self, value: f32) -> [f64; 3] {
            [f64::from(value); 3]
        }

        #[inline(always)]
        fn widen3(self, [x, y, z]: [f32; 3]) -> [f64; 3] {
            [f64::from(x), f64::from(y), f64::from(z)]
        }

        #[inline(always)]
        fn add3(self, a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
            [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
        }

        #[inline(always)]
        fn sub3(self, a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
            [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
        }

        #[inline(always)]
        fn mul3(self, a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
            [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
        }

        #[inline(always)]
        fn abs3(self, a: [f64; 3]) -> [f64; 3] {
            [a[0].abs(), a[1].abs(), a[2].abs()]
        }

        #[inline(always)]
        fn second_first(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
            [y, z, x]
        }

        #[inline(always)]
        fn third_first(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
            [z, x, y]
        }

        #[inline(always)]
        fn values3(self, a: [f64; 3]) -> [f64; 3] {
            a
        }

        #[inline(always)]
        fn beyond3(self, [x, y, z]: [f64; 3], bound: f64) -> bool {
            (x > bound) & (y > bound) & (z > bound) | (x < -bound) & (y < -bound) & (z < -bound)
        }
    };
}

/// Sixteen floats as two times eight, and steps on the instruction set itself.
macro_rules! pairs {
    () => {
        type Sixteen = Pair<Self>;
        type ForSteps = Self;

        #[inline(always)]
        fn sixteen(self) -> Pair<Self> {
            Pair(self)
        }

        #[inline(always)]
        fn for_steps(self) -> Self {
            self
        }
    };
}

/// Orders of lanes on plain arrays. No defaults of the trait's: an instruction set that has better ones could forget them.
macro_rules! plain_orders {
    () => {
        #[inline(always)]
        fn sort_descending(self, a: Self::F32x8) -> Self::F32x8 {
            let mut bits = self.store(a).map(|value| value.to_bits() as i32);
            for end in 1..LANES {
                for at in (0..end).rev() {
                    let (upper, lower) = (bits[at], bits[at + 1]);
                    (bits[at], bits[at + 1]) = (upper.max(lower), upper.min(lower));
                }
            }
            self.load(&bits.map(|bits| f32::from_bits(bits as u32)))
        }

        #[inline(always)]
        fn gather(self, values: &[u32; LANES], by: Self::F32x8) -> [u32; LANES] {
            self.store(by).map(|lane| values[lane.to_bits() as usize % LANES])
        }

        #[inline(always)]
        fn compress_lanes(self, a: Self::F32x8, mask: u32) -> Self::F32x8 {
            let values = self.store(a);
            self.load(&super::COMPRESSED[mask as usize & 0xFF].map(|lane| values[usize::from(lane) % LANES]))
        }

        #[inline(always)]
        fn order_two(self, a: Self::F32x8) -> Self::F32x8 {
            let mut values = self.store(a);
            if (values[0].to_bits() as i32) < values[1].to_bits() as i32 {
                values.swap(0, 1);
            }
            self.load(&values)
        }

        #[inline(always)]
        fn compress(self, values: &[u32; LANES], mask: u32) -> [u32; LANES] {
            super::COMPRESSED[mask as usize & 0xFF].map(|lane| values[usize::from(lane) % LANES])
        }

        #[inline(always)]
        fn transpose_eights(self, rows: [Self::F32x8; LANES]) -> [Self::F32x8; LANES] {
            let rows = rows.map(|row| self.store(row));
            std::array::from_fn(|column| self.load(&rows.map(|row| row[column])))
        }

        #[inline(always)]
        fn blend(self, a: Self::F32x8, b: Self::F32x8, mask: u32) -> Self::F32x8 {
            let (mut a, b) = (self.store(a), self.store(b));
            for lane in 0..LANES {
                a[lane] = if mask >> lane & 1 == 1 { b[lane] } else { a[lane] };
            }
            self.load(&a)
        }
    };
}

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod floats;
mod isa;
mod scalar;
#[cfg(target_arch = "x86_64")]
mod sse42;
#[cfg(test)]
mod tests;

#[cfg(target_arch = "x86_64")]
pub(crate) use avx2::Avx2;
#[cfg(target_arch = "x86_64")]
pub(crate) use avx512::Avx512;
pub(crate) use floats::{Eight, Floats, One, SIXTEEN, Sixteen};
pub(crate) use isa::DetectedIsa;
pub use isa::Isa;
pub(crate) use scalar::Scalar;
#[cfg(target_arch = "x86_64")]
pub(crate) use sse42::Sse42;

/// How many floats an operation works on.
pub(crate) const LANES: usize = 8;

/// Work that is generic over the instruction set.
pub(crate) trait SimdKernel {
    type Output;
    /// Must be `#[inline(always)]`.
    fn run<S: Simd>(self, simd: S) -> Self::Output;
}

/// Operations on eight floats, each rounded once like the scalar one. Masks have bit `i` for lane `i`.
pub(crate) trait Simd: Copy + Send + Sync {
    type F32x8: Copy;
    /// Of three values each, with the first one again in the fourth lane.
    type F64x3: Copy;

    /// Runs a query's kernel where the compiler may use the instruction set, in a frame of its own, whose machine code
    /// `tests/hot_loops.rs` looks at.
    fn vectorize<K: SimdKernel>(self, kernel: K) -> K::Output;
    /// As [`Simd::vectorize`] for many rays, where calls once in a while do not show.
    fn vectorize_batch<K: SimdKernel>(self, kernel: K) -> K::Output;
    /// As [`Simd::vectorize`] for what builds, which is not looked at.
    fn vectorize_build<K: SimdKernel>(self, kernel: K) -> K::Output;

    fn splat(self, value: f32) -> Self::F32x8;
    fn load(self, values: &[f32; LANES]) -> Self::F32x8;
    /// The first, second and third values of eight fours, in a register each.
    fn transpose(self, fours: [&[f32; 4]; LANES]) -> [Self::F32x8; 3];
    /// Eight rows become columns.
    fn transpose_eights(self, rows: [Self::F32x8; LANES]) -> [Self::F32x8; LANES];
    fn store(self, a: Self::F32x8) -> [f32; LANES];
    fn add(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    fn sub(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    fn mul(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    fn div(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// `a * b + c`, rounded once or twice: for bounds, where a rounding more or less does not show.
    fn mul_add(self, a: Self::F32x8, b: Self::F32x8, c: Self::F32x8) -> Self::F32x8;
    /// `a * b - c`, as [`Simd::mul_add`].
    fn mul_sub(self, a: Self::F32x8, b: Self::F32x8, c: Self::F32x8) -> Self::F32x8;
    /// The lesser; `b` where either is NaN or both are equal.
    fn min(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// The greater; `b` where either is NaN or both are equal.
    fn max(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// `a < b`; not where either is NaN.
    fn less(self, a: Self::F32x8, b: Self::F32x8) -> u32;
    /// `a <= b`; not where either is NaN.
    fn less_or_equal(self, a: Self::F32x8, b: Self::F32x8) -> u32;

    /// Of the bits.
    fn and(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;
    /// Of the bits.
    fn or(self, a: Self::F32x8, b: Self::F32x8) -> Self::F32x8;

    #[inline(always)]
    fn abs(self, a: Self::F32x8) -> Self::F32x8 {
        self.and(a, self.splat(f32::from_bits(i32::MAX as u32)))
    }

    /// One value in all lanes.
    fn splat3(self, value: f32) -> Self::F64x3;
    fn widen3(self, values: [f32; 3]) -> Self::F64x3;
    fn add3(self, a: Self::F64x3, b: Self::F64x3) -> Self::F64x3;
    fn sub3(self, a: Self::F64x3, b: Self::F64x3) -> Self::F64x3;
    fn mul3(self, a: Self::F64x3, b: Self::F64x3) -> Self::F64x3;
    fn abs3(self, a: Self::F64x3) -> Self::F64x3;
    /// The second value first, then the third and the first.
    fn second_first(self, a: Self::F64x3) -> Self::F64x3;
    /// The third value first, then the first and the second.
    fn third_first(self, a: Self::F64x3) -> Self::F64x3;
    fn values3(self, a: Self::F64x3) -> [f64; 3];
    /// Whether all are above `bound`, which is not negative, or all below its negative; not where one is NaN.
    fn beyond3(self, a: Self::F64x3, bound: f64) -> bool;

    /// Descending, the bits taken for signed integers: floats that are not negative in their order, negative ones
    /// after them in any.
    fn sort_descending(self, a: Self::F32x8) -> Self::F32x8;
    /// The value that the low three bits of each lane name.
    fn gather(self, values: &[u32; LANES], by: Self::F32x8) -> [u32; LANES];
    /// The lanes whose bit is set in the mask, in their order, then the last of them again.
    fn compress_lanes(self, a: Self::F32x8, mask: u32) -> Self::F32x8;
    /// The first two lanes in descending order, as by [`Simd::sort_descending`].
    fn order_two(self, a: Self::F32x8) -> Self::F32x8;
    /// The values whose bit is set in the mask, in their order; what follows them has no meaning.
    fn compress(self, values: &[u32; LANES], mask: u32) -> [u32; LANES];
    /// Of `b` the lanes whose bit is set in the mask, of `a` the others.
    fn blend(self, a: Self::F32x8, b: Self::F32x8, mask: u32) -> Self::F32x8;

    /// The same operations on sixteen floats.
    type Sixteen: Sixteen;
    fn sixteen(self) -> Self::Sixteen;

    /// The instruction set for frames of many short steps.
    type ForSteps: Simd;
    fn for_steps(self) -> Self::ForSteps;
}

/// For each mask the lanes whose bit is set, in their order, then the last of them again.
const COMPRESSED: [[u8; LANES]; 1 << LANES] = {
    let mut table = [[0; LANES]; 1 << LANES];
    let mut mask = 0;
    while mask < table.len() {
        let (mut lane, mut count) = (0, 0);
        while lane < LANES {
            if mask >> lane & 1 == 1 {
                table[mask][count] = lane as u8;
                count += 1;
            }
            lane += 1;
        }
        while 0 < count && count < LANES {
            table[mask][count] = table[mask][count - 1];
            count += 1;
        }
        mask += 1;
    }
    table
};

/// Asks for cache lines ahead of their use, from the one at an address on.
#[inline(always)]
pub(crate) fn prefetch_lines<const COUNT: usize>(address: *const u8) {
    #[cfg(target_arch = "x86_64")]
    for line in 0..COUNT {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: a prefetch has no effect that a program can see, wherever it points.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(address.cast::<i8>().wrapping_add(64 * line)) };
    }
}
