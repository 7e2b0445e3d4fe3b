//! Meshes, spheres and rays that are hard on purpose, all seeded.

use glam::Vec3;
use gnomon::{IndexBytes, IndexView, PositionView, Ray, SceneBuilder, SphereView, TriangleView};

/// SplitMix64 (Steele, Lea, Flood 2014).
pub(crate) struct Rng(u64);

impl Rng {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// In `[-1, 1)`.
    pub(crate) fn signed(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }

    pub(crate) fn point(&mut self) -> Vec3 {
        Vec3::new(self.signed(), self.signed(), self.signed())
    }

    pub(crate) fn below(&mut self, bound: usize) -> usize {
        (self.next() % bound as u64) as usize
    }
}

/// The geometry of each mesh that nothing may hit.
pub(crate) const ZERO_AREA_GEOMETRY: u32 = 1;

pub(crate) struct Mesh {
    pub(crate) name: &'static str,
    pub(crate) vertices: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Centres and radii.
    pub(crate) spheres: Vec<(Vec3, f32)>,
}

impl Mesh {
    /// As several geometries, which share edges: half of the triangles, [`ZERO_AREA_GEOMETRY`], none, the other half. In
    /// place of the last two the spheres, if there are any; without triangles the spheres as the triangles otherwise.
    pub(crate) fn add_to(&self, builder: &mut SceneBuilder) {
        let (first_half, second_half) = self.triangles.split_at(self.triangles.len() / 2);
        let zero_area: Vec<[u32; 3]> = self.triangles.iter().map(|&[a, b, _]| [a, b, a]).collect();
        let points: Vec<(Vec3, f32)> = self.spheres.iter().map(|&(centre, _)| (centre, 0.0)).collect();
        let (first_spheres, other_spheres) = self.spheres.split_at(self.spheres.len() / 2);
        if self.spheres.is_empty() {
            for triangles in [first_half, &zero_area, &[], second_half] {
                self.add_geometry(triangles, builder);
            }
        } else if self.triangles.is_empty() {
            for spheres in [first_spheres, &points, &[], other_spheres] {
                add_spheres(spheres, builder);
            }
        } else {
            self.add_geometry(&self.triangles, builder);
            self.add_geometry(&zero_area, builder);
            add_spheres(&points, builder);
            add_spheres(&self.spheres, builder);
        }
    }

    pub(crate) fn add_geometry(&self, triangles: &[[u32; 3]], builder: &mut SceneBuilder) {
        let positions: Vec<u8> = self.vertices.iter().flat_map(|v| v.to_array()).flat_map(f32::to_ne_bytes).collect();
        let indices: Vec<u8> = triangles.iter().flatten().flat_map(|index| index.to_ne_bytes()).collect();
        let view = TriangleView {
            positions: PositionView::new(&positions, 12, self.vertices.len()).expect("packed"),
            indices: IndexView::U32(IndexBytes::new(&indices, 12, triangles.len()).expect("packed")),
        };
        builder.add_triangles(&view).expect("the indices are in range");
    }

