//! No structure: every triangle is asked. The fastest for a handful, and the answer that the others are held against.

use super::leaf::{ClosestHit, Query, test_triangles};
use super::stats::Shape;
use super::tally::Tally;
use super::{Accel, BuildContext, BuildFailure};
use crate::geometry::{PrecisionMode, Ray, Triangle, TriangleRay};

pub(crate) struct BruteForce {
    triangles: Vec<Triangle>,
}

impl BruteForce {
    pub(crate) fn build(triangles: Vec<Triangle>, context: &BuildContext) -> Result<Self, BuildFailure> {
        context.check()?;
        Ok(Self { triangles })
    }

    pub(crate) fn shape(&self) -> Shape {
        Shape {
            reference_count: self.triangles.len(),
            node_count: 0,
            leaf_count: 0,
            depth: 0,
            node_bytes: 0,
            leaf_bytes: size_of_val(self.triangles.as_slice()),
            sah_cost: self.triangles.len() as f64,
        }
    }
}

impl Accel for BruteForce {
    #[inline(always)]
    fn query<Q: Query, P: PrecisionMode, R>(
        &self,
        ray: impl Into<Ray>,
        then: impl FnOnce(Option<ClosestHit>, Q::Tally) -> R,
    ) -> R {
        // An empty scene answers before the ray is looked at.
        if self.triangles.is_empty() {
            return then(None, Q::Tally::default());
        }
        let Some(ray) = Ray::valid(ray) else { return then(None, Q::Tally::default()) };
        let mut tally = Q::Tally::default();
        tally.test_primitives(self.triangles.len());
        let mut best = ClosestHit::none(&ray);
        test_triangles::<Q, P>(&self.triangles, &TriangleRay::new(&ray), ray.t_min, &mut best);
        then(best.found(), tally)
    }
}
