//! From a binary tree to one of eight children a node, at the least expected cost.
//!
//! Source: Ylitie, Karras, Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs",
//! section 3.1: for each binary node the least cost of representing it by at most i wide children, found bottom up.

use arrayvec::ArrayVec;

use super::WideBvh;
use super::leaves::{Ids, LeafForm, Leaves};
use super::node::{Child, WideNode};
use crate::accel::build_context::slices;
use crate::accel::bvh::build::{BinaryTree, Subtree};
use crate::accel::bvh::node::{MOST_LEVELS, Node};
use crate::accel::reference::{PrimitiveSource, Reference};
use crate::accel::{BuildContext, BuildFailure};
use crate::geometry::Aabb;
use crate::simd::{LANES, Simd, SimdKernel};

/// The cost of testing a node's eight children.
pub(super) const NODE_COST: f32 = 1.0;
/// The cost of testing a leaf's triangles, however many.
pub(super) const LEAF_COST: f32 = 1.2;

/// The least cost with at most `i + 1` wide children in a binary node's place, in areas of the root.
type Costs = [f32; LANES];

/// What becomes of a binary node: bit 31 says whether it becomes a leaf where it gets one wide child; the `i`-th three
/// bits, of `i + 2` wide children, how many stand for its first child, 0 where one fewer costs no more.
#[derive(Clone, Copy)]
struct Choice(u32);

impl Choice {
    const LEAF: u32 = 1 << 31;

    fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    fn share(self, slots: usize) -> usize {
        (self.0 >> (3 * (slots - 2))) as usize & 7
    }
}

/// Nodes in depth-first order, and what becomes of each.
struct Plan {
    nodes: Vec<Node>,
    choices: Vec<Choice>,
    /// Of the root.
    costs: Costs,
}

/// A binary node that becomes a wide child, and the number of slots that are left to it: more than one where it is a
/// leaf of the tree's top, and the subtree there shares them out.
#[derive(Clone, Copy)]
struct Entry {
    node: usize,
    slots: usize,
}

type Entries = ArrayVec<Entry, LANES>;

impl Plan {
    /// `leaf_costs` tells, for a leaf and its area, the costs and how many triangles there are.
    fn new(
        nodes: Vec<Node>,
        scale: Option<f64>,
        context: &BuildContext,
        leaf_costs: impl Fn(&Node, f32) -> (Costs, u32),
    ) -> Result<Self, BuildFailure> {
        let mut choices = context.filled_here(nodes.len(), Choice(Choice::LEAF))?;
        let costs = context.vectorize(Choose { nodes: &nodes, choices: &mut choices, scale, leaf_costs });
        Ok(Self { nodes, choices, costs })
    }

    /// The binary nodes that become wide children where this one has that many slots.
    fn entries(&self, node: usize, slots: usize) -> Entries {
        let mut entries = Entries::new();
        self.share_out(Entry { node, slots }, &mut entries);
        entries
    }

    fn share_out(&self, entry: Entry, entries: &mut Entries) {
        let Entry { node, mut slots } = entry;
        if !self.nodes[node].is_leaf() {
            let choice = self.choices[node];
            while slots > 1 && choice.share(slots) == 0 {
                slots -= 1;
            }
            if slots > 1 {
                let share = choice.share(slots);
                self.share_out(Entry { node: node + 1, slots: share }, entries);
                self.share_out(Entry { node: self.nodes[node].first as usize, slots: slots - share }, entries);
                return;
            }
        }
        entries.push(Entry { node, slots });
    }

    /// The triangles of a node that becomes a leaf: the first one and how many.
    fn triangles(&self, node: usize) -> (usize, usize) {
        let (mut first, mut last) = (node, node);
        while !self.nodes[first].is_leaf() {
            first += 1;
        }
        while !self.nodes[last].is_leaf() {
            last = self.nodes[last].first as usize;
        }
        let (first, last) = (&self.nodes[first], &self.nodes[last]);
        (first.first as usize, (last.first + last.count - first.first) as usize)
    }

    /// What becomes a leaf where the root has that many slots, each as its first triangle and how many.
    fn leaves(&self, slots: usize) -> impl Iterator<Item = (usize, usize)> {
        let mut pending = Vec::from_iter(self.entries(0, slots));
        std::iter::from_fn(move || {
            loop {
                let entry = pending.pop()?;
                if self.choices[entry.node].is_leaf() {
                    return Some(self.triangles(entry.node));
                }
                pending.extend(self.entries(entry.node, LANES));
            }
        })
    }

