//! What structures hold. All but the wide BVH are generic over it, so that a scene's kernels know only what it has.

use glam::{DVec3, Vec3};

use crate::geometry::{Aabb, INVALID_ID, Interval, Polygon, PrecisionMode, Ray, Triangle, TriangleHit, TriangleRay};

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

/// What planes leave of a primitive, or a little more than that. Heights are affine functions, and computed in `f64`.
pub(crate) trait Part: Copy + Send + Sync {
    /// Where `height` is not positive; `None` where there is no point of it.
    fn below(&self, height: impl Fn(DVec3) -> f64) -> Option<Self>;

    /// The least and the greatest height.
    fn extent(&self, height: impl Fn(DVec3) -> f64) -> (f64, f64);

    /// The least and the greatest coordinates.
    fn bounds(&self) -> (DVec3, DVec3);
}

impl Part for Polygon {
    #[inline(always)]
    fn below(&self, height: impl Fn(DVec3) -> f64) -> Option<Self> {
        Polygon::below(self, height)
    }

    #[inline(always)]
    fn extent(&self, height: impl Fn(DVec3) -> f64) -> (f64, f64) {
        Polygon::extent(self, height)
    }

    #[inline(always)]
    fn bounds(&self) -> (DVec3, DVec3) {
        Polygon::bounds(self)
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

    /// What planes can leave of it.
    type Part: Part;

    /// All of it.
    fn whole(&self) -> Self::Part;

    /// A plane that it lies in, as a normal of any length but 0, where there is one.
    fn plane_normal(&self) -> Option<DVec3>;
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

    type Part = Polygon;

    #[inline(always)]
    fn whole(&self) -> Polygon {
        Polygon::of(self)
    }

    fn plane_normal(&self) -> Option<DVec3> {
        let normal = self.whole().doubled_area();
        (normal != DVec3::ZERO).then_some(normal)
    }
}
