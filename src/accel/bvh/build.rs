//! Building top down: references to triangles are split until a rule says leaf; the rules are in files of their own.

use glam::Vec4;
use rayon::prelude::*;

use super::Bvh;
use super::node::{MOST_LEVELS, Node, NodePair};
use super::split_sah::{NODE_COST, TRIANGLE_COST};
use crate::accel::{BuildContext, BuildFailure};
use crate::geometry::{Aabb, Triangle};

/// A triangle's box and where the triangle is; 32 bytes. The index travels in the fourth lane of `lower`, so that box
/// arithmetic is one instruction on four lanes.
#[derive(Clone, Copy)]
pub(crate) struct Reference {
    pub(super) lower: Vec4,
    pub(super) upper: Vec4,
}

impl Reference {
    fn new(bounds: &Aabb, index: usize) -> Self {
        Self { lower: bounds.lower.extend(f32::from_bits(index as u32)), upper: bounds.upper.extend(0.0) }
    }

    pub(super) fn index(&self) -> u32 {
        self.lower.w.to_bits()
    }

    /// Halved before the sum, which else may overflow.
    pub(super) fn centre(&self) -> Vec4 {
        self.lower * 0.5 + self.upper * 0.5
    }
}

/// A box on four lanes, the fourth without meaning.
#[derive(Clone, Copy)]
pub(super) struct Bounds4 {
    pub(super) lower: Vec4,
    pub(super) upper: Vec4,
}

impl Bounds4 {
    pub(super) const EMPTY: Self = Self { lower: Vec4::INFINITY, upper: Vec4::NEG_INFINITY };

    pub(super) fn grow(&mut self, lower: Vec4, upper: Vec4) {
        self.lower = self.lower.min(lower);
        self.upper = self.upper.max(upper);
    }

    pub(super) fn union(mut self, other: Self) -> Self {
        self.grow(other.lower, other.upper);
        self
    }

    pub(super) fn half_area(&self) -> f32 {
        let size = self.upper - self.lower;
        size.x * size.y + size.y * size.z + size.z * size.x
    }

    fn to_aabb(self) -> Aabb {
        Aabb { lower: self.lower.truncate(), upper: self.upper.truncate() }
    }
}

/// What a split rule may know of a node.
pub(crate) struct NodeExtent {
    pub(super) bounds: Bounds4,
    pub(super) centres: Bounds4,
}

impl NodeExtent {
    const EMPTY: Self = Self { bounds: Bounds4::EMPTY, centres: Bounds4::EMPTY };

    fn of(references: &[Reference], context: &BuildContext) -> Self {
        reduce_chunks(
            references,
            context,
            |chunk| {
                let mut extent = Self::EMPTY;
                for reference in chunk {
                    extent.bounds.grow(reference.lower, reference.upper);
                    let centre = reference.centre();
                    extent.centres.grow(centre, centre);
                }
                extent
            },
            |a, b| Self { bounds: a.bounds.union(b.bounds), centres: a.centres.union(b.centres) },
        )
    }
}

/// Decides about a node: reorders its references and says where the second child's begin, or `None` for a leaf.
pub(crate) trait SplitRule: Sync {
    /// Nodes with more triangles are always split.
    fn most_in_leaf(&self) -> usize;

    fn split(&self, references: &mut [Reference], extent: &NodeExtent, context: &BuildContext) -> Option<usize>;
}

/// Maps chunks of a slice, on all threads where it is long, and combines what they give. The result does not depend
/// on the number of threads as long as `combine` is associative and commutative to the bit.
pub(super) fn reduce_chunks<T: Send>(
    references: &[Reference],
    context: &BuildContext,
    map: impl Fn(&[Reference]) -> T + Sync,
    combine: impl Fn(T, T) -> T + Sync,
) -> T {
    /// Long enough that starting a task does not show.
    const CHUNK: usize = 1 << 15;
    if references.len() <= CHUNK || !context.is_parallel() {
        return map(references);
    }
    references.par_chunks(CHUNK).map(&map).reduce_with(&combine).expect("a slice longer than a chunk has chunks")
}

