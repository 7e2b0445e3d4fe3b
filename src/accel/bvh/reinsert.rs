//! A finished tree made better: subtrees move to where they make the boxes smaller.
//!
//! Source: Meister and Bittner 2018, "Parallel reinsertion for bounding volume hierarchy optimization": the best place of
//! each of a batch of nodes is searched for in parallel, with a bound that cuts the search short; then the moves are made,
//! the most useful first, as far as they do not touch the same nodes. Each batch has the nodes with the largest boxes.

use super::build::{BinaryTree, MOST_IN_SUBTREE, Subtree};
use super::node::{MOST_LEVELS, Node};
use super::split_sah::Area;
use crate::accel::build_context::slices;
use crate::accel::reference::{Bounds8, Reference};
use crate::accel::{BuildContext, BuildFailure};
use crate::simd::Scalar;

/// Batches, and the share of the nodes in each.
const BATCH_COUNT: usize = 12;
const NODES_PER_CANDIDATE: usize = 5;
/// What the boxes must lose by a batch for another one to pay.
const LEAST_GAIN: f64 = 0.003;
/// How many nodes the search for one place looks at.
const MOST_VISITS: usize = 1024;

const ROOT: u32 = 0;
const NO_NODE: u32 = u32::MAX;

/// A binary tree whose nodes can be moved.
struct Forest<'a> {
    bounds: Vec<Bounds8>,
    areas: Vec<f32>,
    links: Vec<Link>,
    leaves: Vec<&'a [Reference]>,
    area: Area,
}

/// A leaf has no first child, and its number in place of the second.
#[derive(Clone, Copy)]
struct Link {
    parent: u32,
    children: [u32; 2],
}

/// A node as a child: its parent, and which of both children it is.
type Place = (u32, usize);

/// Where a node would go, as the sibling of `to`, and by how much the boxes shrink.
#[derive(Clone, Copy)]
struct Move {
    gain: f32,
    from: u32,
    to: u32,
}

/// The tree, or a better one of the same leaves whose references are copied to `reordered`.
pub(in crate::accel) fn reinsert<'r>(
    tree: BinaryTree<'r>,
    reordered: &'r mut Vec<Reference>,
    context: &BuildContext,
) -> Result<BinaryTree<'r>, BuildFailure> {
    if !tree.top[0].bounds8().size().truncate().is_finite() {
        // Areas tell nothing of boxes beyond f32.
        return Ok(tree);
    }
    let mut forest = Forest::new(&tree, context)?;
    let mut before = forest.cost();
    let mut has_moved = false;
    for _ in 0..BATCH_COUNT {
        context.check()?;
        let moved_count = forest.improve(context)?;
        let after = forest.cost();
        has_moved |= moved_count > 0;
        if after >= before * (1.0 - LEAST_GAIN) {
            break;
        }
        before = after;
    }
    let improved = if has_moved { forest.rebuild(reordered, context)? } else { None };
    forest.release(context);
    Ok(improved.unwrap_or(tree))
}

impl<'a> Forest<'a> {
    fn new(tree: &BinaryTree<'a>, context: &BuildContext) -> Result<Self, BuildFailure> {
        let count = tree.top.len() + tree.subtrees.iter().map(|subtree| subtree.nodes.len() - 1).sum::<usize>();
        let mut forest = Self {
            bounds: context.reserve(count)?,
            areas: context.reserve(count)?,
            links: context.reserve(count)?,
            leaves: context.reserve(count / 2 + 1)?,
            area: Area::within(&tree.top[0].bounds8()),
        };
        forest.copy(&tree.top, (NO_NODE, 0), |forest, leaf, place| {
            let subtree = &tree.subtrees[leaf.first as usize];
            forest.copy(&subtree.nodes, place, |forest, leaf, place| {
                let references = &subtree.references[leaf.first as usize..][..leaf.count as usize];
                forest.leaves.push(references);
                let number = forest.leaves.len() as u32 - 1;
                forest.push(leaf, place, number);
            });
        });
        Ok(forest)
    }

    /// Copies nodes in depth-first order; `copy_leaf` gets each leaf and its place.
    fn copy(&mut self, nodes: &[Node], place: Place, mut copy_leaf: impl FnMut(&mut Self, &Node, Place)) {
        let mut pending = vec![(0, place)];
        while let Some((at, place)) = pending.pop() {
            let node = &nodes[at];
            if node.is_leaf() {
                copy_leaf(self, node, place);
                continue;
            }
            let number = self.links.len() as u32;
            self.push(node, place, NO_NODE);
            pending.push((node.first as usize, (number, 1)));
            pending.push((at + 1, (number, 0)));
        }
    }

