//! Building top down: references to triangles are split until a rule says leaf; the rules are in files of their own.

use arrayvec::ArrayVec;

use super::node::{MOST_LEVELS, Node};
use crate::accel::reference::{Bounds8, PrimitiveSource, Reference};
use crate::accel::{BuildContext, BuildFailure, Copied, Primitive};
use crate::simd::{Scalar, Simd, SimdKernel};

/// A binary tree in two parts: what lies below a few thousand references is a subtree of its own, built by one thread.
pub(in crate::accel) struct BinaryTree<'r> {
    /// What lies above the subtrees, in depth-first order: a node's first child follows it, and its `first` is the second
    /// one. A leaf's `first` is a subtree.
    pub(in crate::accel) top: Vec<Node>,
    /// In depth-first order, too.
    pub(in crate::accel) subtrees: Vec<Subtree<'r>>,
    pub(in crate::accel) depth: u32,
}

/// Nodes as in [`BinaryTree::top`]; a leaf's `first` counts from the subtree's first reference.
pub(in crate::accel) struct Subtree<'r> {
    pub(in crate::accel) nodes: Vec<Node>,
    pub(in crate::accel) references: &'r [Reference],
}

/// A node's two children: where the second one's references begin, and their boxes.
pub(crate) struct Split {
    pub(super) middle: usize,
    pub(super) bounds: [Bounds8; 2],
}

impl Split {
    #[inline(always)]
    pub(super) fn at<S: Simd>(simd: S, middle: usize, references: &[Reference]) -> Self {
        let (left, right) = references.split_at(middle);
        Self { middle, bounds: [union(simd, left), union(simd, right)] }
    }

    /// Shares out the room behind the first `count` references, to both children in proportion.
    #[inline(always)]
    pub(super) fn share_out(self, references: &mut [Reference], count: usize) -> Division {
        let Self { middle, bounds } = self;
        let room = references.len() - count;
        let mut right_begin = middle;
        if room > 0 {
            right_begin += (room as u64 * middle as u64 / count as u64) as usize;
            references.copy_within(middle..count, right_begin);
        }
        Division { left_count: middle, right_begin, right_count: count - middle, bounds }
    }
}

/// As [`Split`], where there may be room between the children's references, for more of the first child's.
pub(crate) struct Division {
    left_count: usize,
    right_begin: usize,
    right_count: usize,
    bounds: [Bounds8; 2],
}

struct Union<'a>(&'a [Reference]);

impl SimdKernel for Union<'_> {
    type Output = Bounds8;

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Bounds8 {
        union(simd, self.0)
    }
}

#[inline(always)]
pub(super) fn union<S: Simd>(simd: S, references: &[Reference]) -> Bounds8 {
    let mut bounds = Bounds8::EMPTY;
    for reference in references {
        bounds.grow(simd, reference.bounds());
    }
    bounds
}

/// The box of them all, on all threads.
pub(super) fn union_together(references: &[Reference], context: &BuildContext) -> Bounds8 {
    let union = |chunk: &[Reference]| context.vectorize(Union(chunk));
    context.reduce_chunks(references, union, |a, b| a.union(Scalar, &b)).unwrap_or(Bounds8::EMPTY)
}

/// Decides about a node: reorders its references and says where the second child's begin, or `None` for a leaf or where it
/// cannot tell the references apart.
pub(crate) trait SplitRule: Sync {
    /// What the rule needs room for, kept from node to node.
    type Scratch: Default;

    /// Nodes with more triangles are always split.
    fn most_in_leaf(&self) -> usize;

    /// Must be `#[inline(always)]`.
    fn split<S: Simd>(
        &self,
        simd: S,
        references: &mut [Reference],
        bounds: &Bounds8,
        scratch: &mut Self::Scratch,
    ) -> Option<Split>;

    /// As [`SplitRule::split`], on all threads.
    fn split_together(&self, references: &mut [Reference], bounds: &Bounds8, context: &BuildContext) -> Option<Split>;

    /// As [`SplitRule::split`] of the first `count` references, where a rule may make more of them, up to the slice's end.
    #[inline(always)]
    fn divide<S: Simd>(
        &self,
        simd: S,
        references: &mut [Reference],
        count: usize,
        bounds: &Bounds8,
        scratch: &mut Self::Scratch,
    ) -> Option<Division> {
        let split = self.split(simd, &mut references[..count], bounds, scratch)?;
        Some(split.share_out(references, count))
    }

