//! What a traversal relies on, checked after every build in debug builds and tests.

use std::collections::HashMap;

use super::Bvh;
use super::node::{MOST_LEVELS, Node};
use crate::accel::Primitive;
use crate::geometry::Aabb;

impl<T: Primitive> Bvh<T> {
    /// Every box contains what is below it, the leaves that have a primitive contain it together, every place is in one
    /// leaf, and the stack suffices.
    pub(crate) fn validate(&self) -> Result<(), String> {
        let mut is_seen = vec![false; self.primitives.len()];
        let mut covers = HashMap::<_, Aabb>::new();
        let mut deepest = 0;
        let mut pending = vec![(self.root, self.bounds, 1)];
        while let Some((node, parent, level)) = pending.pop() {
            deepest = deepest.max(level);
            let bounds = bounds_of(&node);
            if !parent.contains(&bounds) {
                return Err(format!("the box {bounds:?} is not inside its parent's {parent:?}"));
            }
            if !node.is_leaf() {
                let pair = self.pairs.get(node.first as usize).ok_or_else(|| format!("no pair {}", node.first))?;
                pending.extend(pair.children.map(|child| (child, bounds, level + 1)));
                continue;
            }
            for index in node.first..node.first + node.count {
                let primitive = self.primitives.get(index as usize).ok_or_else(|| format!("no primitive {index}"))?;
                let cover = covers.entry(primitive.ids()).or_insert(Aabb::EMPTY);
                *cover = cover.union(bounds);
                if std::mem::replace(&mut is_seen[index as usize], true) {
                    return Err(format!("primitive {index} is in two leaves"));
                }
            }
        }
        if let Some(index) = is_seen.iter().position(|seen| !seen) {
            return Err(format!("primitive {index} is in no leaf"));
        }
        for primitive in &self.primitives {
            let cover = covers[&primitive.ids()];
            if !cover.contains(&primitive.bounds()) {
                return Err(format!("primitive {:?} is not inside its leaves' boxes {cover:?}", primitive.ids()));
            }
        }
        if deepest != self.depth || deepest as usize > MOST_LEVELS {
            return Err(format!("{deepest} levels, {} stated, at most {MOST_LEVELS} allowed", self.depth));
        }
        Ok(())
    }
}

fn bounds_of(node: &Node) -> Aabb {
    Aabb { lower: node.planes.map(|[lower, _]| lower).into(), upper: node.planes.map(|[_, upper]| upper).into() }
}
