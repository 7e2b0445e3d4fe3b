//! What a traversal relies on, checked after every build in debug builds and tests.

use glam::DVec3;

use super::SpaceTree;
use super::node::{MOST_LEVELS, Node};
use crate::accel::{Part, Primitive};

/// What of each primitive is in a cell.
type Parts<T> = Vec<(usize, <T as Primitive>::Part)>;

impl<T: Primitive> SpaceTree<T> {
    /// The lists are in range, every primitive is in one, and the stack suffices.
    pub(super) fn validate_lists(&self) -> Result<(), String> {
        let mut is_seen = vec![false; self.primitives.len()];
        let (mut deepest, mut leaf_count) = (0, 0);
        let mut pending = vec![(self.root, 1)];
        while let Some((node, level)) = pending.pop() {
            deepest = deepest.max(level);
            if !node.is_leaf() {
                let pair = self.pairs.get(node.pair()).ok_or_else(|| format!("no pair {}", node.pair()))?;
                pending.extend(pair.children.map(|child| (child, level + 1)));
                continue;
            }
            leaf_count += 1;
            let list = self.lists.get(node.list()).ok_or_else(|| format!("no list {:?}", node.list()))?;
            for &index in list {
                *is_seen.get_mut(index as usize).ok_or_else(|| format!("no primitive {index}"))? = true;
            }
        }
        if let Some(index) = is_seen.iter().position(|seen| !seen) {
            return Err(format!("primitive {index} is in no leaf"));
        }
        if deepest != self.depth || deepest as usize > MOST_LEVELS || leaf_count != self.pairs.len() + 1 {
            return Err(format!("{deepest} levels, {} stated; {leaf_count} leaves", self.depth));
        }
        Ok(())
    }

    /// Every primitive, or the one that wins over it, is in each leaf whose cell it reaches into further than by `reach`
    /// along an axis. `plane` has an inner node's normal and distance.
    pub(in crate::accel) fn validate(&self, reach: f64, plane: impl Fn(Node) -> (DVec3, f64)) -> Result<(), String> {
        let whole = self.primitives.iter().enumerate().map(|(index, primitive)| (index, primitive.whole())).collect();
        let mut pending: Vec<(Node, Parts<T>)> = vec![(self.root, whole)];
        while let Some((node, parts)) = pending.pop() {
            if node.is_leaf() {
                let list = &self.lists[node.list()];
                let mut sorted = list.to_vec();
                sorted.sort_unstable();
                for (index, _) in parts {
                    if sorted.binary_search(&(index as u32)).is_ok() {
                        continue;
                    }
                    let primitive = &self.primitives[index];
                    let stands_for = |other: &T| other.shape() == primitive.shape() && other.ids() <= primitive.ids();
                    if !list.iter().any(|&listed| stands_for(&self.primitives[listed as usize])) {
                        return Err(format!("primitive {index} is not in the list {:?} of a leaf", node.list()));
                    }
                }
                continue;
            }
            let (normal, distance) = plane(node);
            let reach = reach * normal.abs().element_sum();
            let within = |sign: f64| {
                let height = move |point: DVec3| sign * (normal.dot(point) - distance) + reach;
                let cut = |(index, part): &(usize, T::Part)| {
                    let part = part.below(height)?;
                    // One of too many corners is not cut: what it says of the cells from here on may be too much.
                    (part.extent(height).1 < 0.5 * reach).then_some((*index, part))
                };
                parts.iter().filter_map(cut).collect::<Vec<_>>()
            };
            let (below, above) = (within(1.0), within(-1.0));
            let [left, right] = self.pairs[node.pair()].children;
            pending.push((left, below));
            pending.push((right, above));
        }
        Ok(())
    }
}
