//! Leaves that store each vertex once: half the memory where the triangles are those of a mesh, for the time it takes to
//! put a leaf's rows together before its test.

use arrayvec::ArrayVec;

use super::leaf_test::TriangleTest;
use super::leaves::{Ids, LeafForm, LeafRows, LeafTriangles, TriangleForm};
use super::node::Child;
use crate::accel::reference::{Reference, TriangleSource};
use crate::accel::{BuildContext, BuildFailure};
use crate::geometry::Triangle;
use crate::simd::{LANES, Simd};

/// A leaf of n triangles with v distinct vertices has `3 n` bytes, for each triangle where its three vertices begin among
/// the coordinates; from the next whole word on n ids as bits; then `3 v` coordinates, x, y and z of each vertex.
#[derive(Clone, Copy)]
pub(crate) struct Compact;

/// One in the form [`Compact`].
#[derive(Clone, Copy)]
pub(crate) struct CompactLeaf<'a> {
    header: &'a [f32; HEADER],
    coordinates: &'a [f32; REACH],
    count: usize,
}

/// Two words: leaves need less than one more for it, and the places reach 2 GiB.
const PLACE_WORDS: usize = 2;
/// The words of indices and ids of the largest leaf.
const HEADER: usize = index_words(LANES) + LANES;
/// How far the coordinates reach for what the compiler knows: any index of eight bits, and from it on four floats.
const REACH: usize = u8::MAX as usize + 4;

/// The most places that a leaf of so many triangles takes.
const fn most_places(count: usize) -> usize {
    (index_words(count) + count + 9 * count).div_ceil(PLACE_WORDS)
}

/// The most places that a triangle takes, alone in its leaf.
const MOST_PLACES: usize = most_places(1);

const _: () = {
    assert!(3 * (3 * LANES - 1) <= u8::MAX as usize, "an index fits eight bits");
    let mut count = 1;
    while count <= LANES {
        assert!(most_places(count) <= count * MOST_PLACES, "a leaf takes no more than its triangles would alone");
        count += 1;
    }
    // 44 million; of an ordinary mesh a reference could name twice as many.
    assert!(Compact::MOST_PRIMITIVES == 44_739_242);
};

const fn index_words(count: usize) -> usize {
    (3 * count).div_ceil(4)
}

/// A leaf's vertices, those that are equal to the bit as one, and each triangle's three.
struct Welded {
    vertices: ArrayVec<[f32; 3], { 3 * LANES }>,
    triangles: ArrayVec<[u8; 3], LANES>,
}

impl Welded {
    fn new(references: &[Reference], source: &impl TriangleSource) -> Self {
        let mut welded = Self { vertices: ArrayVec::new(), triangles: ArrayVec::new() };
        for reference in references {
            let [x, y, z] = reference.primitive(source).axes;
            let index = [0, 1, 2].map(|corner| welded.index([x[corner], y[corner], z[corner]]));
            welded.triangles.push(index);
        }
        welded
    }

    fn index(&mut self, vertex: [f32; 3]) -> u8 {
        let bits = vertex.map(f32::to_bits);
        let known = self.vertices.iter().position(|other| other.map(f32::to_bits) == bits);
        known.unwrap_or_else(|| {
            self.vertices.push(vertex);
            self.vertices.len() - 1
        }) as u8
    }

    fn place_count(&self) -> usize {
        let count = self.triangles.len();
        (index_words(count) + count + 3 * self.vertices.len()).div_ceil(PLACE_WORDS)
    }
}

impl LeafForm for Compact {
    type Primitive = Triangle;
    type Test<'a> = TriangleTest<'a, Self>;

    const PLACE_WORDS: usize = PLACE_WORDS;
    /// However few vertices they share.
    const MOST_PRIMITIVES: usize = Child::MOST_PLACES / MOST_PLACES;

    fn words(place_count: usize, context: &BuildContext) -> Result<Vec<f32>, BuildFailure> {
        let spare = (HEADER + REACH).div_ceil(PLACE_WORDS);
        Ok(context.filled(place_count + spare, [0.0; PLACE_WORDS])?.into_flattened())
    }

    fn size(references: &[Reference], source: &impl TriangleSource) -> usize {
        Welded::new(references, source).place_count()
    }

