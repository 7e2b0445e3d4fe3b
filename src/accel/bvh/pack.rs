//! From the builder's tree to the one that queries read: siblings side by side, in depth-first order.

use super::Bvh;
use super::build::BinaryTree;
use super::node::{Node, NodePair};
use super::split_sah::{NODE_COST, TRIANGLE_COST};
use crate::accel::build_context::slices;
use crate::accel::reference::PrimitiveSource;
use crate::accel::{BuildContext, BuildFailure, Primitive};
use crate::geometry::Aabb;

pub(super) fn pack<S: PrimitiveSource>(
    tree: BinaryTree,
    bounds: Aabb,
    source: &S,
    context: &BuildContext,
) -> Result<Bvh<S::Primitive>, BuildFailure> {
    let BinaryTree { top, subtrees, depth } = tree;
    let top_pairs = pair_count(&top);
    let pair_counts: Vec<usize> = subtrees.iter().map(|subtree| pair_count(&subtree.nodes)).collect();
    let primitive_counts: Vec<usize> = subtrees.iter().map(|subtree| subtree.references.len()).collect();
    let mut pairs = context.filled(top_pairs + pair_counts.iter().sum::<usize>(), NodePair::EMPTY)?;
    let mut primitives = context.filled(primitive_counts.iter().sum(), S::Primitive::NONE)?;

    let (above, below) = pairs.split_at_mut(top_pairs);
    let (mut first_pair, mut first_primitive) = (top_pairs as u32, 0);
    let mut roots = Vec::with_capacity(subtrees.len());
    let mut tasks = Vec::with_capacity(subtrees.len());
    for ((subtree, pairs), primitives) in
        subtrees.into_iter().zip(slices(below, &pair_counts)).zip(slices(&mut primitives, &primitive_counts))
    {
        let root = subtree.nodes[0];
        roots.push(if root.is_leaf() {
            Node { first: root.first + first_primitive, ..root }
        } else {
            Node { first: first_pair, ..root }
        });
        let (pair_base, primitive_base) = (first_pair, first_primitive);
        first_pair += pairs.len() as u32;
        first_primitive += primitives.len() as u32;
        tasks.push((subtree, pairs, pair_base, primitives, primitive_base));
    }
    let root = if top[0].is_leaf() { roots[0] } else { Node { first: 0, ..top[0] } };
    pack_nodes(&top, above, 0, |leaf| roots[leaf.first as usize]);
    let costs = context.map_each(tasks, |(subtree, pairs, pair_base, primitives, primitive_base)| {
        pack_nodes(&subtree.nodes, pairs, pair_base, |leaf| Node { first: leaf.first + primitive_base, ..*leaf });
        for (primitive, reference) in primitives.iter_mut().zip(subtree.references) {
            *primitive = reference.primitive(source);
        }
        let cost = subtree.nodes.iter().map(cost_of).sum::<f64>();
        context.release(subtree.nodes);
        cost
    });
    // The top's leaves are the subtrees' roots.
    let above = top.iter().filter(|node| !node.is_leaf()).map(cost_of).sum::<f64>();
    let cost = above + costs.iter().sum::<f64>();
    Ok(Bvh { bounds, root, pairs, primitives, depth, sah_cost: cost / root.half_area() })
}

fn pair_count(nodes: &[Node]) -> usize {
    nodes.len() / 2
}

/// The pairs of nodes in depth-first order, themselves in that order; their numbers begin with `base`.
fn pack_nodes(nodes: &[Node], pairs: &mut [NodePair], base: u32, leaf: impl Fn(&Node) -> Node) {
    let mut next = base;
    let numbers: Vec<u32> = nodes
        .iter()
        .map(|node| {
            let number = next;
            next += u32::from(!node.is_leaf());
            number
        })
        .collect();
    let child = |at: usize| {
        let node = &nodes[at];
        if node.is_leaf() { leaf(node) } else { Node { first: numbers[at], ..*node } }
    };
    let inner = (0..nodes.len()).filter(|&at| !nodes[at].is_leaf());
    for (pair, at) in pairs.iter_mut().zip(inner) {
        *pair = NodePair { children: [child(at + 1), child(nodes[at].first as usize)] };
    }
}

/// Of a ray that meets the node, not counting what is below it.
fn cost_of(node: &Node) -> f64 {
    node.half_area() * if node.is_leaf() { f64::from(node.count) * TRIANGLE_COST } else { NODE_COST }
}
