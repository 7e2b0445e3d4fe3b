// Rationals rounded once: a detour through another format would round twice.
#pragma once

#include <gmpxx.h>

namespace harness {

/// The nearest float, ties to even; infinite from the midpoint above the largest float on.
float nearest_float(const mpq_class& value);

/// The nearest double, ties to even.
double nearest_double(const mpq_class& value);

/// The distance between neighbouring floats in the binade of `value`; 2^-149 for zero and for denormals.
double float_spacing(const mpq_class& value);

}  // namespace harness