    pub(crate) fn from_soup(name: &'static str, corners: Vec<Vec3>) -> Self {
        let triangles = (0..corners.len() as u32 / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        Self { name, vertices: corners, triangles, spheres: Vec::new() }
    }

    fn with_spheres(self, name: &'static str, spheres: Vec<(Vec3, f32)>) -> Self {
        Self { name, spheres, ..self }
    }

    fn mapped(mut self, name: &'static str, map: impl Fn(Vec3) -> Vec3) -> Self {
        self.name = name;
        self.vertices.iter_mut().for_each(|v| *v = map(*v));
        self
    }
}

pub(crate) fn add_spheres(spheres: &[(Vec3, f32)], builder: &mut SceneBuilder) {
    let floats = spheres.iter().flat_map(|(centre, radius)| [centre.x, centre.y, centre.z, *radius]);
    let bytes: Vec<u8> = floats.flat_map(f32::to_ne_bytes).collect();
    let (centres, radii) =
        if spheres.is_empty() { (&[][..], &[][..]) } else { (&bytes[..bytes.len() - 4], &bytes[12..]) };
    let centres = PositionView::new(centres, 16, spheres.len()).expect("four floats each");
    let view = SphereView::new(centres, radii, 16).expect("four floats each");
    builder.add_spheres(&view).expect("there are few");
}

/// Of very different sizes; every eighth one is there three times.
fn spheres(rng: &mut Rng, count: usize, size: f32) -> Vec<(Vec3, f32)> {
    (0..count)
        .flat_map(|index| {
            let sphere = (rng.point(), size * rng.signed().abs().powi(4).max(1e-6));
            std::iter::repeat_n(sphere, if index % 8 == 0 { 3 } else { 1 })
        })
        .collect()
}

fn soup(rng: &mut Rng, count: usize, size: f32) -> Mesh {
    let corners = (0..count)
        .flat_map(|_| {
            let centre = rng.point();
            [0; 3].map(|_| centre + size * rng.point())
        })
        .collect();
    Mesh::from_soup("soup", corners)
}

/// Long and thin: width `width`, length about 1.
fn needles(rng: &mut Rng, count: usize, width: f32) -> Mesh {
    let corners = (0..count)
        .flat_map(|_| {
            let a = rng.point();
            let b = a + rng.point();
            [a, b, a + width * rng.point()]
        })
        .collect();
    Mesh::from_soup("needles", corners)
}

/// A height field of small integers over an integer grid: edges on axis-parallel lines, many equal coordinates.
fn height_field(rng: &mut Rng, side: u32) -> Mesh {
    let vertices = (0..=side)
        .flat_map(|y| (0..=side).map(move |x| (x, y)))
        .map(|(x, y)| Vec3::new(x as f32, y as f32, rng.below(3) as f32))
        .collect();
    let row = side + 1;
    let triangles = (0..side)
        .flat_map(|y| (0..side).map(move |x| y * row + x))
        .flat_map(|at| [[at, at + 1, at + row], [at + 1, at + row + 1, at + row]])
        .collect();
    Mesh { name: "height field", vertices, triangles, spheres: Vec::new() }
}

/// The same few triangles many times, and some in one plane: ties everywhere.
fn duplicates(rng: &mut Rng) -> Mesh {
    let few = soup(rng, 12, 0.8);
    let flat = height_field(rng, 6).mapped("flat", |v| Vec3::new(v.x / 3.0 - 1.0, v.y / 3.0 - 1.0, 0.25));
    let mut mesh = Mesh { name: "duplicates", vertices: few.vertices, triangles: Vec::new(), spheres: Vec::new() };
    for _ in 0..20 {
        mesh.triangles.extend_from_slice(&few.triangles);
    }
    let offset = mesh.vertices.len() as u32;
    mesh.vertices.extend(flat.vertices);
    mesh.triangles.extend(flat.triangles.iter().chain(&flat.triangles).map(|t| t.map(|index| index + offset)));
    mesh
}

/// Triangles of [`on_cell_walls`], zero area or not.
const WALL_TRIANGLES: usize = 512;
/// With so many cells for each triangle that is hit, a grid has 16 along each axis.
pub(crate) const CELLS_ON_WALLS: f32 = 4096.0 / WALL_TRIANGLES as f32;

/// Corners at multiples of 1/16 of a cube: on the walls of a grid of 16 cells along each axis, and of an octree.
fn on_cell_walls(rng: &mut Rng) -> Mesh {
    let mut on_wall = |most: usize| rng.below(most + 1) as f32 / 16.0;
    let mut corners: Vec<Vec3> = Vec::new();
    while corners.len() < 3 * WALL_TRIANGLES {
        let lower = Vec3::from_array([0; 3].map(|_| on_wall(13)));
        let triangle = [0; 3].map(|_| lower + Vec3::from_array([0; 3].map(|_| on_wall(3))));
        if (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]) != Vec3::ZERO {
            corners.extend(triangle);
        }
    }
    // So that the scene is all of the cube.
    (corners[0], corners[3]) = (Vec3::ZERO, Vec3::ONE);
    Mesh::from_soup("on cell walls", corners)
}