    /// As [`SplitRule::divide`], on all threads.
    fn divide_together(
        &self,
        references: &mut [Reference],
        count: usize,
        bounds: &Bounds8,
        context: &BuildContext,
    ) -> Option<Division> {
        let split = self.split_together(&mut references[..count], bounds, context)?;
        Some(split.share_out(references, count))
    }
}

/// From here halving 2^32 references ends in time.
const LAST_FREE_LEVEL: usize = MOST_LEVELS - 33;

/// Smaller trees are built by one thread without a look at the watch.
pub(super) const MOST_IN_SUBTREE: usize = 4096;

/// The references are reordered; the tree's subtrees have them. Those behind the first `count` are room for more.
pub(in crate::accel) fn build<'r, R: SplitRule, T: PrimitiveSource>(
    references: &'r mut [Reference],
    count: usize,
    rule: &R,
    source: &T,
    context: &BuildContext,
) -> Result<BinaryTree<'r>, BuildFailure> {
    let bounds = union_together(&references[..count], context);
    let part = Part { references, count, bounds, level: 0, is_distinct: false };
    let branch = Builder { rule, source, context }.build(part)?;
    let mut tree = BinaryTree { top: Vec::new(), subtrees: Vec::new(), depth: 0 };
    tree.append(branch);
    Ok(tree)
}

/// What is to become a node, and what lies below it.
struct Part<'r> {
    references: &'r mut [Reference],
    /// How many there are; the others are room for more.
    count: usize,
    bounds: Bounds8,
    level: usize,
    /// Whether no two triangles are the same.
    is_distinct: bool,
}

enum Branch<'r> {
    Subtree { subtree: Subtree<'r>, depth: u32 },
    Node { bounds: Bounds8, children: Box<[Branch<'r>; 2]> },
}

impl<'r> BinaryTree<'r> {
    fn append(&mut self, branch: Branch<'r>) {
        match branch {
            Branch::Subtree { subtree, depth } => {
                self.top.push(Node { first: self.subtrees.len() as u32, count: 1, ..subtree.nodes[0] });
                self.subtrees.push(subtree);
                self.depth = self.depth.max(depth);
            }
            Branch::Node { bounds, children } => {
                let at = self.top.len();
                self.top.push(Node::new(&bounds.to_aabb(), 0, 0));
                let [left, right] = *children;
                self.append(left);
                self.top[at].first = self.top.len() as u32;
                self.append(right);
            }
        }
    }
}

struct Builder<'a, R, T> {
    rule: &'a R,
    source: &'a T,
    context: &'a BuildContext<'a>,
}

impl<R: SplitRule, T: PrimitiveSource> Builder<'_, R, T> {
    fn build<'r>(&self, part: Part<'r>) -> Result<Branch<'r>, BuildFailure> {
        self.context.check()?;
        if part.count <= MOST_IN_SUBTREE {
            return self.subtree(part);
        }
        let Part { references, mut count, bounds, level, mut is_distinct } = part;
        let mut division = None;
        if level < LAST_FREE_LEVEL {
            division = self.rule.divide_together(references, count, &bounds, self.context);
        }
        if division.is_none() && !is_distinct {
            is_distinct = true;
            count = drop_duplicates(&mut references[..count], self.source, self.context);
            if count <= MOST_IN_SUBTREE {
                return self.subtree(Part { references, count, bounds, level, is_distinct });
            }
        }
        let Division { left_count, right_begin, right_count, bounds: [left_bounds, right_bounds] } =
            division.unwrap_or_else(|| halve(Scalar, &mut references[..count]).share_out(references, count));
        let level = level + 1;
        let (left, right) = references.split_at_mut(right_begin);
        let left = Part { references: left, count: left_count, bounds: left_bounds, level, is_distinct };
        let right = Part { references: right, count: right_count, bounds: right_bounds, level, is_distinct };
        let (left, right) = self.context.join(|| self.build(left), || self.build(right));
        Ok(Branch::Node { bounds, children: Box::new([left?, right?]) })
    }

    fn subtree<'r>(&self, part: Part<'r>) -> Result<Branch<'r>, BuildFailure> {
        let count = part.count;
        let nodes = self.context.reserve(2 * part.references.len() - 1)?;
        let (mut subtree, depth) = self.context.vectorize(GrowSubtree {
            rule: self.rule,
            source: self.source,
            context: self.context,
            nodes,
            part,
        });
        self.context.shrink(&mut subtree.nodes);
        self.context.advance(count)?;
        Ok(Branch::Subtree { subtree, depth })
    }
}

