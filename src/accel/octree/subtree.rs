//! What one thread grows: the tree below a cell.

use super::StopRule;
use super::cell::{Cell, Cube, Cut};
use super::node::{MOST_LEVELS, Node};
use crate::accel::{BuildContext, BuildFailure, Primitive};

/// How often a primitive may be listed on average, in each part of the tree: what bounds the memory.
const MOST_GROWTH: f64 = 16.0;

/// What is to become a node.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) cell: Cell,
    /// The root's is 1.
    pub(super) level: usize,
    /// How many times as often primitives are listed here as in the root, if this were the whole tree.
    pub(super) growth: f64,
}

impl Part {
    pub(super) fn can_be_cut(&self, count: usize, rule: StopRule) -> bool {
        count > rule.most_in_leaf && self.level < MOST_LEVELS
    }

    /// Whether cutting pays, by how many primitives each octant then lists. Each octant has a quarter of the cell's
    /// surface, so a ray that meets the cell meets it with a probability of a quarter (MacDonald and Booth 1990).
    pub(super) fn is_worth_cutting(&self, count: usize, counts: &[usize; 8], rule: StopRule) -> bool {
        let listed = counts.iter().sum::<usize>() as f64;
        rule.node_cost + 0.25 * listed < count as f64 && self.growth * listed <= MOST_GROWTH * count as f64
    }

    pub(super) fn octant(&self, octant: usize, count: usize, counts: &[usize; 8]) -> Self {
        let listed = counts.iter().sum::<usize>();
        Self {
            cell: self.cell.octant(octant as u32),
            level: self.level + 1,
            growth: self.growth * listed as f64 / count as f64,
        }
    }

    /// Of a ray that meets the node, in units of the square of a length.
    pub(super) fn cost(&self, tests: f64) -> f64 {
        12.0 * self.cell.half * self.cell.half * tests
    }
}

/// A bit for each octant with a count.
pub(super) fn octants_with_any(counts: &[usize; 8]) -> u8 {
    counts.iter().enumerate().fold(0, |octants, (octant, &count)| octants | u8::from(count > 0) << octant)
}

/// Nodes as in [`super::Octree`]; all numbers count from its own beginning.
#[derive(Default)]
pub(super) struct Subtree {
    pub(super) nodes: Vec<Node>,
    pub(super) listed: Vec<u32>,
    pub(super) leaf_count: usize,
    pub(super) depth: usize,
    pub(super) cost: f64,
}

pub(super) struct Grower<'a, T> {
    pub(super) primitives: &'a [T],
    pub(super) cube: &'a Cube,
    pub(super) rule: StopRule,
    pub(super) context: &'a BuildContext<'a>,
    tree: Subtree,
    /// The lists of the cell at work, of its siblings and of those of all cells above.
    lists: Vec<u32>,
    masks: Vec<u8>,
}

impl<'a, T: Primitive> Grower<'a, T> {
    pub(super) fn new(primitives: &'a [T], cube: &'a Cube, rule: StopRule, context: &'a BuildContext<'a>) -> Self {
        Self { primitives, cube, rule, context, tree: Subtree::default(), lists: Vec::new(), masks: Vec::new() }
    }

    pub(super) fn grow(mut self, list: &[u32], part: Part) -> Result<Subtree, BuildFailure> {
        self.lists.extend_from_slice(list);
        self.context.make_room(&mut self.tree.nodes, 1)?;
        self.tree.nodes.push(Node::EMPTY);
        self.grow_node(0, 0, list.len(), part)?;
        Ok(self.tree)
    }

    /// The node's list begins at `begin` and is the last one.
    fn grow_node(&mut self, at: usize, begin: usize, count: usize, part: Part) -> Result<(), BuildFailure> {
        self.tree.depth = self.tree.depth.max(part.level);
        let end = begin + count;
        if part.can_be_cut(count, self.rule) {
            let cut = Cut::new(self.cube, &part.cell);
            let mut counts = [0; 8];
            self.masks.clear();
            for &number in &self.lists[begin..end] {
                let octants = cut.octants_of(&self.primitives[number as usize]);
                for (octant, count) in counts.iter_mut().enumerate() {
                    *count += usize::from(octants >> octant & 1);
                }
                self.masks.push(octants);
            }
            if part.is_worth_cutting(count, &counts, self.rule) {
                return self.grow_children(at, begin, counts, part);
            }
        }
        self.tree.nodes[at] = Node::leaf(self.tree.listed.len(), count);
        self.tree.leaf_count += 1;
        self.tree.cost += part.cost(count as f64);
        self.context.make_room(&mut self.tree.listed, count)?;
        self.tree.listed.extend_from_slice(&self.lists[begin..end]);
        Ok(())
    }

    fn grow_children(&mut self, at: usize, begin: usize, counts: [usize; 8], part: Part) -> Result<(), BuildFailure> {
        let count = self.masks.len();
        let mut end = begin + count;
        let begins = counts.map(|count| {
            end += count;
            end - count
        });
        self.lists.truncate(begin + count);
        self.lists.resize(end, 0);
        let mut ends = begins;
        for index in 0..count {
            let (number, mut octants) = (self.lists[begin + index], self.masks[index]);
            while octants != 0 {
                let end = &mut ends[octants.trailing_zeros() as usize];
                self.lists[*end] = number;
                *end += 1;
                octants &= octants - 1;
            }
        }

        let first = self.tree.nodes.len();
        let octants = octants_with_any(&counts);
        let child_count = octants.count_ones() as usize;
        self.tree.nodes[at] = Node::with_children(first, octants);
        self.tree.cost += part.cost(self.rule.node_cost);
        self.context.make_room(&mut self.tree.nodes, child_count)?;
        self.tree.nodes.resize(first + child_count, Node::EMPTY);
        // The last one first, so that its list is the last.
        let mut child = first + child_count;
        for octant in (0..8).rev().filter(|&octant| counts[octant] > 0) {
            child -= 1;
            self.lists.truncate(begins[octant] + counts[octant]);
            self.grow_node(child, begins[octant], counts[octant], part.octant(octant, count, &counts))?;
        }
        Ok(())
    }
}
