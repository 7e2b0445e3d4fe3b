//! What all leaves hold, in a form that kernels and builder are generic over; and the ordinary form of triangles, each leaf
//! by coordinate: what one load brings is one coordinate of all its triangles.

use std::marker::PhantomData;

use super::Vectorized;
use super::batch::Batch;
use super::leaf_test::{LeafTest, TriangleTest};
use super::node::Child;
use crate::accel::build_context::slices;
use crate::accel::reference::{PrimitiveSource, Reference, TriangleSource};
use crate::accel::{BuildContext, BuildFailure, ClosestHit, Primitive, Query, query_one_by_one};
use crate::geometry::{PrecisionMode, Ray, Triangle};
use crate::simd::{LANES, Simd};

/// How the primitives of a leaf are stored, and tested.
pub(crate) trait LeafForm: Copy + Send + Sync + 'static {
    type Primitive: Primitive;
    type Test<'a>: LeafTest<'a, Self>;

    /// What a reference to a leaf counts in.
    const PLACE_WORDS: usize;
    /// So many primitives surely have places that a reference can name.
    const MOST_PRIMITIVES: usize;

    /// Room for so many places, and beyond them for what the last leaf's kernel may read.
    fn words(place_count: usize, context: &BuildContext) -> Result<Vec<f32>, BuildFailure>;

    /// How many places a leaf takes.
    fn size(references: &[Reference], source: &impl PrimitiveSource<Primitive = Self::Primitive>) -> usize;

    /// How many places a subtree's leaves take.
    fn subtree_size<'r>(
        references: &[Reference],
        leaves: impl Iterator<Item = &'r [Reference]>,
        source: &impl PrimitiveSource<Primitive = Self::Primitive>,
    ) -> usize;

    /// Where a leaf goes that begins with the `first`-th of its subtree's primitives, when the leaf before ended at `next`.
    fn place(first: usize, next: usize) -> usize;

    /// Writes a leaf, and returns how many places it takes.
    fn write(
        words: &mut [f32],
        place: usize,
        references: &[Reference],
        ids: &Ids,
        source: &impl PrimitiveSource<Primitive = Self::Primitive>,
    ) -> usize;

    /// See [`Accel::query_runs`]. Ray by ray, if a form has nothing better.
    fn query_runs<'r, S: Simd, Q, P, R, T>(
        accel: &Vectorized<'_, S, Self>,
        next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
        answer: impl Fn(&mut T, Option<ClosestHit<Surface<Self>>>),
    ) where
        Q: Query,
        P: PrecisionMode,
        for<'a> &'a R: Into<Ray>,
        R: 'r,
        T: 'r,
    {
        query_one_by_one::<_, Q, P, R, T>(accel, next_run, answer);
    }

    /// One of the leaf whose words come first, with geometry and primitive joined into one number, in place of the
    /// primitive: [`Leaves::resolve`] separates them.
    fn primitive(words: &[f32], count: usize, lane: usize) -> Self::Primitive;
}

/// What hits of a form's primitives tell.
type Surface<F> = <<F as LeafForm>::Primitive as Primitive>::Surface;

/// A form of triangles.
pub(crate) trait TriangleForm: LeafForm<Primitive = Triangle> {
    type Leaf<'a>: LeafTriangles;

    /// The leaf whose words come first.
    fn leaf(words: &[f32], count: usize) -> Self::Leaf<'_>;
}

/// A leaf's triangles by coordinate.
pub(crate) trait LeafRows {
    /// One coordinate of the three vertices of all triangles; what lies beyond the last one has no meaning.
    fn rows(&self, axis: usize) -> [&[f32; LANES]; 3];
}

/// A leaf as a kernel reads it.
pub(crate) trait LeafTriangles: Copy {
    type Rows: LeafRows;

    fn unpacked<S: Simd>(self, simd: S) -> Self::Rows;

    /// Bit `i` for triangle `i`.
    fn mask(&self) -> u32;

    /// One coordinate of the three vertices of one triangle.
    fn corners(&self, axis: usize, lane: usize) -> [f32; 3];

