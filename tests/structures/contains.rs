//! Every structure tells what a closed surface contains; integers, in which nothing rounds, are the measure.

use crate::agree::variants;
use crate::common::{Mesh, Rng, add_spheres};
use glam::Vec3;
use gnomon::{BuildOptions, Scene, SceneBuilder, Structure};

type Point = [i64; 3];

fn minus(p: Point, q: Point) -> [i128; 3] {
    [0, 1, 2].map(|axis| i128::from(p[axis] - q[axis]))
}

fn cross(p: [i128; 3], q: [i128; 3]) -> [i128; 3] {
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

fn dot(p: [i128; 3], q: [i128; 3]) -> i128 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

/// A closed surface with integer coordinates, which `f32` has all.
struct Solid {
    name: &'static str,
    vertices: Vec<Point>,
    triangles: Vec<[usize; 3]>,
    /// Centres and radii.
    spheres: Vec<(Point, i64)>,
}

impl Solid {
    fn new(name: &'static str, vertices: Vec<Point>, triangles: Vec<[usize; 3]>) -> Self {
        Self { name, vertices, triangles, spheres: Vec::new() }
    }

    /// Both together.
    fn and(mut self, other: &Self) -> Self {
        let first = self.vertices.len();
        self.vertices.extend(&other.vertices);
        self.triangles.extend(other.triangles.iter().map(|triangle| triangle.map(|index| index + first)));
        self.spheres.extend(&other.spheres);
        self
    }

    fn mapped(mut self, map: impl FnMut(&mut Point)) -> Self {
        self.vertices.iter_mut().for_each(map);
        self
    }

    fn corners(&self) -> impl Iterator<Item = [Point; 3]> {
        self.triangles.iter().map(|triangle| triangle.map(|index| self.vertices[index]))
    }

    /// By a half-line in a direction in which it meets no edge, and no triangle edge-on; or on the surface.
    fn contains(&self, point: Point, rng: &mut Rng) -> bool {
        let is_touching = |&(centre, radius): &(Point, i64)| {
            let offset = minus(point, centre);
            dot(offset, offset) == i128::from(radius).pow(2)
        };
        if self.corners().any(|corners| is_on(corners, point)) || self.spheres.iter().any(is_touching) {
            return true;
        }
        let inside = self.spheres.iter().filter(|&&(centre, radius)| {
            let offset = minus(point, centre);
            dot(offset, offset) < i128::from(radius).pow(2)
        });
        let in_spheres = inside.count();
        loop {
            let direction = [0; 3].map(|_| rng.below(1 << 20) as i128 - (1 << 19));
            let crossed: Option<Vec<bool>> = self.corners().map(|corners| crosses(corners, point, direction)).collect();
            if let Some(crossed) = crossed {
                let in_meshes = crossed.into_iter().filter(|is_crossed| *is_crossed).count();
                return (in_meshes + in_spheres) % 2 == 1;
            }
        }
    }

    fn build(&self, options: BuildOptions) -> Scene {
        let float = |point: Point| Vec3::from_array(point.map(|c| c as f32));
        let mesh = Mesh {
            name: self.name,
            vertices: self.vertices.iter().copied().map(float).collect(),
            triangles: Vec::new(),
            spheres: Vec::new(),
        };
        let triangles: Vec<[u32; 3]> = self.triangles.iter().map(|t| t.map(|index| index as u32)).collect();
        let mut builder = SceneBuilder::new();
        // Two meshes that are closed together alone.
        let (first, second) = triangles.split_at(triangles.len() / 2);
        mesh.add_geometry(first, &mut builder);
        mesh.add_geometry(second, &mut builder);
        let spheres: Vec<(Vec3, f32)> = self.spheres.iter().map(|&(centre, r)| (float(centre), r as f32)).collect();
        add_spheres(&spheres, &mut builder);
        builder.build(&options).expect("it is valid")
    }

    /// At random, at vertices, at middles of edges, on triangles, in line with vertices and edges along each axis, and next
    /// to all of these.
    fn points(&self, rng: &mut Rng) -> Vec<Point> {
        let extent = self.vertices.iter().flatten().map(|c| c.abs()).max().unwrap_or(100);
        let mut points = Vec::new();
        for _ in 0..60 {
            let away = [0; 3].map(|_| (rng.signed() * 1.25 * extent as f32) as i64);
            let [a, b, c] = match self.triangles.len() {
                0 => [self.spheres[rng.below(self.spheres.len())].0, away, away],
                count => self.triangles[rng.below(count)].map(|index| self.vertices[index]),
            };
            let middle = [0, 1, 2].map(|axis| (a[axis] + b[axis]) / 2);
            let inner = [0, 1, 2].map(|axis| (2 * a[axis] + b[axis] + c[axis]) / 4);
            let step = [0; 3].map(|_| rng.below(3) as i64 - 1);
            for target in [away, a, middle, inner] {
                let (mut in_line, mut in_plane) = (target, target);
                let axis = rng.below(3);
                in_line[axis] = away[axis];
                in_plane[(axis + 1) % 3] = away[(axis + 1) % 3];
                in_plane[(axis + 2) % 3] = away[(axis + 2) % 3];
                let beside = [0, 1, 2].map(|axis| target[axis] + step[axis]);
                points.extend([target, in_line, in_plane, beside]);
            }
        }
        points
    }
}

fn is_on([a, b, c]: [Point; 3], point: Point) -> bool {
    let normal = cross(minus(b, a), minus(c, a));
    normal != [0; 3]
        && dot(normal, minus(point, a)) == 0
        && [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| dot(cross(minus(v, u), minus(point, u)), normal) >= 0)
}

/// Whether the half-line from a point that is not on the triangle crosses its inside; `None` where its line meets an edge, or
/// the triangle's plane holds it.
fn crosses(corners: [Point; 3], point: Point, direction: [i128; 3]) -> Option<bool> {
    let normal = cross(minus(corners[1], corners[0]), minus(corners[2], corners[0]));
    if normal == [0; 3] {
        return Some(false);
    }
    let [a, b, c] = corners.map(|corner| minus(corner, point));
    let volume = dot(a, cross(b, c));
    if volume == 0 {
        // It meets the plane at the point alone.
        return (dot(direction, normal) != 0).then_some(false);
    }
    let weights = [(b, c), (c, a), (a, b)].map(|(u, v)| dot(direction, cross(u, v)));
    if weights.contains(&0) {
        return None;
    }
    let is_met = weights.iter().all(|w| *w > 0) || weights.iter().all(|w| *w < 0);
    // By Cramer's rule the line is at the plane at their quotient.
    Some(is_met && (volume > 0) == (weights.iter().sum::<i128>() > 0))
}

/// A box whose faces are grids of so many cells, each of two triangles.
fn gridded_box(name: &'static str, cells: i64, size: i64) -> Solid {
    let mut solid = Solid::new(name, Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [0, cells] {
            let first = solid.vertices.len();
            let row = cells as usize + 1;
            for i in 0..=cells {
                for j in 0..=cells {
                    let mut vertex = [0; 3];
                    (vertex[axis], vertex[(axis + 1) % 3], vertex[(axis + 2) % 3]) = (side, i, j);
                    solid.vertices.push(vertex.map(|c| (2 * c - cells) * size));
                }
            }
            for i in 0..cells as usize {
                for j in 0..cells as usize {
                    let at = first + i * row + j;
                    solid.triangles.extend([[at, at + 1, at + row], [at + row + 1, at + row, at + 1]]);
                }
            }
        }
    }
    solid
}

/// An icosahedron whose triangles are divided so many times into four.
fn icosphere(name: &'static str, levels: usize, radius: f64) -> Solid {
    let g = 0.5 + 1.25f64.sqrt();
    let mut vertices: Vec<[f64; 3]> = Vec::new();
    for (s, t) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        vertices.extend([[0.0, s, t], [s, t, 0.0], [t, 0.0, s]]);
    }
    let square = |p: [f64; 3], q: [f64; 3]| (0..3).map(|axis| (p[axis] - q[axis]).powi(2)).sum::<f64>();
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in 0..a {
            for c in 0..b {
                let edges = [(a, b), (b, c), (c, a)];
                if edges.iter().all(|&(u, v)| square(vertices[u], vertices[v]) < 5.0) {
                    triangles.push([a, b, c]);
                }
            }
        }
    }
    assert_eq!(triangles.len(), 20);
    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut divided = Vec::new();
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(u, v)| {
                *middles.entry((u.min(v), u.max(v))).or_insert_with(|| {
                    vertices.push([0, 1, 2].map(|axis| 0.5 * (vertices[u][axis] + vertices[v][axis])));
                    vertices.len() - 1
                })
            });
            divided.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = divided;
    }
    let on_sphere = |p: [f64; 3]| p.map(|c| 2 * (0.5 * radius * c / square(p, [0.0; 3]).sqrt()).round() as i64);
    Solid::new(name, vertices.into_iter().map(on_sphere).collect(), triangles)
}

