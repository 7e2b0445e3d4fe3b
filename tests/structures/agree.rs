//! Every structure, quality, precision and call form gives the same hits, to the bit: brute force is the measure.

use std::mem::MaybeUninit;

use crate::common::{CELLS_ON_WALLS, Mesh, Rng, ZERO_AREA_GEOMETRY, meshes, rays_for};
use glam::Vec3;
use gnomon::{BuildOptions, Hit, Isa, Precision, Quality, Ray, Scene, SceneBuilder, Structure};

pub(crate) fn build(mesh: &Mesh, options: BuildOptions) -> Scene {
    let mut builder = SceneBuilder::new();
    mesh.add_to(&mut builder);
    builder.build(&options).expect("the mesh is valid")
}

/// Each structure in each quality and on each instruction set that makes a difference to it; the cap is no more than a
/// cap, so on a small CPU some are the same.
pub(crate) fn variants() -> Vec<BuildOptions> {
    let of = |structure, quality, isa| BuildOptions { structure, quality, isa, ..BuildOptions::default() };
    let qualities = [Quality::Low, Quality::Medium, Quality::High];
    let scalar = [Structure::Bvh, Structure::KdTree, Structure::BspTree]
        .into_iter()
        .flat_map(|structure| qualities.map(|quality| of(structure, quality, Isa::Auto)));
    let wide = [Isa::Scalar, Isa::Sse42, Isa::Avx2, Isa::Avx512]
        .into_iter()
        .flat_map(|isa| qualities.map(|quality| of(Structure::WideBvh, quality, isa)));
    let wide: Vec<BuildOptions> = wide.collect();
    let compact = wide.iter().map(|&options| BuildOptions { is_compact: true, ..options });
    let grid = qualities.map(|quality| of(Structure::Grid, quality, Isa::Auto));
    // One cell; 16 along each axis of the mesh on cell walls; far more cells than triangles.
    let grids = [1e-6, CELLS_ON_WALLS, 300.0]
        .map(|grid_cells_per_triangle| BuildOptions { grid_cells_per_triangle, ..grid[0] });
    let octree = qualities.map(|quality| of(Structure::Octree, quality, Isa::Auto));
    scalar.chain(wide.iter().copied()).chain(compact).chain(grid).chain(grids).chain(octree).collect()
}

/// Without all qualities but one of the structures that take their rays one by one.
fn fewer_variants() -> Vec<BuildOptions> {
    let is_kept = |of: &BuildOptions| of.quality == Quality::Medium || of.structure == Structure::WideBvh;
    variants().into_iter().filter(is_kept).collect()
}

/// The structures of default quality, with exact decisions.
fn exact_variants() -> Vec<BuildOptions> {
    use Structure::{BruteForce, BspTree, Bvh, Grid, KdTree, Octree, WideBvh};
    [BruteForce, Grid, Octree, KdTree, BspTree, Bvh, WideBvh]
        .map(|structure| BuildOptions { structure, precision: Precision::Exact, ..BuildOptions::default() })
        .into()
}

/// Floats as bits, so that -0 and 0 differ, and a NaN would be seen.
pub(crate) fn bits(hit: &Hit) -> [u32; 9] {
    let [x, y, z] = hit.normal.to_array();
    [
        hit.t.to_bits(),
        hit.u.to_bits(),
        hit.v.to_bits(),
        x.to_bits(),
        y.to_bits(),
        z.to_bits(),
        hit.primitive_id,
        hit.geometry_id,
        hit.instance_id,
    ]
}

pub(crate) fn hexadecimal(ray: &Ray) -> String {
    let words = [ray.origin.to_array(), ray.direction.to_array()].concat();
    let words: Vec<String> =
        words.iter().chain([&ray.t_min, &ray.t_max]).map(|f| format!("{:08x}", f.to_bits())).collect();
    format!("origin, direction, t_min, t_max as bits: {}", words.join(" "))
}

fn batch(scene: &Scene, rays: &[Ray], thread_count: u32) -> Vec<Hit> {
    let mut hits = vec![MaybeUninit::new(Hit::MISS); rays.len()];
    scene.intersect_n(rays, &mut hits, thread_count);
    // A `MaybeUninit<Hit>` that was initialised before the call is so after it.
    #[expect(unsafe_code, reason = "reading back an array that was initialised when it was made")]
    // SAFETY: each element was made with `MaybeUninit::new`.
    hits.into_iter().map(|hit| unsafe { hit.assume_init() }).collect()
}

