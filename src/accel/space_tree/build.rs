//! Building top down: a rule chooses planes, and what they divide goes to one side or, cut, to both.

use arrayvec::ArrayVec;

use super::node::{ANY, MOST_LEVELS, MOST_PAIRS, Node, NodePair};
use super::pack::{numbered, pack};
use super::sah::NODE_COST;
use super::{Plane, SpaceTree};
use crate::accel::{BuildContext, BuildFailure, Copied, Primitive, PrimitiveSource};
use crate::geometry::Aabb;

/// A plane that divides a cell.
#[derive(Clone, Copy, Debug)]
pub(in crate::accel) enum Split {
    /// Of a fixed direction.
    Fixed {
        direction: u32,
        position: f32,
        /// On which side a piece goes that lies in the plane.
        is_planar_below: bool,
    },
    Any(Plane),
}

/// Where a piece goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::accel) enum Side {
    Below,
    Above,
    Both,
}

/// What differs between trees of planes: what a cell is, and what is known of a primitive in it.
pub(in crate::accel) trait Divide: Sync {
    type Cell: Clone + Send;
    /// A primitive's part in a cell.
    type Piece: Copy + Send + Sync;
    /// What a choice needs room for, kept from node to node.
    type Scratch: Default;

    /// The cost of testing one primitive, in steps down.
    const PRIMITIVE_COST: f64;
    /// How many times a primitive may be listed, on average: ends what would not end in time.
    const MOST_COPIES: usize;

    /// The primitive's number in its source.
    fn number(&self, piece: &Self::Piece) -> u32;
    /// Half the surface.
    fn half_area(&self, cell: &Self::Cell) -> f64;
    /// `None` for a leaf.
    fn choose(
        &self,
        cell: &Self::Cell,
        pieces: &[Self::Piece],
        level: usize,
        scratch: &mut Self::Scratch,
    ) -> Option<Split>;
    /// The two parts of a cell.
    fn divide(&self, cell: &Self::Cell, split: &Split) -> [Self::Cell; 2];
    fn side(&self, piece: &Self::Piece, split: &Split) -> Side;
    /// The two parts of a piece that goes to both sides.
    fn cut(&self, piece: &Self::Piece, split: &Split, cells: &[Self::Cell; 2]) -> [Self::Piece; 2];
}

/// Smaller trees are built by one thread without a look at the watch.
const MOST_IN_SUBTREE: usize = 4096;

/// A longer list is searched for primitives that are the same to the bit.
const MOST_UNSEARCHED: usize = 16;

pub(super) enum Branch {
    Subtree(Subtree),
    Node { split: Split, cost: f64, children: Box<[Branch; 2]> },
}

pub(super) struct Subtree {
    pub(super) root: Node,
    pub(super) pairs: Vec<NodePair>,
    pub(super) planes: Vec<Plane>,
    /// Numbers in the source.
    pub(super) lists: Vec<u32>,
    pub(super) depth: usize,
    /// Of its nodes, times their surface.
    pub(super) cost: f64,
}

/// A cell that is to become a node. `budget` is how many primitives may be listed below it.
struct Part<C, P> {
    cell: C,
    pieces: Vec<P>,
    level: usize,
    budget: usize,
}

struct Builder<'a, D, S> {
    divide: &'a D,
    source: &'a S,
    most_levels: usize,
    context: &'a BuildContext<'a>,
}

pub(super) fn build<D: Divide, S: PrimitiveSource>(
    divide: &D,
    cell: D::Cell,
    pieces: Vec<D::Piece>,
    bounds: Aabb,
    source: &S,
    context: &BuildContext,
) -> Result<SpaceTree<S::Primitive>, BuildFailure> {
    let count = pieces.len();
    if count >= MOST_PAIRS {
        return Err(BuildFailure::TooManyTriangles { count, limit: MOST_PAIRS - 1 });
    }
    let budget = count.saturating_mul(D::MOST_COPIES).min(u32::MAX as usize);
    context.expect(budget);
    let root_area = divide.half_area(&cell);
    let builder = Builder { divide, source, most_levels: most_levels(count), context };
    let branch = builder.build(Part { cell, pieces, level: 1, budget })?;
    pack(branch, bounds, root_area, source, context)
}

