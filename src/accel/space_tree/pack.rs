//! From the builder's branches to the one tree that queries read, in depth-first order.

use super::SpaceTree;
use super::build::{Branch, Split, inner};
use super::node::{MOST_PAIRS, Node, NodePair};
use crate::accel::{BuildContext, BuildFailure, Primitive, PrimitiveSource};
use crate::geometry::Aabb;

pub(super) fn pack<S: PrimitiveSource>(
    branch: Branch,
    bounds: Aabb,
    root_area: f64,
    source: &S,
    context: &BuildContext,
) -> Result<SpaceTree<S::Primitive>, BuildFailure> {
    let mut totals = Totals::default();
    totals.add(&branch);
    if totals.pairs > MOST_PAIRS {
        return Err(BuildFailure::TooManyTriangles { count: totals.listed, limit: MOST_PAIRS });
    }
    let mut tree = SpaceTree {
        bounds,
        root: Node::EMPTY_LEAF,
        pairs: context.reserve(totals.pairs)?,
        planes: context.reserve(totals.planes)?,
        lists: context.reserve(totals.listed)?,
        primitives: Vec::new(),
        depth: 0,
        sah_cost: 0.0,
    };
    tree.root = tree.append(branch, context);
    tree.sah_cost /= root_area;
    tree.store_primitives(source, context)?;
    #[cfg(any(test, debug_assertions))]
    tree.validate_lists().expect("a builder keeps the tree's invariants");
    Ok(tree)
}

/// The primitive of that number among those of all geometries.
pub(in crate::accel) fn numbered<S: PrimitiveSource>(source: &S, number: u32) -> S::Primitive {
    let starts = source.starts();
    let geometry_id = starts.partition_point(|&start| start <= number) - 1;
    source.primitive(geometry_id as u32, number - starts[geometry_id])
}

/// What a tree is to have room for.
#[derive(Default)]
struct Totals {
    pairs: usize,
    planes: usize,
    listed: usize,
}

impl Totals {
    fn add(&mut self, branch: &Branch) {
        match branch {
            Branch::Subtree(subtree) => {
                self.pairs += subtree.pairs.len();
                self.planes += subtree.planes.len();
                self.listed += subtree.lists.len();
            }
            Branch::Node { split, children, .. } => {
                self.pairs += 1;
                self.planes += usize::from(matches!(split, Split::Any(_)));
                children.iter().for_each(|child| self.add(child));
            }
        }
    }
}

impl<T: Primitive> SpaceTree<T> {
    /// In depth-first order. Returns the branch's root.
    fn append(&mut self, branch: Branch, context: &BuildContext) -> Node {
        match branch {
            Branch::Subtree(subtree) => {
                let (pairs, planes, listed) = (self.pairs.len(), self.planes.len(), self.lists.len());
                let after = |node: Node| node.after(pairs, planes, listed);
                self.pairs.extend(subtree.pairs.iter().map(|pair| NodePair { children: pair.children.map(after) }));
                self.planes.extend_from_slice(&subtree.planes);
                self.lists.extend_from_slice(&subtree.lists);
                self.depth = self.depth.max(subtree.depth as u32);
                self.sah_cost += subtree.cost;
                context.release(subtree.pairs);
                context.release(subtree.planes);
                context.release(subtree.lists);
                after(subtree.root)
            }
            Branch::Node { split, cost, children } => {
                let pair = self.pairs.len();
                self.pairs.push(NodePair::EMPTY);
                let node = inner(&split, pair, &mut self.planes);
                self.sah_cost += cost;
                let children = children.map(|child| self.append(child, context));
                self.pairs[pair] = NodePair { children };
                node
            }
        }
    }

    /// Those that the lists name, in the order in which they are first named; then the lists speak of places.
    fn store_primitives<S: PrimitiveSource<Primitive = T>>(
        &mut self,
        source: &S,
        context: &BuildContext,
    ) -> Result<(), BuildFailure> {
        const NOWHERE: u32 = u32::MAX;
        let all = source.starts().last().map_or(0, |&all| all as usize);
        let mut places = context.filled(all, NOWHERE)?;
        let mut numbers = context.reserve(all.min(self.lists.len()))?;
        for number in &mut self.lists {
            let place = &mut places[*number as usize];
            if *place == NOWHERE {
                *place = numbers.len() as u32;
                numbers.push(*number);
            }
            *number = *place;
        }
        context.release(places);
        self.primitives = context.reserve(numbers.len())?;
        let primitive = |(): &mut (), at: u32| numbered(source, numbers[at as usize]);
        context.collect_with(&mut self.primitives, numbers.len() as u32, |_| (), primitive);
        context.release(numbers);
        Ok(())
    }
}