fn batch_occluded(scene: &Scene, rays: &[Ray], thread_count: u32) -> Vec<bool> {
    let mut occluded = vec![MaybeUninit::new(false); rays.len()];
    scene.occluded_n(rays, &mut occluded, thread_count);
    #[expect(unsafe_code, reason = "reading back an array that was initialised when it was made")]
    // SAFETY: each element was made with `MaybeUninit::new`.
    occluded.into_iter().map(|is_hit| unsafe { is_hit.assume_init() }).collect()
}

/// What a batch takes apart: rays at random, rays of two cameras in rows, which go together, and among all now and then
/// an invalid ray, one along an axis, and one whose interval ends before or at its hit.
fn mixed_rays(mesh: &Mesh, scene: &Scene, rng: &mut Rng) -> Vec<Ray> {
    let mut rays = rays_for(mesh, rng);
    let (lower, upper) = (scene.bounds().lower, scene.bounds().upper);
    let (centre, half) = (lower * 0.5 + upper * 0.5, upper * 0.5 - lower * 0.5);
    let eye = centre + half.max_element() * Vec3::new(1.9, 1.4, 1.1);
    let forward = centre - eye;
    let (right, up) = (forward.cross(Vec3::Y), forward.cross(Vec3::Y).cross(forward));
    for row in 0..8 {
        let height = (row as f32 / 4.0 - 1.0) * 0.3;
        for column in 0..200 {
            let aside = (column as f32 / 100.0 - 1.0) * 0.3;
            let direction = forward.normalize() + right.normalize() * aside + up.normalize() * height;
            rays.push(Ray { origin: eye, t_min: 0.0, direction, t_max: f32::INFINITY });
        }
    }
    // Along an axis, so that signs change within rows; with intervals that end anywhere.
    let before = centre + Vec3::Z * (3.0 * half.max_element());
    for row in 0..4 {
        for column in 0..200 {
            let direction = Vec3::new((column as f32 - 99.5) / 250.0, (row as f32 - 1.5) / 10.0, -1.0);
            let t_max = [f32::INFINITY, 3.0 * half.max_element(), f32::MAX, 0.0, f32::INFINITY, -0.0][column % 6];
            rays.push(Ray { origin: before, t_min: -0.0, direction, t_max });
        }
    }
    let nan = f32::NAN;
    for index in (0..rays.len()).step_by(97) {
        let ray = &mut rays[index];
        match index % 7 {
            0 => ray.direction = Vec3::ZERO,
            1 => ray.origin.y = nan,
            2 => (ray.t_min, ray.t_max) = (1.0, 0.5),
            3 => ray.t_max = nan,
            4 => ray.direction *= Vec3::new(0.0, 1.0, -0.0),
            5 => ray.t_max = scene.intersect(ray).t.next_down(),
            _ => ray.t_max = scene.intersect(ray).t,
        }
    }
    rays
}

#[test]
fn batches_of_every_length_give_the_hits_of_single_calls() {
    const LENGTHS: [usize; 14] = [0, 1, 2, 31, 32, 33, 63, 64, 65, 67, 75, 127, 255, 1000];

    for mesh in meshes() {
        for precision in [Precision::Fast, Precision::Accurate, Precision::Exact] {
            for variant in fewer_variants() {
                let scene = build(&mesh, BuildOptions { precision, ..variant });
                let mut rng = Rng::new(19);
                let rays = mixed_rays(&mesh, &scene, &mut rng);
                let single: Vec<Hit> = rays.iter().map(|ray| scene.intersect(ray)).collect();
                for length in LENGTHS.into_iter().chain([rays.len()]) {
                    let first = rng.below(rays.len() - length + 1);
                    let rays = &rays[first..][..length];
                    let thread_count = 1 + rng.below(2) as u32;
                    let hits = batch(&scene, rays, thread_count);
                    let occluded = batch_occluded(&scene, rays, thread_count);
                    for (index, expected) in single[first..][..length].iter().enumerate() {
                        let ray = hexadecimal(&rays[index]);
                        let hit = &hits[index];
                        assert_eq!(
                            bits(hit),
                            bits(expected),
                            "{} {variant:?} {precision:?}, {index} of {length} from {first}: {hit:?} instead of \
                             {expected:?}; {ray}",
                            mesh.name
                        );
                        assert_eq!(
                            occluded[index],
                            expected.is_hit(),
                            "{} {variant:?} {precision:?}: {ray}",
                            mesh.name
                        );
                    }
                }
            }
        }
    }
}

