//! Every structure gives all hits of a ray in the same order, whole or page by page: each primitive asked alone is the
//! measure.

use std::mem::MaybeUninit;

use crate::agree::{bits, build, hexadecimal, variants};
use crate::common::{Mesh, Rng, add_spheres, meshes, rays_for};
use glam::Vec3;
use gnomon::{BuildOptions, Hit, Precision, Ray, Scene, SceneBuilder, Structure};

const LARGEST_PAGE: usize = 1000;
const PRECISIONS: [Precision; 3] = [Precision::Fast, Precision::Accurate, Precision::Exact];

/// The hits after one that is known, at most so many.
fn page(scene: &Scene, ray: &Ray, after: Option<&Hit>, capacity: usize) -> Vec<Hit> {
    let mut hits = vec![MaybeUninit::new(Hit::MISS); capacity];
    let count = scene.intersect_all(ray, after, &mut hits).expect("there is memory");
    hits.truncate(count);
    // A `MaybeUninit<Hit>` that was initialised before the call is so after it.
    #[expect(unsafe_code, reason = "reading back an array that was initialised when it was made")]
    // SAFETY: each element was made with `MaybeUninit::new`.
    hits.into_iter().map(|hit| unsafe { hit.assume_init() }).collect()
}

/// All hits, so many at a time.
fn paged(scene: &Scene, ray: &Ray, capacity: usize) -> Vec<Hit> {
    let mut all: Vec<Hit> = Vec::new();
    loop {
        let next = page(scene, ray, all.last(), capacity);
        all.extend(&next);
        if next.len() < capacity {
            return all;
        }
    }
}

/// A scene of one primitive each, and the ids that it has in the scene of all.
fn alone(mesh: &Mesh, options: BuildOptions) -> Vec<(Scene, u32, u32)> {
    let mut scenes = Vec::new();
    let mut add = |builder: &SceneBuilder, geometry_id: u32, primitive_id: usize| {
        let scene = builder.build(&options).expect("it is valid");
        scenes.push((scene, geometry_id, primitive_id as u32));
    };
    let half = |count: usize, index: usize| if index < count / 2 { (0, index) } else { (3, index - count / 2) };
    for (index, &triangle) in mesh.triangles.iter().enumerate() {
        let mut builder = SceneBuilder::new();
        mesh.add_geometry(&[triangle], &mut builder);
        let (geometry_id, primitive_id) =
            if mesh.spheres.is_empty() { half(mesh.triangles.len(), index) } else { (0, index) };
        add(&builder, geometry_id, primitive_id);
    }
    for (index, &sphere) in mesh.spheres.iter().enumerate() {
        let mut builder = SceneBuilder::new();
        add_spheres(&[sphere], &mut builder);
        let (geometry_id, primitive_id) =
            if mesh.triangles.is_empty() { half(mesh.spheres.len(), index) } else { (3, index) };
        add(&builder, geometry_id, primitive_id);
    }
    scenes
}

/// What each primitive alone gives, from hit to hit, sorted.
fn expected(primitives: &[(Scene, u32, u32)], ray: &Ray) -> Vec<Hit> {
    let mut hits = Vec::new();
    for (scene, geometry_id, primitive_id) in primitives {
        let mut rest = *ray;
        loop {
            let hit = scene.intersect(&rest);
            if !hit.is_hit() {
                break;
            }
            hits.push(Hit { geometry_id: *geometry_id, primitive_id: *primitive_id, ..hit });
            rest.t_min = hit.t.next_up();
        }
    }
    sort_by_t_and_ids(&mut hits);
    hits
}

fn sort_by_t_and_ids(hits: &mut [Hit]) {
    let ids = |hit: &Hit| (hit.geometry_id, hit.primitive_id);
    hits.sort_by(|a, b| a.t.partial_cmp(&b.t).expect("a hit's t is a number").then(ids(a).cmp(&ids(b))));
}

fn assert_same(hits: &[Hit], expected: &[Hit], what: impl Fn() -> String) {
    let is_same = hits.len() == expected.len() && hits.iter().zip(expected).all(|(a, b)| bits(a) == bits(b));
    assert!(is_same, "{}: {hits:?} instead of {expected:?}", what());
}