    /// How many wide nodes there are where the root has that many slots.
    fn wide_node_count(&self, slots: usize) -> usize {
        let (mut count, mut pending) = (0, Vec::from_iter(self.entries(0, slots)));
        while let Some(entry) = pending.pop() {
            if !self.choices[entry.node].is_leaf() {
                count += 1;
                pending.extend(self.entries(entry.node, LANES));
            }
        }
        count
    }
}

/// Fills in the choices, and returns the costs of the root.
struct Choose<'a, L> {
    nodes: &'a [Node],
    choices: &'a mut [Choice],
    scale: Option<f64>,
    leaf_costs: L,
}

impl<L: Fn(&Node, f32) -> (Costs, u32)> SimdKernel for Choose<'_, L> {
    type Output = Costs;

    #[inline(always)]
    fn run<S: Simd>(self, _simd: S) -> Costs {
        // Backwards, a node comes after its children: the first one is on top, the second one below.
        let mut stack = ArrayVec::<(Costs, u32), { MOST_LEVELS + 1 }>::new_const();
        for (node, choice) in self.nodes.iter().zip(self.choices).rev() {
            let area = self.scale.map_or(1.0, |scale| (node.half_area() * scale) as f32);
            if node.is_leaf() {
                stack.push((self.leaf_costs)(node, area));
                continue;
            }
            let (left, left_count) = stack.pop().expect("a node has a first child");
            let (right, right_count) = stack.pop().expect("a node has a second child");
            let count = left_count.saturating_add(right_count);
            let (mut costs, shares) = distribute(&left, &right);
            let as_node = NODE_COST * area + costs[LANES - 1];
            let as_leaf = if count as usize <= LANES { LEAF_COST * area } else { f32::INFINITY };
            costs[0] = as_leaf.min(as_node);
            let mut bits = if as_leaf <= as_node { Choice::LEAF } else { 0 };
            for index in 1..LANES {
                // Of eight slots a wide node uses as many as it can.
                if costs[index] < costs[index - 1] || index == LANES - 1 {
                    bits |= shares[index] << (3 * (index - 1));
                }
                costs[index] = costs[index].min(costs[index - 1]);
            }
            *choice = Choice(bits);
            stack.push((costs, count));
        }
        stack.pop().expect("a tree has a root").0
    }
}

/// The least cost of `i + 1` wide children, at least one for each of two nodes, and how many of them stand for the first
/// one.
#[inline(always)]
fn distribute(left: &Costs, right: &Costs) -> (Costs, [u32; LANES]) {
    let (mut costs, mut shares) = ([f32::INFINITY; LANES], [0; LANES]);
    let mut shifted = [f32::INFINITY; 2 * LANES];
    shifted[LANES..].copy_from_slice(right);
    for share in 1..LANES {
        let rights: &[f32; LANES] = shifted[LANES - share..].first_chunk().expect("the array is twice as long");
        for index in 0..LANES {
            let cost = left[share - 1] + rights[index];
            let is_better = cost < costs[index];
            costs[index] = if is_better { cost } else { costs[index] };
            shares[index] = if is_better { share as u32 } else { shares[index] };
        }
    }
    (costs, shares)
}

/// A subtree on its way.
struct Part<'r> {
    plan: Plan,
    references: &'r [Reference],
}

impl Part<'_> {
    /// The triangles of a node that becomes a leaf, each once, and which of the subtree's references is their first.
    fn leaf(&self, node: usize) -> (usize, ArrayVec<Reference, LANES>) {
        let (first, count) = self.plan.triangles(node);
        let mut leaf = ArrayVec::<Reference, LANES>::new();
        for reference in &self.references[first..][..count] {
            if leaf.iter().all(|other| other.ids() != reference.ids()) {
                leaf.push(*reference);
            }
        }
        (first, leaf)
    }
}

/// Where a subtree hangs in the wide tree.
#[derive(Clone, Copy)]
struct Place {
    slots: usize,
    level: u32,
    first_node: usize,
    first_leaf: usize,
}

