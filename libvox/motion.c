/* How a voxel moves and how its size follows the actuation (sections 4, 7 and 8). */
#include "internal.h"

static const double TWO_PI = 6.283185005187988; /* single precision */
static const double SETTLING = 0.5; /* share of the time until the start in which a size takes to the rounded edge */

/* Share of the amplitude that is reached at a time after the start. */
static double ramp_at(double time, const struct vox_settings *s)
{
    const double since = time - s->start_time;
    return since < s->ramp ? since / s->ramp : 1.0;
}

/* Size at a time; a size beyond the limits leaves the old one as it is. */
static double size_at(double time, const struct voxel *voxel, const vox_model *model)
{
    const struct vox_settings *s = &model->settings;
    const double edge = s->voxel_size, amplitude = voxel->substance->strain_amplitude;
    if (time < s->start_time) {
        const double settled = fmin(1.0, time / (SETTLING * s->start_time));
        return edge * (1.0 + settled * (model->rest_scale - 1.0));
    }
    if (amplitude == 0.0) return edge * model->rest_scale;
    const double cycles = time / s->period + voxel->phase;
    const double size = edge * (model->rest_scale + ramp_at(time, s) * amplitude * sin(TWO_PI * cycles));
    if (size < SMALLEST_SCALE * edge && size < voxel->size) return voxel->size;
    if (size > LARGEST_SCALE * edge && size > voxel->size) return voxel->size;
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

static void turn(struct voxel *voxel, double dt)
{
    const struct substance *s = voxel->substance;
    if (voxel->fixed & VOX_FIX_ROTATION_X) voxel->torque.x = 0.0;
    if (voxel->fixed & VOX_FIX_ROTATION_Y) voxel->torque.y = 0.0;
    if (voxel->fixed & VOX_FIX_ROTATION_Z) voxel->torque.z = 0.0;
    voxel->spin = vec_add(voxel->spin, vec_scale(dt, voxel->torque));
    voxel->spin = vec_scale(1.0 - s->slow_spin_rate * dt, voxel->spin);
    voxel->orientation = turned(voxel->orientation, vec_scale(1.0 / s->inertia, voxel->spin), dt);
}

static void hold_coordinate(double *position, double *momentum, double start)
{
    *position = start;
    *momentum = 0.0;
}

/* A voxel keeps the coordinates that it is not free to change, and its orientation if it may turn about no axis. */
static void hold(struct voxel *voxel)
{
    const unsigned rotation = VOX_FIX_ROTATION_X | VOX_FIX_ROTATION_Y | VOX_FIX_ROTATION_Z;
    if (voxel->fixed & VOX_FIX_X) hold_coordinate(&voxel->position.x, &voxel->momentum.x, voxel->start.x);
    if (voxel->fixed & VOX_FIX_Y) hold_coordinate(&voxel->position.y, &voxel->momentum.y, voxel->start.y);
    if (voxel->fixed & VOX_FIX_Z) hold_coordinate(&voxel->position.z, &voxel->momentum.z, voxel->start.z);
    if ((voxel->fixed & rotation) != rotation) return;
    voxel->orientation = (struct quat){1.0, 0.0, 0.0, 0.0};
    voxel->spin = (struct vec){0.0, 0.0, 0.0};
}

/* Semi-implicit Euler: the new momentum moves the voxel. The floor comes last, since friction looks at all other
 * forces. Returns the speed. */
static double move(struct voxel *voxel, const vox_model *model, double dt)
{
    const struct substance *s = voxel->substance;
    struct vec force = vec_add(vec_scale(-s->slow_drag / s->mass, voxel->momentum), voxel->force);
    force.z += s->mass * model->settings.gravity;
    if (model->settings.floor) force = floor_apply(model, voxel, force, dt);

    voxel->momentum = vec_add(voxel->momentum, vec_scale(dt, force));
    voxel->position = vec_add(voxel->position, vec_scale(dt, velocity_of(voxel)));
    turn(voxel, dt);
    if (voxel->fixed) hold(voxel);
    const struct vec velocity = velocity_of(voxel);
    return sqrt(vec_dot(velocity, velocity));
}

bool voxels_advance(struct body *body)
{
    const double dt = body->census.dt, too_far = body->model->too_far;
    bool fine = true;
    body->top_speed = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        struct voxel *voxel = &body->voxels[i];
        if (voxel->fixed != VOX_FIX_ALL) {
            const double speed = move(voxel, body->model, dt);
            if (speed > body->top_speed) body->top_speed = speed;
            const struct vec way = vec_sub(voxel->position, voxel->start);
            fine &= vec_dot(way, way) <= too_far * too_far; /* false for a NaN */
            fine &= isfinite(vec_dot(voxel->spin, voxel->spin) / voxel->substance->inertia);
        }
        voxel->size = size_at(body->time, voxel, body->model);
        voxel->force = voxel->torque = (struct vec){0};
    }
    body->time += dt;
    return fine;
}
