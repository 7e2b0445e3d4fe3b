//! Leaves of spheres: eight are refused at once in `f32`, the others are decided one by one.

use super::WideBvh;
use super::leaf_test::{Best, LeafTest, Place};
use super::leaves::{Ids, LeafForm};
use super::node::Child;
use crate::accel::leaf::Query;
use crate::accel::reference::{PrimitiveSource, Reference};
use crate::accel::{BuildContext, BuildFailure};
use crate::geometry::{Interval, PrecisionMode, Ray, Sphere, SphereRay};
use crate::math::UNIT_ROUNDOFF;
use crate::simd::{LANES, Simd};

/// A leaf of n spheres has rows of n words: x, y and z of the centres, the radii, then ids as bits.
#[derive(Clone, Copy)]
pub(crate) struct Spheres;

/// Floats that a sphere takes.
const WORDS: usize = 5;
/// What a leaf reads at the most, its rows loaded as eight.
const WINDOW: usize = (WORDS - 1) * LANES + LANES;

const _: () = assert!(Child::MOST_PLACES <= (u32::MAX as usize - WINDOW) / WORDS);

impl LeafForm for Spheres {
    type Primitive = Sphere;
    type Test<'a> = SphereTest<'a>;

    const PLACE_WORDS: usize = WORDS;
    const MOST_PRIMITIVES: usize = Child::MOST_PLACES;

    fn words(place_count: usize, context: &BuildContext) -> Result<Vec<f32>, BuildFailure> {
        Ok(context.filled(place_count + WINDOW.div_ceil(WORDS), [0.0; WORDS])?.into_flattened())
    }

    fn size(references: &[Reference], _source: &impl PrimitiveSource<Primitive = Sphere>) -> usize {
        references.len()
    }

    fn subtree_size<'r>(
        references: &[Reference],
        _leaves: impl Iterator<Item = &'r [Reference]>,
        _source: &impl PrimitiveSource<Primitive = Sphere>,
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
        source: &impl PrimitiveSource<Primitive = Sphere>,
    ) -> usize {
        let count = references.len();
        let words = &mut words[place * WORDS..][..count * WORDS];
        for (lane, reference) in references.iter().enumerate() {
            let Sphere { centre: [x, y, z], radius, .. } = reference.primitive(source);
            let id = f32::from_bits(ids.joined(reference));
            for (row, word) in [x, y, z, radius, id].into_iter().enumerate() {
                words[row * count + lane] = word;
            }
        }
        count
    }

    #[inline(always)]
    fn primitive(words: &[f32], count: usize, lane: usize) -> Sphere {
        let word = |row: usize| words[row * count + lane];
        Sphere { centre: [word(0), word(1), word(2)], radius: word(3), geometry_id: 0, primitive_id: word(4).to_bits() }
    }
}

/// A ray made ready for leaves of spheres.
pub(crate) struct SphereTest<'a> {
    bvh: &'a WideBvh<Spheres>,
    ray: SphereRay,
    origin: [f32; 3],
    /// The direction by its square's inverse, and the direction.
    per_square: [f32; 3],
    direction: [f32; 3],
    t_min: f32,
}

