//! Building a scene: options checked, triangles gathered, one structure built.

use std::sync::Arc;
use std::time::Instant;

use super::builder::Geometry;
use super::flatten::{Flat, Meshes, flatten};
use super::{BuildError, BuildOptions, Scene, threads};
use crate::accel::{self, BuildContext, Plan, Precision, Stats, Structure, Watch};
use crate::simd::Isa;

pub(super) fn build(geometries: &[Arc<Geometry>], options: &BuildOptions, watch: &Watch) -> Result<Scene, BuildError> {
    let precision = (options.precision == Precision::Exact).then_some("GNOMON_PRECISION_EXACT");
    if let Some(what) = accel::unsupported(options.structure).or(precision) {
        return Err(BuildError::Unsupported(what));
    }
    let own_pool;
    let pool = match options.thread_count {
        0 => threads::shared_pool(),
        1 => None,
        count => {
            own_pool = threads::new_pool(count)?;
            Some(&own_pool)
        }
    };
    let limit = usize::try_from(options.memory_limit_bytes).ok().filter(|&limit| limit != 0);
    let context = BuildContext::new(pool, limit, options.isa, watch);
    context.install(|| build_with(geometries, options, &context))
}

fn build_with(
    geometries: &[Arc<Geometry>],
    options: &BuildOptions,
    context: &BuildContext,
) -> Result<Scene, BuildError> {
    let start = Instant::now();
    let meshes = Meshes::new(geometries)?;
    let Flat { references, bounds, skipped_count } = flatten(&meshes, options.invalid_triangles, context)?;
    let structure = accel::choose(options.structure, references.len());
    let plan = Plan {
        structure,
        quality: options.quality,
        is_compact: options.is_compact,
        grid_cells_per_triangle: options.grid_cells_per_triangle,
    };
    let accel = accel::build(plan, references, bounds, &meshes, context)?;
    let shape = accel.shape();
    // Only the wide BVH has kernels beyond the scalar one.
    let isa = if structure == Structure::WideBvh { options.isa } else { Isa::Scalar }.resolve();
    let stats = Stats {
        triangle_count: (meshes.triangle_count() - skipped_count) as u64,
        node_count: shape.node_count as u64,
        leaf_count: shape.leaf_count as u64,
        reference_count: shape.reference_count as u64,
        skipped_count: skipped_count as u64,
        depth: shape.depth,
        structure,
        precision: options.precision,
        isa: isa.into(),
        bytes: (shape.node_bytes + shape.leaf_bytes + size_of::<Scene>()) as u64,
        node_bytes: shape.node_bytes as u64,
        leaf_bytes: shape.leaf_bytes as u64,
        peak_build_bytes: context.peak_bytes() as u64,
        build_seconds: start.elapsed().as_secs_f64(),
        sah_cost: shape.sah_cost,
    };
    Ok(Scene { accel, precision: options.precision, isa, bounds, stats })
}
