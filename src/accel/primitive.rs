//! What structures hold. All but the wide BVH are generic over it, so that a scene's kernels know only what it has.

use glam::{DVec3, Vec3};

use super::wide_bvh::{ByAxis, Compact, LeafForm, Spheres};
use crate::geometry::{
    Aabb, Crossing, INVALID_ID, Interval, Polygon, PrecisionMode, Ray, Sphere, SpherePart, SphereRay, Triangle,
    TriangleHit, TriangleRay,
};

/// What a hit tells about what it hit.
pub(crate) trait Surface {
    /// `(geometry_id, primitive_id)`.
    fn ids(&self) -> (u32, u32);

    /// At the hit.
    fn normal(&self) -> Vec3;
}

/// A surface where a ray hit it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AnySurface {
    pub(crate) geometry_id: u32,
    pub(crate) primitive_id: u32,
    pub(crate) normal: Vec3,
}

impl Surface for AnySurface {
    #[inline(always)]
    fn ids(&self) -> (u32, u32) {
        (self.geometry_id, self.primitive_id)
    }

    #[inline(always)]
    fn normal(&self) -> Vec3 {
        self.normal
    }
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

impl Part for SpherePart {
    fn below(&self, height: impl Fn(DVec3) -> f64) -> Option<Self> {
        SpherePart::below(self, height)
    }

    fn extent(&self, height: impl Fn(DVec3) -> f64) -> (f64, f64) {
        SpherePart::extent(self, height)
    }

    fn bounds(&self) -> (DVec3, DVec3) {
        SpherePart::bounds(self)
    }
}

/// One of any kind.
#[derive(Clone, Copy, Debug)]
pub(crate) enum AnyPrimitive {
    Triangle(Triangle),
    Sphere(Sphere),
}

/// One thing that a ray can hit.
pub(crate) trait Primitive: Copy + Send + Sync + 'static {
    /// A ray made ready for these.
    type Ray: Copy;
    /// What its hits tell.
    type Surface: Surface;
    /// How the wide BVH stores it, and how where memory counts.
    type Leaves: LeafForm<Primitive = Self>;
    type CompactLeaves: LeafForm<Primitive = Self>;

    /// None at all: what a search begins with.
    const NONE: Self;

    /// Expects a valid ray.
    fn make_ready(ray: &Ray) -> Self::Ray;

    /// The first hit in the closed interval.
    fn hit<P: PrecisionMode>(&self, ray: &Self::Ray, interval: Interval) -> Option<TriangleHit>;

    /// All hits in the closed interval, in their order; those with one `t` are one.
    fn each_hit<P: PrecisionMode>(&self, ray: &Self::Ray, interval: Interval, then: impl FnMut(TriangleHit));

    /// How the half-line from a point along +x crosses it; see [`Crossing`].
    fn crossing(&self, point: [f32; 3]) -> Crossing;

    /// What there is to tell of the hit at `t`.
    fn surface(&self, ray: &Ray, t: f32) -> Self::Surface;

    /// `(geometry_id, primitive_id)`, the order in which equal hits win.
    fn ids(&self) -> (u32, u32);

    /// Whether of the ray's hits on both, at the same `t`, the one on this wins. Any wins over [`Primitive::NONE`].
    #[inline(always)]
    fn precedes<P: PrecisionMode>(&self, other: &Self, _ray: &Self::Ray) -> bool {
        self.ids() < other.ids()
    }

    /// The same one under other ids.
    fn with_ids(self, geometry_id: u32, primitive_id: u32) -> Self;

    /// What two of the same place and size have in common, to the bit.
    type Shape: Ord;

    /// See [`Primitive::Shape`].
    fn shape(&self) -> Self::Shape;

    /// The least box that contains it.
    fn bounds(&self) -> Aabb;

    /// Whether it has a point in the closed box; may say so of one that passes within the rounding of `f64`.
    fn overlaps(&self, lower: DVec3, upper: DVec3) -> bool;

    /// Whether it is a triangle.
    const IS_TRIANGLE: bool;

