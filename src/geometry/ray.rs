//! A ray, and what it hits.

use glam::{Vec3, Vec4};

/// The id of what is not there: a miss's geometry, an instance where none is involved.
pub const INVALID_ID: u32 = u32::MAX;

/// `origin + t * direction` for `t` in `[t_min, t_max]`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Where `t` is 0.
    pub origin: Vec3,
    /// The least `t` that counts; may be negative or `-inf`.
    pub t_min: f32,
    /// Need not be of unit length: `t` counts in its lengths.
    pub direction: Vec3,
    /// The largest `t` that counts; may be `+inf`.
    pub t_max: f32,
}

impl Ray {
    /// The ray, if it [is valid](Self::is_valid).
    #[inline(always)]
    pub(crate) fn valid(source: impl Into<Self>) -> Option<Self> {
        Some(source.into()).filter(Self::is_valid)
    }

    /// Whether the ray can hit anything: finite origin and direction, a direction that is not zero, an interval that
    /// is not empty. A NaN anywhere makes it false.
    #[inline]
    pub fn is_valid(&self) -> bool {
        // Of what is not finite this makes a NaN.
        let (origin, direction) = (self.origin.extend(0.0), self.direction.extend(0.0));
        let is_finite = (origin * 0.0 + direction * 0.0).cmpeq(Vec4::ZERO).all();
        is_finite & direction.cmpne(Vec4::ZERO).any() & (self.t_min <= self.t_max)
    }
}

impl From<&Self> for Ray {
    fn from(ray: &Self) -> Self {
        *ray
    }
}

/// The closest hit of a ray, or its absence.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Hit {
    /// Distance along the ray in lengths of its direction; `+inf` for a miss.
    pub t: f32,
    /// Weight of the second vertex: the hit point is `(1 - u - v) * p0 + u * p1 + v * p2`. 0 for a sphere.
    pub u: f32,
    /// Weight of the third vertex. 0 for a sphere.
    pub v: f32,
    /// `(p1 - p0) x (p2 - p0)`, not normalised; each component rounded once from `f64`. Of a sphere from the centre to the
    /// hit.
    pub normal: Vec3,
    /// The triangle's or sphere's index within its geometry; [`INVALID_ID`] for a miss.
    pub primitive_id: u32,
    /// [`INVALID_ID`] for a miss.
    pub geometry_id: u32,
    /// [`INVALID_ID`] where no instance is involved.
    pub instance_id: u32,
}

impl Hit {
    /// No hit.
    pub const MISS: Self = Self {
        t: f32::INFINITY,
        u: 0.0,
        v: 0.0,
        normal: Vec3::ZERO,
        primitive_id: INVALID_ID,
        geometry_id: INVALID_ID,
        instance_id: INVALID_ID,
    };

    /// Whether it is one.
    pub fn is_hit(&self) -> bool {
        self.geometry_id != INVALID_ID
    }
}
