//! What arrives at a point of a scene, with shadows.

use std::sync::Mutex;

use glam::DVec3;
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::{Rng, SeedableRng};

use super::direction::{finite, unit};
use super::error::RadiometryError;
use super::estimate::Estimate;
use super::patch::Patches;
use super::quantity::Illuminance;
use super::source::{Direct, Receiver, Sources};
use crate::accel::Precision;
use crate::geometry::Ray;
use crate::math::gamma;
use crate::scene::{Scene, run_workers};

/// How hard to try.
#[derive(Clone, Copy, Debug)]
pub struct IrradianceOptions {
    /// Rays towards spheres and triangles that shine, all together; at least 2.
    pub sample_count: u64,
    /// The same seed gives the same answer.
    pub seed: u64,
    /// As in [`Scene::intersect_n`]; the answer does not depend on it.
    pub thread_count: u32,
}

/// What arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrradianceEstimate {
    /// From all sources.
    pub illuminance: Illuminance,
    /// Of the part that is sampled; 0 where nothing is.
    pub standard_error: Illuminance,
    /// How many were traced: fewer than samples where a sphere reaches below the horizon.
    pub ray_count: u64,
}

/// What arrives at a point, on the side of its normal, from all sources; `scene` is what may be in the way.
///
/// Points, spots and directions take a ray each. Spheres and triangles are known in closed form where nothing hides them (see
/// [`projected_polygon_sr`](super::projected_polygon_sr)); where something may, random rays towards them tell which share
/// arrives, and how far that is off. Where all of these arrive, the answer is the closed form, where none does 0, both without
/// an error: of `N` rays less than `3 / N` may be hidden, or not, with 95 % confidence.
///
/// What lies within `gamma(3)` of the distance from a source, of one of triangles within 2^-12 in FAST, or touches the point, is not in
/// the way: a source may be part of the scene.
pub fn irradiance(
    scene: Option<&Scene>,
    sources: &Sources,
    point: [f32; 3],
    normal: [f32; 3],
    options: &IrradianceOptions,
) -> Result<IrradianceEstimate, RadiometryError> {
    let receiver = Receiver { point: finite("point", point)?, normal: unit("normal", normal)? };
    let mut view = View { scene, receiver, options, ray_count: 0 };
    let from_lamps = view.lamps(sources)?;
    let patches = Patches::of(sources, &receiver)?;
    let (from_patches, standard_error) = view.patches(&patches)?;
    Ok(IrradianceEstimate { illuminance: from_lamps + from_patches, standard_error, ray_count: view.ray_count })
}

/// Of the way to a source: the direction is off by a rounding, the end by another, and a hit's t by one; what is no nearer than that counts as
/// the source.
const LEFT_OUT: f64 = gamma(3) as f64;

/// The same for triangles in FAST, whose t is off by more, the more the flatter a ray meets them: at [`LEFT_OUT`] a tenth of the rays to a
/// sphere of triangles hit it before their end, here one in 20,000.
const FAST_LEFT_OUT: f64 = 1.0 / 4096.0;

struct View<'a> {
    scene: Option<&'a Scene>,
    receiver: Receiver,
    options: &'a IrradianceOptions,
    ray_count: u64,
}

