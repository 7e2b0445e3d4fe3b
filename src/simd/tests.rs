//! Every operation on every instruction set against the scalar one, NaN, zeros, infinities and denormals among the
//! operands.

use super::*;

/// All pairs of these, eight at a time.
const VALUES: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    1.5,
    -2.75,
    3.3e-39,
    -1e-45,
    f32::MIN_POSITIVE,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    1e20,
    0.1,
];

/// The results of all operations as bits, a NaN as one number.
fn results<S: Simd>(simd: S) -> Vec<u32> {
    struct All;
    impl SimdKernel for All {
        type Output = Vec<u32>;

        fn run<S: Simd>(self, simd: S) -> Vec<u32> {
            let mut results = Vec::new();
            for shift in 0..VALUES.len() {
                for half in 0..2 {
                    let a: [f32; LANES] = std::array::from_fn(|lane| VALUES[half * LANES + lane]);
                    let b: [f32; LANES] =
                        std::array::from_fn(|lane| VALUES[(half * LANES + lane + shift) % VALUES.len()]);
                    let fours: [[f32; 4]; LANES] =
                        std::array::from_fn(|lane| [a[lane], b[lane], a[(lane + 3) % LANES], b[(lane + 5) % LANES]]);
                    let transposed = simd.transpose(fours.each_ref()).map(|row| simd.store(row));
                    results.extend(transposed.as_flattened().iter().map(|value| value.to_bits()));
                    let (a, b) = (simd.load(&a), simd.load(&b));
                    let eights: [S::F32x8; LANES] = std::array::from_fn(|row| simd.add(a, simd.splat(row as f32)));
                    let columns = simd.transpose_eights(eights).map(|column| simd.store(column));
                    for (column, values) in columns.iter().enumerate() {
                        for (row, value) in values.iter().enumerate() {
                            let of_row = simd.store(eights[row])[column];
                            assert!(value.to_bits() == of_row.to_bits() || value.is_nan() && of_row.is_nan());
                        }
                    }
                    let lanes = [
                        simd.add(a, b),
                        simd.sub(a, b),
                        simd.mul(a, b),
                        simd.div(a, b),
                        simd.min(a, b),
                        simd.max(a, b),
                    ];
                    for value in lanes.into_iter().flat_map(|lanes| simd.store(lanes)) {
                        results.push(if value.is_nan() { f32::NAN.to_bits() } else { value.to_bits() });
                    }
                    results.extend([simd.less(a, b), simd.less_or_equal(a, b)]);
                }
            }
            results
        }
    }
    simd.vectorize(All)
}

/// What the operations on whole lanes make of every mask, and of lanes in many orders.
fn arrangements<S: Simd>(simd: S) -> Vec<u32> {
    struct All;
    impl SimdKernel for All {
        type Output = Vec<u32>;

        fn run<S: Simd>(self, simd: S) -> Vec<u32> {
            let mut results = Vec::new();
            let numbers: [u32; LANES] = [70, 61, 52, 43, 34, 25, 16, 7];
            for mask in 0..1 << LANES {
                // Some negative, two equal.
                let keys: [f32; LANES] = std::array::from_fn(|lane| {
                    let value = ((lane + 1) * (mask + 3) % 11) as f32;
                    if mask >> lane & 1 == 1 { value } else { -value }
                });
                let keys = simd.load(&keys);
                let sorted = simd.store(simd.sort_descending(keys));
                assert!(sorted.is_sorted_by_key(|key| std::cmp::Reverse(key.to_bits() as i32)), "{sorted:?}");
                results.extend(sorted.map(f32::to_bits));
                results.extend(simd.store(simd.order_two(keys))[..2].iter().map(|key| key.to_bits()));
                results.extend(simd.gather(&numbers, keys));
                let count = mask.count_ones() as usize;
                let (lanes, values) = (simd.compress_lanes(keys, mask as u32), simd.compress(&numbers, mask as u32));
                results.extend(simd.store(lanes)[..count].iter().map(|key| key.to_bits()));
                results.extend(&values[..count]);
                let (and, or) = (simd.and(keys, simd.splat(-1.5)), simd.or(keys, simd.splat(-0.0)));
                let blended = simd.blend(keys, simd.splat(0.5), mask as u32);
                results.extend([and, or, blended].into_iter().flat_map(|lanes| simd.store(lanes)).map(f32::to_bits));
            }
            results
        }
    }
    simd.vectorize(All)
}