fn solids() -> Vec<Solid> {
    let mut rng = Rng::new(43);
    let tetrahedron = |name| {
        Solid::new(
            name,
            vec![[-9, -9, -9], [9, 9, -9], [9, -9, 9], [-9, 9, 9]],
            vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
        )
    };
    // In one line along each axis, and edge-on: one edge along x, two faces across axes.
    let corner = Solid::new(
        "corner",
        vec![[0; 3], [64, 0, 0], [0, 64, 0], [0, 0, 64]],
        vec![[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]],
    );
    let jagged = icosphere("jagged", 2, 3e4).mapped(|vertex| {
        let length = 1 + rng.below(16) as i64;
        *vertex = vertex.map(|c| c / 16 * length);
    });
    let balls = |name| {
        let mut solid = Solid::new(name, Vec::new(), Vec::new());
        solid.spheres = vec![([0; 3], 50), ([20, 0, 0], 50), ([0; 3], 10), ([-70, 30, 5], 25), ([0, 0, 90], 90)];
        solid
    };
    // An edge of the one is cut in two by the other's vertex; a sliver without area closes the gap.
    let sliver = Solid::new(
        "sliver",
        vec![[0, 0, 0], [8, 8, 0], [4, 4, 0], [8, 0, 0], [0, 8, 0], [4, 4, 8]],
        vec![[0, 3, 1], [0, 1, 2], [0, 2, 4], [2, 1, 4], [0, 3, 5], [3, 1, 5], [1, 4, 5], [4, 0, 5]],
    );
    vec![
        tetrahedron("tetrahedron"),
        corner,
        sliver,
        gridded_box("box", 1, 16),
        gridded_box("gridded box", 6, 16),
        icosphere("icosphere", 3, 1e5),
        icosphere("shells", 2, 6e4).and(&icosphere("inner", 1, 3e4)).and(&gridded_box("core", 2, 4096)),
        gridded_box("overlapping", 2, 32)
            .and(&gridded_box("beside", 2, 32).mapped(|[x, y, _]| (*x, *y) = (*x + 32, *y + 64))),
        gridded_box("thrice", 3, 16).and(&gridded_box("second", 3, 16)).and(&gridded_box("third", 3, 16)),
        tetrahedron("twice").and(&tetrahedron("second")),
        jagged,
        balls("balls"),
        gridded_box("box and balls", 2, 16).and(&balls("balls")),
    ]
}

