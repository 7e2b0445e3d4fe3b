//! The triangles of all leaves, each leaf by coordinate: what one load brings is one coordinate of all its triangles.

use super::node::Child;
use crate::accel::{BuildContext, BuildFailure, ClosestHit};
use crate::geometry::Triangle;
use crate::simd::{LANES, prefetch};

/// Floats that a triangle takes: three vertices and an id.
const WORDS: usize = 10;
/// What a leaf reads at the most, its rows loaded as eight: so the compiler sees that every row is inside. The axis
/// counts as 2 bits.
const WINDOW: usize = (3 * 3 + 2) * LANES + LANES;

// Counted in words, the place of every leaf that a reference can name fits 32 bits; its bytes are beyond 4 GiB.
const _: () = assert!(Child::MOST_TRIANGLES <= (u32::MAX as usize - WINDOW) / WORDS);

pub(super) struct Leaves {
    /// A leaf of n triangles from the i-th on has the words from 10 i on: nine rows of n coordinates (x, y, z; first,
    /// second, third vertex each), then n ids as bits. More words at the end, so that the last leaf has a whole window.
    words: Vec<f32>,
    leaf_count: usize,
    ids: Ids,
}

/// A leaf as a kernel reads it.
#[derive(Clone, Copy)]
pub(super) struct Leaf<'a> {
    words: &'a [f32; WINDOW],
    count: usize,
}

impl Leaves {
    pub(super) fn reserve(triangle_count: usize, ids: Ids, context: &BuildContext) -> Result<Self, BuildFailure> {
        let words = context.reserve(triangle_count * WORDS + WINDOW)?;
        Ok(Self { words, leaf_count: 0, ids })
    }

    /// Appends a leaf and returns its first triangle's place.
    pub(super) fn push(&mut self, triangles: &[Triangle]) -> usize {
        let first = self.words.len() / WORDS;
        for axis in 0..3 {
            for corner in 0..3 {
                self.words.extend(triangles.iter().map(|triangle| triangle.axes[axis][corner]));
            }
        }
        self.words.extend(triangles.iter().map(|triangle| f32::from_bits(self.ids.joined(triangle))));
        self.leaf_count += 1;
        first
    }

    pub(super) fn finish(&mut self) {
        self.words.extend([0.0; WINDOW]);
    }

    #[inline(always)]
    pub(super) fn leaf(&self, (first, count): (usize, usize)) -> Leaf<'_> {
        let words = self.words[first * WORDS..].first_chunk().expect("the words end with a whole window");
        Leaf { words, count }
    }

    /// Asks for the first four cache lines of a leaf, six triangles and a bit.
    #[inline(always)]
    pub(super) fn prefetch(&self, (first, _): (usize, usize)) {
        if let Some(words) = self.words[first * WORDS..].first_chunk::<64>() {
            prefetch(words);
        }
    }

    pub(super) fn leaf_count(&self) -> usize {
        self.leaf_count
    }

    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.words.as_slice()) + self.ids.bytes()
    }

    /// The hit with its triangle's own ids.
    #[inline(always)]
    pub(super) fn resolve(&self, mut hit: ClosestHit) -> ClosestHit {
        (hit.triangle.geometry_id, hit.triangle.primitive_id) = self.ids.separate(hit.triangle.primitive_id);
        hit
    }
}

impl<'a> Leaf<'a> {
    /// One coordinate of the three vertices of all triangles; what lies beyond the last one has no meaning.
    #[inline(always)]
    pub(super) fn rows(&self, axis: usize) -> [&'a [f32; LANES]; 3] {
        let rows: &[f32; 3 * LANES] = array(self.words, 3 * (axis & 3) * self.count);
        [array(rows, 0), array(rows, self.count), array(rows, 2 * self.count)]
    }

    /// Bit `i` for triangle `i`.
    #[inline(always)]
    pub(super) fn mask(&self) -> u32 {
        (1 << self.count) - 1
    }

