//! Whether a triangle and a box share a point: separating axes (Akenine-Moeller 2001, "Fast 3D triangle-box overlap
//! testing"), in `f64`, never "no" for a triangle that touches the closed box.

use glam::DVec3;

use super::Triangle;

/// How much larger the box is taken for, in units of the largest coordinate `m` that takes part.
///
/// With `u = 2^-53`: relative to the box's centre a coordinate is at most 2 m and off by at most 3 u m (the centre rounds
/// once, the halved size once, the difference once), which needs a box larger by 6 u m. The products of an edge `e` with
/// such a coordinate, `e_i v_j - e_j v_i`, and with the box's size, are off by at most four roundings each (of the edge, of
/// the product, of the sums), `8 u (|e_i| + |e_j|) 2 m`; and a box larger by `s` adds `s (|e_i| + |e_j|)`. 22 u m suffices.
const ROUNDING: f64 = 32.0 * 0.5 * f64::EPSILON;

/// The same for the triangle's plane, relative to its permanent: two roundings in each edge, two in a component of the
/// normal, four in the dot product.
const PLANE_ROUNDING: f64 = 16.0 * 0.5 * f64::EPSILON;

impl Triangle {
    /// Whether it may have a point in the closed box: false only where it has none.
    pub(crate) fn overlaps(&self, lower: DVec3, upper: DVec3) -> bool {
        let [a, b, c] = std::array::from_fn(|corner| DVec3::from_array(self.axes.map(|row| f64::from(row[corner]))));
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        if (least.cmpgt(upper) | most.cmplt(lower)).any() {
            return false;
        }
        let magnitude = most.max(-least).max(upper).max(-lower).max_element();
        let centre = 0.5 * lower + 0.5 * upper;
        let half = (0.5 * upper - 0.5 * lower) + ROUNDING * magnitude;
        let (a, b, c) = (a - centre, b - centre, c - centre);

        let (ab, bc, ca) = (b - a, c - b, a - c);
        let permanent = |p: DVec3, q: DVec3| {
            let (p, q) = (p.abs(), q.abs());
            DVec3::new(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x)
        };
        let normal = ab.cross(bc);
        let rounding = PLANE_ROUNDING * permanent(ab, bc).dot(a.abs() + half);
        if normal.dot(a).abs() > normal.abs().dot(half) + rounding {
            return false;
        }

        // The two ends of an edge lie at one distance along each axis that is at right angles to it.
        !(is_apart(ab, a, c, half) || is_apart(bc, b, a, half) || is_apart(ca, c, b, half))
    }
}

/// Whether one of the cross products of the edge with x, y and z separates the triangle, given by a point of the edge and
/// the opposite corner, from the box around the origin.
#[inline(always)]
fn is_apart(edge: DVec3, on_edge: DVec3, opposite: DVec3, half: DVec3) -> bool {
    let size = edge.abs();
    let (p, q) = (edge.cross(on_edge), edge.cross(opposite));
    let radius = DVec3::new(
        size.z * half.y + size.y * half.z,
        size.x * half.z + size.z * half.x,
        size.y * half.x + size.x * half.y,
    );
    (p.min(q).cmpgt(radius) | p.max(q).cmplt(-radius)).any()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In `[0, 1)`, from a seed.
    fn uniform(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 40) as f64 / (1u64 << 24) as f64
    }

    fn point(state: &mut u64) -> DVec3 {
        DVec3::new(uniform(state), uniform(state), uniform(state)) * 2.0 - 1.0
    }

    /// The part of a polygon in the box (Sutherland and Hodgman 1974) has a corner, and how many.
    fn clipped(triangle: &Triangle, lower: DVec3, upper: DVec3) -> usize {
        let mut polygon: Vec<DVec3> =
            (0..3).map(|corner| DVec3::from_array(triangle.axes.map(|row| f64::from(row[corner])))).collect();
        for axis in 0..3 {
            for (plane, sign) in [(lower[axis], 1.0), (upper[axis], -1.0)] {
                let height = |p: DVec3| sign * (p[axis] - plane);
                let next = polygon.iter().cycle().skip(1);
                let mut kept = Vec::new();
                for (&p, &q) in polygon.iter().zip(next) {
                    if height(p) >= 0.0 {
                        kept.push(p);
                    }
                    if (height(p) >= 0.0) != (height(q) >= 0.0) {
                        kept.push(p + (q - p) * (height(p) / (height(p) - height(q))));
                    }
                }
                polygon = kept;
            }
        }
        polygon.len()
    }

    fn triangle(vertices: [DVec3; 3]) -> Triangle {
        Triangle::new(vertices.map(|vertex| vertex.as_vec3().to_array()), 0, 0)
    }

    #[test]
    fn overlap_is_told_as_clipping_tells_it() {
        let (mut yes, mut no) = (0, 0);
        for seed in 0..40_000_u64 {
            let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15);
            let offset = point(&mut state) * [0.0, 1.0, 1e3, 1e6][seed as usize % 4];
            let size = [1.0, 1e-2, 30.0][seed as usize / 4 % 3];
            let centre = 0.5 * point(&mut state);
            let mut vertices = [0; 3].map(|_| offset + centre + size * point(&mut state));
            if seed % 5 == 0 {
                vertices[2] = vertices[1] + 1e-5 * point(&mut state);
            }
            let half = 0.5 * (point(&mut state).abs() + 1e-3);
            let (triangle, rounding) = (triangle(vertices), 1e-9 * (1.0 + offset.abs().max_element()));
            let (lower, upper) = (offset - half, offset + half);
            let told = triangle.overlaps(lower, upper);
            if clipped(&triangle, lower + rounding, upper - rounding) > 0 {
                assert!(told, "seed {seed}: {triangle:?} in {lower} to {upper}");
                yes += 1;
            } else if clipped(&triangle, lower - rounding, upper + rounding) == 0 {
                assert!(!told, "seed {seed}: {triangle:?} beside {lower} to {upper}");
                no += 1;
            }
        }
        assert!(yes > 5000 && no > 5000, "{yes} overlap, {no} do not");
    }

    #[test]
    fn triangle_that_touches_the_box_overlaps_it() {
        let (lower, upper) = (DVec3::splat(0.25), DVec3::splat(0.5));
        let v = DVec3::new;
        // In a side's plane, at a corner, along an edge, and with an edge across an edge of the box.
        for vertices in [
            [v(0.5, 0.3, 0.3), v(0.5, 0.4, 0.3), v(0.5, 0.3, 0.4)],
            [v(0.5, 0.5, 0.5), v(1.0, 0.5, 0.5), v(1.0, 1.0, 0.75)],
            [v(0.5, 0.5, 0.0), v(0.5, 0.5, 1.0), v(1.0, 1.0, 0.0)],
            [v(0.75, 0.25, 0.375), v(0.25, 0.75, 0.375), v(1.0, 1.0, 1.0)],
        ] {
            assert!(triangle(vertices).overlaps(lower, upper), "{vertices:?}");
            let beside = vertices.map(|vertex| vertex + DVec3::splat(1e-6));
            assert!(!triangle(beside).overlaps(lower, upper), "{beside:?}");
        }
    }
}