/// `FAST` takes `t` from the plane, far from where the weights of this sliver lead to, which the ray sees end-on.
#[test]
fn fast_batches_give_the_hit_of_a_sliver_that_single_calls_give() {
    let s = 1.0 / 65536.0;
    let (near, far) = (0.875 + 4.0 * s - s, 0.875 + 4.0 * s + 2.0 * s);
    let (tip, depth) = (Vec3::new(0.5 - s, 0.5 - s, 1.0), 1.75 + 8.0 * s);
    let mesh = Mesh::from_soup("sliver", vec![tip, Vec3::new(far, near, depth), Vec3::new(near, far, depth)]);
    let options = BuildOptions { structure: Structure::WideBvh, precision: Precision::Fast, ..BuildOptions::default() };
    let scene = build(&mesh, options);
    let ray = Ray { origin: Vec3::ZERO, t_min: 0.0, direction: Vec3::new(0.5, 0.5, 1.0), t_max: 1.2 };
    let expected = scene.intersect(&ray);
    assert_eq!(expected.t, 137.0 / 128.0);
    let rays = [ray; 200];
    for hit in batch(&scene, &rays, 1) {
        assert_eq!(bits(&hit), bits(&expected));
    }
    assert_eq!(batch_occluded(&scene, &rays, 1), [true; 200]);
}

#[test]
fn every_structure_gives_the_hits_of_brute_force() {
    for mesh in meshes() {
        let rays = rays_for(&mesh, &mut Rng::new(7));
        for precision in [Precision::Fast, Precision::Accurate, Precision::Exact] {
            let brute_force = BuildOptions { structure: Structure::BruteForce, precision, ..BuildOptions::default() };
            let reference = build(&mesh, brute_force);
            let expected: Vec<Hit> = rays.iter().map(|ray| reference.intersect(ray)).collect();
            for geometry_id in [0, 3] {
                let is_hit = expected.iter().any(|hit| hit.geometry_id == geometry_id);
                assert!(is_hit, "{}: no ray hits geometry {geometry_id}", mesh.name);
            }
            let hits_nothing = expected.iter().all(|hit| hit.geometry_id != ZERO_AREA_GEOMETRY);
            assert!(hits_nothing, "{}: a triangle of zero area is hit", mesh.name);
            // Exact ties take long, and what decides them is the same in each quality.
            let variants = if precision == Precision::Exact { fewer_variants() } else { variants() };
            for variant in variants {
                let variant = BuildOptions { precision, ..variant };
                let scene = build(&mesh, variant);
                let single: Vec<Hit> = rays.iter().map(|ray| scene.intersect(ray)).collect();
                let counted: Vec<Hit> = rays.iter().map(|ray| scene.intersect_counted(ray).0).collect();
                let forms = [
                    ("single", single),
                    ("counted", counted),
                    ("batch 1", batch(&scene, &rays, 1)),
                    ("batch 2", batch(&scene, &rays, 2)),
                ];
                for (form, hits) in forms {
                    for ((ray, hit), expected) in rays.iter().zip(&hits).zip(&expected) {
                        assert_eq!(
                            bits(hit),
                            bits(expected),
                            "{} {variant:?} {form}: {hit:?} instead of {expected:?}; {}",
                            mesh.name,
                            hexadecimal(ray)
                        );
                        assert_eq!(scene.occluded(ray), expected.is_hit(), "{}: {}", mesh.name, hexadecimal(ray));
                    }
                }
            }
        }
    }
}

#[test]
fn thread_count_does_not_change_the_scene() {
    for mesh in meshes() {
        let rays = rays_for(&mesh, &mut Rng::new(11));
        for variant in variants() {
            let one = build(&mesh, BuildOptions { thread_count: 1, ..variant });
            let two = build(&mesh, BuildOptions { thread_count: 2, ..variant });
            assert_eq!(one.stats().node_count, two.stats().node_count, "{} {variant:?}", mesh.name);
            assert_eq!(one.stats().sah_cost.to_bits(), two.stats().sah_cost.to_bits(), "{} {variant:?}", mesh.name);
            for ray in &rays {
                let (one, two) = (one.intersect(ray), two.intersect(ray));
                assert_eq!(bits(&one), bits(&two), "{} {variant:?}: {}", mesh.name, hexadecimal(ray));
            }
        }
    }
}

