//! What a traversal relies on, checked after every build in debug builds and tests.

use std::collections::HashMap;

use glam::Vec3;

use super::WideBvh;
use super::collapse::{LEAF_COST, NODE_COST};
use super::leaves::LeafForm;
use super::node::Child;
use crate::accel::Primitive;
use crate::accel::bvh::node::MOST_LEVELS;
use crate::geometry::{Aabb, Triangle};
use crate::simd::LANES;

impl<F: LeafForm> WideBvh<F> {
    /// Every box contains what is below it, or part of each triangle and some other leaf the rest; every leaf and node is
    /// reached once, and the stack suffices.
    pub(crate) fn validate(&self) -> Result<(), String> {
        let (mut node_seen, mut leaf_count, mut deepest) = (vec![false; self.nodes.len()], 0, 0);
        let mut pending = vec![(Child::ROOT, self.bounds, 1)];
        let mut cost = 0.0;
        let (mut primitive_count, mut leaves) = (0, Vec::new());
        while let Some((child, bounds, level)) = pending.pop() {
            deepest = deepest.max(level);
            cost += half_area(&bounds) * f64::from(if child.is_leaf() { LEAF_COST } else { NODE_COST });
            if child.is_leaf() {
                leaf_count += 1;
                leaves.push((child, bounds));
                primitive_count += child.triangles().1;
                continue;
            }
            let at = child.node_index();
            let seen = node_seen.get_mut(at).ok_or_else(|| format!("no node {at}"))?;
            if std::mem::replace(seen, true) {
                return Err(format!("node {at} has two parents"));
            }
            let node = &self.nodes[at];
            for slot in 0..LANES {
                let plane = |side: usize| std::array::from_fn::<f32, 3, _>(|axis| node.planes[axis][side][slot]);
                let slot_bounds = Aabb { lower: plane(0).into(), upper: plane(1).into() };
                if slot_bounds == Aabb::EMPTY {
                    continue;
                }
                if !bounds.contains(&slot_bounds) {
                    return Err(format!("node {at} slot {slot}: {slot_bounds:?} is not inside {bounds:?}"));
                }
                pending.push((node.children[slot], slot_bounds, level + 1));
            }
        }
        if let Some(index) = node_seen.iter().position(|seen| !seen) {
            return Err(format!("node {index} is not reached"));
        }
        self.validate_leaves(&leaves)?;
        if primitive_count != self.leaves.primitive_count() {
            return Err(format!("the leaves have {primitive_count} primitives, not {}", self.leaves.primitive_count()));
        }
        if leaf_count != self.leaves.leaf_count() {
            return Err(format!("{leaf_count} leaves are reached, {} are there", self.leaves.leaf_count()));
        }
        // Areas in `f32` round once each.
        let cost = cost / half_area(&self.bounds);
        if (cost - self.sah_cost).abs() > 1e-4 * cost {
            return Err(format!("the tree costs {cost}, {} is stated", self.sah_cost));
        }
        if deepest != self.depth || deepest as usize > MOST_LEVELS {
            return Err(format!("{deepest} levels, {} stated, at most {MOST_LEVELS} allowed", self.depth));
        }
        Ok(())
    }

    /// Whether the leaves that have a primitive contain it together: all of its points that are looked at.
    fn validate_leaves(&self, leaves: &[(Child, Aabb)]) -> Result<(), String> {
        let mut parts = HashMap::<_, (F::Primitive, Vec<Aabb>)>::new();
        for &(child, bounds) in leaves {
            for primitive in self.primitives(child) {
                if !bounds.contains(&primitive.bounds()) {
                    parts.insert(primitive.ids(), (primitive, Vec::new()));
                }
            }
        }
        for &(child, bounds) in leaves {
            for primitive in self.primitives(child) {
                if let Some((_, boxes)) = parts.get_mut(&primitive.ids()) {
                    boxes.push(bounds);
                }
            }
        }
        for (primitive, boxes) in parts.values() {
            let Some(triangle) = primitive.as_triangle() else {
                return Err(format!("{:?} is not inside its leaf's box {boxes:?}", primitive.bounds()));
            };
            let is_covered =
                |&point: &Vec3| boxes.iter().any(|part| part.contains(&Aabb { lower: point, upper: point }));
            if let Some(point) = points_of(&triangle).iter().find(|point| !is_covered(point)) {
                return Err(format!("{point} of {triangle:?} is in none of its leaves' boxes {boxes:?}"));
            }
        }
        Ok(())
    }
}

/// The points that divide the edges and the inside evenly.
fn points_of(triangle: &Triangle) -> Vec<Vec3> {
    const STEPS: u32 = 12;
    let mut points = Vec::new();
    for i in 0..=STEPS {
        for j in 0..=STEPS - i {
            // Rounded once: no box that contains the point itself loses it so.
            let weights = [i, j, STEPS - i - j].map(|weight| f64::from(weight) / f64::from(STEPS));
            let point =
                triangle.axes.map(|row| (0..3).map(|corner| f64::from(row[corner]) * weights[corner]).sum::<f64>());
            points.push(point.map(|coordinate| coordinate as f32).into());
        }
    }
    points
}

fn half_area(bounds: &Aabb) -> f64 {
    let size = bounds.upper.as_dvec3() - bounds.lower.as_dvec3();
    size.x * size.y + size.y * size.z + size.z * size.x
}
