//! Floats at a time without saying how many: one, eight, or sixteen where many rays are tested against one triangle.

use super::{LANES, Simd};

/// How many floats [`Sixteen`] works on.
pub(crate) const SIXTEEN: usize = 16;

/// Operations on a number of floats, each as the one of [`Simd`] with its name. Masks have bit `i` for lane `i`.
pub(crate) trait Floats: Copy {
    type Vector: Copy;

    fn splat(self, value: f32) -> Self::Vector;
    fn add(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn sub(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn mul(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn div(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn mul_add(self, a: Self::Vector, b: Self::Vector, c: Self::Vector) -> Self::Vector;
    fn mul_sub(self, a: Self::Vector, b: Self::Vector, c: Self::Vector) -> Self::Vector;
    fn min(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn max(self, a: Self::Vector, b: Self::Vector) -> Self::Vector;
    fn abs(self, a: Self::Vector) -> Self::Vector;
    fn less(self, a: Self::Vector, b: Self::Vector) -> u32;
    fn less_or_equal(self, a: Self::Vector, b: Self::Vector) -> u32;
    fn blend(self, a: Self::Vector, b: Self::Vector, mask: u32) -> Self::Vector;
}

/// Sixteen of them.
pub(crate) trait Sixteen: Floats {
    fn load(self, values: &[f32; SIXTEEN]) -> Self::Vector;
    fn store(self, a: Self::Vector, values: &mut [f32; SIXTEEN]);
    fn greatest(self, a: Self::Vector) -> f32;
}

/// One float.
#[derive(Clone, Copy)]
pub(crate) struct One;

impl Floats for One {
    type Vector = f32;

    #[inline(always)]
    fn splat(self, value: f32) -> f32 {
        value
    }

    #[inline(always)]
    fn add(self, a: f32, b: f32) -> f32 {
        a + b
    }

    #[inline(always)]
    fn sub(self, a: f32, b: f32) -> f32 {
        a - b
    }

    #[inline(always)]
    fn mul(self, a: f32, b: f32) -> f32 {
        a * b
    }

    #[inline(always)]
    fn div(self, a: f32, b: f32) -> f32 {
        a / b
    }

    #[inline(always)]
    fn mul_add(self, a: f32, b: f32, c: f32) -> f32 {
        a * b + c
    }

    #[inline(always)]
    fn mul_sub(self, a: f32, b: f32, c: f32) -> f32 {
        a * b - c
    }

    #[inline(always)]
    fn min(self, a: f32, b: f32) -> f32 {
        if a < b { a } else { b }
    }

    #[inline(always)]
    fn max(self, a: f32, b: f32) -> f32 {
        if a > b { a } else { b }
    }

    #[inline(always)]
    fn abs(self, a: f32) -> f32 {
        a.abs()
    }

    #[inline(always)]
    fn less(self, a: f32, b: f32) -> u32 {
        u32::from(a < b)
    }

    #[inline(always)]
    fn less_or_equal(self, a: f32, b: f32) -> u32 {
        u32::from(a <= b)
    }

    #[inline(always)]
    fn blend(self, a: f32, b: f32, mask: u32) -> f32 {
        if mask & 1 == 1 { b } else { a }
    }
}

/// The eight of an instruction set.
#[derive(Clone, Copy)]
pub(crate) struct Eight<S>(pub(crate) S);

/// Sixteen as two times eight.
#[derive(Clone, Copy)]
pub(crate) struct Pair<S>(pub(crate) S);

macro_rules! as_eight {
    ($(fn $name:ident($($operand:ident),*);)*) => {$(
        #[inline(always)]
        fn $name(self, $($operand: S::F32x8),*) -> S::F32x8 {
            self.0.$name($($operand),*)
        }
    )*};
}

impl<S: Simd> Floats for Eight<S> {
    type Vector = S::F32x8;

    as_eight! {
        fn add(a, b);
        fn sub(a, b);
        fn mul(a, b);
        fn div(a, b);
        fn mul_add(a, b, c);
        fn mul_sub(a, b, c);
        fn min(a, b);
        fn max(a, b);
        fn abs(a);
    }

    #[inline(always)]
    fn splat(self, value: f32) -> S::F32x8 {
        self.0.splat(value)
    }

    #[inline(always)]
    fn less(self, a: S::F32x8, b: S::F32x8) -> u32 {
        self.0.less(a, b)
    }

    #[inline(always)]
    fn less_or_equal(self, a: S::F32x8, b: S::F32x8) -> u32 {
        self.0.less_or_equal(a, b)
    }

    #[inline(always)]
    fn blend(self, a: S::F32x8, b: S::F32x8, mask: u32) -> S::F32x8 {
        self.0.blend(a, b, mask)
    }
}

macro_rules! as_pair {
    ($(fn $name:ident($($operand:ident),*);)*) => {$(
        #[inline(always)]
        fn $name(self, $($operand: [S::F32x8; 2]),*) -> [S::F32x8; 2] {
            [self.0.$name($($operand[0]),*), self.0.$name($($operand[1]),*)]
        }
    )*};
}

impl<S: Simd> Floats for Pair<S> {
    type Vector = [S::F32x8; 2];

    as_pair! {
        fn add(a, b);
        fn sub(a, b);
        fn mul(a, b);
        fn div(a, b);
        fn mul_add(a, b, c);
        fn mul_sub(a, b, c);
        fn min(a, b);
        fn max(a, b);
        fn abs(a);
    }

    #[inline(always)]
    fn splat(self, value: f32) -> [S::F32x8; 2] {
        [self.0.splat(value); 2]
    }

    #[inline(always)]
    fn less(self, a: [S::F32x8; 2], b: [S::F32x8; 2]) -> u32 {
        self.0.less(a[0], b[0]) | self.0.less(a[1], b[1]) << LANES
    }

    #[inline(always)]
    fn less_or_equal(self, a: [S::F32x8; 2], b: [S::F32x8; 2]) -> u32 {
        self.0.less_or_equal(a[0], b[0]) | self.0.less_or_equal(a[1], b[1]) << LANES
    }

    #[inline(always)]
    fn blend(self, a: [S::F32x8; 2], b: [S::F32x8; 2], mask: u32) -> [S::F32x8; 2] {
        [self.0.blend(a[0], b[0], mask), self.0.blend(a[1], b[1], mask >> LANES)]
    }
}

impl<S: Simd> Sixteen for Pair<S> {
    #[inline(always)]
    fn load(self, values: &[f32; SIXTEEN]) -> [S::F32x8; 2] {
        let (halves, _) = values.as_chunks::<LANES>();
        [self.0.load(&halves[0]), self.0.load(&halves[1])]
    }

    #[inline(always)]
    fn store(self, [a, b]: [S::F32x8; 2], values: &mut [f32; SIXTEEN]) {
        let (halves, _) = values.as_chunks_mut::<LANES>();
        halves[0] = self.0.store(a);
        halves[1] = self.0.store(b);
    }

    #[inline(always)]
    fn greatest(self, [a, b]: [S::F32x8; 2]) -> f32 {
        self.0.store(self.0.max(a, b)).into_iter().reduce(|a, b| if a > b { a } else { b }).expect("eight")
    }
}