    fn subtree_size<'r>(
        _references: &[Reference],
        leaves: impl Iterator<Item = &'r [Reference]>,
        source: &impl TriangleSource,
    ) -> usize {
        leaves.map(|references| Self::size(references, source)).sum()
    }

    fn place(_first: usize, next: usize) -> usize {
        next
    }

    fn write(
        words: &mut [f32],
        place: usize,
        references: &[Reference],
        ids: &Ids,
        source: &impl TriangleSource,
    ) -> usize {
        let welded = Welded::new(references, source);
        let count = references.len();
        let words = &mut words[place * PLACE_WORDS..];
        let (indices, words) = words.split_at_mut(index_words(count));
        for (word, bytes) in indices.iter_mut().zip(welded.triangles.as_flattened().chunks(4)) {
            let mut starts = [0; 4];
            for (start, index) in starts.iter_mut().zip(bytes) {
                *start = 3 * index;
            }
            *word = f32::from_bits(u32::from_le_bytes(starts));
        }
        let (id_words, words) = words.split_at_mut(count);
        for (word, reference) in id_words.iter_mut().zip(references) {
            *word = f32::from_bits(ids.joined(reference));
        }
        let coordinates = welded.vertices.as_flattened();
        words[..coordinates.len()].copy_from_slice(coordinates);
        welded.place_count()
    }

    #[inline(always)]
    fn primitive(words: &[f32], count: usize, lane: usize) -> Triangle {
        Self::leaf(words, count).triangle(lane)
    }
}

impl TriangleForm for Compact {
    type Leaf<'a> = CompactLeaf<'a>;

    #[inline(always)]
    fn leaf(words: &[f32], count: usize) -> CompactLeaf<'_> {
        let header: &[f32; HEADER] = words.first_chunk().expect("the words end with a whole window");
        let coordinates: &[f32; REACH] =
            words[index_words(count) + count..].first_chunk().expect("the words end with a whole window");
        CompactLeaf { header, coordinates, count }
    }
}

/// For each axis the coordinate of the first, second and third vertices.
pub(crate) struct CompactRows([[f32; LANES]; 9]);

impl LeafRows for CompactRows {
    #[inline(always)]
    fn rows(&self, axis: usize) -> [&[f32; LANES]; 3] {
        let first = 3 * (axis % 3);
        [&self.0[first], &self.0[first + 1], &self.0[first + 2]]
    }
}

impl LeafTriangles for CompactLeaf<'_> {
    type Rows = CompactRows;

    #[inline(always)]
    fn unpacked<S: Simd>(self, simd: S) -> CompactRows {
        let starts = starts(self.header, self.count);
        let [ax, ay, az] = corner::<0, S>(simd, &starts, self.coordinates);
        let [bx, by, bz] = corner::<1, S>(simd, &starts, self.coordinates);
        let [cx, cy, cz] = corner::<2, S>(simd, &starts, self.coordinates);
        CompactRows([ax, bx, cx, ay, by, cy, az, bz, cz])
    }

    #[inline(always)]
    fn mask(&self) -> u32 {
        (1 << self.count) - 1
    }

    #[inline(always)]
    fn corners(&self, axis: usize, lane: usize) -> [f32; 3] {
        let byte = 3 * (lane % LANES);
        // Two words hold the three bytes, and an id follows the last ones.
        let first = byte / 4;
        let starts = both(self.header[first], self.header[first + 1]) >> (8 * (byte % 4));
        let along = &self.coordinates[axis & 3..];
        [along[start(starts)], along[start(starts >> 8)], along[start(starts >> 16)]]
    }

    #[inline(always)]
    fn id(&self, lane: usize) -> u32 {
        self.header[index_words(self.count) + lane % LANES].to_bits()
    }
}

/// Eight bytes, the first word's below.
#[inline(always)]
fn both(first: f32, second: f32) -> u64 {
    u64::from(first.to_bits()) | (u64::from(second.to_bits()) << 32)
}

/// Where the vertices of eight triangles begin, eight bytes a number; the leaf's first vertex for triangles beyond its
/// last: other bytes there would name words of other cache lines.
#[inline(always)]
fn starts(header: &[f32; HEADER], count: usize) -> [u64; 3] {
    /// The bytes of so many triangles.
    const MASKS: [[u64; 3]; LANES] = {
        let mut masks = [[0; 3]; LANES];
        let mut byte = 0;
        while byte < 3 * LANES {
            let mut count = byte / 3;
            while count < LANES {
                masks[count][byte / 8] |= 0xFF << (8 * (byte % 8));
                count += 1;
            }
            byte += 1;
        }
        masks
    };
    let mask = &MASKS[(count - 1) % LANES];
    [both(header[0], header[1]) & mask[0], both(header[2], header[3]) & mask[1], both(header[4], header[5]) & mask[2]]
}

/// x, y and z of one vertex of each triangle.
#[inline(always)]
fn corner<const CORNER: usize, S: Simd>(simd: S, starts: &[u64; 3], coordinates: &[f32; REACH]) -> [[f32; LANES]; 3] {
    let [x, y, z] = simd.transpose([
        vertex(starts, coordinates, CORNER),
        vertex(starts, coordinates, CORNER + 3),
        vertex(starts, coordinates, CORNER + 6),
        vertex(starts, coordinates, CORNER + 9),
        vertex(starts, coordinates, CORNER + 12),
        vertex(starts, coordinates, CORNER + 15),
        vertex(starts, coordinates, CORNER + 18),
        vertex(starts, coordinates, CORNER + 21),
    ]);
    [simd.store(x), simd.store(y), simd.store(z)]
}

