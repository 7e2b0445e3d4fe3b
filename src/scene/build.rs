//! Building a scene: options checked, triangles and spheres gathered, a structure built for each.

use std::sync::Arc;
use std::time::Instant;

use arrayvec::ArrayVec;

use super::builder::Geometry;
use super::flatten::{Balls, Flat, Meshes, flatten};
use super::{BuildError, BuildOptions, Content, Scene, threads};
use crate::accel::{
    self, AnyAccel, BuildContext, Copies, Places, Plan, PrimitiveSource, Shape, Stats, Structure, Watch,
};
use crate::simd::Isa;

pub(super) fn build(geometries: &[Arc<Geometry>], options: &BuildOptions, watch: &Watch) -> Result<Scene, BuildError> {
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
    let (meshes, balls) = (Meshes::new(geometries)?, Balls::new(geometries)?);
    let of_meshes = flatten(&meshes, options.invalid_triangles, context)?;
    let of_balls = balls.flatten(options.invalid_triangles, context)?;
    let bounds = of_meshes.bounds.union(of_balls.bounds);
    let (skipped_triangles, skipped_spheres) = (of_meshes.skipped_count, of_balls.skipped_count);
    let (has_triangles, has_spheres) = (!of_meshes.references.is_empty(), !of_balls.references.is_empty());
    let structure = accel::choose(options.structure, of_meshes.references.len() + of_balls.references.len());
    let plan = Plan {
        structure,
        quality: options.quality,
        is_compact: options.is_compact,
        grid_cells_per_triangle: options.grid_cells_per_triangle,
    };
    let mut shapes = ArrayVec::<Shape, 2>::new();
    let content = if has_spheres && has_triangles {
        let triangles = build_part(plan, of_meshes, &meshes, context, &mut shapes)?;
        let spheres = build_part(plan, of_balls, &balls, context, &mut shapes)?;
        Content::Both(Box::new((triangles, spheres)))
    } else if has_spheres {
        Content::Spheres(build_part(plan, of_balls, &balls, context, &mut shapes)?)
    } else {
        Content::Triangles(build_part(plan, of_meshes, &meshes, context, &mut shapes)?)
    };
    let copies = Copies::new(context.take_copies()?, context)?;
    let total = |of: fn(&Shape) -> usize| shapes.iter().map(of).sum::<usize>() as u64;
    // Only the wide BVH has kernels beyond the scalar one.
    let isa = if structure == Structure::WideBvh { options.isa } else { Isa::Scalar }.resolve();
    let (node_bytes, leaf_bytes) = (total(|shape| shape.node_bytes), total(|shape| shape.leaf_bytes));
    let stats = Stats {
        triangle_count: (meshes.triangle_count() - skipped_triangles) as u64,
        node_count: total(|shape| shape.node_count),
        leaf_count: total(|shape| shape.leaf_count),
        reference_count: total(|shape| shape.reference_count),
        skipped_count: (skipped_triangles + skipped_spheres) as u64,
        depth: shapes.iter().map(|shape| shape.depth).max().unwrap_or(0),
        structure,
        precision: options.precision,
        isa: isa.into(),
        bytes: node_bytes + leaf_bytes + (copies.bytes() + size_of::<Scene>()) as u64,
        node_bytes,
        leaf_bytes,
        peak_build_bytes: context.peak_bytes() as u64,
        build_seconds: start.elapsed().as_secs_f64(),
        sah_cost: shapes.iter().map(|shape| shape.sah_cost).sum(),
        sphere_count: (balls.count() - skipped_spheres) as u64,
    };
    let (triangle_places, sphere_places) = (Places::default(), Places::default());
    Ok(Scene { content, copies, precision: options.precision, isa, bounds, stats, triangle_places, sphere_places })
}

/// One kind's structure; its shape is appended to `shapes`.
fn build_part<S: PrimitiveSource>(
    plan: Plan,
    Flat { references, bounds, .. }: Flat,
    source: &S,
    context: &BuildContext,
    shapes: &mut ArrayVec<Shape, 2>,
) -> Result<AnyAccel<S::Primitive>, BuildError> {
    let accel = accel::build(plan, references, bounds, source, context)?;
    shapes.push(accel.shape());
    Ok(accel)
}
