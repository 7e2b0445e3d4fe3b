#include "oracle/rounding.hpp"

#include <algorithm>
#include <cmath>

namespace harness {
namespace {

/// An IEEE 754 binary format.
struct Format {
    int significand_bits;
    int min_quantum_exponent;  // of the least denormal
};
constexpr Format binary32{24, -149};
constexpr Format binary64{53, -1074};

/// For value != 0.
int floor_log2(const mpq_class& value) {
    const mpz_class numerator = abs(value.get_num());
    const mpz_class& denominator = value.get_den();
    // With n and m bits the quotient lies in (2^(n-m-1), 2^(n-m+1)): one comparison tells which half.
    const int exponent =
        static_cast<int>(mpz_sizeinbase(numerator.get_mpz_t(), 2)) - static_cast<int>(mpz_sizeinbase(denominator.get_mpz_t(), 2));
    const bool reaches = exponent >= 0 ? numerator >= (denominator << exponent) : (numerator << -exponent) >= denominator;
    return reaches ? exponent : exponent - 1;
}

/// The exponent of the format's spacing at value != 0.
int quantum_exponent(const mpq_class& value, const Format& format) {
    return std::max(floor_log2(value) - (format.significand_bits - 1), format.min_quantum_exponent);
}

/// The nearest multiple of the format's spacing, ties to even; what lies beyond a narrower format's range is for its caller.
double nearest(const mpq_class& value, const Format& format) {
    if (value == 0) return 0.0;
    const int exponent = quantum_exponent(value, format);
    mpz_class numerator = abs(value.get_num());
    mpz_class denominator = value.get_den();
    if (exponent >= 0) {
        denominator <<= exponent;
    } else {
        numerator <<= -exponent;
    }
    mpz_class quanta, remainder;
    mpz_fdiv_qr(quanta.get_mpz_t(), remainder.get_mpz_t(), numerator.get_mpz_t(), denominator.get_mpz_t());
    const int half = cmp(2 * remainder, denominator);
    if (half > 0 || (half == 0 && mpz_odd_p(quanta.get_mpz_t()))) ++quanta;
    const double magnitude = std::ldexp(quanta.get_d(), exponent);
    return value < 0 ? -magnitude : magnitude;
}

}  // namespace

// The conversion is exact, or overflows to infinity as rounding to nearest asks for.
float nearest_float(const mpq_class& value) { return static_cast<float>(nearest(value, binary32)); }

double nearest_double(const mpq_class& value) { return nearest(value, binary64); }

double float_spacing(const mpq_class& value) {
    return std::ldexp(1.0, value == 0 ? binary32.min_quantum_exponent : quantum_exponent(value, binary32));
}

}  // namespace harness