/// The results of all operations on doubles, as bits, a NaN as one number.
fn doubles<S: Simd>(simd: S) -> Vec<u64> {
    struct All;
    impl SimdKernel for All {
        type Output = Vec<u64>;

        fn run<S: Simd>(self, simd: S) -> Vec<u64> {
            let mut results = Vec::new();
            for first in VALUES {
                for second in VALUES {
                    let (a, b) = (simd.widen3([first, second, 1.5]), simd.widen3([second, -2.75, first]));
                    let values = [
                        simd.splat3(first),
                        simd.add3(a, b),
                        simd.sub3(a, b),
                        simd.mul3(a, b),
                        simd.abs3(a),
                        simd.second_first(a),
                        simd.third_first(a),
                    ];
                    for value in values.into_iter().flat_map(|values| simd.values3(values)) {
                        results.push(if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() });
                    }
                    for bound in [0.0, 1.0, 1.5, f64::INFINITY, f64::NAN] {
                        results.push(u64::from(simd.beyond3(a, bound)));
                    }
                }
            }
            results
        }
    }
    simd.vectorize(All)
}

/// The results of all operations on sixteen floats: the bits, a NaN as one number.
fn sixteens<S: Simd>(simd: S) -> Vec<u32> {
    struct All;
    impl SimdKernel for All {
        type Output = Vec<u32>;

        fn run<S: Simd>(self, simd: S) -> Vec<u32> {
            let floats = simd.sixteen();
            let mut results = Vec::new();
            for shift in 0..SIXTEEN {
                let b = std::array::from_fn(|lane| VALUES[(lane + shift) % SIXTEEN]);
                results.extend(of_all(floats, floats.load(&VALUES), floats.load(&b), |a| {
                    let mut values = [0.0; SIXTEEN];
                    floats.store(a, &mut values);
                    values
                }));
            }
            // NaN is the greatest of nothing.
            let numbers = VALUES.map(|value| if value.is_nan() { -3.0 } else { value });
            results.push(floats.greatest(floats.load(&numbers)).to_bits());
            results
        }
    }
    simd.vectorize(All)
}

fn of_all<F: Floats>(floats: F, a: F::Vector, b: F::Vector, store: impl Fn(F::Vector) -> [f32; SIXTEEN]) -> Vec<u32> {
    let values = [
        floats.add(a, b),
        floats.sub(a, b),
        floats.mul(a, b),
        floats.div(a, b),
        floats.min(a, b),
        floats.max(a, b),
        floats.abs(b),
        floats.blend(a, b, 0b1010_0110_1111_0001),
        floats.mul_add(floats.splat(1.0), a, floats.splat(0.0)),
        floats.mul_sub(floats.splat(1.0), a, floats.splat(0.0)),
    ];
    let bits = |value: f32| if value.is_nan() { f32::NAN.to_bits() } else { value.to_bits() };
    let mut results: Vec<u32> = values.into_iter().flat_map(store).map(bits).collect();
    results.extend([floats.less(a, b), floats.less_or_equal(a, b)]);
    results
}

#[test]
fn sixteen_floats_are_each_computed_as_one() {
    for shift in 0..SIXTEEN {
        let b: [f32; SIXTEEN] = std::array::from_fn(|lane| VALUES[(lane + shift) % SIXTEEN]);
        let floats = Scalar.sixteen();
        let store = |a| {
            let mut values = [0.0; SIXTEEN];
            floats.store(a, &mut values);
            values
        };
        let together = of_all(floats, floats.load(&VALUES), floats.load(&b), store);
        for lane in 0..SIXTEEN {
            let alone = of_all(One, VALUES[lane], b[lane], |a| [a; SIXTEEN]);
            for operation in (0..10).filter(|operation| *operation != 7) {
                assert_eq!(together[operation * SIXTEEN + lane], alone[operation * SIXTEEN], "{operation} of {lane}");
            }
            for comparison in [160, 161] {
                assert_eq!(together[comparison] >> lane & 1, alone[comparison] & 1, "{comparison} of {lane}");
            }
        }
    }
}

