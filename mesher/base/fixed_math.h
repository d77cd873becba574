// Elementary functions whose bits are the same on every machine and with every C library: all that the state
// of a simulation depends on calls these, never libm, which picks other versions where the processor has
// fused operations.
//
// Written in additions, multiplications, divisions and square roots of doubles, which IEEE 754 fixes to the
// bit; build with -ffp-contract=off. Series are Taylor's, after reductions of the argument [Cody & Waite
// 1980; Muller, Elementary Functions, 3rd ed.; the forms that save the last bits are those of W. Kahan and K.
// C. Ng's fdlibm]. Errors are at most 1 ulp unless stated (tests/mesher/fixed_math_test.cpp measures them).
// Not-a-number in, not-a-number out.
#pragma once

namespace liana::fixed {

double sin(double x);  ///< x in rad; above 2⁵¹, of x modulo the double nearest to 2π
double cos(double x);
double atan2(double y, double x);  ///< rad, signs of zero as in C
double acos(double x);             ///< not-a-number outside of [-1, 1]
double asin(double x);

double exp(double x);
double log(double x);
double log1p(double x);
double pow(double x, double y);  ///< negative x: of whole y only. Squares and roots are correctly rounded
double cbrt(double x);
double hypot(double x, double y);  ///< within 1.5 ulp, for |x|, |y| within 1e-150 … 1e150, or zero

}  // namespace liana::fixed