pub(crate) fn meshes() -> Vec<Mesh> {
    let mut rng = Rng::new(1);
    vec![
        soup(&mut rng, 800, 0.1),
        soup(&mut rng, 3, 0.8).mapped("three triangles", |v| v),
        needles(&mut rng, 400, 1e-3),
        needles(&mut rng, 400, 1e-6).mapped("thin needles", |v| v),
        height_field(&mut rng, 20),
        duplicates(&mut rng),
        soup(&mut rng, 400, 0.2).mapped("far away", |v| v + Vec3::new(148_376.0, 1234.0, -223_423.0)),
        soup(&mut rng, 400, 0.2).mapped("tiny", |v| v * 1e-30),
        soup(&mut rng, 400, 0.2).mapped("huge", |v| v * 1e30),
        soup(&mut rng, 400, 0.2).mapped("denormal", |v| v * 1e-41),
        soup(&mut rng, 400, 0.5).mapped("in a plane", |v| Vec3::new(v.x, 0.5, v.z)),
        Mesh::from_soup("spheres", Vec::new()).with_spheres("spheres", spheres(&mut rng, 500, 0.3)),
        soup(&mut rng, 400, 0.2).with_spheres("triangles and spheres", spheres(&mut rng, 300, 0.3)),
        on_cell_walls(&mut rng),
    ]
}

/// Rays at random, at vertices, edges and insides, along axes, in planes, from far away, with long and short
/// directions.
pub(crate) fn rays_for(mesh: &Mesh, rng: &mut Rng) -> Vec<Ray> {
    let points = || mesh.vertices.iter().copied().chain(mesh.spheres.iter().map(|&(centre, _)| centre));
    let lower = points().reduce(Vec3::min).expect("a mesh has vertices or spheres");
    let upper = points().reduce(Vec3::max).expect("a mesh has vertices or spheres");
    let (centre, half) = (lower * 0.5 + upper * 0.5, upper * 0.5 - lower * 0.5);
    let scale = half.max_element();
    let mut rays = Vec::new();
    // Between points of the walls that halving an axis four times makes: at corners of cells, along and in walls.
    for round in 0..200 {
        let mut on_wall = || lower + 2.0 * half * Vec3::from_array([0; 3].map(|_| rng.below(17) as f32 / 16.0));
        let (origin, mut target) = (on_wall(), on_wall());
        for axis in 0..round % 3 {
            target[axis] = origin[axis];
        }
        let direction = target - origin;
        for distance in [0.0, 1e3, 1e5, 1e7] {
            let origin = origin - distance * direction;
            rays.push(Ray { origin, t_min: f32::NEG_INFINITY, direction, t_max: f32::INFINITY });
        }
    }
    for round in 0..1200 {
        let primitive = rng.below(mesh.triangles.len() + mesh.spheres.len());
        let corners = match mesh.triangles.get(primitive) {
            Some(triangle) => triangle.map(|index| mesh.vertices[index as usize]),
            // Three points of the sphere.
            None => {
                let (centre, radius) = mesh.spheres[primitive - mesh.triangles.len()];
                [0; 3].map(|_| centre + radius * rng.point().normalize_or(Vec3::X))
            }
        };
        let (a, b) = (rng.signed().abs(), rng.signed().abs());
        let on_edge = corners[0] + (corners[1] - corners[0]) * a;
        let target = match round % 6 {
            0 => corners[rng.below(3)],
            1 => on_edge,
            2 => on_edge + (corners[2] - on_edge) * b,
            3 => (corners[0] + corners[1]) * 0.5,
            4 => centre + half * rng.point(),
            _ => corners[0] + (corners[1] - corners[0]) * a * 1.0001,
        };
        let distance = [1.5, 1e-4, 1e3, 1e5][(round / 6) % 4];
        let origin = match (round / 24) % 5 {
            // Along an axis, exactly at the target's other coordinates.
            0 => {
                let mut origin = target;
                origin[rng.below(3)] += scale * distance;
                origin
            }
            // In a plane through the target.
            1 => target + scale * distance * Vec3::new(rng.signed(), 0.0, rng.signed()),
            // At a vertex of the same triangle: along an edge, or in the triangle's plane.
            2 => corners[rng.below(3)],
            _ => target + scale * distance * rng.point(),
        };
        let length = [1.0, 1e-3, 1e12, 1e-25][(round / 5) % 4] / scale.max(1e-12);
        let direction = (target - origin) * length;
        let (t_min, t_max) = [(0.0, f32::INFINITY), (f32::NEG_INFINITY, f32::INFINITY), (0.0, 1.0 / length)][round % 3];
        rays.push(Ray { origin, t_min, direction, t_max });
        // The opposite signs of zero.
        rays.push(Ray { origin, t_min, direction: direction * -1.0, t_max });
    }
    rays
}