pub(super) fn collapse<F: LeafForm, T: PrimitiveSource<Primitive = F::Primitive>>(
    tree: BinaryTree,
    bounds: Aabb,
    source: &T,
    context: &BuildContext,
) -> Result<WideBvh<F>, BuildFailure> {
    let BinaryTree { top, subtrees, .. } = tree;
    let area = top[0].half_area();
    let scale = (area > 0.0).then_some(1.0 / area);
    let plan = |Subtree { nodes, references }| {
        let plan = Plan::new(nodes, scale, context, |leaf, area| ([LEAF_COST * area; LANES], leaf.count))?;
        Ok(Part { plan, references })
    };
    let parts = context.map_each(subtrees, plan).into_iter().collect::<Result<Vec<_>, _>>()?;
    let top = Plan::new(top, scale, context, |leaf, _| (parts[leaf.first as usize].plan.costs, u32::MAX))?;

    // The root is a node, if only of one leaf.
    let is_leaf = top.nodes[0].is_leaf() && parts[0].plan.choices[0].is_leaf();
    let (root_slots, root_cost) = if is_leaf { (1, NODE_COST) } else { (LANES, 0.0) };
    let (top_nodes, mut places) = share_out_top(&top, parts.len(), root_slots);
    let places_of_parts: Vec<(&Part, &Place)> = parts.iter().zip(&places).collect();
    let counts = context.map_each(places_of_parts, |(part, place)| {
        let leaves = part.plan.leaves(place.slots).map(|(first, count)| &part.references[first..][..count]);
        (part.plan.wide_node_count(place.slots), F::subtree_size(part.references, leaves, source))
    });
    let (node_counts, leaf_places): (Vec<usize>, Vec<usize>) = counts.into_iter().unzip();
    let (mut next_node, mut next_leaf) = (top_nodes.len(), 0);
    for (index, place) in places.iter_mut().enumerate() {
        (place.first_node, place.first_leaf) = (next_node, next_leaf);
        next_node += node_counts[index];
        next_leaf += leaf_places[index];
    }

    let mut nodes = context.filled(next_node, WideNode::EMPTY)?;
    let (above, below) = nodes.split_at_mut(top_nodes.len());
    emit_top::<F>(&top, &top_nodes, &parts, &places, above, source);
    let mut leaves = Leaves::filled(next_leaf, Ids::new(source.starts()), context)?;
    let (words, ids) = leaves.parts(&leaf_places);
    let tasks: Vec<_> = parts.into_iter().zip(places).zip(slices(below, &node_counts)).zip(words).collect();
    let shapes = context.map_each(tasks, |(((part, place), nodes), words)| {
        let shape = Emission { part: &part, place, nodes, words, next_leaf: 0, ids, source }.run::<F>();
        context.advance(part.references.len())?;
        context.release(part.plan.nodes);
        context.release(part.plan.choices);
        Ok(shape)
    });
    let shapes = shapes.into_iter().collect::<Result<Vec<_>, _>>()?;
    let leaf_count = shapes.iter().map(|shape| shape.leaf_count).sum();
    leaves.set_counts(leaf_count, shapes.iter().map(|shape| shape.primitive_count).sum());
    let depth = shapes.iter().map(|shape| shape.depth).max().expect("a tree has a subtree");
    let sah_cost = f64::from(root_cost + top.costs[0]);
    Ok(WideBvh { bounds, corners: bounds.corners4(), nodes, leaves, depth, sah_cost })
}

/// The wide nodes above the subtrees, each as the binary nodes that become its children, and each subtree's slots and
/// level.
fn share_out_top(top: &Plan, subtree_count: usize, root_slots: usize) -> (Vec<Entries>, Vec<Place>) {
    let mut places = vec![Place { slots: 1, level: 1, first_node: 0, first_leaf: 0 }; subtree_count];
    let (mut nodes, mut levels) = (vec![top.entries(0, root_slots)], vec![1]);
    let mut at = 0;
    while at < nodes.len() {
        let level = levels[at] + 1;
        for entry in nodes[at].clone() {
            let node = &top.nodes[entry.node];
            if node.is_leaf() {
                let place = &mut places[node.first as usize];
                (place.slots, place.level) = (entry.slots, level);
            } else {
                nodes.push(top.entries(entry.node, LANES));
                levels.push(level);
            }
        }
        at += 1;
    }
    (nodes, places)
}

