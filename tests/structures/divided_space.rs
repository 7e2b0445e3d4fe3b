//! What kd-tree and BSP tree must stand: rays in the planes that divide, and input that no plane divides well.

use std::time::{Duration, Instant};

use crate::common::{Mesh, Rng};
use glam::Vec3;
use gnomon::{BuildOptions, Quality, Ray, Scene, SceneBuilder, Structure};

const STRUCTURES: [Structure; 2] = [Structure::KdTree, Structure::BspTree];
const QUALITIES: [Quality; 2] = [Quality::Low, Quality::Medium];

fn build(mesh: &Mesh, structure: Structure, quality: Quality) -> Scene {
    let mut builder = SceneBuilder::new();
    mesh.add_to(&mut builder);
    builder.build(&BuildOptions { structure, quality, ..BuildOptions::default() }).expect("the mesh is valid")
}

fn assert_agree(mesh: &Mesh, rays: &[Ray]) {
    let reference = build(mesh, Structure::BruteForce, Quality::Medium);
    for structure in STRUCTURES {
        for quality in QUALITIES {
            let scene = build(mesh, structure, quality);
            for ray in rays {
                let (hit, expected) = (scene.intersect(ray), reference.intersect(ray));
                let is_same = hit.t.to_bits() == expected.t.to_bits()
                    && (hit.geometry_id, hit.primitive_id) == (expected.geometry_id, expected.primitive_id);
                assert!(
                    is_same && scene.occluded(ray) == expected.is_hit(),
                    "{} {structure:?} {quality:?}: {hit:?} instead of {expected:?} for {ray:?}",
                    mesh.name
                );
            }
        }
    }
}

/// Ends of triangles are where planes are: rays in those planes, along them and through their edges, from near and far.
#[test]
fn rays_in_and_through_the_dividing_planes_find_what_brute_force_finds() {
    let mut rng = Rng::new(23);
    let corners = (0..300).flat_map(|_| {
        let centre = rng.point();
        [0; 3].map(|_| centre + 0.3 * rng.point())
    });
    let mesh = Mesh::from_soup("planes", corners.collect());
    let mut rays = Vec::new();
    for distance in [1.0, 1e3, 1e4, 1e5, 1e6, 1e7] {
        for _ in 0..300 {
            let through = Vec3::from_array([0, 1, 2].map(|axis| mesh.vertices[rng.below(mesh.vertices.len())][axis]));
            let mut direction = rng.point();
            match rng.below(4) {
                0 => direction[rng.below(3)] = 0.0,
                1 => {
                    let axis = rng.below(3);
                    direction = Vec3::AXES[axis] * if rng.below(2) == 0 { 1.0 } else { -1.0 };
                }
                2 => direction = Vec3::from_array([0; 3].map(|_| rng.below(3) as f32 - 1.0)),
                _ => {}
            }
            if direction == Vec3::ZERO {
                continue;
            }
            let origin = through - direction * distance;
            rays.push(Ray { origin, t_min: 0.0, direction, t_max: f32::INFINITY });
            // Towards a point of a triangle, so that many are hit.
            let target = mesh.vertices[rng.below(mesh.vertices.len())];
            rays.push(Ray { origin, t_min: 0.0, direction: target - origin, t_max: f32::INFINITY });
        }
    }
    assert_agree(&mesh, &rays);
}

fn hard_meshes() -> Vec<Mesh> {
    const COUNT: usize = 20_000;
    let mut rng = Rng::new(29);
    let mut soup = |name, corner: &dyn Fn(&mut Rng, usize) -> [Vec3; 3]| {
        Mesh::from_soup(name, (0..COUNT).flat_map(|at| corner(&mut rng, at)).collect())
    };
    vec![
        soup("one place", &|_, _| [Vec3::X, Vec3::Y, Vec3::Z]),
        soup("nested", &|_, at| [Vec3::X, Vec3::Y, -Vec3::X - Vec3::Y].map(|v| v * (1.0 + at as f32))),
        soup("equal centroids", &|rng, _| {
            let (a, b) = (rng.point(), rng.point());
            [a, b, -a - b]
        }),
        soup("a slanted plane", &|rng, _| {
            [0; 3].map(|_| Vec3::new(1.0, 0.3, -0.2) * rng.signed() + Vec3::Y * rng.signed())
        }),
        soup("nearly on a line", &|rng, _| {
            [0; 3].map(|_| Vec3::new(1.0, 2.0, 3.0) * rng.signed() + 1e-7 * rng.point())
        }),
        soup("one huge", &|rng, at| {
            let (centre, size) = if at == 0 { (Vec3::ZERO, 1e6) } else { (rng.point(), 1e-3) };
            [0; 3].map(|_| centre + size * rng.point())
        }),
        soup("crossing needles", &|rng, _| {
            let (a, b) = (rng.point(), rng.point());
            [a, b, a + 1e-4 * rng.point()]
        }),
    ]
}

#[test]
fn hard_input_is_built_in_bounded_time_and_memory() {
    /// No structure lists a triangle more often, on average.
    const MOST_COPIES: u64 = 16;
    /// A hundred times what it takes, in a build without optimisation and with checks.
    const MOST_TIME: Duration = Duration::from_secs(300);
    for mesh in hard_meshes() {
        for structure in STRUCTURES {
            let start = Instant::now();
            let scene = build(&mesh, structure, Quality::Medium);
            let stats = scene.stats();
            assert!(start.elapsed() < MOST_TIME, "{} {structure:?}: {:?}", mesh.name, start.elapsed());
            println!("{} {structure:?}: {:?} {stats:?}", mesh.name, start.elapsed());
            assert!(stats.reference_count <= MOST_COPIES * stats.triangle_count, "{} {structure:?}", mesh.name);
        }
    }
}

#[test]
fn one_triangle_is_found() {
    let mesh = Mesh::from_soup("one", vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::X, Vec3::Y, -Vec3::Z]);
    let mut rng = Rng::new(31);
    let rays = [0; 500].map(|_| {
        let origin = 2.0 * rng.point();
        Ray { origin, t_min: 0.0, direction: Vec3::splat(0.2) + 0.4 * rng.point() - origin, t_max: f32::INFINITY }
    });
    assert_agree(&mesh, &rays);
}
