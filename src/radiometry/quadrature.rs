//! Integrals over triangles, sharing nothing with the closed forms that they check.

use gauss_quad::GaussLegendre;
use glam::DVec3;

/// Of `integrand(ray, cosine at the triangle)/ray^2` over the triangle's area, seen from the point: an integral over solid angle. Splits the
/// triangle in four until two rules agree within `tolerance` of the whole.
pub(super) fn over_triangle(
    point: DVec3,
    vertices: [DVec3; 3],
    tolerance: f64,
    integrand: &dyn Fn(DVec3) -> f64,
) -> f64 {
    let rule = |n: usize| GaussLegendre::new(n.try_into().expect("not 0"));
    let rules = [rule(8), rule(14)];
    let whole = once(&rules[1], point, vertices, integrand).abs();
    adaptive(&rules, point, vertices, tolerance * whole, 12, integrand)
}

fn adaptive(
    rules: &[GaussLegendre; 2],
    point: DVec3,
    vertices: [DVec3; 3],
    tolerance: f64,
    depth: u32,
    integrand: &dyn Fn(DVec3) -> f64,
) -> f64 {
    let [coarse, fine] = [0, 1].map(|which| once(&rules[which], point, vertices, integrand));
    if (coarse - fine).abs() <= tolerance || depth == 0 {
        return fine;
    }
    let [a, b, c] = vertices;
    let (ab, bc, ca) = (0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a));
    let parts = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]];
    parts.into_iter().map(|part| adaptive(rules, point, part, 0.25 * tolerance, depth - 1, integrand)).sum()
}

/// A product rule on the square, collapsed to the triangle (Duffy 1982).
fn once(rule: &GaussLegendre, point: DVec3, [a, b, c]: [DVec3; 3], integrand: &dyn Fn(DVec3) -> f64) -> f64 {
    let normal = (b - a).cross(c - a); // twice the area long
    rule.integrate(0.0, 1.0, |s| {
        rule.integrate(0.0, 1.0, |t| {
            let ray = a - point + s * ((b - a) + t * (c - b));
            let square = ray.length_squared();
            let cosine_times_area = normal.dot(ray).abs() / square.sqrt();
            s * cosine_times_area / square * integrand(ray / square.sqrt())
        })
    })
}