/// Fills the nodes above the subtrees.
fn emit_top<F: LeafForm>(
    top: &Plan,
    entries: &[Entries],
    parts: &[Part],
    places: &[Place],
    nodes: &mut [WideNode],
    source: &impl PrimitiveSource<Primitive = F::Primitive>,
) {
    let mut next = 1;
    for (node, entries) in nodes.iter_mut().zip(entries) {
        let mut children = Children::new();
        for entry in entries {
            let binary = &top.nodes[entry.node];
            if binary.is_leaf() {
                let index = binary.first as usize;
                children.extend(parts[index].children::<F>(&places[index], source));
            } else {
                children.push((*binary, Child::node(next)));
                next += 1;
            }
        }
        node.fill(children);
    }
}

/// Wide children and their boxes.
type Children = ArrayVec<(Node, Child), LANES>;

impl WideNode {
    /// An occlusion ray goes on with the last slot that it meets, so the largest is last.
    fn fill(&mut self, mut children: Children) {
        children.sort_by(|(a, _), (b, _)| a.half_area().total_cmp(&b.half_area()));
        for (slot, (node, child)) in children.into_iter().enumerate() {
            self.set(slot, &node.planes, child);
        }
    }
}

impl Part<'_> {
    /// What the subtree has for the wide node above it.
    fn children<F: LeafForm>(
        &self,
        place: &Place,
        source: &impl PrimitiveSource<Primitive = F::Primitive>,
    ) -> Children {
        let (mut next_node, mut next_leaf) = (place.first_node, 0);
        let mut child = |entry: Entry| {
            let node = self.plan.nodes[entry.node];
            if self.plan.choices[entry.node].is_leaf() {
                let (first, leaf) = self.leaf(entry.node);
                let at = F::place(first, next_leaf);
                next_leaf += F::size(&leaf, source);
                return (node, Child::leaf(place.first_leaf + at, leaf.len()));
            }
            next_node += 1;
            (node, Child::node(next_node - 1))
        };
        self.plan.entries(0, place.slots).into_iter().map(&mut child).collect()
    }
}

/// One subtree's nodes and leaves.
struct Emission<'a, T> {
    part: &'a Part<'a>,
    place: Place,
    nodes: &'a mut [WideNode],
    words: &'a mut [f32],
    /// Where the last leaf ended.
    next_leaf: usize,
    ids: &'a Ids,
    source: &'a T,
}

struct Shape {
    leaf_count: usize,
    primitive_count: usize,
    depth: u32,
}

impl<T: PrimitiveSource> Emission<'_, T> {
    fn run<F: LeafForm<Primitive = T::Primitive>>(mut self) -> Shape {
        let plan = &self.part.plan;
        let mut shape = Shape { leaf_count: 0, primitive_count: 0, depth: self.place.level };
        let (mut next, mut pending) = (0, Vec::new());
        for entry in plan.entries(0, self.place.slots) {
            self.emit::<F>(entry.node, self.place.level, &mut next, &mut pending, &mut shape);
        }
        while let Some((at, node, level)) = pending.pop() {
            shape.depth = shape.depth.max(level + 1);
            let mut children = Children::new();
            for entry in plan.entries(node, LANES) {
                let child = self.emit::<F>(entry.node, level + 1, &mut next, &mut pending, &mut shape);
                children.push((plan.nodes[entry.node], child));
            }
            self.nodes[at].fill(children);
        }
        shape
    }

    /// A leaf with its triangles, or the next node, to be filled later.
    fn emit<F: LeafForm<Primitive = T::Primitive>>(
        &mut self,
        node: usize,
        level: u32,
        next: &mut usize,
        pending: &mut Vec<(usize, usize, u32)>,
        shape: &mut Shape,
    ) -> Child {
        let plan = &self.part.plan;
        if plan.choices[node].is_leaf() {
            let (first, leaf) = self.part.leaf(node);
            let at = F::place(first, self.next_leaf);
            self.next_leaf += F::write(self.words, at, &leaf, self.ids, self.source);
            shape.leaf_count += 1;
            shape.primitive_count += leaf.len();
            return Child::leaf(self.place.first_leaf + at, leaf.len());
        }
        pending.push((*next, node, level));
        *next += 1;
        Child::node(self.place.first_node + *next - 1)
    }
}