    fn push(&mut self, node: &Node, (parent, side): Place, leaf: u32) {
        if parent != NO_NODE {
            self.links[parent as usize].children[side] = self.links.len() as u32;
        }
        self.links.push(Link { parent, children: [NO_NODE, leaf] });
        let bounds = node.bounds8();
        self.areas.push(self.area.of(&bounds));
        self.bounds.push(bounds);
    }

    fn is_leaf(&self, node: u32) -> bool {
        self.links[node as usize].children[0] == NO_NODE
    }

    fn area(&self, node: u32) -> f32 {
        self.areas[node as usize]
    }

    fn parent(&self, node: u32) -> u32 {
        self.links[node as usize].parent
    }

    fn sibling(&self, node: u32) -> u32 {
        let [first, second] = self.links[self.parent(node) as usize].children;
        if node == first { second } else { first }
    }

    /// The area of all nodes with children: the leaves stay as they are.
    fn cost(&self) -> f64 {
        let nodes = self.links.iter().zip(&self.areas);
        nodes.filter(|(link, _)| link.children[0] != NO_NODE).map(|(_, &area)| f64::from(area)).sum()
    }

    /// One batch; returns how many nodes have moved.
    fn improve(&mut self, context: &BuildContext) -> Result<usize, BuildFailure> {
        // The root stays, and so do its children, whose parent would have to go.
        let is_movable = |&node: &u32| node != ROOT && self.parent(node) != ROOT;
        let mut candidates: Vec<u32> = context.reserve(self.links.len())?;
        candidates.extend((0..self.links.len() as u32).filter(is_movable));
        let count = (self.links.len() / NODES_PER_CANDIDATE).min(candidates.len());
        if count == 0 {
            context.release(candidates);
            return Ok(0);
        }
        let larger = |a: &u32, b: &u32| self.area(*b).total_cmp(&self.area(*a)).then(a.cmp(b));
        candidates.select_nth_unstable_by(count - 1, larger);
        let mut moves = context.map_each(candidates[..count].to_vec(), |node| self.best_move(node));
        context.release(candidates);
        context.check()?;
        moves.sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));

        let mut is_touched = vec![false; self.links.len()];
        let mut moved_count = 0;
        for Move { gain, from, to } in moves {
            if gain <= 0.0 {
                break;
            }
            let touched = [from, to, self.sibling(from), self.parent(from), self.parent(to)];
            // An earlier move may have brought the place to below the node.
            if touched.iter().any(|&node| is_touched[node as usize]) || self.is_below(to, from) {
                continue;
            }
            touched.iter().for_each(|&node| is_touched[node as usize] = true);
            self.make(from, to);
            moved_count += 1;
        }
        Ok(moved_count)
    }

    fn is_below(&self, node: u32, ancestor: u32) -> bool {
        let mut at = node;
        while at != NO_NODE && at != ancestor {
            at = self.parent(at);
        }
        at == ancestor
    }

    fn best_move(&self, from: u32) -> Move {
        let (own, own_area) = (&self.bounds[from as usize], self.area(from));
        let parent = self.parent(from);
        let mut best = Move { gain: 0.0, from, to: NO_NODE };
        // What is won above the node's place, before the node is added elsewhere: its parent goes, and the ancestors up to
        // the pivot shrink.
        let mut won = self.area(parent);
        let (mut pivot, mut sibling) = (parent, self.sibling(from));
        let mut pivot_bounds = self.bounds[sibling as usize];
        let mut pending = Vec::new();
        let mut visits_left = MOST_VISITS;
        while pivot != ROOT && visits_left > 0 {
            pending.push((won, sibling));
            while let Some((won, at)) = pending.pop() {
                if won - own_area <= best.gain || visits_left == 0 {
                    continue;
                }
                visits_left -= 1;
                let merged = self.area.of(&self.bounds[at as usize].union(Scalar, own));
                let gain = won - merged;
                if gain > best.gain && at != self.sibling(from) {
                    best = Move { gain, from, to: at };
                }
                if !self.is_leaf(at) {
                    let below = gain + self.area(at);
                    let [first, second] = self.links[at as usize].children;
                    pending.extend([(below, first), (below, second)]);
                }
            }
            if pivot != parent {
                pivot_bounds.grow(Scalar, &self.bounds[sibling as usize]);
                won += self.area(pivot) - self.area.of(&pivot_bounds);
            }
            sibling = self.sibling(pivot);
            pivot = self.parent(pivot);
        }
        best
    }

    /// The parent moves along, to be the parent of both.
    fn make(&mut self, from: u32, to: u32) {
        let (parent, sibling) = (self.parent(from), self.sibling(from));
        let grandparent = self.parent(parent);
        self.replace_child(grandparent, parent, sibling);
        let above = self.parent(to);
        self.replace_child(above, to, parent);
        self.links[parent as usize].children = [to, from];
        self.links[to as usize].parent = parent;
        self.refit(grandparent);
        self.refit(parent);
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        let children = &mut self.links[parent as usize].children;
        children[usize::from(children[1] == old)] = new;
        self.links[new as usize].parent = parent;
    }

    /// The boxes of a node and of all above.
    fn refit(&mut self, mut node: u32) {
        while node != NO_NODE {
            let [first, second] = self.links[node as usize].children;
            let bounds = self.bounds[first as usize].union(Scalar, &self.bounds[second as usize]);
            self.areas[node as usize] = self.area.of(&bounds);
            self.bounds[node as usize] = bounds;
            node = self.parent(node);
        }
    }

    /// The tree as builders make it; `None` where it became too deep.
    fn rebuild<'r>(
        &self,
        reordered: &'r mut Vec<Reference>,
        context: &BuildContext,
    ) -> Result<Option<BinaryTree<'r>>, BuildFailure> {
        let node_count = self.links.len();
        let mut order: Vec<u32> = context.reserve(node_count)?;
        let mut depth = 0;
        let mut pending = vec![(ROOT, 1)];
        while let Some((node, level)) = pending.pop() {
            depth = depth.max(level);
            order.push(node);
            if !self.is_leaf(node) {
                let [first, second] = self.links[node as usize].children;
                pending.extend([(second, level + 1), (first, level + 1)]);
            }
        }
        if depth as usize > MOST_LEVELS {
            context.release(order);
            return Ok(None);
        }
        // By place in the order: how many references and nodes there are from the node on down, and the second child.
        let mut extents = context.filled(node_count, Extent::default())?;
        let mut places = context.filled(node_count, 0)?;
        for at in (0..node_count).rev() {
            let node = order[at];
            places[node as usize] = at as u32;
            let [_, second] = self.links[node as usize].children;
            extents[at] = if self.is_leaf(node) {
                Extent { reference_count: self.leaves[second as usize].len(), node_count: 1, second: 0 }
            } else {
                let second = places[second as usize];
                let (a, b) = (&extents[at + 1], &extents[second as usize]);
                let reference_count = a.reference_count + b.reference_count;
                Extent { reference_count, node_count: 1 + a.node_count + b.node_count, second }
            };
        }

        let mut ranges = Vec::new();
        let mut top = Vec::new();
        let mut waiting: Vec<usize> = Vec::new();
        let mut at = 0;
        while at < node_count {
            let extent = &extents[at];
            let aabb = self.bounds[order[at] as usize].to_aabb();
            if extent.reference_count > MOST_IN_SUBTREE {
                waiting.push(top.len());
                top.push(Node::new(&aabb, 0, 0));
                at += 1;
                continue;
            }
            top.push(Node::new(&aabb, ranges.len() as u32, 1));
            ranges.push(at..at + extent.node_count);
            at += extent.node_count;
            // What follows in depth-first order is the second child of the last node that waits for one.
            if let Some(parent) = waiting.pop() {
                top[parent].first = top.len() as u32;
            }
        }

        *reordered = context.filled(extents[0].reference_count, self.leaves[0][0])?;
        let counts: Vec<usize> = ranges.iter().map(|range| extents[range.start].reference_count).collect();
        let tasks = ranges.into_iter().zip(slices(reordered, &counts)).collect();
        let subtrees = context.map_each(tasks, |(range, references): (std::ops::Range<usize>, &'r mut [Reference])| {
            let mut nodes = context.reserve(range.len())?;
            let mut next = 0;
            for at in range.clone() {
                let node = order[at];
                let aabb = self.bounds[node as usize].to_aabb();
                if !self.is_leaf(node) {
                    nodes.push(Node::new(&aabb, extents[at].second - range.start as u32, 0));
                    continue;
                }
                let leaf = self.leaves[self.links[node as usize].children[1] as usize];
                references[next..][..leaf.len()].copy_from_slice(leaf);
                nodes.push(Node::new(&aabb, next as u32, leaf.len() as u32));
                next += leaf.len();
            }
            Ok(Subtree { nodes, references })
        });
        let subtrees = subtrees.into_iter().collect::<Result<Vec<_>, _>>()?;
        context.release(order);
        context.release(extents);
        context.release(places);
        Ok(Some(BinaryTree { top, subtrees, depth }))
    }

    fn release(self, context: &BuildContext) {
        context.release(self.bounds);
        context.release(self.areas);
        context.release(self.links);
        context.release(self.leaves);
    }
}

/// What there is from a node on down.
#[derive(Clone, Copy, Default)]
struct Extent {
    reference_count: usize,
    node_count: usize,
    second: u32,
}