    /// Geometry and primitive as one number.
    fn id(&self, lane: usize) -> u32;

    /// See [`LeafForm::primitive`].
    #[inline(always)]
    fn triangle(&self, lane: usize) -> Triangle {
        Triangle {
            axes: [self.corners(0, lane), self.corners(1, lane), self.corners(2, lane)],
            geometry_id: 0,
            primitive_id: self.id(lane),
        }
    }
}

pub(super) struct Leaves<F> {
    words: Vec<f32>,
    leaf_count: usize,
    primitive_count: usize,
    ids: Ids,
    form: PhantomData<F>,
}

impl<F: LeafForm> Leaves<F> {
    /// Room for so many places, to be filled leaf by leaf.
    pub(super) fn filled(place_count: usize, ids: Ids, context: &BuildContext) -> Result<Self, BuildFailure> {
        let words = F::words(place_count, context)?;
        Ok(Self { words, leaf_count: 0, primitive_count: 0, ids, form: PhantomData })
    }

    /// The words of runs of so many places each, and the ids to write into them.
    pub(super) fn parts(&mut self, place_counts: &[usize]) -> (Vec<&mut [f32]>, &Ids) {
        let word_counts: Vec<usize> = place_counts.iter().map(|count| count * F::PLACE_WORDS).collect();
        (slices(&mut self.words, &word_counts), &self.ids)
    }

    pub(super) fn set_counts(&mut self, leaf_count: usize, primitive_count: usize) {
        (self.leaf_count, self.primitive_count) = (leaf_count, primitive_count);
    }

    /// The words from a leaf's first one on.
    #[inline(always)]
    pub(super) fn words_from(&self, place: usize) -> &[f32] {
        &self.words[place * F::PLACE_WORDS..]
    }

    /// See [`LeafForm::primitive`].
    #[inline(always)]
    pub(super) fn primitive(&self, (place, count): (usize, usize), lane: usize) -> F::Primitive {
        F::primitive(self.words_from(place), count, lane)
    }

    /// Where a leaf's words are, for a prefetch.
    #[inline(always)]
    pub(super) fn address(&self, (place, _): (usize, usize)) -> *const u8 {
        self.words.as_ptr().wrapping_add(place * F::PLACE_WORDS).cast()
    }

    pub(super) fn leaf_count(&self) -> usize {
        self.leaf_count
    }

    pub(super) fn primitive_count(&self) -> usize {
        self.primitive_count
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.words.as_slice()) + self.ids.bytes()
    }

    #[cfg(test)]
    pub(super) fn bits(&self) -> impl Iterator<Item = u32> {
        self.words.iter().map(|word| word.to_bits())
    }

    /// The hit with its primitive's own ids.
    #[inline(always)]
    pub(super) fn resolve(&self, hit: ClosestHit<F::Primitive>) -> ClosestHit<F::Primitive> {
        ClosestHit { primitive: self.with_own_ids(hit.primitive), ..hit }
    }

    /// What [`LeafForm::primitive`] gave, with its own ids.
    #[inline(always)]
    pub(super) fn with_own_ids(&self, primitive: F::Primitive) -> F::Primitive {
        let (_, joined) = primitive.ids();
        let (geometry_id, primitive_id) = self.ids.separate(joined);
        primitive.with_ids(geometry_id, primitive_id)
    }
}

impl<F: TriangleForm> Leaves<F> {
    #[inline(always)]
    pub(super) fn leaf(&self, (place, count): (usize, usize)) -> F::Leaf<'_> {
        F::leaf(self.words_from(place), count)
    }
}

/// A leaf of n triangles, of which the first is the scene's i-th, has the words from 10 i on: nine rows of n coordinates
/// (x, y, z; first, second, third vertex each), then n ids as bits.
#[derive(Clone, Copy)]
pub(crate) struct ByAxis;

