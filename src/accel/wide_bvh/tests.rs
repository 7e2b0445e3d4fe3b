//! What the builders make of hard input, and that it does not depend on the threads.

use std::time::{Duration, Instant};

use glam::Vec3;

use super::leaves::{ByAxis, LeafForm, LeafTriangles, TriangleForm};
use super::node::Child;
use super::{Compact, WideBvh, check_count};
use crate::accel::leaf::Counted;
use crate::accel::{BuildContext, BuildFailure, PrimitiveSource, Quality, Reference, Watch};
use crate::geometry::{Aabb, Accurate, Ray, Triangle};
use crate::simd::{Isa, Scalar};

/// One geometry.
struct Soup {
    triangles: Vec<Triangle>,
    starts: [u32; 2],
}

impl PrimitiveSource for Soup {
    type Primitive = Triangle;

    fn primitive(&self, _geometry_id: u32, primitive_id: u32) -> Triangle {
        self.triangles[primitive_id as usize]
    }

    fn starts(&self) -> &[u32] {
        &self.starts
    }
}

impl Soup {
    fn new(count: u32, vertices: impl Fn(u32) -> [[f32; 3]; 3]) -> Self {
        let triangles = (0..count).map(|id| Triangle::new(vertices(id), 0, id)).collect();
        Self { triangles, starts: [0, count] }
    }

    fn build(&self, quality: Quality, isa: Isa, thread_count: usize) -> WideBvh {
        self.build_in_form(quality, isa, thread_count)
    }

    fn build_in_form<F: TriangleForm>(&self, quality: Quality, isa: Isa, thread_count: usize) -> WideBvh<F> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count).build().expect("a few threads");
        let watch = Watch::default();
        let context = BuildContext::new((thread_count > 1).then_some(&pool), None, isa, &watch);
        let references =
            self.triangles.iter().map(|triangle| Reference::new(&triangle.bounds(), 0, triangle.primitive_id));
        let bounds = self.triangles.iter().map(Triangle::bounds).fold(Aabb::EMPTY, Aabb::union);
        let references = references.collect();
        // The build validates the tree.
        context.install(|| WideBvh::build(references, bounds, quality, self, &context)).expect("nothing limits it")
    }
}

