/* The floor: a spring, a damper and dry friction under every voxel (section 9). */
#include "internal.h"

/* Lateral part of the force on a voxel that is pushed up with `push`. */
static struct vec rub(struct voxel *voxel, struct vec force, double push, double dt)
{
    const struct substance *s = voxel->substance;
    const struct vec velocity = velocity_of(voxel);
    const double speed = sqrt(velocity.x * velocity.x + velocity.y * velocity.y);
    const double friction = s->dynamic_friction * push;
    const bool rests = speed == 0.0;
    if (rests && !(sqrt(force.x * force.x + force.y * force.y) < s->static_friction * push)) return force;
    if (!rests && friction * dt < s->mass * speed) {
        force.x -= friction * velocity.x / speed;
        force.y -= friction * velocity.y / speed;
        return force;
    }
    voxel->momentum.x = voxel->momentum.y = 0.0;
    return (struct vec){0.0, 0.0, force.z};
}

struct vec floor_apply(const vox_model *model, struct voxel *voxel, struct vec force, double dt)
{
    const struct substance *s = voxel->substance;
    const double depth = 0.5 * voxel->size - voxel->position.z + model->floor_rise * voxel->position.x;
    if (!(depth > 0.0)) return force;
    const double push = s->floor_stiffness * depth;
    force.z += push - s->floor_drag * velocity_of(voxel).z;
    return rub(voxel, force, push, dt);
}
