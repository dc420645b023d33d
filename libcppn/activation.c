/* The activation functions, with the formulas, scales and clamps of neat-python 2.0; the five that
 * it lacks come from the authors of the experiment. Each formula is evaluated as written: nothing
 * is simplified, reordered or fused. */
#include <math.h>

#include "internal.h"

typedef double formula(double z);

/* Volatile, so that compilers do not replace the C library's power by a product, which may differ
 * in the last bit. */
static const volatile double TWO = 2.0;
static const volatile double THREE = 3.0;

static const double SELU_SCALE = 1.0507009873554804934193349852946;
static const double SELU_ALPHA = 1.6732632423543772848170429916717;

IN_LOOP double clamp(double z, double limit)
{
    const double below = z > limit ? limit : z;
    return below < -limit ? -limit : below;
}

/* clang-format off: a table of formulas. */
IN_LOOP double sigmoid(double z)
{
    return 1.0 / (1.0 + exp(-clamp(5.0 * z, 60.0)));
}
IN_LOOP double tanh_2_5(double z)
{
    return tanh(clamp(2.5 * z, 60.0));
}
IN_LOOP double sin_5(double z)
{
    return sin(clamp(5.0 * z, 60.0));
}
IN_LOOP double softplus(double z)
{
    return 0.2 * log(1.0 + exp(clamp(5.0 * z, 60.0)));
}
IN_LOOP double gauss(double z)
{
    return exp(-5.0 * pow(clamp(z, 3.4), TWO));
}
IN_LOOP double relu(double z)
{
    return z > 0.0 ? z : 0.0;
}
IN_LOOP double elu(double z)
{
    return z > 0.0 ? z : exp(z) - 1.0;
}
IN_LOOP double lelu(double z)
{
    return z > 0.0 ? z : 0.005 * z;
}
IN_LOOP double selu(double z)
{
    return z > 0.0 ? SELU_SCALE * z : SELU_SCALE * SELU_ALPHA * (exp(z) - 1.0);
}
IN_LOOP double identity(double z)
{
    return z;
}
IN_LOOP double clamped(double z)
{
    return clamp(z, 1.0);
}
IN_LOOP double inv(double z)
{
    return z == 0.0 ? 0.0 : 1.0 / z;
}
IN_LOOP double log_above_0(double z)
{
    return log(z > 1e-7 ? z : 1e-7);
}
IN_LOOP double exp_clamped(double z)
{
    return exp(clamp(z, 60.0));
}
IN_LOOP double absolute(double z)
{
    return fabs(z);
}
IN_LOOP double hat(double z)
{
    return relu(1.0 - fabs(z));
}
IN_LOOP double square(double z)
{
    return pow(z, TWO);
}
IN_LOOP double cube(double z)
{
    return pow(z, THREE);
}
IN_LOOP double neg_abs(double z)
{
    return -fabs(z);
}
IN_LOOP double neg_square(double z)
{
    return -pow(z, TWO);
}
IN_LOOP double sqrt_abs(double z)
{
    return sqrt(fabs(z));
}
IN_LOOP double neg_sqrt_abs(double z)
{
    return -sqrt(fabs(z));
}
IN_LOOP double neg_sin(double z)
{
    return -sin(z);
}
/* clang-format on */

/* One loop per formula, which the compiler vectorizes if it calls no function of the C library. */
IN_LOOP void map(formula *f, double bias, double response, int64_t n, double *sums)
{
    for (int64_t i = 0; i < n; i++) sums[i] = guarded(f(guarded(bias + response * sums[i])));
}

void cppn_activate(enum cppn_activation activation, double bias, double response, int64_t n,
                   double *sums)
{
    switch (activation) {
    case CPPN_SIGMOID: map(sigmoid, bias, response, n, sums); return;
    case CPPN_TANH: map(tanh_2_5, bias, response, n, sums); return;
    case CPPN_SIN: map(sin_5, bias, response, n, sums); return;
    case CPPN_SOFTPLUS: map(softplus, bias, response, n, sums); return;
    case CPPN_GAUSS: map(gauss, bias, response, n, sums); return;
    case CPPN_RELU: map(relu, bias, response, n, sums); return;
    case CPPN_ELU: map(elu, bias, response, n, sums); return;
    case CPPN_LELU: map(lelu, bias, response, n, sums); return;
    case CPPN_SELU: map(selu, bias, response, n, sums); return;
    case CPPN_IDENTITY: map(identity, bias, response, n, sums); return;
    case CPPN_CLAMPED: map(clamped, bias, response, n, sums); return;
    case CPPN_INV: map(inv, bias, response, n, sums); return;
    case CPPN_LOG: map(log_above_0, bias, response, n, sums); return;
    case CPPN_EXP: map(exp_clamped, bias, response, n, sums); return;
    case CPPN_ABS: map(absolute, bias, response, n, sums); return;
    case CPPN_HAT: map(hat, bias, response, n, sums); return;
    case CPPN_SQUARE: map(square, bias, response, n, sums); return;
    case CPPN_CUBE: map(cube, bias, response, n, sums); return;
    case CPPN_NEG_ABS: map(neg_abs, bias, response, n, sums); return;
    case CPPN_NEG_SQUARE: map(neg_square, bias, response, n, sums); return;
    case CPPN_SQRT_ABS: map(sqrt_abs, bias, response, n, sums); return;
    case CPPN_NEG_SQRT_ABS: map(neg_sqrt_abs, bias, response, n, sums); return;
    case CPPN_NEG_SIN: map(neg_sin, bias, response, n, sums); return;
    }
}