/// A vertex and what follows it.
#[inline(always)]
fn vertex<'a>(starts: &[u64; 3], coordinates: &'a [f32; REACH], byte: usize) -> &'a [f32; 4] {
    let start = start(starts[byte / 8] >> (8 * (byte % 8)));
    coordinates[start..].first_chunk().expect("a start has eight bits")
}

/// What the lowest eight bits say.
#[inline(always)]
fn start(bits: u64) -> usize {
    usize::from(bits as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accel::wide_bvh::leaves::Leaves;
    use crate::accel::{PrimitiveSource, Watch};
    use crate::geometry::Triangle;
    use crate::simd::{Isa, Scalar};

    struct Triangles(Vec<Triangle>);

    impl PrimitiveSource for Triangles {
        type Primitive = Triangle;

        fn primitive(&self, _geometry_id: u32, primitive_id: u32) -> Triangle {
            self.0[primitive_id as usize]
        }

        fn starts(&self) -> &[u32] {
            &[0, 1 << 20]
        }
    }

    /// Writes the leaves one after the other, and reads them back.
    fn check(leaves_of_vertices: &[Vec<[[f32; 3]; 3]>]) {
        let triangles = leaves_of_vertices.concat().into_iter().zip(0..);
        let source = Triangles(triangles.map(|(vertices, id)| Triangle::new(vertices, 0, id)).collect());
        let references: Vec<Reference> =
            source.0.iter().map(|triangle| Reference::new(&triangle.bounds(), 0, triangle.primitive_id)).collect();
        let mut rest = references.as_slice();
        let runs = leaves_of_vertices.iter().map(|leaf| rest.split_off(..leaf.len()).expect("one a triangle"));
        let runs: Vec<&[Reference]> = runs.collect();

        let watch = Watch::default();
        let context = BuildContext::new(None, None, Isa::Auto, &watch);
        let place_count = Compact::subtree_size(&references, runs.iter().copied(), &source);
        let ids = Ids::new(source.starts());
        let mut leaves = Leaves::<Compact>::filled(place_count, ids, &context).expect("no limit");
        let (mut words, ids) = leaves.parts(&[place_count]);
        let mut places = vec![0];
        for run in &runs {
            let place = places[places.len() - 1];
            let size = Compact::write(words[0], place, run, ids, &source);
            assert_eq!(size, Compact::size(run, &source));
            places.push(place + size);
        }
        assert_eq!(places[runs.len()], place_count);

        for (run, place) in runs.iter().zip(places) {
            let leaf = leaves.leaf((place, run.len()));
            let unpacked = leaf.unpacked(Scalar);
            assert_eq!(leaf.mask(), (1 << run.len()) - 1);
            for (lane, reference) in run.iter().enumerate() {
                let expected = reference.primitive(&source);
                assert_eq!(leaf.id(lane), reference.primitive_id());
                for axis in 0..3 {
                    let bits = expected.axes[axis].map(f32::to_bits);
                    assert_eq!(leaf.corners(axis, lane).map(f32::to_bits), bits, "triangle {lane} of {}", run.len());
                    assert_eq!(
                        unpacked.rows(axis).map(|row| row[lane].to_bits()),
                        bits,
                        "triangle {lane} of {}",
                        run.len()
                    );
                }
            }
        }
    }

    fn vertex(number: usize) -> [f32; 3] {
        [1.0, 100.0, 10_000.0].map(|scale| scale * (number as f32 + 1.0))
    }

    #[test]
    fn triangles_of_every_number_come_back_shared_or_not() {
        for count in 1..=LANES {
            let strip = (0..count).map(|id| [0, 1, 2].map(|corner| vertex(id + corner))).collect();
            let fan = (0..count).map(|id| [vertex(id + 2), vertex(0), vertex(id + 1)]).collect();
            let apart = (0..count).map(|id| [0, 1, 2].map(|corner| vertex(3 * id + corner))).collect();
            check(&[strip, fan, apart]);
        }
    }

    #[test]
    fn vertices_are_stored_once_and_those_that_differ_in_a_bit_are_kept_apart() {
        let zero = [0.0, 1.0, 2.0];
        let minus_zero = [-0.0, 1.0, 2.0];
        let next = [0.0, 1.0f32.next_up(), 2.0];
        let leaf = vec![[zero, minus_zero, next], [minus_zero, next, vertex(0)], [next, zero, vertex(0)]];
        check(std::slice::from_ref(&leaf));
        let triangles = leaf.into_iter().zip(0..).map(|(vertices, id)| Triangle::new(vertices, 0, id));
        let source = Triangles(triangles.collect());
        let references: Vec<Reference> =
            source.0.iter().map(|triangle| Reference::new(&triangle.bounds(), 0, triangle.primitive_id)).collect();
        assert_eq!(Welded::new(&references, &source).vertices.len(), 4);
    }
}
