//! From a binary tree to one of eight children a node, at the least expected cost.
//!
//! Source: Ylitie, Karras, Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs",
//! section 3.1: for each binary node the least cost of representing it by at most i wide children, found bottom up.

use super::WideBvh;
use super::leaves::{Ids, Leaves};
use super::node::{Child, WideNode};
use crate::accel::bvh::Bvh;
use crate::accel::bvh::node::Node;
use crate::accel::{BuildContext, BuildFailure};
use crate::simd::LANES;

/// The cost of testing a node's eight children.
const NODE_COST: f32 = 1.0;
/// The cost of testing a leaf's triangles, however many.
const LEAF_COST: f32 = 1.2;

/// What is known of a binary node with children.
#[derive(Clone, Copy)]
struct Plan {
    /// The least cost with at most `i + 1` wide children in its place, in areas of the root.
    costs: [f32; LANES - 1],
    /// Of `i + 2` wide children, how many stand for the left child; 0 where one fewer costs no more.
    left_shares: [u8; LANES - 1],
    /// Whether it becomes a leaf where it gets one wide child.
    is_leaf: bool,
    /// The triangles below, which follow each other.
    first: u32,
    count: u32,
}

impl Plan {
    const UNKNOWN: Self =
        Self { costs: [0.0; LANES - 1], left_shares: [0; LANES - 1], is_leaf: false, first: 0, count: 0 };
}

struct Collapse<'a> {
    binary: &'a Bvh,
    plans: Vec<Plan>,
    root_area: f64,
}

pub(super) fn collapse(binary: Bvh, ids: Ids, context: &BuildContext) -> Result<WideBvh, BuildFailure> {
    let collapse = Collapse::plan(&binary, context)?;
    let mut leaves = Leaves::reserve(binary.triangles.len(), ids, context)?;
    let mut nodes = context.reserve(collapse.node_count())?;
    let (root, depth) = collapse.emit(&mut nodes, &mut leaves);
    let sah_cost = f64::from(collapse.cost(&binary.root, 1));
    context.release(collapse.plans);
    leaves.finish();
    Ok(WideBvh { bounds: binary.bounds, corners: binary.bounds.corners4(), root, nodes, leaves, depth, sah_cost })
}

impl<'a> Collapse<'a> {
    fn plan(binary: &'a Bvh, context: &BuildContext) -> Result<Self, BuildFailure> {
        let plans = context.filled(binary.pairs.len(), Plan::UNKNOWN)?;
        let mut collapse = Self { binary, plans, root_area: binary.root.half_area() };
        // Children come after their parents.
        for pair in (0..binary.pairs.len()).rev() {
            collapse.plans[pair] = collapse.plan_pair(pair);
        }
        Ok(collapse)
    }

    fn plan_pair(&self, pair: usize) -> Plan {
        let [left, right] = &self.binary.pairs[pair].children;
        let ((first, left_count), (_, right_count)) = (self.triangles(left), self.triangles(right));
        let mut plan = Plan { first, count: left_count + right_count, ..Plan::UNKNOWN };

        let distributed: [(f32, u8); LANES - 1] = std::array::from_fn(|index| {
            let slots = index + 2;
            (1..slots)
                .map(|share| (self.cost(left, share) + self.cost(right, slots - share), share as u8))
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .expect("two slots can be shared out")
        });
        let (in_a_node, share) = distributed[LANES - 2];
        plan.left_shares[LANES - 2] = share;
        let area = self.area(&Node { planes: union(&left.planes, &right.planes), ..*left });
        let as_node = NODE_COST * area + in_a_node;
        let as_leaf = if plan.count as usize <= LANES { LEAF_COST * area } else { f32::INFINITY };
        plan.is_leaf = as_leaf <= as_node;
        plan.costs[0] = as_leaf.min(as_node);
        for slots in 2..LANES {
            let (cost, share) = distributed[slots - 2];
            let is_worth_it = cost < plan.costs[slots - 2];
            plan.costs[slots - 1] = if is_worth_it { cost } else { plan.costs[slots - 2] };
            plan.left_shares[slots - 2] = if is_worth_it { share } else { 0 };
        }
        plan
    }