#[test]
fn all_hits_are_those_that_each_primitive_alone_gives() {
    let mut most = 0;
    for mesh in meshes() {
        for precision in PRECISIONS {
            let options = BuildOptions { structure: Structure::BruteForce, precision, ..BuildOptions::default() };
            let (scene, primitives) = (build(&mesh, options), alone(&mesh, options));
            for ray in rays_for(&mesh, &mut Rng::new(37)).iter().step_by(23) {
                let mut hits = page(&scene, ray, None, LARGEST_PAGE);
                if precision == Precision::Exact {
                    // Its order tells exact `t` apart that are rounded to one float.
                    sort_by_t_and_ids(&mut hits);
                }
                assert_same(&hits, &expected(&primitives, ray), || format!("{}: {}", mesh.name, hexadecimal(ray)));
                most = most.max(hits.len());
            }
        }
    }
    assert!(most > 10, "{most} hits of one ray are not many");
}

#[test]
fn every_structure_gives_all_hits_of_brute_force_page_by_page() {
    const CAPACITIES: [usize; 7] = [1, 2, 3, 5, 16, 17, 64];

    for (mesh_index, mesh) in meshes().into_iter().enumerate() {
        let rays: Vec<Ray> = rays_for(&mesh, &mut Rng::new(41)).into_iter().step_by(9).collect();
        let all = PRECISIONS.map(|precision| {
            let brute_force = BuildOptions { structure: Structure::BruteForce, precision, ..BuildOptions::default() };
            let scene = build(&mesh, brute_force);
            rays.iter().map(|ray| page(&scene, ray, None, LARGEST_PAGE)).collect::<Vec<_>>()
        });
        let brute_force = BuildOptions { structure: Structure::BruteForce, ..BuildOptions::default() };
        for (index, variant) in variants().into_iter().chain([brute_force]).enumerate() {
            // Each variant in every precision, though not each on every mesh.
            let precision = (index + mesh_index) % PRECISIONS.len();
            let variant = BuildOptions { precision: PRECISIONS[precision], ..variant };
            let scene = build(&mesh, variant);
            for (index, (ray, expected)) in rays.iter().zip(&all[precision]).enumerate() {
                let capacity = CAPACITIES[index % CAPACITIES.len()];
                let what = || format!("{} {variant:?}, pages of {capacity}: {}", mesh.name, hexadecimal(ray));
                assert_same(&paged(&scene, ray, capacity), expected, what);
                let first = expected.first().copied().unwrap_or(Hit::MISS);
                assert_eq!(bits(&scene.intersect(ray)), bits(&first), "{}", what());
                assert_eq!(scene.occluded(ray), first.is_hit(), "{}", what());
            }
        }
    }
}