#[test]
fn retrace_keeps_the_hit_at_the_closed_ends_and_loses_it_beyond() {
    for mesh in meshes() {
        for variant in variants().into_iter().chain(exact_variants()) {
            let scene = build(&mesh, variant);
            for ray in rays_for(&mesh, &mut Rng::new(13)) {
                let hit = scene.intersect(&ray);
                if !hit.is_hit() {
                    continue;
                }
                for (t_min, t_max) in [(ray.t_min, hit.t), (hit.t, ray.t_max), (hit.t, hit.t)] {
                    let again = scene.intersect(&Ray { t_min, t_max, ..ray });
                    let interval = format!("[{t_min:e}, {t_max:e}]");
                    assert_eq!(bits(&again), bits(&hit), "{} {variant:?} {interval}; {}", mesh.name, hexadecimal(&ray));
                }
                let before = Ray { t_max: hit.t.next_down(), ..ray };
                assert!(!scene.intersect(&before).is_hit(), "{} {variant:?}: {}", mesh.name, hexadecimal(&before));
            }
        }
    }
}

#[test]
fn counts_are_within_what_the_structure_has() {
    for mesh in meshes() {
        let brute_force = BuildOptions { structure: Structure::BruteForce, ..BuildOptions::default() };
        for variant in variants().into_iter().chain([brute_force]) {
            let scene = build(&mesh, variant);
            let stats = scene.stats();
            let inner_node_count = stats.node_count - stats.leaf_count;
            for ray in rays_for(&mesh, &mut Rng::new(19)) {
                let (hit, counts) = scene.intersect_counted(&ray);
                let (nodes, primitives) = (u64::from(counts.nodes_visited), u64::from(counts.primitives_tested));
                let what = format!("{} {variant:?}: {counts:?}; {}", mesh.name, hexadecimal(&ray));
                assert_eq!(counts, scene.intersect_counted(&ray).1, "{what}");
                // A cell counts as a leaf, and is passed once at most.
                let has_cells = matches!(variant.structure, Structure::Grid | Structure::KdTree | Structure::BspTree);
                assert!(u64::from(counts.cells_stepped) <= u64::from(has_cells) * stats.leaf_count, "{what}");
                assert!(nodes <= inner_node_count && primitives <= stats.reference_count, "{what}");
                assert!(primitives >= u64::from(hit.is_hit()), "{what}");
                if variant.structure == Structure::BruteForce && hit.is_hit() {
                    assert_eq!(primitives, stats.reference_count, "{what}");
                }
            }
        }
    }
}

#[test]
fn exact_hits_on_any_finite_floats_are_those_of_brute_force() {
    let mut rng = Rng::new(31);
    for round in 0..30 {
        // All magnitudes that there are, or those around one.
        let (centre, range) = if round % 3 == 0 { (0, 278) } else { (rng.below(240) as i32 - 120, 20) };
        let mut float = || {
            let exponent = (centre + rng.below(range) as i32 - range as i32 / 2).clamp(-148, 127);
            (f64::from(rng.signed()) * 2f64.powi(exponent)) as f32
        };
        let mut point = || Vec3::new(float(), float(), float());
        let mesh = Mesh::from_soup("any floats", (0..300).map(|_| point()).collect());
        let scenes: Vec<Scene> = exact_variants().into_iter().map(|options| build(&mesh, options)).collect();
        let origins: Vec<Vec3> = (0..300).map(|_| point()).collect();
        for origin in origins {
            let corners = mesh.triangles[rng.below(mesh.triangles.len())].map(|corner| mesh.vertices[corner as usize]);
            let share = [rng.signed().abs(), rng.signed().abs()];
            let edge = corners[0] * (1.0 - share[0]) + corners[1] * share[0];
            let target = edge * (1.0 - share[1]) + corners[2] * share[1];
            // Half, because differences may exceed all floats.
            let direction = target * 0.5 - origin * 0.5;
            let ray = Ray { origin, t_min: 0.0, direction, t_max: f32::INFINITY };
            let expected = scenes[0].intersect(&ray);
            for (scene, options) in scenes.iter().zip(exact_variants()) {
                let hit = scene.intersect(&ray);
                assert_eq!(
                    bits(&hit),
                    bits(&expected),
                    "{options:?} {hit:?} instead of {expected:?}; {}",
                    hexadecimal(&ray)
                );
                assert_eq!(scene.occluded(&ray), expected.is_hit(), "{options:?}; {}", hexadecimal(&ray));
            }
        }
    }
}

