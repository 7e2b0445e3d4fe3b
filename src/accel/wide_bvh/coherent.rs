//! Rays that go the same way, value by value.

use glam::Vec3A;

use super::wavefront::{LEAST_DIRECTION, MOST_REACH, is_fit};
use crate::geometry::{Aabb, Ray, TriangleRay};
use crate::simd::{LANES, SIXTEEN, Simd, Sixteen};

/// How many rays make a packet.
pub(super) const PACKET: usize = SIXTEEN;

/// One value a ray.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(super) struct Row(pub(super) [f32; PACKET]);

impl Row {
    pub(super) const ZERO: Self = Self([0.0; PACKET]);

    #[inline(always)]
    pub(super) fn load<F: Sixteen>(&self, floats: F) -> F::Vector {
        floats.load(&self.0)
    }

    #[inline(always)]
    pub(super) fn store<F: Sixteen>(&mut self, floats: F, values: F::Vector) {
        floats.store(values, &mut self.0);
    }
}

/// The widest difference of two directions along an axis, in lengths of the largest component.
const MOST_SPREAD: f32 = 0.25;
/// The widest difference of two origins along an axis, in lengths of the scene's largest side.
const MOST_DISTANCE: f32 = 1.0 / 64.0;

/// The fewest rays that are worth a packet's work.
pub(super) const LEAST_PACKET: usize = 4;

/// A packet's rays, and what they lie between.
pub(super) struct Coherent {
    /// How many they are; the first one again stands in for those that lack.
    pub(super) count: usize,
    pub(super) origin: [Row; 3],
    pub(super) direction: [Row; 3],
    pub(super) t_min: Row,
    pub(super) t_max: Row,
    /// The least and the greatest along each axis.
    pub(super) origin_ends: [[f32; 2]; 3],
    pub(super) direction_ends: [[f32; 2]; 3],
    pub(super) least_t_min: f32,
    pub(super) signs: u32,
    pub(super) axes: [usize; 3],
}

impl Coherent {
    pub(super) const NONE: Self = Self {
        count: 0,
        origin: [Row::ZERO; 3],
        direction: [Row::ZERO; 3],
        t_min: Row::ZERO,
        t_max: Row::ZERO,
        origin_ends: [[0.0; 2]; 3],
        direction_ends: [[0.0; 2]; 3],
        least_t_min: 0.0,
        signs: 0,
        axes: [0, 1, 2],
    };

    /// Takes as many of the first rays as have signs and the largest component in common, if they differ little. False if those
    /// make no packet.
    #[inline(always)]
    pub(super) fn take<S: Simd, R>(&mut self, simd: S, rays: &[R], bounds: &Aabb) -> bool
    where
        for<'r> &'r R: Into<Ray>,
    {
        let (Some(first), Some(near)) = (rays.first(), rays.get(LEAST_PACKET - 1)) else { return false };
        let first: Ray = first.into();
        let direction = Vec3A::from(first.direction);
        let signs = direction.is_negative_bitmask();
        let most_across = MOST_SPREAD * direction.abs().max_element();
        // These two settle most refusals.
        let near = Vec3A::from(Into::<Ray>::into(near).direction);
        if near.is_negative_bitmask() != signs
            || (near - direction).abs().max_element() > most_across
            || !is_fit(&first)
        {
            return false;
        }
        (self.signs, self.axes, self.count) = (signs, TriangleRay::new(&first).axes, rays.len().min(PACKET));
        // In loops, because the closures of an array's functions are not inlined into a vectorised frame.
        let mut loaded = [simd.load(&values(&rays[0])); PACKET];
        for (loaded, ray) in loaded.iter_mut().zip(rays) {
            *loaded = simd.load(&values(ray));
        }
        self.set_rows(simd, &loaded);
        let alike = self.alike(simd.sixteen()).trailing_ones() as usize;
        if alike < self.count {
            if alike < LEAST_PACKET {
                return false;
            }
            self.count = alike;
            let first = loaded[0];
            loaded[alike..].fill(first);
            self.set_rows(simd, &loaded);
        }
        self.set_ends(simd, &loaded);
        let most_apart = MOST_DISTANCE * (bounds.upper - bounds.lower).max_element();
        let widest = |[x, y, z]: &[[f32; 2]; 3]| (x[1] - x[0]).max(y[1] - y[0]).max(z[1] - z[0]);
        widest(&self.direction_ends) <= most_across && widest(&self.origin_ends) <= most_apart
    }

    #[inline(always)]
    fn set_rows<S: Simd>(&mut self, simd: S, rays: &[S::F32x8; PACKET]) {
        for (half, rays) in rays.as_chunks::<LANES>().0.iter().enumerate() {
            let rows = simd.transpose_eights(*rays);
            let set = |row: &mut Row, values| row.0.as_chunks_mut::<LANES>().0[half] = simd.store(values);
            for axis in 0..3 {
                set(&mut self.origin[axis], rows[axis]);
                set(&mut self.direction[axis], rows[4 + axis]);
            }
            set(&mut self.t_min, rows[3]);
            set(&mut self.t_max, rows[7]);
        }
    }

    #[inline(always)]
    fn set_ends<S: Simd>(&mut self, simd: S, rays: &[S::F32x8; PACKET]) {
        let (mut least, mut greatest) = (rays[0], rays[0]);
        for ray in &rays[1..] {
            (least, greatest) = (simd.min(*ray, least), simd.max(*ray, greatest));
        }
        let (least, greatest) = (simd.store(least), simd.store(greatest));
        for axis in 0..3 {
            self.origin_ends[axis] = [least[axis], greatest[axis]];
            self.direction_ends[axis] = [least[4 + axis], greatest[4 + axis]];
        }
        self.least_t_min = least[3];
    }

    /// Which are [fit](is_fit), go the first one's way along each axis, and have its axes.
    #[inline(always)]
    fn alike<F: Sixteen>(&self, floats: F) -> u32 {
        let zero = floats.splat(0.0);
        let longest = self.axes[2];
        let (t_min, t_max) = (self.t_min.load(floats), self.t_max.load(floats));
        let mut alike = floats.less_or_equal(zero, t_min) & floats.less_or_equal(t_min, t_max);
        let length = floats.abs(self.direction[longest % 3].load(floats));
        // No sum of magnitudes is less than one of them; it passes a NaN on.
        let (mut sum, mut least) = (zero, length);
        for axis in 0..3 {
            let direction = self.direction[axis].load(floats);
            let along = floats.abs(direction);
            sum = floats.add(floats.add(sum, floats.abs(self.origin[axis].load(floats))), along);
            least = floats.min(along, least);
            let is_negative = self.signs >> axis & 1 == 1;
            alike &= if is_negative { floats.less(direction, zero) } else { floats.less(zero, direction) };
            // Of equal components a ray takes the first.
            alike &= if axis < longest { floats.less(along, length) } else { floats.less_or_equal(along, length) };
        }
        alike & floats.less(sum, floats.splat(MOST_REACH)) & floats.less(floats.splat(LEAST_DIRECTION), least)
    }
}

/// A ray as eight numbers: origin, `t_min`, direction, `t_max`.
#[inline(always)]
fn values<R>(ray: &R) -> [f32; LANES]
where
    for<'r> &'r R: Into<Ray>,
{
    let ray: Ray = ray.into();
    let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin.to_array(), ray.direction.to_array());
    [ox, oy, oz, ray.t_min, dx, dy, dz, ray.t_max]
}