/// Floats that a triangle takes: three vertices and an id.
const WORDS: usize = 10;
/// What a leaf reads at the most, its rows loaded as eight: so the compiler sees that every row is inside. The axis
/// counts as 2 bits.
const WINDOW: usize = (3 * 3 + 2) * LANES + LANES;

// Counted in words, the place of every leaf that a reference can name fits 32 bits; its bytes are beyond 4 GiB.
const _: () = assert!(Child::MOST_PLACES <= (u32::MAX as usize - WINDOW) / WORDS);

/// One in the form [`ByAxis`].
#[derive(Clone, Copy)]
pub(crate) struct Leaf<'a> {
    words: &'a [f32; WINDOW],
    count: usize,
}

impl LeafForm for ByAxis {
    type Primitive = Triangle;
    type Test<'a> = TriangleTest<'a, Self>;

    const PLACE_WORDS: usize = WORDS;
    const MOST_PRIMITIVES: usize = Child::MOST_PLACES;

    fn words(place_count: usize, context: &BuildContext) -> Result<Vec<f32>, BuildFailure> {
        Ok(context.filled(place_count + WINDOW.div_ceil(WORDS), [0.0; WORDS])?.into_flattened())
    }

    fn size(references: &[Reference], _source: &impl TriangleSource) -> usize {
        references.len()
    }

    fn subtree_size<'r>(
        references: &[Reference],
        _leaves: impl Iterator<Item = &'r [Reference]>,
        _source: &impl TriangleSource,
    ) -> usize {
        references.len()
    }

    fn place(first: usize, _next: usize) -> usize {
        first
    }

    fn write(
        words: &mut [f32],
        place: usize,
        references: &[Reference],
        ids: &Ids,
        source: &impl TriangleSource,
    ) -> usize {
        let count = references.len();
        let words = &mut words[place * WORDS..][..count * WORDS];
        for (lane, reference) in references.iter().enumerate() {
            let triangle = reference.primitive(source);
            for (row, coordinate) in triangle.axes.as_flattened().iter().enumerate() {
                words[row * count + lane] = *coordinate;
            }
            words[(WORDS - 1) * count + lane] = f32::from_bits(ids.joined(reference));
        }
        count
    }

    #[inline(always)]
    fn primitive(words: &[f32], count: usize, lane: usize) -> Triangle {
        Self::leaf(words, count).triangle(lane)
    }

    fn query_runs<'r, S: Simd, Q, P, R, T>(
        accel: &Vectorized<'_, S, Self>,
        next_run: impl FnMut() -> Option<(&'r [R], &'r mut [T])>,
        answer: impl Fn(&mut T, Option<ClosestHit>),
    ) where
        Q: Query,
        P: PrecisionMode,
        for<'a> &'a R: Into<Ray>,
        R: 'r,
        T: 'r,
    {
        let batch = Batch::<Q, P, _, _, _, _, _>::new(accel.simd, accel.bvh, next_run, answer);
        accel.simd.for_steps().vectorize_batch(batch);
    }
}

impl TriangleForm for ByAxis {
    type Leaf<'a> = Leaf<'a>;

    #[inline(always)]
    fn leaf(words: &[f32], count: usize) -> Leaf<'_> {
        Leaf { words: words.first_chunk().expect("the words end with a whole window"), count }
    }
}

impl LeafRows for Leaf<'_> {
    #[inline(always)]
    fn rows(&self, axis: usize) -> [&[f32; LANES]; 3] {
        let rows: &[f32; 3 * LANES] = array(self.words, 3 * (axis & 3) * self.count);
        [array(rows, 0), array(rows, self.count), array(rows, 2 * self.count)]
    }
}

impl LeafTriangles for Leaf<'_> {
    type Rows = Self;

    #[inline(always)]
    fn unpacked<S: Simd>(self, _simd: S) -> Self {
        self
    }

    #[inline(always)]
    fn mask(&self) -> u32 {
        (1 << self.count) - 1
    }

    #[inline(always)]
    fn corners(&self, axis: usize, lane: usize) -> [f32; 3] {
        // What the compiler sees is inside the window.
        let first = 3 * (axis & 3) * self.count + lane % LANES;
        [self.words[first], self.words[first + self.count], self.words[first + 2 * self.count]]
    }

    #[inline(always)]
    fn id(&self, lane: usize) -> u32 {
        self.words[9 * self.count + lane % LANES].to_bits()
    }
}

