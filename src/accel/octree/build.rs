//! Building top down: large cells are cut by all threads, what lies below them grows on one each.

use super::cell::{Cube, Cut};
use super::node::Node;
use super::subtree::{Grower, Part, Subtree, octants_with_any};
use super::{Octree, StopRule};
use crate::accel::{BuildContext, BuildFailure, Primitive};
use crate::geometry::Aabb;

/// Smaller trees grow on one thread without a look at the watch.
const MOST_IN_SUBTREE: usize = 4096;

enum Branch {
    Subtree(Subtree),
    Node { children: Vec<Branch>, octants: u8, cost: f64 },
}

pub(super) fn build<T: Primitive>(
    primitives: Vec<T>,
    bounds: Aabb,
    rule: StopRule,
    context: &BuildContext,
) -> Result<Octree<T>, BuildFailure> {
    let count = primitives.len();
    let cube = Cube::around(&bounds);
    let mut all = context.reserve(count)?;
    all.extend(0..count as u32);
    let builder = Builder { primitives: &primitives, cube: &cube, rule, context };
    let branch = builder.build(all, Part { cell: cube.whole(), level: 1, growth: 1.0 })?;

    let (node_count, listed_count) = branch.lengths();
    if listed_count.max(node_count) > u32::MAX as usize {
        return Err(BuildFailure::TooManyTriangles { count: listed_count.max(node_count), limit: u32::MAX as usize });
    }
    let (nodes, listed) = (context.reserve(node_count)?, context.reserve(listed_count)?);
    let mut whole = Subtree { nodes, listed, ..Subtree::default() };
    whole.nodes.push(Node::EMPTY);
    whole.append(0, branch, context);
    let Subtree { nodes, listed, leaf_count, depth, cost } = whole;
    let extent = bounds.upper.as_dvec3() - bounds.lower.as_dvec3();
    let area = 2.0 * (extent.x * extent.y + extent.y * extent.z + extent.z * extent.x);
    let depth = depth as u32;
    Ok(Octree { bounds, cube, nodes, listed, primitives, leaf_count, depth, sah_cost: 2.0 * cost / area })
}

struct Builder<'a, T> {
    primitives: &'a [T],
    cube: &'a Cube,
    rule: StopRule,
    context: &'a BuildContext<'a>,
}

impl<T: Primitive> Builder<'_, T> {
    fn build(&self, list: Vec<u32>, part: Part) -> Result<Branch, BuildFailure> {
        let Self { primitives, cube, rule, context } = *self;
        context.check()?;
        let count = list.len();
        if count > MOST_IN_SUBTREE && part.can_be_cut(count, rule) {
            let cut = Cut::new(cube, &part.cell);
            let mut masks: Vec<u8> = context.reserve(count)?;
            let octants_of = |index: u32| cut.octants_of(&primitives[list[index as usize] as usize]);
            context.collect_with(&mut masks, count as u32, |_| (), |(), index| octants_of(index));
            let sum = |a: [usize; 8], b: [usize; 8]| std::array::from_fn(|octant| a[octant] + b[octant]);
            let counts = context.reduce_chunks(&masks, count_octants, sum).unwrap_or_default();
            if part.is_worth_cutting(count, &counts, rule) {
                return self.build_children(list, masks, counts, part);
            }
            context.release(masks);
        }
        let part_of_all = count as f64 / part.growth;
        let subtree = if count > MOST_IN_SUBTREE {
            Grower::new(primitives, cube, StopRule { most_in_leaf: usize::MAX, ..rule }, context).grow(&list, part)?
        } else {
            Grower::new(primitives, cube, rule, context).grow(&list, part)?
        };
        context.release(list);
        context.advance(part_of_all as usize)?;
        Ok(Branch::Subtree(subtree))
    }

    fn build_children(
        &self,
        list: Vec<u32>,
        masks: Vec<u8>,
        counts: [usize; 8],
        part: Part,
    ) -> Result<Branch, BuildFailure> {
        let context = self.context;
        let octants: Vec<usize> = (0..8).filter(|&octant| counts[octant] > 0).collect();
        let lists = context.map_each(octants.clone(), |octant| {
            let mut child: Vec<u32> = context.reserve(counts[octant])?;
            child.extend(
                list.iter().zip(&masks).filter(|&(_, mask)| mask >> octant & 1 != 0).map(|(&number, _)| number),
            );
            Ok(child)
        });
        let lists = lists.into_iter().collect::<Result<Vec<_>, BuildFailure>>()?;
        let count = list.len();
        context.release(list);
        context.release(masks);
        let parts: Vec<(usize, Vec<u32>)> = octants.into_iter().zip(lists).collect();
        let children = context.map_each(parts, |(octant, list)| self.build(list, part.octant(octant, count, &counts)));
        let children = children.into_iter().collect::<Result<Vec<_>, BuildFailure>>()?;
        Ok(Branch::Node { children, octants: octants_with_any(&counts), cost: part.cost(self.rule.node_cost) })
    }
}

fn count_octants(masks: &[u8]) -> [usize; 8] {
    let mut counts = [0; 8];
    for mask in masks {
        for (octant, count) in counts.iter_mut().enumerate() {
            *count += usize::from(mask >> octant & 1);
        }
    }
    counts
}

impl Branch {
    /// Of nodes and of lists, below and in it.
    fn lengths(&self) -> (usize, usize) {
        match self {
            Self::Subtree(subtree) => (subtree.nodes.len(), subtree.listed.len()),
            Self::Node { children, .. } => {
                children.iter().map(Self::lengths).fold((1, 0), |a, b| (a.0 + b.0, a.1 + b.1))
            }
        }
    }
}

impl Subtree {
    /// Puts the branch at a place that waits for it, and what is below it at the end.
    fn append(&mut self, at: usize, branch: Branch, context: &BuildContext) {
        match branch {
            Branch::Subtree(subtree) => {
                // Its root goes elsewhere; the others follow the nodes that are there.
                let (node_base, listed_base) = (self.nodes.len() as u32 - 1, self.listed.len() as u32);
                self.nodes[at] = subtree.nodes[0].moved(listed_base, node_base);
                self.nodes.extend(subtree.nodes[1..].iter().map(|node| node.moved(listed_base, node_base)));
                self.listed.extend_from_slice(&subtree.listed);
                self.leaf_count += subtree.leaf_count;
                self.depth = self.depth.max(subtree.depth);
                self.cost += subtree.cost;
                context.release(subtree.nodes);
                context.release(subtree.listed);
            }
            Branch::Node { children, octants, cost } => {
                let first = self.nodes.len();
                self.nodes[at] = Node::with_children(first, octants);
                self.nodes.resize(first + children.len(), Node::EMPTY);
                self.cost += cost;
                for (child, branch) in (first..).zip(children) {
                    self.append(child, branch, context);
                }
            }
        }
    }
}
