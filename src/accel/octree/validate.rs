//! What a traversal relies on, checked after every build in debug builds and tests.

use super::Octree;
use super::node::MOST_LEVELS;
use crate::accel::Primitive;

impl<T: Primitive> Octree<T> {
    /// Every list is in its place, no node is in two places, the stack suffices, and every primitive is listed in each
    /// leaf that it overlaps.
    pub(crate) fn validate(&self) -> Result<(), String> {
        let mut leaves = Vec::new();
        let mut is_seen = vec![false; self.nodes.len()];
        let mut deepest = 0;
        let mut pending = vec![(0, self.cube.whole(), 1, (0..self.primitives.len() as u32).collect::<Vec<u32>>())];
        while let Some((number, cell, level, overlapping)) = pending.pop() {
            deepest = deepest.max(level);
            let node = self.nodes.get(number as usize).ok_or_else(|| format!("no node {number}"))?;
            if std::mem::replace(&mut is_seen[number as usize], true) {
                return Err(format!("node {number} is in two places"));
            }
            let overlapping: Vec<u32> = overlapping
                .into_iter()
                .filter(|&number| self.cube.overlaps(&cell, &self.primitives[number as usize]))
                .collect();
            if !node.is_leaf() {
                if node.child_count() == 0 {
                    return Err(format!("node {number} has no child"));
                }
                for octant in 0..8 {
                    if node.has_child(octant) {
                        pending.push((node.child(octant), cell.octant(octant), level + 1, overlapping.clone()));
                    } else {
                        let octant = cell.octant(octant);
                        let is_empty = |&number: &u32| !self.cube.overlaps(&octant, &self.primitives[number as usize]);
                        if !overlapping.iter().all(is_empty) {
                            return Err(format!("node {number} misses a child"));
                        }
                    }
                }
                continue;
            }
            let list = self.listed.get(node.first as usize..node.first as usize + node.count());
            let list = list.ok_or_else(|| format!("the list of node {number} ends outside of all"))?;
            if let Some(missing) = overlapping.iter().find(|number| list.binary_search(number).is_err()) {
                return Err(format!("primitive {missing} is not listed in leaf {number}"));
            }
            leaves.push(number);
        }
        if leaves.len() != self.leaf_count || is_seen.contains(&false) {
            return Err(format!("{} leaves, {} stated; or a node is in no place", leaves.len(), self.leaf_count));
        }
        if deepest != self.depth || deepest as usize > MOST_LEVELS {
            return Err(format!("{deepest} levels, {} stated, at most {MOST_LEVELS} allowed", self.depth));
        }
        Ok(())
    }
}
