//! Vectors of exact numbers, for tests.

use num_bigint::BigInt;
use num_rational::BigRational;

pub(crate) type Vector = [BigRational; 3];

pub(crate) fn exact(point: [f32; 3]) -> Vector {
    point.map(|coordinate| BigRational::from_float(coordinate).expect("finite"))
}

pub(crate) fn zero() -> BigRational {
    BigRational::from_integer(BigInt::from(0))
}

pub(crate) fn minus(p: &Vector, q: &Vector) -> Vector {
    std::array::from_fn(|axis| &p[axis] - &q[axis])
}

pub(crate) fn along(p: &Vector, t: &BigRational, d: &Vector) -> Vector {
    std::array::from_fn(|axis| &p[axis] + t * &d[axis])
}

pub(crate) fn cross(p: &Vector, q: &Vector) -> Vector {
    std::array::from_fn(|axis| {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        &p[next] * &q[last] - &p[last] * &q[next]
    })
}

pub(crate) fn dot(p: &Vector, q: &Vector) -> BigRational {
    &p[0] * &q[0] + &p[1] * &q[1] + &p[2] * &q[2]
}

pub(crate) fn magnitude(value: &BigRational) -> BigRational {
    if *value < zero() { -value.clone() } else { value.clone() }
}
