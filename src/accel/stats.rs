//! The choices a build has, and what it tells about itself.

/// A structure, as asked for and as built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Structure {
    /// The best there is for the scene: brute force for a handful of triangles, else the wide BVH.
    #[default]
    Auto,
    /// Every triangle is asked.
    BruteForce,
    /// Uniform grid.
    Grid,
    /// Octree.
    Octree,
    /// kd-tree.
    KdTree,
    /// BSP tree with planes of any direction.
    BspTree,
    /// Binary bounding volume hierarchy.
    Bvh,
    /// Bounding volume hierarchy with many children a node.
    WideBvh,
}

/// How much a build may spend on queries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// Fastest build.
    Low,
    /// Good for both.
    #[default]
    Medium,
    /// Best queries.
    High,
}

/// How hits are decided and computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// Decided in `f32`, watertight; `t`, `u`, `v` from what decided.
    Fast,
    /// Decided as [`Precision::Fast`]; `t` within 0.51 ulp, `u` and `v` within 0.52 x 2^-24.
    #[default]
    Accurate,
    /// Decided as if nothing was rounded; `t` rounded once, `u` and `v` as [`Precision::Accurate`].
    Exact,
}

/// What a build made.
#[derive(Clone, Copy, Debug)]
pub struct Stats {
    /// Triangles that were added, without the skipped ones.
    pub triangle_count: u64,
    /// Nodes, leaves among them; the cells of a grid.
    pub node_count: u64,
    /// Nodes without children; the cells of a grid.
    pub leaf_count: u64,
    /// Triangles and spheres stored: not those of zero area or radius, which nothing hits, nor all of those that are the
    /// same to the bit and that a BVH cannot tell apart. Where leaves divide space, one counts in each that it overlaps.
    pub reference_count: u64,
    /// Triangles and spheres left out because they are invalid.
    pub skipped_count: u64,
    /// Nodes on the longest way from the root to a leaf, both counted; 0 without nodes.
    pub depth: u32,
    /// What was built.
    pub structure: Structure,
    /// What queries use.
    pub precision: Precision,
    /// What queries use.
    pub isa: crate::simd::Isa,
    /// What the scene holds.
    pub bytes: u64,
    /// Of these, for nodes.
    pub node_bytes: u64,
    /// Of these, for triangles.
    pub leaf_bytes: u64,
    /// The most that the build held at a time, the scene among it.
    pub peak_build_bytes: u64,
    /// Wall-clock time.
    pub build_seconds: f64,
    /// Expected cost of a random ray, in triangle tests (MacDonald and Booth 1990); NaN where it has no meaning. With
    /// triangles and spheres the sum of both structures'.
    pub sah_cost: f64,
    /// Spheres that were added, without the skipped ones.
    pub sphere_count: u64,
}

/// What a structure tells about itself; the scene knows the rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    pub(crate) reference_count: usize,
    pub(crate) node_count: usize,
    pub(crate) leaf_count: usize,
    pub(crate) depth: u32,
    pub(crate) node_bytes: usize,
    pub(crate) leaf_bytes: usize,
    pub(crate) sah_cost: f64,
}
