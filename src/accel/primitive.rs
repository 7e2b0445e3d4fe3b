//! What structures hold. All but the wide BVH are generic over it, so that a scene's kernels know only what it has.

use glam::{DVec3, Vec3};

use crate::geometry::{Aabb, INVALID_ID, Interval, PrecisionMode, Ray, Triangle, TriangleHit, TriangleRay};

/// What a hit tells about what it hit.
pub(crate) trait Surface {
    /// `(geometry_id, primitive_id)`.
    fn ids(&self) -> (u32, u32);

    /// At the hit.
    fn normal(&self) -> Vec3;
}

impl Surface for Triangle {
    #[inline(always)]
    fn ids(&self) -> (u32, u32) {
        (self.geometry_id, self.primitive_id)
    }

    #[inline(always)]
    fn normal(&self) -> Vec3 {
        Triangle::normal(self)
    }
}

/// One thing that a ray can hit.
pub(crate) trait Primitive: Copy + Send + Sync + 'static {
    /// A ray made ready for these.
    type Ray: Copy;

    /// None at all: what a search begins with.
    const NONE: Self;

    /// Expects a valid ray.
    fn make_ready(ray: &Ray) -> Self::Ray;

    /// The first hit in the closed interval.
    fn hit<P: PrecisionMode>(&self, ray: &Self::Ray, interval: Interval) -> Option<TriangleHit>;

    /// `(geometry_id, primitive_id)`, the order in which equal hits win.
    fn ids(&self) -> (u32, u32);

    /// What two of the same place and size have in common, to the bit.
    type Shape: Ord;

    /// See [`Primitive::Shape`].
    fn shape(&self) -> Self::Shape;

    /// The least box that contains it.
    fn bounds(&self) -> Aabb;

    /// Whether it has a point in the closed box; may say so of one that passes within the rounding of `f64`.
    fn overlaps(&self, lower: DVec3, upper: DVec3) -> bool;
}

impl Primitive for Triangle {
    type Ray = TriangleRay;
    type Shape = [[u32; 3]; 3];

    const NONE: Self = Self { axes: [[f32::NAN; 3]; 3], geometry_id: INVALID_ID, primitive_id: INVALID_ID };

    #[inline(always)]
    fn make_ready(ray: &Ray) -> TriangleRay {
        TriangleRay::new(ray)
    }

    #[inline(always)]
    fn hit<P: PrecisionMode>(&self, ray: &TriangleRay, interval: Interval) -> Option<TriangleHit> {
        ray.hit::<P>(self, interval)
    }

    #[inline(always)]
    fn ids(&self) -> (u32, u32) {
        (self.geometry_id, self.primitive_id)
    }

    fn shape(&self) -> Self::Shape {
        self.axes.map(|row| row.map(f32::to_bits))
    }

    fn bounds(&self) -> Aabb {
        Triangle::bounds(self)
    }

    #[inline(always)]
    fn overlaps(&self, lower: DVec3, upper: DVec3) -> bool {
        Triangle::overlaps(self, lower, upper)
    }
}
