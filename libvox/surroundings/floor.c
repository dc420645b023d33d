/* The floor: a spring, a damper and dry friction under every voxel (section 9). */
#include "internal.h"

/* Apply friction to a force on a voxel with the normal force `push`. */
static struct vec rub(struct body *body, int64_t slot, struct vec force, double push)
{
    const struct substance *s = substance_of_voxel(body, slot);
    struct voxels *v = &body->voxels;
    const struct vec velocity = velocity_of(v, slot);
    const double speed = sqrt(velocity.x * velocity.x + velocity.y * velocity.y);
    const double friction = s->dynamic_friction * push;
    const bool rests = speed == 0.0;
    if (rests && !(sqrt(force.x * force.x + force.y * force.y) < s->static_friction * push))
        return force;
    if (!rests && friction * body->census.dt < s->mass * speed) {
        force.x -= friction * velocity.x / speed;
        force.y -= friction * velocity.y / speed;
        return force;
    }
    v->momentum.x[slot] = v->momentum.y[slot] = 0.0;
    return (struct vec){0.0, 0.0, force.z};
}

void vox_floor_apply(struct body *body, int64_t slot)
{
    const struct substance *s = substance_of_voxel(body, slot);
    const struct voxels *v = &body->voxels;
    const double depth = floor_depth(body, slot);
    if (!(depth > 0.0)) return;
    const double push = s->floor_stiffness * depth;
    struct vec force = vec_at(v->force, slot);
    force.z += push - s->floor_drag * velocity_of(v, slot).z;
    vec_put(v->force, slot, rub(body, slot, force, push));
}
