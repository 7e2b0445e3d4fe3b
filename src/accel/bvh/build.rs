//! Building top down: references to triangles are split until a rule says leaf; the rules are in files of their own.

use arrayvec::ArrayVec;

use super::node::{MOST_LEVELS, Node};
use crate::accel::reference::{Bounds8, PrimitiveSource, Reference};
use crate::accel::{BuildContext, BuildFailure, Primitive};
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
fn union<S: Simd>(simd: S, references: &[Reference]) -> Bounds8 {
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
}

/// From here halving 2^32 references ends in time.
const LAST_FREE_LEVEL: usize = MOST_LEVELS - 33;

/// Smaller trees are built by one thread without a look at the watch.
pub(super) const MOST_IN_SUBTREE: usize = 4096;

/// The references are reordered; the tree's subtrees have them.
pub(in crate::accel) fn build<'r, R: SplitRule, T: PrimitiveSource>(
    references: &'r mut [Reference],
    rule: &R,
    source: &T,
    context: &BuildContext,
) -> Result<BinaryTree<'r>, BuildFailure> {
    let bounds = union_together(references, context);
    let part = Part { references, bounds, level: 0, is_distinct: false };
    let branch = Builder { rule, source, context }.build(part)?;
    let mut tree = BinaryTree { top: Vec::new(), subtrees: Vec::new(), depth: 0 };
    tree.append(branch);
    Ok(tree)
}

/// What is to become a node, and what lies below it.
struct Part<'r> {
    references: &'r mut [Reference],
    bounds: Bounds8,
    level: usize,
    /// Whether no triangle is there twice.
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
        if part.references.len() <= MOST_IN_SUBTREE {
            return self.subtree(part);
        }
        let Part { mut references, bounds, level, mut is_distinct } = part;
        let mut split = None;
        if level < LAST_FREE_LEVEL {
            split = self.rule.split_together(references, &bounds, self.context);
        }
        if split.is_none() && !is_distinct {
            is_distinct = true;
            let count = drop_duplicates(references, self.source);
            references = &mut references[..count];
            if count <= MOST_IN_SUBTREE {
                return self.subtree(Part { references, bounds, level, is_distinct });
            }
        }
        let Split { middle, bounds: [left_bounds, right_bounds] } = split.unwrap_or_else(|| halve(Scalar, references));
        let (left, right) = references.split_at_mut(middle);
        let left = Part { references: left, bounds: left_bounds, level: level + 1, is_distinct };
        let right = Part { references: right, bounds: right_bounds, level: level + 1, is_distinct };
        let (left, right) = self.context.join(|| self.build(left), || self.build(right));
        Ok(Branch::Node { bounds, children: Box::new([left?, right?]) })
    }

    fn subtree<'r>(&self, part: Part<'r>) -> Result<Branch<'r>, BuildFailure> {
        let count = part.references.len();
        let nodes = self.context.reserve(2 * count - 1)?;
        let (mut subtree, depth) =
            self.context.vectorize(GrowSubtree { rule: self.rule, source: self.source, nodes, part });
        self.context.shrink(&mut subtree.nodes);
        self.context.advance(count)?;
        Ok(Branch::Subtree { subtree, depth })
    }
}

struct GrowSubtree<'a, 'r, R, T> {
    rule: &'a R,
    source: &'a T,
    /// Empty, with room for all.
    nodes: Vec<Node>,
    part: Part<'r>,
}

/// A node that waits, or is at work: its references are those from `begin` to `end`.
#[derive(Clone, Copy)]
struct Waiting {
    begin: usize,
    end: usize,
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
        let Self { rule, source, mut nodes, part: Part { references, bounds, level, is_distinct } } = self;
        let mut scratch = R::Scratch::default();
        let mut waiting = ArrayVec::<Waiting, MOST_LEVELS>::new_const();
        let mut at_work = Waiting { begin: 0, end: references.len(), bounds, level, is_distinct, parent: 0 };
        let (mut deepest, mut stored) = (level, 0);
        loop {
            let Waiting { begin, mut end, bounds, level, mut is_distinct, .. } = at_work;
            deepest = deepest.max(level);
            let mut split = None;
            if end - begin > 1 && level < LAST_FREE_LEVEL {
                split = rule.split(simd, &mut references[begin..end], &bounds, &mut scratch);
            }
            if split.is_none() && end - begin > rule.most_in_leaf() {
                if !is_distinct {
                    is_distinct = true;
                    end = begin + drop_duplicates(&mut references[begin..end], source);
                }
                if end - begin > rule.most_in_leaf() {
                    split = Some(halve(simd, &mut references[begin..end]));
                }
            }
            let aabb = bounds.to_aabb();
            if let Some(Split { middle, bounds: [left_bounds, right_bounds] }) = split {
                let (middle, level) = (begin + middle, level + 1);
                let right =
                    Waiting { begin: middle, end, bounds: right_bounds, level, is_distinct, parent: nodes.len() };
                waiting.push(right);
                at_work = Waiting { begin, end: middle, bounds: left_bounds, level, is_distinct, parent: 0 };
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
fn drop_duplicates(references: &mut [Reference], source: &impl PrimitiveSource) -> usize {
    let shape = |reference: &Reference| reference.primitive(source).shape();
    references.sort_by_cached_key(|reference| (shape(reference), reference.ids()));
    let mut count = 1;
    for next in 1..references.len() {
        if shape(&references[next]) != shape(&references[count - 1]) {
            references[count] = references[next];
            count += 1;
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
