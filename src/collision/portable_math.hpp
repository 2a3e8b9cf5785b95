/// \file
/// exp, log, pow, sin and cos with the same bits on every machine.
///
/// The C library's functions differ between machines in their last bits. These use + - * / in double and integer
/// arithmetic only. Every finite number, infinity and NaN is in the domain; special values give what C says they give,
/// without the error flags. Largest errors found against the C library's long double, subnormal results included: log
/// 0.5 ulp, the others 0.8 ulp.
#pragma once

namespace carom::detail {

/// e to the power of x: 0 below -745.2, infinity above 709.8.
double exp(double x);

/// Natural logarithm: log(0) is -infinity, of a negative number NaN.
double log(double x);

/// x to the power of y, with the special cases of C: pow(x, 0) and pow(1, y) are 1 whatever the other is; a negative x
/// needs an integer y, else NaN.
double pow(double x, double y);

/// Sine of x radians, of any size: the period is taken off exactly.
double sin(double x);

/// Cosine of x radians, as sin().
double cos(double x);

} // namespace carom::detail