impl SphereTest<'_> {
    /// Those that the line of the ray may hit, as bits.
    ///
    /// With `w` the centre seen from the origin and `s = (w.d) / (d.d)`, a sphere is refused where `|w - s d|` exceeds its
    /// radius. In roundings: `d / (d.d)` makes 4, `w` one, `s` three more with products and sums, `s d` another, so it is
    /// off by `9 u |w|`; with `w` itself and the difference that vector is off by `10 u |w|` and one of its own length `p`;
    /// squares and sums make 4 of `p^2`. By `(p - y)^2 >= p^2 (1 - 1/65) - 65 y^2` the true square is at least
    /// `p^2 (1 - 1/64) - 65 (10 u)^2 w.w`, in which the rest of `p`'s roundings has room. A NaN refuses nothing.
    #[inline(always)]
    fn candidates<S: Simd>(&self, simd: S, child: Child) -> u32 {
        const NEAR: f32 = 1.0 - 1.0 / 64.0;
        // Twice, for the roundings here.
        const FAR: f32 = 2.0 * 65.0 * (10.0 * UNIT_ROUNDOFF) * (10.0 * UNIT_ROUNDOFF);
        let (place, count) = child.triangles();
        let words: &[f32; WINDOW] = self.bvh.leaves.words_from(place).first_chunk().expect("they end with a window");
        let row = |row: usize| -> S::F32x8 {
            let lanes: &[f32; LANES] =
                words[row * count..][..LANES].try_into().expect("the length is that of the array");
            simd.load(lanes)
        };
        let (x, y, z) = (
            simd.sub(row(0), simd.splat(self.origin[0])),
            simd.sub(row(1), simd.splat(self.origin[1])),
            simd.sub(row(2), simd.splat(self.origin[2])),
        );
        let [dx, dy, dz] =
            [simd.splat(self.direction[0]), simd.splat(self.direction[1]), simd.splat(self.direction[2])];
        let along = simd.mul(x, simd.splat(self.per_square[0]));
        let along = simd.add(along, simd.mul(y, simd.splat(self.per_square[1])));
        let along = simd.add(along, simd.mul(z, simd.splat(self.per_square[2])));
        let square =
            |x: S::F32x8, y: S::F32x8, z: S::F32x8| simd.add(simd.mul(x, x), simd.add(simd.mul(y, y), simd.mul(z, z)));
        let beside = square(
            simd.sub(x, simd.mul(along, dx)),
            simd.sub(y, simd.mul(along, dy)),
            simd.sub(z, simd.mul(along, dz)),
        );
        let radius = row(3);
        let allowed = simd.add(
            simd.add(simd.mul(radius, radius), simd.mul(simd.splat(FAR), square(x, y, z))),
            simd.splat(f32::MIN_POSITIVE),
        );
        ((1 << count) - 1) & !simd.less(allowed, simd.mul(beside, simd.splat(NEAR)))
    }
}

impl<'a> LeafTest<'a, Spheres> for SphereTest<'a> {
    #[inline(always)]
    fn new<P: PrecisionMode>(bvh: &'a WideBvh<Spheres>, ray: &Ray) -> Self {
        let per_square = ray.direction / ray.direction.length_squared();
        Self {
            bvh,
            ray: SphereRay::new(ray),
            origin: ray.origin.to_array(),
            per_square: per_square.to_array(),
            direction: ray.direction.to_array(),
            t_min: ray.t_min,
        }
    }

    /// Where the square of the direction overflows, or loses bits to underflow, nothing is refused.
    #[inline(always)]
    fn check_range(&mut self) {
        const LEAST: f32 = f32::MIN_POSITIVE / UNIT_ROUNDOFF;
        let square = self.direction.iter().map(|d| d * d).sum::<f32>();
        if !(LEAST..=f32::MAX).contains(&square) {
            self.per_square = [f32::NAN; 3];
        }
    }

    #[inline(always)]
    fn t_min(&self) -> f32 {
        self.t_min
    }

    #[inline(always)]
    fn ray(&self) -> &SphereRay {
        &self.ray
    }

    #[inline(always)]
    fn lanes<P: PrecisionMode, S: Simd>(&self, simd: S, child: Child, _t_max: f32) -> u32 {
        self.candidates(simd, child)
    }

    #[inline(always)]
    fn test<Q: Query, P: PrecisionMode, S: Simd>(&self, simd: S, child: Child, _t_max: f32, best: &mut Best) -> bool {
        let mut left = self.candidates(simd, child);
        while left != 0 {
            let lane = left.trailing_zeros();
            left &= left - 1;
            let place = Place::new(child, lane);
            let interval = Interval { t_min: self.t_min, t_max: best.t_max() };
            if let Some(hit) = place.primitive(self.bvh).hit(&self.ray, interval) {
                if Q::FIRST_HIT_ENDS {
                    return true;
                }
                best.improve::<Spheres, P>(self.bvh, &self.ray, hit, place);
            }
        }
        false
    }
}