/// Ten thousand triangles, from what is given of a number and random points.
fn many(name: &'static str, corners: impl Fn(f32, &mut Rng) -> [Vec3; 3]) -> Mesh {
    const COUNT: u32 = 10_000;
    let mut rng = Rng::new(23);
    Mesh::from_soup(name, (0..COUNT).flat_map(|n| corners(n as f32 / COUNT as f32, &mut rng)).collect())
}

#[test]
fn degenerate_scenes_take_bounded_memory_and_give_the_hits_of_brute_force() {
    /// What a structure that divides space allows itself, with room for a grid's estimate.
    const MOST_LISTED_PER_TRIANGLE: u64 = 120;

    let small = |rng: &mut Rng, size: f32| [0; 3].map(|_| size * rng.point());
    let meshes = [
        many("equal centroids", |n, rng| {
            let [a, b, _] = small(rng, n);
            [a, b, -a - b]
        }),
        many("nested shells", |n, _| [Vec3::X, Vec3::Y, Vec3::Z].map(|corner| corner * (1.0 + n))),
        many("long diagonals", |n, rng| [Vec3::ZERO, Vec3::ONE, Vec3::new(n, 1.0 - n, 0.5) + 1e-3 * rng.point()]),
        many("in one plane", |_, rng| {
            let centre = rng.point();
            small(rng, 0.02).map(|corner| (centre + corner).with_y(0.3))
        }),
        many("along a line", |n, rng| small(rng, 1e-4).map(|corner| corner + Vec3::X * n)),
        many("in one point", |n, rng| {
            small(rng, 1e-6).map(|corner| corner + if n == 0.0 { Vec3::ONE } else { Vec3::ZERO })
        }),
        many("the same", |_, _| [Vec3::X, Vec3::Y, Vec3::Z]),
        many("one huge, many tiny", |n, rng| if n == 0.0 { small(rng, 1e5) } else { small(rng, 1.0) }),
    ];
    for mesh in meshes {
        let of = |structure| build(&mesh, BuildOptions { structure, ..BuildOptions::default() });
        let reference = of(Structure::BruteForce);
        for structure in [Structure::Grid, Structure::Octree] {
            let scene = of(structure);
            let stats = scene.stats();
            assert!(
                stats.reference_count <= MOST_LISTED_PER_TRIANGLE * stats.triangle_count,
                "{}: {stats:?}",
                mesh.name
            );
            for ray in rays_for(&mesh, &mut Rng::new(29)).iter().take(300) {
                let (hit, expected) = (scene.intersect(ray), reference.intersect(ray));
                assert_eq!(bits(&hit), bits(&expected), "{} {structure:?}: {}", mesh.name, hexadecimal(ray));
            }
        }
    }
}

/// Two triangles, and a ray by its origin and direction.
type Pair = ([[Vec3; 3]; 2], Vec3, Vec3);

/// Found by gnomon-hard.
fn pairs_whose_edge_functions_overflow() -> [Pair; 2] {
    // The ray passes the edge between the two within the band.
    let (a, c) = (Vec3::new(0.809_017, -0.5, -0.309_017), Vec3::new(0.850_650_8, 0.0, -0.525_731_1));
    let at_an_edge = (
        [[a, Vec3::new(0.5, -0.309_017, -0.809_017), c], [a, c, Vec3::X]],
        Vec3::new(1.234_939_9, -1.465_358_4, -0.572_405_64),
        Vec3::new(-0.402_562_02, 1.245_910_9, 0.141_789_29),
    );
    // It meets the vertex of the two exactly.
    let vertex = Vec3::new(-0.525_731_1, 0.850_650_8, 0.0);
    let at_a_vertex = (
        [
            [vertex, Vec3::new(-0.809_017, 0.5, 0.309_017), Vec3::new(-0.309_017, 0.809_017, 0.5)],
            [vertex, Vec3::Y, Vec3::new(-0.309_017, 0.809_017, -0.5)],
        ],
        Vec3::new(-1.375_135_3, 0.898_717_05, 1.140_75),
        Vec3::new(0.849_404_2, -0.048_066_26, -1.140_75),
    );
    [at_an_edge, at_a_vertex]
}