struct GrowSubtree<'a, 'r, R, T> {
    rule: &'a R,
    source: &'a T,
    context: &'a BuildContext<'a>,
    /// Empty, with room for all.
    nodes: Vec<Node>,
    part: Part<'r>,
}

/// A node that waits, or is at work: its references are those from `begin` to `end`, and up to `limit` is room for more.
#[derive(Clone, Copy)]
struct Waiting {
    begin: usize,
    end: usize,
    limit: usize,
    bounds: Bounds8,
    level: usize,
    is_distinct: bool,
    /// Whose second child it is.
    parent: usize,
}

impl<'r, R: SplitRule, T: PrimitiveSource> SimdKernel for GrowSubtree<'_, 'r, R, T> {
    type Output = (Subtree<'r>, u32);

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> Self::Output {
        let Self { rule, source, context, mut nodes, part: Part { references, count, bounds, level, is_distinct } } =
            self;
        let mut scratch = R::Scratch::default();
        let mut waiting = ArrayVec::<Waiting, MOST_LEVELS>::new_const();
        let limit = references.len();
        let mut at_work = Waiting { begin: 0, end: count, limit, bounds, level, is_distinct, parent: 0 };
        let (mut deepest, mut stored) = (level, 0);
        loop {
            let Waiting { begin, mut end, limit, bounds, level, mut is_distinct, .. } = at_work;
            deepest = deepest.max(level);
            let mut division = None;
            if end - begin > 1 && level < LAST_FREE_LEVEL {
                division = rule.divide(simd, &mut references[begin..limit], end - begin, &bounds, &mut scratch);
            }
            if division.is_none() && end - begin > rule.most_in_leaf() {
                if !is_distinct {
                    is_distinct = true;
                    end = begin + drop_duplicates(&mut references[begin..end], source, context);
                }
                if end - begin > rule.most_in_leaf() {
                    let split = halve(simd, &mut references[begin..end]);
                    division = Some(split.share_out(&mut references[begin..limit], end - begin));
                }
            }
            let aabb = bounds.to_aabb();
            if let Some(Division { left_count, right_begin, right_count, bounds: [left_bounds, right_bounds] }) =
                division
            {
                let (middle, level, parent) = (begin + right_begin, level + 1, nodes.len());
                let end = middle + right_count;
                waiting.push(Waiting { begin: middle, end, limit, bounds: right_bounds, level, is_distinct, parent });
                let end = begin + left_count;
                at_work = Waiting { begin, end, limit: middle, bounds: left_bounds, level, is_distinct, parent: 0 };
                nodes.push(Node::new(&aabb, 0, 0));
                continue;
            }
            nodes.push(Node::new(&aabb, stored as u32, (end - begin) as u32));
            if stored < begin {
                references.copy_within(begin..end, stored);
            }
            stored += end - begin;
            let Some(next) = waiting.pop() else { break };
            nodes[next.parent].first = nodes.len() as u32;
            at_work = next;
        }
        let references: &'r [Reference] = references;
        (Subtree { nodes, references: &references[..stored] }, deepest as u32 + 1)
    }
}

/// Keeps, of primitives that are the same to the bit, the one whose hits win. Returns how many are left, at the front.
#[cold]
fn drop_duplicates(references: &mut [Reference], source: &impl PrimitiveSource, context: &BuildContext) -> usize {
    let shape = |reference: &Reference| reference.primitive(source).shape();
    references.sort_by_cached_key(|reference| (shape(reference), reference.ids()));
    let mut count = 1;
    for next in 1..references.len() {
        if shape(&references[next]) != shape(&references[count - 1]) {
            references[count] = references[next];
            count += 1;
        } else {
            context.note_copy(Copied { stored: references[count - 1].ids(), ids: references[next].ids() });
            // Their boxes differ where parts of them were cut off.
            let both = references[count - 1].bounds().union(Scalar, references[next].bounds());
            references[count - 1].set_bounds(&both);
        }
    }
    count
}

/// Splits what no rule can: the smaller half of the boxes from the larger.
#[cold]
fn halve<S: Simd>(simd: S, references: &mut [Reference]) -> Split {
    let extent = |reference: &Reference| reference.bounds().size().truncate().element_sum();
    references.sort_unstable_by(|a, b| extent(a).total_cmp(&extent(b)).then_with(|| a.ids().cmp(&b.ids())));
    Split::at(simd, references.len() / 2, references)
}
