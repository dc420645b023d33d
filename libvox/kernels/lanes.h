/* Mathematical functions for vectorized loops, without branches and calls. Each is accurate to 2
 * units in the last place and returns the same bits with every instruction set. */
#ifndef VOX_LANES_H
#define VOX_LANES_H

#include "internal.h"

/* Compiled to a selection, not to a jump. */
IN_LOOP double choose(bool first, double a, double b)
{
    return first ? a : b;
}

/* 1 / sqrt(1 - x/2) for x from 0 to 0.0012: the power series, to double precision. */
IN_LOOP double inverse_root_of_half(double x)
{
    return 1.0 + x * (1.0 / 4 + x * (3.0 / 32 + x * (5.0 / 128 + x * (35.0 / 2048))));
}

/* asin(sqrt(y)) / sqrt(y) for y from 0 to 1/4: the polynomial of this degree with the smallest
 * error, 1.7e-17. */
IN_LOOP double arcsine_ratio(double y)
{
    const double high =
        0.012170138592391726 +
        y * (0.0065293020047365695 +
             y * (0.019513468251252167 + y * (-0.016187392271599134 + y * 0.03187962140081284)));
    const double middle =
        0.022371749733164054 + y * (0.01735977964134998 + y * (0.01388484282640208 + y * high));
    const double low = 0.04464285680599894 + y * (0.03038195969768514 + y * middle);
    return 1.0 + y * (0.16666666666664942 + y * (0.07500000000385201 + y * low));
}

/* acos(w) for w from -1 to 1, from asin near 0 or near the closer end. */
IN_LOOP double arccosine(double w)
{
    /* the sum of both is pi / 2 */
    const double half_pi = 1.5707963267948966, beyond = 6.123233995736766e-17;
    const double size = fabs(w), chord2 = 0.5 - 0.5 * size;
    const bool near_end = size >= 0.5;
    const double y = choose(near_end, chord2, w * w);
    const double a = choose(near_end, sqrt(y), w) * arcsine_ratio(y);
    const double end = choose(w < 0.0, 2.0 * (half_pi - (a - beyond)), 2.0 * a);
    return choose(near_end, end, half_pi - (a - beyond));
}

/* 2 acos(w) / sqrt(1 - w^2) for w from 1/2 to 1: the polynomial of this degree with the smallest
 * relative error, 3e-18. */
IN_LOOP double short_arc_ratio(double w)
{
    const double x = 1.0 - w;
    const double high = 0.001049096790044682 +
                        x * (0.0007000998867085538 +
                             x * (-9.826809193147589e-05 +
                                  x * (0.0006042949318865728 +
                                       x * (-0.0003572798762358973 + x * 0.0002109868336204033))));
    const double middle =
        0.05079365223047195 +
        x * (0.02308799675989684 +
             x * (0.010656324448812008 +
                  x * (0.004970251864828021 + x * (0.0023547350062818385 + x * high))));
    return 2.0 + x * (0.6666666666666612 +
                      x * (0.26666666666747313 + x * (0.11428571423862295 + x * middle)));
}

/* sin(x): accurate to 2 units in the last place up to about 1e6; larger x are not exact anyway. */
IN_LOOP double sine(double x)
{
    /* 1.5 * 2^52: adding it rounds to an integer */
    const double whole = 6755399441055744.0;
    /* pi in three parts; the first two have 33 bits each, so their products with n are exact */
    const double first = 3.1415926534682512, second = 1.2154201012607932e-10,
                 third = 4.044532497591901e-21;
    const double n = (x * 0.3183098861837907 + whole) - whole, half = 0.5 * n;
    const bool odd = (half + whole) - whole != half;
    const double near = ((x - n * first) - n * second) - n * third;
    /* false only for very large x */
    const double r = choose(fabs(near) <= 1.6, near, 0.0), y = r * r;
    const double high =
        1.0 / 6227020800.0 +
        y * (-1.0 / 1307674368000.0 +
             y * (1.0 / 355687428096000.0 +
                  y * (-1.0 / 121645100408832000.0 + y * (1.0 / 51090942171709440000.0))));
    const double low =
        -1.0 / 6.0 +
        y * (1.0 / 120.0 +
             y * (-1.0 / 5040.0 + y * (1.0 / 362880.0 + y * (-1.0 / 39916800.0 + y * high))));
    const double sine = r + r * (y * low);
    return choose(odd, -sine, sine);
}

/* cos(x), as accurate as the rounding of x allows. */
IN_LOOP double cosine(double x)
{
    return sine(x + 1.5707963267948966);
}

#endif