#[test]
fn triangles_whose_edge_functions_overflow_are_decided_alike() {
    for (triangles, origin, direction) in pairs_whose_edge_functions_overflow() {
        for exponent in [0, 39, 60, 62, 64, 80, 100, 120] {
            let scale = 2f32.powi(exponent);
            let corners = triangles.as_flattened().iter().map(|&corner| corner * scale);
            let mesh = Mesh::from_soup("two triangles", corners.collect());
            let ray = Ray { origin: origin * scale, t_min: 0.0, direction, t_max: f32::INFINITY };
            for precision in [Precision::Accurate, Precision::Exact] {
                let brute_force =
                    BuildOptions { structure: Structure::BruteForce, precision, ..BuildOptions::default() };
                let expected = build(&mesh, brute_force).intersect(&ray);
                for options in variants() {
                    let hit = build(&mesh, BuildOptions { precision, ..options }).intersect(&ray);
                    assert_eq!(bits(&hit), bits(&expected), "2^{exponent}, {options:?}, {precision:?}");
                }
            }
        }
    }
}

#[test]
fn rays_at_the_limits_of_floats_are_answered_alike() {
    let float = f32::from_bits;
    let at = |corners: [[f32; 3]; 3]| Mesh::from_soup("limits", corners.map(Vec3::from_array).to_vec());
    let from = |origin: [f32; 3], direction: [f32; 3], t_min: f32| Ray {
        origin: origin.into(),
        direction: direction.into(),
        t_min,
        t_max: f32::INFINITY,
    };
    let far = |aside: f32| 1e21 + aside;
    let depth = float(0x1165_49A0);
    let cases = [
        // The origin's product with the inverse direction overflows.
        (
            at([[far(-1e16), -1.0, 0.0], [far(1e16), -1.0, 0.0], [far(0.0), 1.0, 0.0]]),
            [from([1e21, 0.3, -1.0], [1e-18, 1e-3, 1.0], 0.0), from([1e21, 0.3, -1.0], [-1e-18, 1e-3, 1.0], 0.0)],
        ),
        // The hit is before all floats.
        (
            at([[-1.0, -1.0, -10.0], [1.0, -1.0, -10.0], [0.0, 1.0, -10.0]]),
            [
                from([0.0; 3], [0.0, 0.0, 1.2e-38], f32::NEG_INFINITY),
                from([0.0; 3], [1e-40, 0.0, 1.2e-38], f32::NEG_INFINITY),
            ],
        ),
        // Its t is denormal.
        (
            at([
                [float(0x9163_0BB3), float(0x9154_8BA8), depth],
                [float(0x112B_C682), float(0x10F1_A21E), depth],
                [float(0x10AD_CDCE), float(0x90C4_77E0), depth],
            ]),
            [
                from(
                    [float(0x115A_BADE), float(0x1126_4E4B), float(0x922E_E871)],
                    [float(0xD9D9_C6E4), float(0xD9B9_2100), float(0x5A63_1FF4)],
                    0.0,
                ),
                from(
                    [float(0x115A_BADE), float(0x1126_4E4B), float(0x922E_E871)],
                    [float(0xDED9_C6E4), float(0xDEB9_2100), float(0x5F63_1FF4)],
                    0.0,
                ),
            ],
        ),
    ];
    for (mesh, rays) in &cases {
        for precision in [Precision::Accurate, Precision::Exact] {
            let brute_force = BuildOptions { structure: Structure::BruteForce, precision, ..BuildOptions::default() };
            let measure = build(mesh, brute_force);
            for options in variants() {
                let scene = build(mesh, BuildOptions { precision, ..options });
                for ray in rays {
                    let (hit, expected) = (scene.intersect(ray), measure.intersect(ray));
                    assert_eq!(bits(&hit), bits(&expected), "{options:?}, {precision:?}, {}", hexadecimal(ray));
                    assert_eq!(scene.occluded(ray), expected.is_hit(), "{options:?}, {}", hexadecimal(ray));
                }
            }
        }
    }
}

#[test]
fn collinear_triangles_are_never_hit() {
    let mut rng = Rng::new(17);
    let points: Vec<Vec3> = (0..300).map(|_| rng.point()).collect();
    // Multiples of one vector by powers of two lie on a line exactly.
    let mesh = Mesh::from_soup("collinear", points.iter().flat_map(|&p| [p, p * 2.0, p * 4.0]).collect());
    let brute_force = BuildOptions { structure: Structure::BruteForce, ..BuildOptions::default() };
    let scenes: Vec<Scene> = variants().into_iter().chain([brute_force]).map(|options| build(&mesh, options)).collect();
    for &point in points.iter().cycle().take(3000) {
        let origin = 3.0 * rng.point();
        let ray = Ray { origin, t_min: 0.0, direction: point * 3.0 - origin, t_max: f32::INFINITY };
        for scene in &scenes {
            assert!(!scene.intersect(&ray).is_hit(), "{}", hexadecimal(&ray));
        }
    }
}
