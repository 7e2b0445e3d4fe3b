//! All hits of a ray, page by page; and whether a point is inside of what is closed.

use std::mem::MaybeUninit;

use glam::Vec3;

use super::Scene;
use super::query::{Kernel, complete};
use crate::accel::{Accel, Around, OutOfMemory, SortedHits, Surface};
use crate::geometry::{Hit, PrecisionMode, Ray};

impl Scene {
    /// The hits of a ray in the order in which hits win, from what [`Scene::intersect`] gives on, or from the one on that
    /// follows `after`, which is a hit of the same ray. As many as `hits` has places for are written, and how many is
    /// returned: if fewer, there are no more.
    ///
    /// Each triangle is there once; a sphere where the ray enters and where it leaves it, once where both have one `t`.
    pub fn intersect_all(
        &self,
        ray: &Ray,
        after: Option<&Hit>,
        hits: &mut [MaybeUninit<Hit>],
    ) -> Result<usize, OutOfMemory> {
        if hits.is_empty() || !ray.is_valid() {
            return Ok(0);
        }
        let found = match after {
            None => self.first_hits(ray, hits.len())?,
            Some(after) => self.hits_after(after, ray, hits.len())?,
        };
        for (place, hit) in hits.iter_mut().zip(&found) {
            place.write(complete(*hit));
        }
        Ok(found.len())
    }

    /// Whether a point is inside of what is closed, or on a surface: whether a line from it crosses triangles and spheres an
    /// odd number of times, decided exactly. A point that is not finite is outside.
    pub fn contains_point(&self, point: Vec3) -> Result<bool, OutOfMemory> {
        let mut around = Around::new(point, &self.copies);
        if point.is_finite() {
            self.dispatch(LookAround(&mut around));
        }
        around.into_answer()
    }

    /// Of a valid ray.
    fn first_hits(&self, ray: &Ray, most: usize) -> Result<SortedHits, OutOfMemory> {
        self.dispatch(FirstHits { scene: self, ray, most })
    }

    /// What comes after a hit among those with its `t` only all of these tell: the order may depend on more than ids.
    fn hits_after(&self, after: &Hit, ray: &Ray, most: usize) -> Result<SortedHits, OutOfMemory> {
        let mut ray = *ray;
        let mut found = SortedHits::new();
        if ray.t_min <= after.t {
            if after.t <= ray.t_max {
                found = self.first_hits(&Ray { t_min: after.t, t_max: after.t, ..ray }, usize::MAX)?;
                let ids = (after.geometry_id, after.primitive_id);
                let end = found.iter().position(|hit| hit.primitive.ids() == ids).map_or(0, |at| at + 1);
                found.drain(..end);
                found.truncate(most);
            }
            ray.t_min = after.t.next_up();
        }
        if found.len() < most && ray.is_valid() {
            found.extend(self.first_hits(&ray, most - found.len())?);
        }
        Ok(found)
    }
}

pub(super) struct FirstHits<'a> {
    pub(super) scene: &'a Scene,
    pub(super) ray: &'a Ray,
    pub(super) most: usize,
}

impl Kernel for FirstHits<'_> {
    type Output = Result<SortedHits, OutOfMemory>;

    fn run<A: Accel + Sync, P: PrecisionMode>(self, accel: &A) -> Self::Output {
        accel.all_hits::<P>(self.ray, self.most, &self.scene.copies)
    }
}

pub(super) struct LookAround<'a, 'c>(pub(super) &'a mut Around<'c>);

impl Kernel for LookAround<'_, '_> {
    type Output = ();

    fn run<A: Accel + Sync, P: PrecisionMode>(self, accel: &A) {
        accel.look_around(self.0);
    }
}