    /// One coordinate of the three vertices of one triangle.
    #[inline(always)]
    pub(super) fn corners(&self, axis: usize, lane: usize) -> [f32; 3] {
        // What the compiler sees is inside the window.
        let first = 3 * (axis & 3) * self.count + lane % LANES;
        [self.words[first], self.words[first + self.count], self.words[first + 2 * self.count]]
    }

    /// With geometry and primitive joined into one number, in place of the primitive: [`Leaves::resolve`] separates
    /// them.
    #[inline(always)]
    pub(super) fn triangle(&self, lane: usize) -> Triangle {
        Triangle {
            axes: [self.corners(0, lane), self.corners(1, lane), self.corners(2, lane)],
            geometry_id: 0,
            primitive_id: self.id(lane),
        }
    }

    #[inline(always)]
    fn id(&self, lane: usize) -> u32 {
        self.words[9 * self.count + lane % LANES].to_bits()
    }
}

/// Geometry and primitive as one number, in the order of `(geometry_id, primitive_id)`.
pub(super) struct Ids {
    /// Where each geometry's numbers begin; at the end where the last one's stop.
    starts: Vec<u32>,
    /// For each bucket of `1 << bucket_bits` numbers the geometry that has its first one, and the same for where the
    /// last bucket ends: as many buckets as geometries make the search among them short.
    buckets: Vec<u32>,
    bucket_bits: u32,
}

impl Ids {
    /// For triangles in the order of their ids.
    pub(super) fn new(triangles: &[Triangle]) -> Self {
        let mut starts = vec![0];
        let mut next = 0;
        for triangle in triangles {
            // Geometries without a triangle to hit begin where the next one does.
            starts.resize(triangle.geometry_id as usize + 1, next);
            next = starts[triangle.geometry_id as usize] + triangle.primitive_id + 1;
        }
        starts.push(next);
        let geometry_count = starts.len() - 1;
        let bucket_bits = (next / geometry_count as u32).checked_ilog2().unwrap_or(0);
        let bucket_count = (next as usize).div_ceil(1 << bucket_bits);
        let mut ids = Self { starts, buckets: Vec::new(), bucket_bits };
        ids.buckets =
            (0..=bucket_count).map(|bucket| ids.geometry_of(bucket << bucket_bits, 0, geometry_count)).collect();
        ids
    }

    fn joined(&self, triangle: &Triangle) -> u32 {
        self.starts[triangle.geometry_id as usize] + triangle.primitive_id
    }

    #[inline(always)]
    fn separate(&self, id: u32) -> (u32, u32) {
        let bucket = (id >> self.bucket_bits) as usize;
        let (first, last) = (self.buckets[bucket], self.buckets[bucket + 1]);
        let geometry =
            if first == last { first } else { self.geometry_of(id as usize, first as usize, last as usize + 1) };
        (geometry, id - self.starts[geometry as usize])
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

    fn triangle(geometry_id: u32, primitive_id: u32) -> Triangle {
        Triangle { axes: [[0.0; 3]; 3], geometry_id, primitive_id }
    }

    #[test]
    fn joined_ids_separate_again_and_keep_their_order() {
        // Geometries of very different sizes, some without a triangle, some with gaps.
        let counts = [3, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1000, 0, 2, 5000, 1, 0, 7];
        let triangles: Vec<_> = (0..)
            .zip(counts)
            .flat_map(|(geometry, count)| (0..count).filter(|primitive| primitive % 7 != 5).map(move |p| (geometry, p)))
            .map(|(geometry, primitive)| triangle(geometry, primitive))
            .collect();
        let ids = Ids::new(&triangles);
        let mut last = None;
        for triangle in &triangles {
            let id = ids.joined(triangle);
            assert_eq!(ids.separate(id), (triangle.geometry_id, triangle.primitive_id));
            assert!(last < Some(id));
            last = Some(id);
        }
    }

    #[test]
    fn a_single_triangle_of_a_late_geometry_has_ids() {
        for primitive in [0, 5, u32::MAX - 1] {
            let lone = triangle(9, primitive);
            let ids = Ids::new(&[lone]);
            assert_eq!(ids.separate(ids.joined(&lone)), (9, primitive));
        }
    }
}
