//! Axis-aligned boxes, and the conservative test of a ray against one.

use glam::{Vec3, Vec4, Vec4Swizzles};

use super::Ray;
use crate::math::{gamma, scale_by_power_of_two_near};

/// An axis-aligned box; closed. Empty where `lower > upper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The least coordinates.
    pub lower: Vec3,
    /// The largest coordinates.
    pub upper: Vec3,
}

impl Aabb {
    /// Contains nothing; the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self { lower: Vec3::INFINITY, upper: Vec3::NEG_INFINITY };

    /// The smallest box that contains both.
    pub fn union(self, other: Self) -> Self {
        Self { lower: self.lower.min(other.lower), upper: self.upper.max(other.upper) }
    }

    /// The lower and the upper corner on four lanes, the fourth 0.
    pub(crate) fn corners4(&self) -> [Vec4; 2] {
        [self.lower.extend(0.0), self.upper.extend(0.0)]
    }

    /// Whether all of `inner` is inside.
    pub fn contains(&self, inner: &Self) -> bool {
        self.lower.cmple(inner.lower).all() && self.upper.cmpge(inner.upper).all()
    }

    /// The largest distance along an axis from `point` to any point of the box. `-inf` or NaN for the empty box.
    pub(crate) fn reach_from(&self, point: Vec3) -> f32 {
        (self.upper - point).max(point - self.lower).max_element()
    }
}

/// How far along each axis a ray may pass the point of a triangle that it is said to hit, with room for the roundings of
/// a box test: the slack of [`SlabRay`], which has the derivation.
#[inline(always)]
pub(crate) fn band_distance(origin: Vec3, scene_bounds: &Aabb) -> f32 {
    gamma(24) * scene_bounds.reach_from(origin) + f32::MIN_POSITIVE
}

/// A ray made ready for box tests inside one scene.
///
/// The test must visit every box whose triangle may answer: a triangle test in `f32` takes triangles that the exact
/// ray passes at a small distance, the band. So each slab is widened, on both sides, by a slack that covers the band,
/// the rounding of the test itself, and the rounding of the hit's `t`. With `u = 2^-24` and `M` the largest distance
/// along an axis from the origin to a corner of the scene, per axis and in units of length:
/// - 6 u M: the sheared coordinates of a vertex are off by at most 2u|ax| + 4u|az| (`triangle_hit.rs`);
/// - 3 u M: `(plane - origin) * inverse` makes three roundings (Ize 2013, "Robust BVH ray traversal", section 3);
/// - 1 u M: the addition of the slack rounds once;
/// - 10 u M: FAST interpolates `t` from distances that are off by u M each, and every `t` is rounded once more.
///
/// `gamma(24)` exceeds the sum with its second-order terms. Absolute terms, one in units of length and one of `t`, cover
/// underflow.
///
/// A zero direction component has no slack: its sheared coordinates keep their sign exactly, so a triangle beside
/// the ray is refused exactly.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SlabRay {
    pub(crate) origin: [f32; 3],
    /// `1 / d`, with a signed infinity where `d` is 0. NaN where `d` is so small beside the other components that
    /// the quotient overflows: such a slab then decides nothing, because comparisons ignore a NaN.
    pub(crate) inverse: [f32; 3],
    pub(crate) slack: [f32; 3],
    /// 1 where the direction is negative, so that the upper plane is the near one.
    pub(crate) near_side: [usize; 3],
    /// Box distances count in lengths of the scaled direction: multiply a `t` by this.
    pub(crate) time_scale: f32,
}

/// Directions of this length and down to its inverse are not scaled.
const MOST_UNSCALED: f32 = (1u64 << 60) as f32;
const LEAST_UNSCALED: f32 = 1.0 / MOST_UNSCALED;

impl SlabRay {
    pub(crate) fn new(ray: &Ray, scene_bounds: &Aabb) -> Self {
        let magnitude = ray.direction.abs().max_element();
        let scale = if (LEAST_UNSCALED..=MOST_UNSCALED).contains(&magnitude) {
            1.0
        } else {
            scale_by_power_of_two_near(magnitude)
        };
        let slack_distance = band_distance(ray.origin, scene_bounds);
        let axis = |d: f32| {
            let inverse = 1.0 / (d * scale);
            match (d == 0.0, inverse.is_infinite()) {
                (true, _) => (f32::INFINITY.copysign(d), 0.0),
                (false, true) => (f32::NAN, f32::NAN),
                (false, false) => (inverse, slack_distance * inverse.abs() + f32::MIN_POSITIVE),
            }
        };
        let direction = ray.direction.to_array();
        let planes = direction.map(axis);
        Self {
            origin: ray.origin.to_array(),
            inverse: planes.map(|(inverse, _)| inverse),
            slack: planes.map(|(_, slack)| slack),
            near_side: direction.map(|d| usize::from(d.is_sign_negative())),
            time_scale: 1.0 / scale,
        }
    }