/// In `[0, 1)`, the same for the same seed (SplitMix64; Steele, Lea, Flood 2014).
fn random(seed: u32) -> f32 {
    let z = (u64::from(seed) + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
}

fn small_triangle(id: u32, size: f32) -> [[f32; 3]; 3] {
    let at = |axis: u32| random(3 * id + axis);
    let [x, y, z] = [at(0), at(1), at(2)];
    [[x, y, z], [x + size, y, z], [x, y + size, z + size]]
}

const QUALITIES: [Quality; 3] = [Quality::Low, Quality::Medium, Quality::High];

/// Among small ones every twentieth is long and thin, along the diagonal of the axes.
fn diagonals(count: u32) -> Soup {
    Soup::new(count, |id| {
        let size = if id % 20 == 0 { 0.25 } else { 0.005 };
        let [start, right, above] = small_triangle(id, size);
        if id % 20 == 0 {
            [start, [right[0], above[1], above[2]], [right[0], above[1] + 0.0025, above[2]]]
        } else {
            [start, right, above]
        }
    })
}

/// Whether threads and instruction sets make no difference to the bytes of a tree.
fn check_bytes<F: TriangleForm>() {
    let soup = Soup::new(60_000, |id| small_triangle(id, if id % 100 == 0 { 0.3 } else { 0.01 }));
    for quality in QUALITIES {
        check_bytes_of::<F>(&soup, quality);
    }
    check_bytes_of::<F>(&diagonals(20_000), Quality::High);
}

fn check_bytes_of<F: TriangleForm>(soup: &Soup, quality: Quality) {
    let expected: WideBvh<F> = soup.build_in_form(quality, Isa::Scalar, 1);
    for (isa, thread_count) in [(Isa::Auto, 1), (Isa::Sse42, 2), (Isa::Auto, 2), (Isa::Auto, 3)] {
        let other: WideBvh<F> = soup.build_in_form(quality, isa, thread_count);
        let is_same = format!("{:?}", other.nodes) == format!("{:?}", expected.nodes)
            && other.leaves.bits().eq(expected.leaves.bits());
        assert!(is_same, "{quality:?} {isa:?} {thread_count} threads");
    }
}

#[test]
fn the_bytes_are_the_same_for_any_number_of_threads_and_any_instruction_set() {
    check_bytes::<ByAxis>();
    check_bytes::<Compact>();
}

/// A height field of `side` times `side` vertices, two triangles a cell.
fn height_field(side: u32) -> Soup {
    let vertex = |x: u32, y: u32| [x as f32, y as f32, random(x + side * y)];
    Soup::new(2 * (side - 1) * (side - 1), |id| {
        let (x, y) = (id / 2 % (side - 1), id / 2 / (side - 1));
        let (right, above) = (vertex(x + 1, y), vertex(x, y + 1));
        if id % 2 == 0 { [vertex(x, y), right, above] } else { [vertex(x + 1, y + 1), above, right] }
    })
}

/// The children that are leaves.
fn leaves_of<F: TriangleForm>(bvh: &WideBvh<F>) -> Vec<Child> {
    let (mut found, mut pending) = (Vec::new(), vec![Child::ROOT]);
    while let Some(child) = pending.pop() {
        if child.is_leaf() {
            found.push(child);
            continue;
        }
        let node = &bvh.nodes[child.node_index()];
        pending.extend(
            (0..8).filter(|&slot| node.planes[0][0][slot] <= node.planes[0][1][slot]).map(|slot| node.children[slot]),
        );
    }
    found
}

#[test]
fn high_cuts_long_diagonal_triangles_and_no_others() {
    // The build validates that the parts cover them.
    let soup = diagonals(20_000);
    let high = soup.build(Quality::High, Isa::Auto, 2).shape();
    assert!(high.reference_count > 21_000 && high.reference_count <= 25_000, "{} references", high.reference_count);
    let soup = height_field(100);
    assert_eq!(soup.build(Quality::High, Isa::Auto, 2).shape().reference_count, soup.triangles.len());
}

/// Off its surface by a float, in a scene that is large beside that.
#[test]
fn a_ray_that_leaves_a_wall_tests_none_of_it() {
    const SIDE: u32 = 64;
    let at = |step: u32| step as f32 * 3.7 - 41.0;
    let wall = |axis: usize| {
        Soup::new(2 * SIDE * SIDE, move |id| {
            let (x, y) = (id / 2 % SIDE, id / 2 / SIDE);
            let (x, y) = ([at(x), at(x + 1)], [at(y), at(y + 1)]);
            let corners = if id % 2 == 0 { [(0, 0), (1, 0), (0, 1)] } else { [(1, 1), (0, 1), (1, 0)] };
            corners.map(|(right, up)| {
                let mut corner = [0.0; 3];
                (corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3]) = (77.925, x[right], y[up]);
                corner
            })
        })
    };
    for axis in 0..3 {
        let bvh = wall(axis).build(Quality::Medium, Isa::Scalar, 1);
        for step in 0..500 {
            let mut origin = Vec3::splat(0.0);
            let mut direction =
                Vec3::new(random(3 * step) - 0.5, random(3 * step + 1) - 0.5, random(3 * step + 2) - 0.5);
            for other in [(axis + 1) % 3, (axis + 2) % 3] {
                origin[other] = 150.0 * random(1000 * other as u32 + step) - 20.0;
            }
            direction[axis] = direction[axis].abs() + 1e-6;
            for side in [-1.0, 1.0] {
                origin[axis] = if side > 0.0 { 77.925f32.next_up() } else { 77.925f32.next_down() };
                direction[axis] = side * direction[axis].abs();
                let ray = Ray { origin, t_min: 0.0, direction, t_max: f32::INFINITY };
                let (hit, counts) = bvh.find::<Counted, Accurate, _>(Scalar, ray);
                assert!(hit.is_none() && counts.primitives_tested == 0, "{ray:?}");
            }
        }
    }
}

