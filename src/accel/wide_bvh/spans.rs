//! What few operations on floats tell of hits, many at a time: whether a ray's line meets a triangle, and between what its
//! `t` lies. Of one ray with many triangles, or of many rays with one.

use crate::geometry::{PrecisionMode, least_doubt};
use crate::math::{UNIT_ROUNDOFF, gamma};
use crate::simd::Floats;

/// One coordinate of the three vertices.
pub(super) type Corners<F> = [<F as Floats>::Vector; 3];

/// Rounding keeps order: the difference of two rounded products has the right sign or is zero. So weights that differ
/// in sign refuse a triangle, and three of one sign, none zero, accept it.
#[inline(always)]
pub(super) fn weights<F: Floats>(floats: F, [x, y, _]: &[Corners<F>; 3]) -> Corners<F> {
    [edge(floats, x[2], y[1], y[2], x[1]), edge(floats, x[0], y[2], y[0], x[2]), edge(floats, x[1], y[0], y[1], x[0])]
}

/// Where weights differ in sign, and where all have the same one; for exact decisions beyond doubt.
#[derive(Clone, Copy)]
pub(super) struct Signs {
    pub(super) differ: u32,
    agree: u32,
}

impl Signs {
    /// See [`edge_slack`](crate::geometry::edge_slack) for the slack.
    #[inline(always)]
    pub(super) fn of<P: PrecisionMode, F: Floats>(
        floats: F,
        [x, y, _]: &[Corners<F>; 3],
        &[a, b, c]: &Corners<F>,
        edge_slack: f32,
    ) -> Self {
        let zero = floats.splat(0.0);
        let (least, greatest) = (floats.min(a, floats.min(b, c)), floats.max(a, floats.max(b, c)));
        // Above zero where all have one sign, below where two differ.
        let agreement = floats.max(least, floats.sub(zero, greatest));
        if !P::IS_EXACT {
            return Self { differ: floats.less(agreement, zero), agree: floats.less(zero, agreement) };
        }
        let (slack, least) = (floats.splat(edge_slack), floats.splat(least_doubt(edge_slack)));
        let doubt = floats.mul_add(size_across(floats, x, y), slack, least);
        Self { differ: floats.less(floats.add(agreement, doubt), zero), agree: floats.less(doubt, agreement) }
    }
}

/// What `f32` can tell of where rays meet triangles.
pub(super) struct Spans<F: Floats> {
    /// Where the ray's line certainly meets the triangle.
    pub(super) certain: u32,
    /// The `t` of a hit on a triangle lies between the two, however it is evaluated.
    pub(super) from: F::Vector,
    pub(super) to: F::Vector,
}

impl<F: Floats> Spans<F> {
    #[inline(always)]
    pub(super) fn within(&self, floats: F, t_min: F::Vector, t_max: F::Vector) -> u32 {
        floats.less_or_equal(t_min, self.to) & floats.less_or_equal(self.from, t_max)
    }
}