/// For a tree of `count` primitives, of the form that Havran gives (2000, "Heuristic ray shooting algorithms", section
/// 4.5); with some more, for planes that cut off empty space.
fn most_levels(count: usize) -> usize {
    const AT_LEAST: f64 = 12.0;
    const EACH_DOUBLING: f64 = 1.6;
    (AT_LEAST + EACH_DOUBLING * (count as f64).log2()).min(MOST_LEVELS as f64) as usize
}

/// Each side's part of what a node may spend.
fn share(budget: usize, counts: [usize; 2]) -> [usize; 2] {
    let [below, above] = counts.map(|count| count as u128);
    let first = (budget as u128 * below).checked_div(below + above).unwrap_or(0) as usize;
    // Never less than what is there.
    let first = first.clamp(counts[0], budget - counts[1]);
    [first, budget - first]
}

impl<D: Divide, S: PrimitiveSource> Builder<'_, D, S> {
    fn build(&self, part: Part<D::Cell, D::Piece>) -> Result<Branch, BuildFailure> {
        self.context.check()?;
        if part.pieces.len() <= MOST_IN_SUBTREE {
            return self.subtree(part);
        }
        let Part { cell, pieces, level, budget } = part;
        let Some((split, counts)) = self.choose(&cell, &pieces, level, budget, &mut D::Scratch::default()) else {
            return self.subtree(Part { cell, pieces, level, budget });
        };
        let cells = self.divide.divide(&cell, &split);
        let [mut below, mut above] = [self.context.reserve(counts[0])?, self.context.reserve(counts[1])?];
        for piece in &pieces {
            match self.divide.side(piece, &split) {
                Side::Below => below.push(*piece),
                Side::Above => above.push(*piece),
                Side::Both => {
                    let [low, high] = self.divide.cut(piece, &split, &cells);
                    below.push(low);
                    above.push(high);
                }
            }
        }
        self.context.release(pieces);
        let cost = NODE_COST * self.divide.half_area(&cell);
        let ([below_cell, above_cell], budgets) = (cells, share(budget, counts));
        let below = Part { cell: below_cell, pieces: below, level: level + 1, budget: budgets[0] };
        let above = Part { cell: above_cell, pieces: above, level: level + 1, budget: budgets[1] };
        let (below, above) = self.context.join(|| self.build(below), || self.build(above));
        Ok(Branch::Node { split, cost, children: Box::new([below?, above?]) })
    }

    /// The rule's choice if there is room for it, and how many pieces it puts on each side.
    fn choose(
        &self,
        cell: &D::Cell,
        pieces: &[D::Piece],
        level: usize,
        budget: usize,
        scratch: &mut D::Scratch,
    ) -> Option<(Split, [usize; 2])> {
        if level >= self.most_levels || pieces.is_empty() {
            return None;
        }
        let split = self.divide.choose(cell, pieces, level, scratch)?;
        let mut counts = [0; 2];
        for piece in pieces {
            let side = self.divide.side(piece, &split);
            counts[0] += usize::from(side != Side::Above);
            counts[1] += usize::from(side != Side::Below);
        }
        (counts[0] + counts[1] <= budget).then_some((split, counts))
    }

    fn subtree(&self, part: Part<D::Cell, D::Piece>) -> Result<Branch, BuildFailure> {
        let budget = part.budget;
        let grown = self.grow(part)?;
        self.context.advance(budget)?;
        Ok(Branch::Subtree(Subtree {
            pairs: self.keep(&grown.pairs)?,
            planes: self.keep(&grown.planes)?,
            lists: self.keep(&grown.lists)?,
            ..grown
        }))
    }

    /// By this thread alone. The pieces of all nodes that wait stand one after the other, those of the node at work last.
    fn grow(&self, part: Part<D::Cell, D::Piece>) -> Result<Subtree, BuildFailure> {
        let Part { cell, mut pieces, level, budget } = part;
        let mut scratch = D::Scratch::default();
        let mut below = Vec::new();
        let mut tree = Subtree::EMPTY;
        let mut waiting = ArrayVec::<Waiting<D::Cell>, MOST_LEVELS>::new();
        let mut at_work = Waiting { begin: 0, cell, level, budget, place: None };
        loop {
            let Waiting { begin, cell, level, budget, place } = at_work;
            tree.depth = tree.depth.max(level);
            let area = self.divide.half_area(&cell);
            if let Some((split, counts)) = self.choose(&cell, &pieces[begin..], level, budget, &mut scratch) {
                let cells = self.divide.divide(&cell, &split);
                below.clear();
                let mut end = begin;
                for at in begin..pieces.len() {
                    let piece = pieces[at];
                    let above = match self.divide.side(&piece, &split) {
                        Side::Below => {
                            below.push(piece);
                            continue;
                        }
                        Side::Above => piece,
                        Side::Both => {
                            let [low, high] = self.divide.cut(&piece, &split, &cells);
                            below.push(low);
                            high
                        }
                    };
                    pieces[end] = above;
                    end += 1;
                }
                pieces.truncate(end);
                self.make_room(&mut pieces, below.len())?;
                pieces.extend_from_slice(&below);
                let pair = tree.pairs.len();
                tree.pairs.push(NodePair::EMPTY);
                let node = inner(&split, pair, &mut tree.planes);
                tree.put(place, node);
                tree.cost += NODE_COST * area;
                let ([below_cell, above_cell], budgets) = (cells, share(budget, counts));
                let child = |begin, cell, side| Waiting {
                    begin,
                    cell,
                    level: level + 1,
                    budget: budgets[side],
                    place: Some((pair, side)),
                };
                waiting.push(child(begin, above_cell, 1));
                at_work = child(end, below_cell, 0);
                continue;
            }
            let listed = tree.lists.len();
            tree.lists.extend(pieces[begin..].iter().map(|piece| self.divide.number(piece)));
            pieces.truncate(begin);
            if tree.lists.len() - listed > MOST_UNSEARCHED {
                let distinct = drop_duplicates(&mut tree.lists[listed..], self.source, self.context);
                tree.lists.truncate(listed + distinct);
            }
            let count = tree.lists.len() - listed;
            tree.put(place, Node::leaf(listed, count));
            tree.cost += D::PRIMITIVE_COST * count as f64 * area;
            let Some(next) = waiting.pop() else { break };
            at_work = next;
        }
        self.context.release(pieces);
        Ok(tree)
    }

    /// As [`Vec::reserve`], counted.
    fn make_room<T: Copy>(&self, vector: &mut Vec<T>, additional: usize) -> Result<(), BuildFailure> {
        let needed = vector.len() + additional;
        if needed > vector.capacity() {
            let mut larger = self.context.reserve(2 * needed)?;
            larger.extend_from_slice(vector);
            self.context.release(std::mem::replace(vector, larger));
        }
        Ok(())
    }

    /// A copy that is counted.
    fn keep<T: Copy>(&self, values: &[T]) -> Result<Vec<T>, BuildFailure> {
        let mut kept = self.context.reserve(values.len())?;
        kept.extend_from_slice(values);
        Ok(kept)
    }
}

