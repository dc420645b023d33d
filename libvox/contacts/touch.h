/* What listed and touching pairs are. */
#ifndef VOX_TOUCH_H
#define VOX_TOUCH_H

#include "internal.h"

/* Distances below which a pair is listed. */
struct limits {
    double reach;   /* m, of any list */
    double engine;  /* m, of the original engine's list, or infinite */
    double horizon; /* of the original engine's list, in sizes of the first voxel, or infinite */
};
/* contact_list.c */
struct limits vox_contacts_limits(const vox_model *model);

/* Return whether a pair is listed, given the size of its first voxel and the square of its
 * distance; pairs exactly at the original engine's reach are not. */
IN_LOOP bool is_listed(const struct limits *limits, double size, double distance2)
{
    if (distance2 >= limits->reach * limits->reach) return false;
    const double distance = sqrt(distance2);
    return distance < limits->horizon * size && distance < limits->engine;
}

/* Two voxels whose envelopes overlap. */
struct touch {
    int32_t first, second;
    struct vec towards; /* unit, from the first to the second */
    double distance;    /* m */
    double overlap;     /* m */
};

/* Return the vector from the first to the second voxel of a pair. */
IN_LOOP struct vec between(const struct voxels *v, struct pair pair)
{
    return vec_sub(vec_at(v->position, pair.second), vec_at(v->position, pair.first));
}

/* Return whether a pair touches, given the vector between its voxels, and set the contact. */
IN_LOOP bool touches(const struct voxels *v, struct pair pair, struct vec apart,
                     double half_envelope, struct touch *touch)
{
    const double reach = half_envelope * (v->size[pair.first] + v->size[pair.second]);
    const double distance2 = vec_dot(apart, apart);
    if (!(distance2 < reach * reach && distance2 > 0.0)) return false;
    const double distance = sqrt(distance2);
    *touch = (struct touch){pair.first, pair.second, vec_scale(1.0 / distance, apart), distance,
                            reach - distance};
    return true;
}

/* Apply the original engine's law to a contact. */
IN_LOOP void repel(const struct body *body, const struct touch *touch)
{
    const struct voxels *v = &body->voxels;
    const double stiffness = coupling_of(body, touch->first, touch->second)->stretch;
    const struct vec force = vec_scale(stiffness * touch->overlap, touch->towards);
    vec_put(v->force, touch->first, vec_sub(vec_at(v->force, touch->first), force));
    vec_put(v->force, touch->second, vec_add(vec_at(v->force, touch->second), force));
}

#endif