    /// For what is done with triangles alone.
    fn as_triangle(&self) -> Option<Triangle>;

    /// What planes can leave of it.
    type Part: Part;

    /// All of it.
    fn whole(&self) -> Self::Part;

    /// A plane that it lies in, as a normal of any length but 0, where there is one.
    fn plane_normal(&self) -> Option<DVec3>;
}

impl Primitive for Triangle {
    type Ray = TriangleRay;
    type Surface = Self;
    type Leaves = ByAxis;
    type CompactLeaves = Compact;
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
    fn each_hit<P: PrecisionMode>(&self, ray: &TriangleRay, interval: Interval, then: impl FnMut(TriangleHit)) {
        ray.hit::<P>(self, interval).into_iter().for_each(then);
    }

    fn crossing(&self, point: [f32; 3]) -> Crossing {
        Triangle::crossing(self, point)
    }

    #[inline(always)]
    fn surface(&self, _ray: &Ray, _t: f32) -> Self {
        *self
    }

    #[inline(always)]
    fn ids(&self) -> (u32, u32) {
        (self.geometry_id, self.primitive_id)
    }

    #[inline(always)]
    fn precedes<P: PrecisionMode>(&self, other: &Self, ray: &TriangleRay) -> bool {
        let in_order = Primitive::ids(self) < Primitive::ids(other);
        if P::IS_EXACT && other.geometry_id != INVALID_ID { ray.precedes(self, other, in_order) } else { in_order }
    }

    #[inline(always)]
    fn with_ids(self, geometry_id: u32, primitive_id: u32) -> Self {
        Self { geometry_id, primitive_id, ..self }
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

    const IS_TRIANGLE: bool = true;

    #[inline(always)]
    fn as_triangle(&self) -> Option<Triangle> {
        Some(*self)
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

impl Primitive for Sphere {
    type Ray = SphereRay;
    type Surface = AnySurface;
    type Leaves = Spheres;
    type CompactLeaves = Spheres;
    type Shape = [u32; 4];

    const NONE: Self =
        Self { centre: [f32::NAN; 3], radius: f32::NAN, geometry_id: INVALID_ID, primitive_id: INVALID_ID };

    #[inline(always)]
    fn make_ready(ray: &Ray) -> SphereRay {
        SphereRay::new(ray)
    }

    #[inline(always)]
    fn hit<P: PrecisionMode>(&self, ray: &SphereRay, interval: Interval) -> Option<TriangleHit> {
        Sphere::hit(self, ray, interval)
    }

    #[inline(always)]
    fn each_hit<P: PrecisionMode>(&self, ray: &SphereRay, interval: Interval, then: impl FnMut(TriangleHit)) {
        Sphere::each_hit(self, ray, interval, then);
    }

    fn crossing(&self, point: [f32; 3]) -> Crossing {
        Sphere::crossing(self, point)
    }

    #[inline(always)]
    fn surface(&self, ray: &Ray, t: f32) -> AnySurface {
        AnySurface { geometry_id: self.geometry_id, primitive_id: self.primitive_id, normal: self.normal_at(ray, t) }
    }

    #[inline(always)]
    fn ids(&self) -> (u32, u32) {
        (self.geometry_id, self.primitive_id)
    }

    #[inline(always)]
    fn with_ids(self, geometry_id: u32, primitive_id: u32) -> Self {
        Self { geometry_id, primitive_id, ..self }
    }

    fn shape(&self) -> [u32; 4] {
        let [x, y, z] = self.centre.map(f32::to_bits);
        [x, y, z, self.radius.to_bits()]
    }

    fn bounds(&self) -> Aabb {
        Sphere::bounds(self)
    }

    fn overlaps(&self, lower: DVec3, upper: DVec3) -> bool {
        Sphere::overlaps(self, lower, upper)
    }

    const IS_TRIANGLE: bool = false;

    fn as_triangle(&self) -> Option<Triangle> {
        None
    }

    type Part = SpherePart;

    fn whole(&self) -> SpherePart {
        SpherePart::of(self)
    }

    fn plane_normal(&self) -> Option<DVec3> {
        None
    }
}