/// Geometry and primitive as one number, in the order of `(geometry_id, primitive_id)`.
pub(crate) struct Ids {
    /// Where each geometry's numbers begin; at the end where the last one's stop.
    starts: Vec<u32>,
    /// For each bucket of `1 << bucket_bits` numbers the geometry that has its first one, and the same for where the
    /// last bucket ends: one or two for each geometry, so that few have more than two. Four times as many make no ray faster.
    buckets: Vec<u32>,
    bucket_bits: u32,
}

impl Ids {
    /// `starts` has for each geometry the number of triangles in those before it, then that of all.
    pub(super) fn new(starts: &[u32]) -> Self {
        let (geometry_count, end) = (starts.len() - 1, starts[starts.len() - 1]);
        let bucket_bits = (end / geometry_count as u32).checked_ilog2().unwrap_or(0);
        let bucket_count = (end as usize).div_ceil(1 << bucket_bits);
        let mut ids = Self { starts: starts.to_vec(), buckets: Vec::new(), bucket_bits };
        ids.buckets =
            (0..=bucket_count).map(|bucket| ids.geometry_of(bucket << bucket_bits, 0, geometry_count)).collect();
        ids
    }

    pub(super) fn joined(&self, reference: &Reference) -> u32 {
        self.starts[reference.geometry_id() as usize] + reference.primitive_id()
    }

    #[inline(always)]
    fn separate(&self, id: u32) -> (u32, u32) {
        let bucket = (id >> self.bucket_bits) as usize;
        let (first, last) = (self.buckets[bucket], self.buckets[bucket + 1]);
        let geometry = if last - first > 1 {
            self.geometry_among_many(id, first, last)
        } else {
            first + u32::from(self.starts[first as usize + 1] <= id)
        };
        (geometry, id - self.starts[geometry as usize])
    }

    #[cold]
    #[inline(never)]
    fn geometry_among_many(&self, id: u32, first: u32, last: u32) -> u32 {
        self.geometry_of(id as usize, first as usize, last as usize + 1)
    }

    /// The geometry that has a number, among those from `first` to before `end`; the last of them for numbers beyond.
    fn geometry_of(&self, id: usize, first: usize, end: usize) -> u32 {
        let starts_before = self.starts[first..end].partition_point(|&start| start as usize <= id);
        (first + starts_before - 1) as u32
    }

    fn bytes(&self) -> usize {
        size_of_val(self.starts.as_slice()) + size_of_val(self.buckets.as_slice())
    }
}

/// `N` values from `at` on.
#[inline(always)]
fn array<const N: usize>(values: &[f32], at: usize) -> &[f32; N] {
    values[at..][..N].try_into().expect("the length is that of the array")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_ids_separate_again() {
        // Geometries of very different sizes, some without a triangle.
        let counts = [3, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1000, 0, 2, 5000, 1, 0, 7, 0];
        let mut starts = vec![0];
        for count in counts {
            starts.push(starts[starts.len() - 1] + count);
        }
        let ids = Ids::new(&starts);
        for (geometry, count) in (0..).zip(counts) {
            for primitive in 0..count {
                assert_eq!(ids.separate(starts[geometry as usize] + primitive), (geometry, primitive));
            }
        }
    }

    #[test]
    fn as_many_triangles_as_a_scene_can_have_have_ids() {
        for starts in [vec![0, u32::MAX], vec![0, 0, u32::MAX - 1, u32::MAX]] {
            let ids = Ids::new(&starts);
            let last = starts.len() - 2;
            assert_eq!(ids.separate(u32::MAX - 1), (last as u32, u32::MAX - 1 - starts[last]));
            assert_eq!(ids.separate(0), (last as u32 / 2, 0));
        }
    }
}
