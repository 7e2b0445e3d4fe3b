//! Every structure, quality, precision and call form gives the same hits, to the bit: brute force is the measure.

mod common;

use std::mem::MaybeUninit;

use common::{Mesh, Rng, meshes, rays_for};
use gnomon::{BuildOptions, Hit, Precision, Quality, Ray, Scene, SceneBuilder, Structure};

fn build(mesh: &Mesh, structure: Structure, quality: Quality, precision: Precision, thread_count: u32) -> Scene {
    let mut builder = SceneBuilder::new();
    mesh.add_to(&mut builder);
    let options = BuildOptions { structure, quality, precision, thread_count, ..BuildOptions::default() };
    builder.build(&options).expect("the mesh is valid")
}

/// Floats as bits, so that -0 and 0 differ, and a NaN would be seen.
fn bits(hit: &Hit) -> [u32; 9] {
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

fn hexadecimal(ray: &Ray) -> String {
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

#[test]
fn every_structure_gives_the_hits_of_brute_force() {
    for mesh in meshes() {
        let rays = rays_for(&mesh, &mut Rng::new(7));
        for precision in [Precision::Fast, Precision::Accurate] {
            let reference = build(&mesh, Structure::BruteForce, Quality::Medium, precision, 1);
            let expected: Vec<Hit> = rays.iter().map(|ray| reference.intersect(ray)).collect();
            for quality in [Quality::Low, Quality::Medium] {
                let scene = build(&mesh, Structure::Bvh, quality, precision, 0);
                let single: Vec<Hit> = rays.iter().map(|ray| scene.intersect(ray)).collect();
                let forms =
                    [("single", single), ("batch 1", batch(&scene, &rays, 1)), ("batch 2", batch(&scene, &rays, 2))];
                for (form, hits) in forms {
                    for ((ray, hit), expected) in rays.iter().zip(&hits).zip(&expected) {
                        assert_eq!(
                            bits(hit),
                            bits(expected),
                            "{} {quality:?} {precision:?} {form}: {hit:?} instead of {expected:?}; {}",
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
        let one = build(&mesh, Structure::Bvh, Quality::Medium, Precision::Accurate, 1);
        let two = build(&mesh, Structure::Bvh, Quality::Medium, Precision::Accurate, 2);
        assert_eq!(one.stats().node_count, two.stats().node_count, "{}", mesh.name);
        assert_eq!(one.stats().sah_cost.to_bits(), two.stats().sah_cost.to_bits(), "{}", mesh.name);
        for ray in &rays {
            assert_eq!(bits(&one.intersect(ray)), bits(&two.intersect(ray)), "{}: {}", mesh.name, hexadecimal(ray));
        }
    }
}

#[test]
fn retrace_keeps_the_hit_at_the_closed_ends_and_loses_it_beyond() {
    for mesh in meshes() {
        let scene = build(&mesh, Structure::Bvh, Quality::Medium, Precision::Accurate, 1);
        for ray in rays_for(&mesh, &mut Rng::new(13)) {
            let hit = scene.intersect(&ray);
            if !hit.is_hit() {
                continue;
            }
            for (t_min, t_max) in [(ray.t_min, hit.t), (hit.t, ray.t_max), (hit.t, hit.t)] {
                let again = scene.intersect(&Ray { t_min, t_max, ..ray });
                assert_eq!(bits(&again), bits(&hit), "{}: [{t_min:e}, {t_max:e}]; {}", mesh.name, hexadecimal(&ray));
            }
            let before = Ray { t_max: hit.t.next_down(), ..ray };
            assert!(!scene.intersect(&before).is_hit(), "{}: {}", mesh.name, hexadecimal(&before));
        }
    }
}
