/* How a voxel moves and how its size follows the actuation (sections 4, 7 and 8). */
#include "internal.h"

static const double TWO_PI = 6.283185005187988; /* single precision */
static const double SMALLEST_SIZE = 0.1, LARGEST_SIZE = 3.0; /* lattice edges */

/* Size at a time; a size beyond the limits leaves the old one as it is. */
static double size_at(double time, const struct voxel *voxel, const vox_model *model)
{
    const double edge = model->settings.voxel_size, amplitude = voxel->substance->strain_amplitude;
    if (amplitude == 0.0) return edge * model->rest_scale;
    const double cycles = time / model->settings.period + voxel->phase;
    const double size = edge * (model->rest_scale + amplitude * sin(TWO_PI * cycles));
    if (size < SMALLEST_SIZE * edge && size < voxel->size) return voxel->size;
    if (size > LARGEST_SIZE * edge && size > voxel->size) return voxel->size;
    return size;
}

static struct quat turned(struct quat q, struct vec spin_rate, double dt)
{
    const struct quat rate = quat_mul((struct quat){0.0, spin_rate.x, spin_rate.y, spin_rate.z}, q);
    const double half = 0.5 * dt;
    const struct quat r = {q.w + half * rate.w, q.x + half * rate.x, q.y + half * rate.y, q.z + half * rate.z};
    const double norm = 1.0 / sqrt(r.w * r.w + r.x * r.x + r.y * r.y + r.z * r.z);
    if (r.w * norm >= 1.0) return (struct quat){1.0, 0.0, 0.0, 0.0};
    return (struct quat){r.w * norm, r.x * norm, r.y * norm, r.z * norm};
}

/* Semi-implicit Euler: the new momentum moves the voxel. Loads other than those of bonds and contacts join the force
 * here. Returns the speed. */
static double move(struct voxel *voxel, double dt)
{
    const struct substance *s = voxel->substance;
    const struct vec slow_drag = vec_scale(-s->slow_drag / s->mass, voxel->momentum);
    const struct vec force = vec_add(slow_drag, voxel->force);

    voxel->momentum = vec_add(voxel->momentum, vec_scale(dt, force));
    const struct vec velocity = vec_scale(1.0 / s->mass, voxel->momentum);
    voxel->position = vec_add(voxel->position, vec_scale(dt, velocity));

    voxel->spin = vec_add(voxel->spin, vec_scale(dt, voxel->torque));
    voxel->spin = vec_scale(1.0 - s->slow_spin_rate * dt, voxel->spin);
    voxel->orientation = turned(voxel->orientation, vec_scale(1.0 / s->inertia, voxel->spin), dt);
    return sqrt(vec_dot(velocity, velocity));
}

bool voxels_advance(struct body *body)
{
    const double dt = body->census.dt, too_far = body->model->too_far;
    bool fine = true;
    body->top_speed = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        struct voxel *voxel = &body->voxels[i];
        if (!voxel->clamped) {
            const double speed = move(voxel, dt);
            if (speed > body->top_speed) body->top_speed = speed;
            const struct vec way = vec_sub(voxel->position, voxel->start);
            fine &= vec_dot(way, way) <= too_far * too_far; /* false for a NaN */
        }
        voxel->size = size_at(body->time, voxel, body->model);
        voxel->force = voxel->torque = (struct vec){0};
    }
    body->time += dt;
    return fine;
}