    /// Where the ray enters the box given as `[[lower, upper]; 3]`, if it does so within `[t_min, t_max]` (all in
    /// scaled lengths). A NaN from `0 * inf`, an origin exactly in the plane of a slab that it runs along, decides
    /// nothing: each comparison keeps the other operand.
    #[inline(always)]
    pub(crate) fn enter(&self, planes: &[[f32; 2]; 3], t_min: f32, t_max: f32) -> Option<f32> {
        let (mut enter, mut leave) = (t_min, t_max);
        for (axis, pair) in planes.iter().enumerate() {
            // The masks tell the compiler that the index is in range.
            let side = self.near_side[axis] & 1;
            let near = (pair[side] - self.origin[axis]) * self.inverse[axis] - self.slack[axis];
            let far = (pair[side ^ 1] - self.origin[axis]) * self.inverse[axis] + self.slack[axis];
            enter = if near > enter { near } else { enter };
            leave = if far < leave { far } else { leave };
        }
        (enter <= leave).then_some(enter)
    }
}

/// A [`SlabRay`] for rays of which no direction component is zero, or as good as zero, no coordinate beyond 2^60, as nearly all
/// are, and no `t_min` below 0. They need no scaling. A plane is met at `plane * inverse + offset`, fused or not: all these
/// numbers are finite.
///
/// The origin's product, its sum with the slack and the plane's product round once each, before they cancel: `gamma(4)` of the
/// origin covers that.
///
/// The slack lets boxes in that end just behind the origin, as those of a surface do that the ray leaves: see [`BEHIND`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObliqueSlabs {
    pub(crate) origin: Vec4,
    pub(crate) inverse: Vec4,
    /// For near planes: the slab begins no later than this says.
    pub(crate) near_offset: Vec4,
    /// For far planes: the slab ends no earlier.
    pub(crate) far_offset: Vec4,
    /// Bit `i` where the direction is negative along axis `i`, so that the upper plane is the near one.
    pub(crate) negative: u32,
    /// Of the ray; not negative, nor negative zero.
    pub(crate) t_min: f32,
    /// What ends behind the origin is said to end no later than this.
    pub(crate) doubtful_until: f32,
}

/// What ends, along any axis, where `(plane - origin) * inverse` is less than this has no hit at 0 or after: triangles by their test's
/// rule (`triangle_hit.rs`), spheres by themselves. So its boxes need not be visited. No slack is needed: the difference has the
/// right sign, and what is said of a box holds for all that is in it, because all is monotonic in the plane.
///
/// Twice the least float, because a `t` that rounds to 0 may be negative by half of it: the product is off by another half, and three
/// roundings, so a `t` beyond this rounds to a negative number.
pub(crate) const BEHIND: f32 = -f32::from_bits(2);

impl ObliqueSlabs {
    /// `corners` are those of the scene. `None` for other rays, and for those that are not valid.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, [lower, upper]: &[Vec4; 2]) -> Option<Self> {
        const MOST: Vec4 = Vec4::splat(MOST_UNSCALED);
        let (origin, direction) = (ray.origin.extend(0.0), ray.direction.extend(1.0));
        // Of a zero it is infinite.
        let inverse = Vec4::ONE / direction;
        let reach = (*upper - origin).max(origin - *lower);
        // Comparisons with a NaN are false.
        let origin_size = origin.abs();
        let is_oblique = direction.abs().max(inverse.abs()).cmplt(MOST) & reach.max(origin_size).cmplt(MOST);
        if !(is_oblique.all() & (0.0 <= ray.t_min) & (ray.t_min <= ray.t_max)) {
            return None;
        }
        let reach = reach.max(reach.yzzz()).max(reach.zzzz()).xxxx();
        // What waits for the reach comes last.
        let size = inverse.abs();
        let least = Vec4::splat(f32::MIN_POSITIVE);
        let least_slack = (origin_size * gamma(4) + least) * size + least;
        let slack = least_slack + size * gamma(24) * reach;
        let offset = -inverse * origin;
        Some(Self {
            origin,
            inverse,
            near_offset: offset - slack,
            far_offset: offset + slack,
            negative: direction.is_negative_bitmask(),
            // Of two zeros the positive one.
            t_min: ray.t_min + 0.0,
            doubtful_until: 2.0 * slack.max(slack.yzzz()).max(slack.zzzz()).x,
        })
    }
}