/// A node that waits, or is at work: its pieces begin with `begin`.
struct Waiting<C> {
    begin: usize,
    cell: C,
    level: usize,
    budget: usize,
    /// The pair, and which of the two it is; `None` for the root.
    place: Option<(usize, usize)>,
}

impl Subtree {
    const EMPTY: Self =
        Self { root: Node::EMPTY_LEAF, pairs: Vec::new(), planes: Vec::new(), lists: Vec::new(), depth: 0, cost: 0.0 };

    fn put(&mut self, place: Option<(usize, usize)>, node: Node) {
        match place {
            None => self.root = node,
            Some((pair, side)) => self.pairs[pair].children[side] = node,
        }
    }
}

/// The node of a split; a plane of any direction goes to the table.
pub(super) fn inner(split: &Split, pair: usize, planes: &mut Vec<Plane>) -> Node {
    match *split {
        Split::Fixed { direction, position, .. } => Node::inner(direction, position.to_bits(), pair),
        Split::Any(plane) => {
            planes.push(plane);
            Node::inner(ANY, planes.len() as u32 - 1, pair)
        }
    }
}

/// Keeps, of primitives that are the same to the bit, the one whose hits win: numbers are in the order of the ids.
/// Returns how many are left, at the front.
#[cold]
fn drop_duplicates<S: PrimitiveSource>(numbers: &mut [u32], source: &S, context: &BuildContext) -> usize {
    let shape = |number: &u32| numbered(source, *number).shape();
    numbers.sort_by_cached_key(|number| (shape(number), *number));
    let mut count = 1;
    for next in 1..numbers.len() {
        if shape(&numbers[next]) != shape(&numbers[count - 1]) {
            numbers[count] = numbers[next];
            count += 1;
        } else {
            let ids = |number: u32| numbered(source, number).ids();
            context.note_copy(Copied { stored: ids(numbers[count - 1]), ids: ids(numbers[next]) });
        }
    }
    count
}