/// Of a hundred triangles, each there ten times, and as many in their plane that overlap them.
#[test]
fn duplicates_and_coplanar_triangles_are_each_given_once_in_the_order_of_their_ids() {
    const SIDE: u32 = 10;
    const COPIES: u32 = 10;
    let corners = |x: u32, y: u32, size: f32| {
        let corner = Vec3::new(x as f32, y as f32, 0.0);
        [corner, corner + size * Vec3::X, corner + size * Vec3::Y]
    };
    let places = || (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    let copies = (0..COPIES).flat_map(|_| places()).flat_map(|(x, y)| corners(x, y, 1.0));
    let overlapping = places().flat_map(|(x, y)| corners(x, y, 0.75));
    let mesh = Mesh::from_soup("copies", copies.chain(overlapping).collect());
    let half = SIDE * SIDE * (COPIES + 1) / 2;
    for variant in variants() {
        let scene = build(&mesh, variant);
        for (x, y) in places() {
            let at = y * SIDE + x;
            let origin = Vec3::new(x as f32 + 0.25, y as f32 + 0.25, 2.0);
            let ray = Ray { origin, t_min: 0.0, direction: Vec3::NEG_Z, t_max: f32::INFINITY };
            let expected: Vec<(u32, u32)> = (0..=COPIES)
                .map(|copy| copy * SIDE * SIDE + at)
                .map(|index| if index < half { (0, index) } else { (3, index - half) })
                .collect();
            for capacity in [1, 4, 11, 12, 100] {
                let hits = paged(&scene, &ray, capacity);
                let ids: Vec<(u32, u32)> = hits.iter().map(|hit| (hit.geometry_id, hit.primitive_id)).collect();
                assert_eq!(ids, expected, "{variant:?}, pages of {capacity}: {}", hexadecimal(&ray));
                assert!(hits.iter().all(|hit| hit.t == 2.0));
            }
        }
    }
}

#[test]
fn a_thousand_copies_are_given_by_every_structure() {
    const COUNT: u32 = 1000;
    let mesh = Mesh::from_soup("the same", (0..COUNT).flat_map(|_| [Vec3::X, Vec3::Y, Vec3::Z]).collect());
    let ray = Ray { origin: Vec3::ZERO, t_min: 0.0, direction: Vec3::ONE, t_max: 1.0 };
    for variant in variants() {
        let scene = build(&mesh, variant);
        for capacity in [300, 2000] {
            let ids = paged(&scene, &ray, capacity).iter().map(|hit| (hit.geometry_id, hit.primitive_id)).collect();
            let expected: Vec<_> = [0, 3].into_iter().flat_map(|g| (0..COUNT / 2).map(move |p| (g, p))).collect();
            let ids: Vec<(u32, u32)> = ids;
            assert_eq!(ids, expected, "{variant:?}");
        }
    }
}

#[test]
fn rays_through_a_vertex_of_a_fan_give_each_triangle_that_they_hit_once() {
    const SPOKES: u32 = 24;
    let rim: Vec<Vec3> = (0..SPOKES)
        .map(|spoke| {
            let angle = spoke as f32 / SPOKES as f32 * std::f32::consts::TAU;
            Vec3::new(angle.cos(), angle.sin(), 0.25)
        })
        .collect();
    let fan = (0..SPOKES as usize).flat_map(|spoke| [Vec3::ZERO, rim[spoke], rim[(spoke + 1) % SPOKES as usize]]);
    let mesh = Mesh::from_soup("fan", fan.collect());
    let down = |origin: Vec3| Ray { origin, t_min: 0.0, direction: Vec3::NEG_Z, t_max: f32::INFINITY };
    for variant in variants() {
        let scene = build(&mesh, variant);
        for capacity in [1, 7, 24, 25] {
            let at_vertex = paged(&scene, &down(Vec3::Z), capacity);
            assert_eq!(at_vertex.len(), SPOKES as usize, "{variant:?}");
            let on_edge = paged(&scene, &down(Vec3::new(0.5, 0.0, 1.0)), capacity);
            let ids: Vec<(u32, u32)> = on_edge.iter().map(|hit| (hit.geometry_id, hit.primitive_id)).collect();
            assert_eq!(ids, [(0, 0), (3, SPOKES / 2 - 1)], "{variant:?}");
        }
    }
}

#[test]
fn invalid_rays_and_pages_without_room_give_nothing() {
    let mesh = Mesh::from_soup("one", vec![Vec3::X, Vec3::Y, Vec3::Z]);
    for variant in variants() {
        let scene = build(&mesh, variant);
        let ray = Ray { origin: Vec3::ZERO, t_min: 0.0, direction: Vec3::ONE, t_max: f32::INFINITY };
        assert_eq!(page(&scene, &ray, None, 3).len(), 1);
        assert_eq!(page(&scene, &ray, None, 0).len(), 0);
        assert_eq!(page(&scene, &ray, Some(&Hit::MISS), 3).len(), 0);
        for invalid in [
            Ray { direction: Vec3::ZERO, ..ray },
            Ray { origin: Vec3::NAN, ..ray },
            Ray { t_min: 1.0, t_max: 0.0, ..ray },
            Ray { t_min: f32::NAN, ..ray },
        ] {
            assert_eq!(page(&scene, &invalid, None, 3).len(), 0);
        }
    }
}
