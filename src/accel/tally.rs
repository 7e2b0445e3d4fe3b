//! What a query did, for those who ask.

/// What one query did: the same in every run. Instruction sets round bounds differently, so now and then a ray takes a
/// step more or less on another. A number that does not fit stays at `u32::MAX`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Nodes whose children's boxes were tested; a leaf is none.
    pub nodes_visited: u32,
    /// Cells that the ray was led through; 0 in structures without cells.
    pub cells_stepped: u32,
    /// Triangles and spheres of the leaves that were tested, each for itself or eight at once; without a structure, all.
    pub primitives_tested: u32,
}

/// Told what a query does, as it does it.
pub(crate) trait Tally: Copy + Default {
    fn visit_node(&mut self);
    fn step_cell(&mut self);
    fn test_primitives(&mut self, count: usize);
    /// What one query did after another.
    fn plus(self, other: Self) -> Self;
}

/// Nothing is counted, and nothing compiled.
impl Tally for () {
    #[inline(always)]
    fn visit_node(&mut self) {}

    #[inline(always)]
    fn step_cell(&mut self) {}

    #[inline(always)]
    fn test_primitives(&mut self, _count: usize) {}

    #[inline(always)]
    fn plus(self, _other: Self) -> Self {}
}

impl Tally for RayCounts {
    #[inline(always)]
    fn visit_node(&mut self) {
        self.nodes_visited = self.nodes_visited.saturating_add(1);
    }

    #[inline(always)]
    fn step_cell(&mut self) {
        self.cells_stepped = self.cells_stepped.saturating_add(1);
    }

    #[inline(always)]
    fn test_primitives(&mut self, count: usize) {
        self.primitives_tested = self.primitives_tested.saturating_add(u32::try_from(count).unwrap_or(u32::MAX));
    }

    fn plus(self, other: Self) -> Self {
        Self {
            nodes_visited: self.nodes_visited.saturating_add(other.nodes_visited),
            cells_stepped: self.cells_stepped.saturating_add(other.cells_stepped),
            primitives_tested: self.primitives_tested.saturating_add(other.primitives_tested),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_beyond_32_bits_stay_at_the_greatest() {
        let mut counts = RayCounts { nodes_visited: u32::MAX, primitives_tested: u32::MAX - 1, ..RayCounts::default() };
        counts.visit_node();
        counts.test_primitives(8);
        assert_eq!((counts.nodes_visited, counts.primitives_tested), (u32::MAX, u32::MAX));
        let mut counts = RayCounts::default();
        counts.test_primitives(1 << 32);
        assert_eq!(counts.primitives_tested, u32::MAX);
    }
}
