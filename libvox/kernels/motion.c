/* Motion of voxels, and actuation of their sizes (sections 4, 7 and 8). */
#include "internal.h"

/* Fraction of the time until the start in which a size changes to the rounded edge. */
static const double SETTLING = 0.5;

struct actuation vox_actuation_at(const vox_model *model, double time)
{
    const struct vox_settings *s = &model->settings;
    struct actuation a = {.edge = s->voxel_size,
                          .rest = model->rest_scale,
                          .cycles = time / s->period,
                          .smallest = s->smallest_size * s->voxel_size,
                          .largest = s->largest_size * s->voxel_size,
                          .clamp = s->size_clamp};
    if (time < s->start_time) {
        a.rest = 1.0 + fmin(1.0, time / (SETTLING * s->start_time)) * (model->rest_scale - 1.0);
        return a;
    }
    const double since = time - s->start_time;
    a.gain = since < s->ramp ? since / s->ramp : 1.0;
    return a;
}

static double size_of(const struct actuation *a, double amplitude, double phase, double last)
{
    const bool acts = a->gain != 0.0 && amplitude != 0.0;
    const double strain = acts ? a->gain * amplitude * sin(TWO_PI * (a->cycles + phase)) : 0.0;
    return limited(a->edge * (a->rest + strain), last, a->smallest, a->largest, a->clamp);
}

static struct quat turned(struct quat q, struct vec spin_rate, double dt)
{
    const struct quat rate = quat_mul((struct quat){0.0, spin_rate.x, spin_rate.y, spin_rate.z}, q);
    const double half = 0.5 * dt;
    const struct quat r = {q.w + half * rate.w, q.x + half * rate.x, q.y + half * rate.y,
                           q.z + half * rate.z};
    const double norm = 1.0 / sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
    if (r.w * norm >= 1.0) return (struct quat){1.0, 0.0, 0.0, 0.0};
    return (struct quat){r.w * norm, r.x * norm, r.y * norm, r.z * norm};
}

static void turn(const struct voxels *v, int64_t slot, double dt)
{
    struct vec torque = vec_at(v->torque, slot);
    if (v->fixed[slot] & VOX_FIX_ROTATION_X) torque.x = 0.0;
    if (v->fixed[slot] & VOX_FIX_ROTATION_Y) torque.y = 0.0;
    if (v->fixed[slot] & VOX_FIX_ROTATION_Z) torque.z = 0.0;
    const struct vec driven = vec_add(vec_at(v->spin, slot), vec_scale(dt, torque));
    const struct vec spin = vec_scale(v->spin_kept[slot], driven);
    const struct vec rate = vec_scale(v->turnability[slot], spin);
    vec_put(v->spin, slot, spin);
    quat_put(v->orientation, slot, turned(quat_at(v->orientation, slot), rate, dt));
}

static void hold_coordinate(double *position, double *momentum, double start)
{
    *position = start;
    *momentum = 0.0;
}

/* Restore the clamped coordinates of a voxel, and its orientation if all rotations are clamped. */
static void hold(const struct voxels *v, int64_t i)
{
    const unsigned rotation = VOX_FIX_ROTATION_X | VOX_FIX_ROTATION_Y | VOX_FIX_ROTATION_Z,
                   fixed = v->fixed[i];
    if (fixed & VOX_FIX_X) hold_coordinate(&v->position.x[i], &v->momentum.x[i], v->start.x[i]);
    if (fixed & VOX_FIX_Y) hold_coordinate(&v->position.y[i], &v->momentum.y[i], v->start.y[i]);
    if (fixed & VOX_FIX_Z) hold_coordinate(&v->position.z[i], &v->momentum.z[i], v->start.z[i]);
    if ((fixed & rotation) != rotation) return;
    quat_put(v->orientation, i, (struct quat){1.0, 0.0, 0.0, 0.0});
    vec_put(v->spin, i, (struct vec){0.0, 0.0, 0.0});
}

/* Add slow damping and weight to the force on a voxel. */
static void load(struct body *body, int64_t slot)
{
    const struct voxels *v = &body->voxels;
    const struct vec force = vec_at(v->force, slot), momentum = vec_at(v->momentum, slot);
    vec_put(v->force, slot, loaded(force, v->drag_rate[slot], momentum, v->weight[slot]));
}

static double larger(double a, double b)
{
    return b > a ? b : a;
}

/* Semi-implicit Euler step: the new momentum determines the position. */
static bool voxel_move(struct body *body, int64_t slot)
{
    const struct voxels *v = &body->voxels;
    const double dt = body->census.dt, too_far = body->model->too_far;
    vec_put(v->momentum, slot,
            vec_add(vec_at(v->momentum, slot), vec_scale(dt, vec_at(v->force, slot))));
    vec_put(v->position, slot,
            vec_add(vec_at(v->position, slot), vec_scale(dt, velocity_of(v, slot))));
    turn(v, slot, dt);
    if (v->fixed[slot]) hold(v, slot);
    const struct vec way = vec_sub(vec_at(v->position, slot), vec_at(v->start, slot));
    const struct vec spin = vec_at(v->spin, slot), velocity = velocity_of(v, slot);
    body->top_speed = larger(body->top_speed, sqrt(vec_dot(velocity, velocity)));
    body->farthest = larger(body->farthest, sqrt(vec_dot(way, way)));
    return vec_dot(way, way) <= too_far * too_far &&
           isfinite(vec_dot(spin, spin) * v->turnability[slot]);
}

/* The floor is last, because friction depends on all other forces. */
bool vox_voxel_advance(struct body *body, int64_t slot)
{
    load(body, slot);
    if (body->model->settings.floor) vox_floor_apply(body, slot);
    return voxel_move(body, slot);
}

bool vox_scalar_voxels_advance(struct body *body, double limit)
{
    const struct voxels *v = &body->voxels;
    bool fine = true;
    body->top_speed = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        if (body->depth[slot] > limit) continue;
        if (v->fixed[slot] != VOX_FIX_ALL) fine &= vox_voxel_advance(body, slot);
        vec_put(v->force, slot, (struct vec){0.0, 0.0, 0.0});
        vec_put(v->torque, slot, (struct vec){0.0, 0.0, 0.0});
    }
    return fine;
}

/* This kernel computes the sine of each sum of time and phase. */
void vox_scalar_phases_set(struct body *body)
{
    (void)body;
}

void vox_scalar_sizes_advance(struct body *body, double limit)
{
    const struct voxels *v = &body->voxels;
    const struct actuation actuation = vox_actuation_at(body->model, body->time);
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        if (body->depth[slot] > limit) continue;
        v->size[slot] = size_of(&actuation, v->amplitude[slot], v->phase[slot], v->size[slot]);
    }
}