#[test]
fn doubles_are_beyond_a_bound_on_one_side_together() {
    let beyond = |values: [f32; 3], bound| Scalar.beyond3(Scalar.widen3(values), bound);
    assert!(beyond([2.0, 3.0, 4.0], 1.0) && beyond([-2.0, -3.0, -4.0], 1.0));
    for values in [[2.0, -3.0, 4.0], [-2.0, -3.0, 4.0], [2.0, 1.0, 4.0], [2.0, f32::NAN, 4.0], [0.0, 0.0, 0.0]] {
        assert!(!beyond(values, 1.0), "{values:?}");
    }
    assert!(!beyond([2.0, 3.0, 4.0], f64::NAN));
}

/// `a * b - c` for operands of which the fused and the two-step result are equal.
fn exact_mul_sub<S: Simd>(simd: S) -> [f32; LANES] {
    struct MulSub;
    impl SimdKernel for MulSub {
        type Output = [f32; LANES];

        fn run<S: Simd>(self, simd: S) -> [f32; LANES] {
            let a = simd.load(&[1.0, 2.0, -3.0, 0.5, 0.0, 7.0, f32::INFINITY, -1.0]);
            simd.store(simd.mul_sub(a, simd.splat(4.0), simd.load(&[1.0, 8.0, 2.0, 0.25, 3.0, -1.0, 5.0, -4.0])))
        }
    }
    simd.vectorize(MulSub)
}

const MUL_SUB: [f32; LANES] = [3.0, 0.0, -14.0, 1.75, -3.0, 29.0, f32::INFINITY, 0.0];

#[test]
fn every_instruction_set_computes_what_the_scalar_one_does() {
    assert_eq!(exact_mul_sub(Scalar), MUL_SUB);
    #[cfg(target_arch = "x86_64")]
    {
        if let Some(simd) = Sse42::detect() {
            assert_eq!(results(simd), results(Scalar), "SSE4.2");
            assert_eq!(doubles(simd), doubles(Scalar), "SSE4.2");
            assert_eq!(arrangements(simd), arrangements(Scalar), "SSE4.2");
            assert_eq!(sixteens(simd), sixteens(Scalar), "SSE4.2");
            assert_eq!(exact_mul_sub(simd), MUL_SUB);
        }
        if let Some(simd) = Avx2::detect() {
            assert_eq!(results(simd), results(Scalar), "AVX2");
            assert_eq!(doubles(simd), doubles(Scalar), "AVX2");
            assert_eq!(arrangements(simd), arrangements(Scalar), "AVX2");
            assert_eq!(sixteens(simd), sixteens(Scalar), "AVX2");
            assert_eq!(exact_mul_sub(simd), MUL_SUB);
        }
        if let Some(simd) = Avx512::detect() {
            assert_eq!(results(simd), results(Scalar), "AVX-512");
            assert_eq!(doubles(simd), doubles(Scalar), "AVX-512");
            assert_eq!(arrangements(simd), arrangements(Scalar), "AVX-512");
            assert_eq!(sixteens(simd), sixteens(Scalar), "AVX-512");
            assert_eq!(exact_mul_sub(simd), MUL_SUB);
        }
    }
}

#[test]
fn a_cap_is_never_exceeded() {
    let resolved = |cap: Isa| Isa::from(cap.resolve());
    assert_eq!(resolved(Isa::Scalar), Isa::Scalar);
    assert!(matches!(resolved(Isa::Sse42), Isa::Scalar | Isa::Sse42));
    assert!(matches!(resolved(Isa::Avx2), Isa::Scalar | Isa::Sse42 | Isa::Avx2));
    assert_eq!(resolved(Isa::Avx512), resolved(Isa::Auto));
    assert_ne!(resolved(Isa::Auto), Isa::Auto);
}