#[test]
fn contains_point_is_exact_in_every_structure() {
    let mut rng = Rng::new(47);
    for solid in solids() {
        let points = solid.points(&mut rng);
        let expected: Vec<bool> = points.iter().map(|&point| solid.contains(point, &mut rng)).collect();
        let inside_count = expected.iter().filter(|is_inside| **is_inside).count();
        assert!((10..points.len() - 10).contains(&inside_count), "{}: {inside_count} inside", solid.name);
        let brute_force = BuildOptions { structure: Structure::BruteForce, ..BuildOptions::default() };
        for variant in variants().into_iter().chain([brute_force]) {
            let scene = solid.build(variant);
            for (point, expected) in points.iter().zip(&expected) {
                let is_inside = scene.contains_point(Vec3::from_array(point.map(|c| c as f32)));
                assert_eq!(is_inside, Ok(*expected), "{} {variant:?}: {point:?}", solid.name);
            }
        }
    }
}

#[test]
fn points_that_are_not_finite_or_far_away_are_outside() {
    let solid = gridded_box("box", 2, 16);
    for variant in variants() {
        let scene = solid.build(variant);
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN] {
            for axis in 0..3 {
                let mut point = Vec3::ZERO;
                assert_eq!(scene.contains_point(point), Ok(true));
                point[axis] = value;
                assert_eq!(scene.contains_point(point), Ok(false), "{variant:?}: {point}");
            }
        }
    }
}