/// Every evaluation of a hit gives a point of the triangle, so `t` lies between those of the vertices, but for
/// roundings: with `u = 2^-24` and relative to the largest of the three, 3u for each of these (the difference, the
/// inverse, the product), u for the hit's, 2^-30 for evaluation in `f64` (`evaluation.rs`), and u for adding the slack:
/// less than `gamma(8)`.
///
/// Closer bounds come from the weights, where `t` [follows them](PrecisionMode::FOLLOWS_WEIGHTS). Of the sheared vertices let `s = sum(|x| + |y|)`, `n` the largest of these,
/// and `m` the largest `|z|`. Before the shear no coordinate exceeds `n + m`, so the sheared ones are off by
/// `e = 2 u (n + m) + 4 u m` at most (`triangle_hit.rs`), which moves the three weights by `2 e s + 6 e^2` together;
/// and their own roundings by `u s^2 / 2`. Weights that move by d together move the depth that they interpolate, where
/// their sum is w, by no more than `2 d / w` of the range of the depths; or else by no more than that range, which
/// this then exceeds. The interpolation's own roundings add less than `24 u m`. The factors below are a little larger
/// for the roundings of the bound itself; absolute terms cover underflow.
#[inline(always)]
pub(super) fn spans<P: PrecisionMode, F: Floats>(
    floats: F,
    &[x, y, z]: &[Corners<F>; 3],
    &[a, b, c]: &Corners<F>,
    signs: Signs,
    inverse_depth: F::Vector,
) -> Spans<F> {
    const LEAST_WEIGHT: f32 = 1.0 / (1u64 << 60) as f32;
    const LEAST_DEPTH: f32 = LEAST_WEIGHT / (1 << 20) as f32;

    let (nearest, farthest) = (floats.min(z[0], floats.min(z[1], z[2])), floats.max(z[0], floats.max(z[1], z[2])));
    let most = floats.max(floats.abs(nearest), floats.abs(farthest));
    let (x, y) = (abs3(floats, x), abs3(floats, y));
    let sizes = [floats.add(x[0], y[0]), floats.add(x[1], y[1]), floats.add(x[2], y[2])];
    let size = floats.add(sizes[0], floats.add(sizes[1], sizes[2]));
    let largest = floats.max(floats.max(floats.max(x[0], y[0]), floats.max(x[1], y[1])), floats.max(x[2], y[2]));
    let unit = |n: f32| floats.splat(n * UNIT_ROUNDOFF);
    let sheared_error = floats.add(floats.mul(unit(2.25), largest), floats.mul(unit(6.5), most));
    let weight_error = floats.add(
        floats.mul(
            sheared_error,
            floats.add(floats.mul(floats.splat(4.25), size), floats.mul(floats.splat(13.0), sheared_error)),
        ),
        floats.add(floats.mul(unit(1.25), floats.mul(size, size)), floats.splat(LEAST_WEIGHT)),
    );
    let inverse_sum = floats.div(floats.splat(1.0), floats.add(floats.add(a, b), c));
    let weighted = floats.add(floats.add(floats.mul(a, z[0]), floats.mul(b, z[1])), floats.mul(c, z[2]));
    let depth = floats.mul(weighted, inverse_sum);
    let moved = floats.mul(floats.mul(weight_error, floats.abs(inverse_sum)), floats.sub(farthest, nearest));
    let depth_error = floats.add(floats.add(moved, floats.mul(unit(24.0), most)), floats.splat(LEAST_DEPTH));

    let (first, last) = (floats.mul(nearest, inverse_depth), floats.mul(farthest, inverse_depth));
    let slack = floats.add(
        floats.mul(floats.splat(gamma(8)), floats.max(floats.abs(first), floats.abs(last))),
        floats.splat(f32::MIN_POSITIVE),
    );
    let (from, to) = (floats.sub(floats.min(first, last), slack), floats.add(floats.max(first, last), slack));
    if !P::FOLLOWS_WEIGHTS {
        return Spans { certain: signs.agree, from, to };
    }
    let t = floats.mul(depth, inverse_depth);
    let t_error = floats.mul(depth_error, floats.abs(inverse_depth));
    // A NaN, from weights that are all zero, leaves the vertices' bounds.
    Spans {
        certain: signs.agree,
        from: floats.max(floats.sub(t, t_error), from),
        to: floats.min(floats.add(t, t_error), to),
    }
}

#[inline(always)]
fn abs3<F: Floats>(floats: F, a: Corners<F>) -> Corners<F> {
    [floats.abs(a[0]), floats.abs(a[1]), floats.abs(a[2])]
}

#[inline(always)]
pub(super) fn shear<F: Floats>(floats: F, row: Corners<F>, slope: F::Vector, z: Corners<F>) -> Corners<F> {
    [
        floats.sub(row[0], floats.mul(slope, z[0])),
        floats.sub(row[1], floats.mul(slope, z[1])),
        floats.sub(row[2], floats.mul(slope, z[2])),
    ]
}

/// `a * b - c * d`.
#[inline(always)]
pub(super) fn edge<F: Floats>(floats: F, a: F::Vector, b: F::Vector, c: F::Vector, d: F::Vector) -> F::Vector {
    floats.sub(floats.mul(a, b), floats.mul(c, d))
}

/// The sum of the magnitudes of sheared coordinates: see [`edge_slack`](crate::geometry::edge_slack).
#[inline(always)]
pub(super) fn size_across<F: Floats>(floats: F, x: &Corners<F>, y: &Corners<F>) -> F::Vector {
    let (a, b) = (floats.add(floats.abs(x[0]), floats.abs(x[1])), floats.add(floats.abs(y[0]), floats.abs(y[1])));
    floats.add(floats.add(a, b), floats.add(floats.abs(x[2]), floats.abs(y[2])))
}
