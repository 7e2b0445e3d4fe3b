//! What closed surfaces a point is inside of: which primitives the half-line from it along x crosses.

use glam::Vec3;

use super::copies::{Copies, Ids};
use super::leaf::{Kept, Query};
use super::out_of_memory::OutOfMemory;
use super::primitive::Primitive;
use crate::geometry::{Crossing, PrecisionMode, Ray};

/// Decides about each primitive that a walk comes by: [`Crossing`] says how, and why the walk along [`Around::ray`]
/// comes by all that matter.
pub(crate) struct Around<'a> {
    point: [f32; 3],
    copies: &'a Copies,
    /// Those that the half-line crosses once; some maybe more than once.
    crossed: Vec<Ids>,
    is_on_surface: bool,
    out_of_memory: Option<OutOfMemory>,
}

impl<'a> Around<'a> {
    /// Expects finite coordinates.
    pub(crate) fn new(point: Vec3, copies: &'a Copies) -> Self {
        Self { point: point.to_array(), copies, crossed: Vec::new(), is_on_surface: false, out_of_memory: None }
    }

    pub(super) fn point(&self) -> [f32; 3] {
        self.point
    }

    /// The half-line.
    pub(super) fn ray(&self) -> Ray {
        Ray { origin: self.point.into(), t_min: 0.0, direction: Vec3::X, t_max: f32::INFINITY }
    }

    /// Whether the point is inside, by parity, or on a surface.
    pub(crate) fn into_answer(mut self) -> Result<bool, OutOfMemory> {
        if let Some(failure) = self.out_of_memory {
            return Err(failure);
        }
        self.crossed.sort_unstable();
        self.crossed.dedup();
        Ok(self.is_on_surface || self.crossed.len() % 2 == 1)
    }
}

impl<T: Primitive> Kept<T> for &mut Around<'_> {
    type Seed = Self;

    fn begin(seed: Self, _ray: &Ray) -> Self {
        seed
    }

    #[inline(always)]
    fn t_max(&self) -> f32 {
        f32::INFINITY
    }

    fn test<Q: Query, P: PrecisionMode>(&mut self, primitive: &T, _ray: &T::Ray, _t_min: f32) -> bool {
        match primitive.crossing(self.point) {
            Crossing::None => {}
            Crossing::AtPoint => self.is_on_surface = true,
            Crossing::Once => {
                let stored = primitive.ids();
                for ids in std::iter::once(stored).chain(self.copies.of(stored)) {
                    if self.crossed.try_reserve(1).is_err() {
                        self.out_of_memory =
                            Some(OutOfMemory { bytes: (self.crossed.len() + 1) * size_of::<(u32, u32)>() });
                        break;
                    }
                    self.crossed.push(ids);
                }
            }
        }
        self.is_on_surface || self.out_of_memory.is_some()
    }

    fn found(self) -> Option<Self> {
        Some(self)
    }
}