    fn cost(&self, node: &Node, slots: usize) -> f32 {
        if node.is_leaf() {
            return LEAF_COST * self.area(node);
        }
        self.plans[node.first as usize].costs[slots.min(LANES - 1) - 1]
    }

    fn area(&self, node: &Node) -> f32 {
        if self.root_area > 0.0 { (node.half_area() / self.root_area) as f32 } else { 1.0 }
    }

    fn triangles(&self, node: &Node) -> (u32, u32) {
        if node.is_leaf() {
            return (node.first, node.count);
        }
        let plan = &self.plans[node.first as usize];
        (plan.first, plan.count)
    }

    /// Whether a node that gets one wide child becomes a leaf.
    fn is_leaf(&self, node: &Node) -> bool {
        node.is_leaf() || self.plans[node.first as usize].is_leaf
    }

    fn node_count(&self) -> usize {
        let mut count = 0;
        let mut pending = vec![self.binary.root];
        while let Some(node) = pending.pop() {
            if !self.is_leaf(&node) {
                count += 1;
                pending.extend(self.children(&node));
            }
        }
        count
    }

    /// The binary nodes that become the children of a node's wide node.
    fn children(&self, node: &Node) -> arrayvec::ArrayVec<Node, LANES> {
        let mut children = arrayvec::ArrayVec::new();
        self.share_out(node, LANES, &mut children);
        children
    }

    fn share_out(&self, node: &Node, slots: usize, children: &mut arrayvec::ArrayVec<Node, LANES>) {
        let mut slots = slots;
        if !node.is_leaf() {
            let plan = &self.plans[node.first as usize];
            while slots > 1 && plan.left_shares[slots - 2] == 0 {
                slots -= 1;
            }
            if slots > 1 {
                let [left, right] = &self.binary.pairs[node.first as usize].children;
                let left_share = usize::from(plan.left_shares[slots - 2]);
                self.share_out(left, left_share, children);
                self.share_out(right, slots - left_share, children);
                return;
            }
        }
        children.push(*node);
    }

    /// Fills nodes and leaves; returns the root and the depth.
    fn emit(&self, nodes: &mut Vec<WideNode>, leaves: &mut Leaves) -> (Child, u32) {
        let root = self.emit_child(&self.binary.root, nodes, leaves);
        let mut depth = 1;
        let mut pending = Vec::new();
        if !root.is_leaf() {
            pending.push((root.node_index(), self.binary.root, 1));
        }
        while let Some((at, node, level)) = pending.pop() {
            depth = depth.max(level + 1);
            let mut children = self.children(&node);
            // An occlusion ray goes on with the last slot that it meets: the largest.
            children.sort_by(|a, b| a.half_area().total_cmp(&b.half_area()));
            for (slot, child) in children.iter().enumerate() {
                let wide = self.emit_child(child, nodes, leaves);
                nodes[at].set(slot, &child.planes, wide);
                if !wide.is_leaf() {
                    pending.push((wide.node_index(), *child, level + 1));
                }
            }
        }
        (root, depth)
    }

    /// A leaf with its triangles, or an empty node.
    fn emit_child(&self, node: &Node, nodes: &mut Vec<WideNode>, leaves: &mut Leaves) -> Child {
        if self.is_leaf(node) {
            let (first, count) = self.triangles(node);
            let triangles = &self.binary.triangles[first as usize..][..count as usize];
            return Child::leaf(leaves.push(triangles), triangles.len());
        }
        nodes.push(WideNode::EMPTY);
        Child::node(nodes.len() - 1)
    }
}

fn union(a: &[[f32; 2]; 3], b: &[[f32; 2]; 3]) -> [[f32; 2]; 3] {
    std::array::from_fn(|axis| [a[axis][0].min(b[axis][0]), a[axis][1].max(b[axis][1])])
}