#[test]
fn compact_leaves_hold_each_triangle_once_and_within_36_bytes() {
    let soup = height_field(200);
    for quality in QUALITIES {
        let bvh: WideBvh<Compact> = soup.build_in_form(quality, Isa::Auto, 2);
        let mut seen = vec![false; soup.triangles.len()];
        for child in leaves_of(&bvh) {
            let leaf = bvh.leaves.leaf(child.triangles());
            for lane in 0..child.triangles().1 {
                let triangle = leaf.triangle(lane);
                assert_eq!(triangle.axes, soup.triangles[triangle.primitive_id as usize].axes);
                assert!(
                    !std::mem::replace(&mut seen[triangle.primitive_id as usize], true),
                    "{triangle:?} is there twice"
                );
            }
        }
        assert!(seen.iter().all(|&seen| seen));
        let ordinary = soup.build(quality, Isa::Auto, 2);
        let (shape, ordinary) = (bvh.shape(), ordinary.shape());
        assert_eq!((shape.node_bytes, shape.sah_cost), (ordinary.node_bytes, ordinary.sah_cost));
        let bytes = (shape.node_bytes + shape.leaf_bytes) as f64 / soup.triangles.len() as f64;
        assert!(bytes <= 36.0, "{quality:?}: {bytes} bytes a triangle");
    }
}

#[test]
fn identical_triangles_are_stored_once_with_the_lowest_id() {
    let soup = Soup::new(300_000, |_| [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]]);
    for quality in QUALITIES {
        let bvh = soup.build(quality, Isa::Auto, 2);
        assert_eq!(bvh.leaves.primitive_count(), 1);
        assert_eq!(bvh.leaves.leaf((0, 1)).triangle(0).primitive_id, 0);
    }
}

#[test]
fn few_different_triangles_many_times_end_in_one_leaf_each() {
    // Two triangles with the same box, and one elsewhere.
    let soup = Soup::new(30_000, |id| match id % 3 {
        0 => [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]],
        1 => [[1.0, 1.0, 0.0], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5]],
        _ => [[5.0, 5.0, 5.0], [6.0, 5.0, 5.0], [5.0, 6.0, 5.0]],
    });
    assert_eq!(soup.build(Quality::Medium, Isa::Auto, 2).leaves.primitive_count(), 3);
}

#[test]
fn hard_arrangements_build_in_time() {
    const COUNT: u32 = 200_000;
    let exponential = |id: u32| 2.0f32.powf(250.0 * random(id) - 125.0);
    let arrangements: [(&str, Soup); 6] = [
        ("plane", Soup::new(COUNT, |id| small_triangle(id, 0.01).map(|[x, y, _]| [x, y, 0.25]))),
        ("line", Soup::new(COUNT, |id| small_triangle(id, 0.01).map(|[x, y, z]| [x, 1e-6 * y, 1e-7 * z]))),
        (
            "one huge",
            Soup::new(COUNT, |id| small_triangle(id, 1e-4).map(|v| v.map(|c| if id == 0 { 1e6 * c } else { c }))),
        ),
        (
            "one centre",
            Soup::new(COUNT, |id| {
                let size = 1.0 + id as f32;
                [[-size, -size, -size], [size, size, -size], [-size, size, size]]
            }),
        ),
        ("every magnitude", Soup::new(COUNT, |id| small_triangle(id, 0.5).map(|v| v.map(|c| c * exponential(id))))),
        ("as large as floats", Soup::new(COUNT, |id| small_triangle(id, 0.1).map(|v| v.map(|c| 3e38 * c - 1.6e38)))),
    ];
    for (name, soup) in &arrangements {
        for quality in QUALITIES {
            let start = Instant::now();
            let bvh = soup.build(quality, Isa::Auto, 2);
            assert_eq!(bvh.leaves.primitive_count(), COUNT as usize, "{name} {quality:?}");
            let seconds = start.elapsed();
            // Hundreds of times what an ordinary scene takes; unoptimised builds and loaded machines are slow.
            assert!(seconds < Duration::from_secs(60), "{name} {quality:?} took {seconds:?}");
        }
    }
}

#[test]
fn more_triangles_than_references_can_name_are_refused_with_both_numbers() {
    assert_eq!(ByAxis::MOST_PRIMITIVES, 1 << 28);
    let limit = ByAxis::MOST_PRIMITIVES;
    assert_eq!(check_count::<ByAxis>(limit), Ok(()));
    assert_eq!(check_count::<ByAxis>(limit + 1), Err(BuildFailure::TooManyTriangles { count: limit + 1, limit }));
    let limit = Compact::MOST_PRIMITIVES;
    assert_eq!(check_count::<Compact>(limit), Ok(()));
    assert_eq!(check_count::<Compact>(limit + 1), Err(BuildFailure::TooManyTriangles { count: limit + 1, limit }));
}