impl View<'_> {
    /// From what has no extent.
    fn lamps(&mut self, sources: &Sources) -> Result<Illuminance, RadiometryError> {
        let receiver = self.receiver;
        let mut sum = Illuminance::new(0.0);
        for (index, source) in sources.points.iter().enumerate() {
            sum = sum + self.unless_hidden(source.direct(&receiver), "point", index)?;
        }
        for (index, source) in sources.spots.iter().enumerate() {
            sum = sum + self.unless_hidden(source.direct(&receiver), "spot", index)?;
        }
        for (index, source) in sources.directionals.iter().enumerate() {
            sum = sum + self.unless_hidden(source.direct(&receiver), "directional", index)?;
        }
        Ok(sum)
    }

    fn unless_hidden(
        &mut self,
        direct: Result<Option<Direct>, RadiometryError>,
        kind: &'static str,
        index: usize,
    ) -> Result<Illuminance, RadiometryError> {
        let Some(direct) = direct.map_err(|cause| cause.of_source(kind, index))? else {
            return Ok(Illuminance::new(0.0));
        };
        let Some(scene) = self.scene else { return Ok(direct.illuminance) };
        self.ray_count += 1;
        let is_hidden = scene.occluded(&self.shadow_ray(direct.to_source, direct.distance, LEFT_OUT));
        Ok(if is_hidden { Illuminance::new(0.0) } else { direct.illuminance })
    }

    /// From what has an extent, and the standard error.
    fn patches(&mut self, patches: &Patches) -> Result<(Illuminance, Illuminance), RadiometryError> {
        let total = patches.total();
        let none = Illuminance::new(0.0);
        let Some(scene) = self.scene.filter(|_| total > 0.0) else { return Ok((Illuminance::new(total), none)) };
        let sample_count = self.options.sample_count;
        if sample_count < 2 {
            let expected = "at least 2, for a standard error";
            return Err(RadiometryError::Value { what: "sample_count", value: sample_count as f64, expected });
        }
        let estimate = self.estimate(scene, patches)?;
        self.ray_count += estimate.ray_count();
        let (mean, error) = estimate.mean_and_error();
        Ok((Illuminance::new(mean), Illuminance::new(error)))
    }

    fn estimate(&self, scene: &Scene, patches: &Patches) -> Result<Estimate, RadiometryError> {
        /// Samples of a chunk: enough that taking the next one does not show.
        const CHUNK: u64 = 1 << 12;
        /// 2^64 over the golden ratio: keeps the seeds of neighbouring streams far apart.
        const GOLDEN_RATIO: u64 = 0x9E37_79B9_7F4A_7C15;

        let triangle_left_out = if scene.precision() == Precision::Fast { FAST_LEFT_OUT } else { LEFT_OUT };
        let sample_count = self.options.sample_count;
        let chunk_count = usize::try_from(sample_count.div_ceil(CHUNK)).unwrap_or(usize::MAX);
        let mut chunks = Vec::new();
        chunks
            .try_reserve_exact(chunk_count)
            .map_err(|_| RadiometryError::OutOfMemory { what: "samples", count: sample_count as usize })?;
        chunks.resize(chunk_count, Estimate::new(patches.total()));
        let next_chunk = Mutex::new(chunks.iter_mut().enumerate());
        let thread_count = if chunk_count == 1 { 1 } else { self.options.thread_count };
        run_workers(thread_count, || {
            while let Some((index, chunk)) = take(&next_chunk) {
                // A chunk has a stream of its own, so that it does not matter which thread takes it.
                let seed = self.options.seed.wrapping_add((index as u64).wrapping_mul(GOLDEN_RATIO));
                let mut rng = Pcg64Mcg::seed_from_u64(seed);
                let count = CHUNK.min(sample_count - CHUNK * index as u64);
                for _ in 0..count {
                    let sample = patches.sample([(); 3].map(|()| uniform(&mut rng)));
                    let left_out = if sample.is_of_triangle { triangle_left_out } else { LEFT_OUT };
                    let ray = self.shadow_ray(sample.to_source, sample.distance, left_out);
                    // A way from below the horizon needs no ray.
                    chunk.add(sample.weight, sample.weight > 0.0 && !scene.occluded(&ray));
                }
            }
        });
        let mut estimate = Estimate::new(patches.total());
        chunks.iter().for_each(|chunk| estimate.merge(chunk));
        Ok(estimate)
    }

    /// From the receiver up to `distance` lengths of `to_source` but for a share of it, both ends left out.
    fn shadow_ray(&self, to_source: DVec3, distance: f64, left_out: f64) -> Ray {
        Ray {
            origin: self.receiver.point.as_vec3(),
            t_min: f32::MIN_POSITIVE,
            direction: to_source.as_vec3(),
            t_max: ((1.0 - left_out) * distance) as f32,
        }
    }
}

fn take<T>(next: &Mutex<impl Iterator<Item = T>>) -> Option<T> {
    next.lock().expect("taking a chunk does not panic").next()
}

/// In [0, 1), a multiple of 2^-53.
fn uniform(rng: &mut Pcg64Mcg) -> f64 {
    const SCALE: f64 = 1.0 / (1u64 << 53) as f64;
    (rng.next_u64() >> 11) as f64 * SCALE
}
