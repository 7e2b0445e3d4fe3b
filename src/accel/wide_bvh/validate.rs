//! What a traversal relies on, checked after every build in debug builds and tests.

use super::WideBvh;
use super::collapse::{LEAF_COST, NODE_COST};
use super::leaves::LeafForm;
use super::node::Child;
use crate::accel::Primitive;
use crate::accel::bvh::node::MOST_LEVELS;
use crate::geometry::Aabb;
use crate::simd::LANES;

impl<F: LeafForm> WideBvh<F> {
    /// Every box contains what is below it, every leaf and node is reached once, and the stack suffices.
    pub(crate) fn validate(&self) -> Result<(), String> {
        let (mut node_seen, mut leaf_count, mut deepest) = (vec![false; self.nodes.len()], 0, 0);
        let mut pending = vec![(self.root, self.bounds, 1)];
        let mut cost = 0.0;
        while let Some((child, bounds, level)) = pending.pop() {
            deepest = deepest.max(level);
            cost += half_area(&bounds) * f64::from(if child.is_leaf() { LEAF_COST } else { NODE_COST });
            if child.is_leaf() {
                leaf_count += 1;
                self.validate_leaf(child, &bounds)?;
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

    fn validate_leaf(&self, child: Child, bounds: &Aabb) -> Result<(), String> {
        for lane in 0..child.triangles().1 {
            let inside = self.leaves.primitive(child.triangles(), lane).bounds();
            if !bounds.contains(&inside) {
                return Err(format!("primitive {lane} of leaf {child:?}: {inside:?} is not inside {bounds:?}"));
            }
        }
        Ok(())
    }
}

fn half_area(bounds: &Aabb) -> f64 {
    let size = bounds.upper.as_dvec3() - bounds.lower.as_dvec3();
    size.x * size.y + size.y * size.z + size.z * size.x
}
