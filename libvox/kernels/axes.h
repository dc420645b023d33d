/* Transformation of a vector to axes of which the bond's own is the first, and back. In loops the
 * axis is a constant. */
#ifndef VOX_AXES_H
#define VOX_AXES_H

#include "internal.h"

IN_LOOP struct vec axis_to_x(enum axis axis, struct vec v)
{
    if (axis == AXIS_X) return v;
    return axis == AXIS_Y ? (struct vec){v.y, -v.x, v.z} : (struct vec){v.z, v.y, -v.x};
}

IN_LOOP struct vec x_to_axis(enum axis axis, struct vec v)
{
    if (axis == AXIS_X) return v;
    return axis == AXIS_Y ? (struct vec){-v.y, v.x, v.z} : (struct vec){-v.z, v.y, v.x};
}

#endif
