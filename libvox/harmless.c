/* A bound on the effect of a step that does not require its forces (docs/solver.md). */
#include "internal.h"

/* For rounding errors, and for frames that are not exactly unit quaternions. */
static const double MARGIN = 1.01;
static const double FARTHEST_TURN = 6.3; /* rad, at an end of a bond, if no voxel is turned far */
static const double LEAST_COSINE =
    0.75; /* of half the rotation angle of a voxel that is not turned far */
static const double SHORTEST = 1e-150; /* s; the square of a time step must not underflow */
static const double WILDEST = 1e200;   /* J, of a spin: far from overflow */

/* Return whether slow damping does not increase any spin. */
static bool spins_do_not_grow(const struct body *body)
{
    const vox_model *model = body->model;
    for (int32_t i = 0; i < model->n_substances; i++)
        if (!(model->substances[i].slow_spin_rate * body->census.dt <= 2.0)) return false;
    return true;
}

/* Return whether no bond can be turned by almost 2 pi, where rotation vectors are unbounded. */
static bool no_voxel_is_wild(const struct body *body)
{
    const struct voxels *v = &body->voxels;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        const struct vec spin = vec_at(v->spin, slot);
        if (!(v->orientation.w[slot] >= LEAST_COSINE)) return false;
        if (!(vec_dot(spin, spin) * v->turnability[slot] <= WILDEST)) return false;
    }
    return true;
}

/* Return the largest number of candidates of a voxel, counted in the scratch array `touching`. */
static int64_t most_contacts(struct body *body)
{
    const struct pairs *pairs = &body->contacts.now;
    int64_t most = 0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) body->voxels.touching[body->slots[i]] = 0;
    for (int64_t i = 0; i < pairs->n; i++) {
        const int32_t first = ++body->voxels.touching[pairs->list[i].first];
        const int32_t second = ++body->voxels.touching[pairs->list[i].second];
        if (first > most) most = first;
        if (second > most) most = second;
    }
    return most;
}

bool vox_next_step_is_harmless(struct body *body)
{
    const vox_model *model = body->model;
    const struct vox_settings *s = &model->settings;
    if (s->floor || s->fluid_drag > 0.0 || s->contact_damping > 0.0 || s->contact_friction)
        return false;
    const double edge = s->voxel_size, dt = body->census.dt;
    if (!(dt >= SHORTEST) || !spins_do_not_grow(body) || !no_voxel_is_wild(body)) return false;
    /* bound on the stretch of a bond, now and in the previous step, in edges */
    const double stretch = 1.0 + (2.0 * body->farthest + model->largest_size) / edge;
    /* displacements in one step, in edges, due to a bond that is stretched by one edge */
    const double spring = model->fastest * dt * dt, damper = s->bond_damping * sqrt(spring);
    const double bonds =
        6.0 * (spring * (stretch + FARTHEST_TURN) + damper * 2.0 * (stretch + FARTHEST_TURN));
    const double touch =
        s->self_collision ? spring * s->collision_envelope * model->largest_size / edge : 0.0;
    const double push = bonds + (double)(s->self_collision ? most_contacts(body) : 0) * touch;
    double slow = 0.0;
    for (int32_t i = 0; i < model->n_substances; i++)
        slow = fmax(slow, model->substances[i].slow_drag / model->substances[i].mass * dt);
    const double way =
        (1.0 + slow) * body->top_speed * dt / edge + push + fabs(s->gravity) * dt * dt / edge;
    return MARGIN * stretch <= s->largest_strain &&
           MARGIN * (body->farthest + way * edge) <= model->too_far;
}