pub(super) fn build<R: SplitRule>(
    triangles: Vec<Triangle>,
    bounds: Aabb,
    rule: &R,
    context: &BuildContext,
) -> Result<Bvh, BuildFailure> {
    let count = triangles.len();
    // Half of the work is in the tree, the rest before and after.
    context.expect(4 * count);

    let mut references = context.reserve::<Reference>(count)?;
    let reference = |(index, triangle): (usize, &Triangle)| Reference::new(&triangle.bounds(), index);
    if context.is_parallel() {
        references.par_extend(triangles.par_iter().enumerate().map(reference));
    } else {
        references.extend(triangles.iter().enumerate().map(reference));
    }
    context.advance(count)?;

    let mut sparse = context.filled(count - 1, NodePair::EMPTY)?;
    let subtree = Subtree { rule, context }.build(&mut references, &mut sparse, 0, 0, 0)?;
    let mut pairs = context.reserve(subtree.pair_count)?;
    let (root, sah_cost) = compact(subtree.node, &sparse, &mut pairs);
    context.release(sparse);

    let mut sorted = context.reserve(count)?;
    let sort = |reference: &Reference| triangles[reference.index() as usize];
    if context.is_parallel() {
        sorted.par_extend(references.par_iter().map(sort));
    } else {
        sorted.extend(references.iter().map(sort));
    }
    context.release(references);
    context.release(triangles);
    context.advance(count)?;
    Ok(Bvh { bounds, root, pairs, triangles: sorted, depth: subtree.depth, sah_cost })
}

/// One node and what lies below it.
struct Built {
    node: Node,
    pair_count: usize,
    depth: u32,
}

struct Subtree<'a, R> {
    rule: &'a R,
    context: &'a BuildContext<'a>,
}

impl<R: SplitRule> Subtree<'_, R> {
    /// `references` are those from `first` on; their subtree has room for its pairs, one fewer than there are
    /// references, in `pairs`, which are those from `first_pair` on.
    fn build(
        &self,
        references: &mut [Reference],
        pairs: &mut [NodePair],
        first: usize,
        first_pair: usize,
        level: usize,
    ) -> Result<Built, BuildFailure> {
        /// Smaller subtrees are built by one thread without a look at the watch.
        const TASK: usize = 4096;
        let count = references.len();
        if count > TASK {
            self.context.check()?;
        }
        let extent = NodeExtent::of(references, self.context);
        let Some(middle) = self.split(references, &extent, level) else {
            let node = Node::new(&extent.bounds.to_aabb(), first as u32, count as u32);
            self.context.advance(2 * count)?;
            return Ok(Built { node, pair_count: 0, depth: 1 });
        };

        let (left_references, right_references) = references.split_at_mut(middle);
        let (pair, below) = pairs.split_first_mut().expect("room for one pair fewer than references");
        let (left_pairs, right_pairs) = below.split_at_mut(middle - 1);
        let mut build_left = || self.build(left_references, left_pairs, first, first_pair + 1, level + 1);
        let mut build_right =
            || self.build(right_references, right_pairs, first + middle, first_pair + middle, level + 1);
        let (left, right) =
            if count > TASK { self.context.join(build_left, build_right) } else { (build_left(), build_right()) };
        let (left, right) = (left?, right?);

        *pair = NodePair { children: [left.node, right.node] };
        Ok(Built {
            node: Node::new(&extent.bounds.to_aabb(), first_pair as u32, 0),
            pair_count: 1 + left.pair_count + right.pair_count,
            depth: 1 + left.depth.max(right.depth),
        })
    }

    /// The rule's answer, but halves where it would make a leaf too large or the tree too deep for a traversal's stack.
    fn split(&self, references: &mut [Reference], extent: &NodeExtent, level: usize) -> Option<usize> {
        /// From here halving 2^32 references ends in time.
        const LAST_FREE_LEVEL: usize = MOST_LEVELS - 33;
        let count = references.len();
        if count == 1 {
            return None;
        }
        let middle = if level < LAST_FREE_LEVEL { self.rule.split(references, extent, self.context) } else { None };
        middle.or_else(|| (count > self.rule.most_in_leaf()).then_some(count / 2))
    }
}

/// Copies the used pairs in depth-first order, and adds up the expected cost of a ray that meets the root.
fn compact(root: Node, sparse: &[NodePair], pairs: &mut Vec<NodePair>) -> (Node, f64) {
    let mut cost = 0.0;
    let mut count_cost = |node: &Node| {
        cost += node.half_area() * if node.is_leaf() { node.count as f64 * TRIANGLE_COST } else { NODE_COST };
    };
    count_cost(&root);
    let mut compacted = root;
    if root.is_leaf() {
        return (root, f64::from(root.count) * TRIANGLE_COST);
    }
    compacted.first = 0;
    pairs.push(sparse[root.first as usize]);
    let mut pending = vec![0];
    while let Some(at) = pending.pop() {
        for child in 0..2 {
            let node = pairs[at].children[child];
            count_cost(&node);
            if !node.is_leaf() {
                pairs[at].children[child].first = pairs.len() as u32;
                pending.push(pairs.len());
                pairs.push(sparse[node.first as usize]);
            }
        }
    }
    (compacted, cost / root.half_area())
}
