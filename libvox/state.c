/* The state of a body at rest, and after its first step. In the first step all sizes are still
 * those at rest, so all controllers of a body have the same state after it, except the sizes. */
#include <string.h>

#include "internal.h"
#include "kernels/lanes.h"

/* The arrays of the state, except sizes. */
struct state {
    double *numbers[N_STATE];
};

static struct state state_of(const struct body *body)
{
    const struct voxels *v = &body->voxels;
    const struct bonds *x = &body->bonds[AXIS_X], *y = &body->bonds[AXIS_Y],
                       *z = &body->bonds[AXIS_Z];
#define BOND(b)                                                                             \
    b->small, b->stretch.x, b->stretch.y, b->stretch.z, b->lower_y, b->lower_z, b->upper.x, \
        b->upper.y, b->upper.z
    return (struct state){{v->position.x, v->position.y, v->position.z, v->orientation.w,
                           v->orientation.x, v->orientation.y, v->orientation.z, v->momentum.x,
                           v->momentum.y, v->momentum.z, v->spin.x, v->spin.y, v->spin.z, BOND(x),
                           BOND(y), BOND(z)}};
#undef BOND
}

/* Return the array of starts for a coordinate of the position, and NULL for other parts of the
 * state. */
static const double *start_of(const struct body *body, const double *numbers)
{
    const struct voxels *v = &body->voxels;
    if (numbers == v->position.x) return v->start.x;
    if (numbers == v->position.y) return v->start.y;
    return numbers == v->position.z ? v->start.z : NULL;
}

/* Return the number that a part of the state consists of at rest. */
static double rest_of(const struct body *body, const double *numbers)
{
    if (numbers == body->voxels.orientation.w) return 1.0;
    for (int axis = 0; axis < 3; axis++)
        if (numbers == body->bonds[axis].small) return 1.0;
    return 0.0;
}

static void copy(double *to, const double *from, int64_t n)
{
    memcpy(to, from, (size_t)n * sizeof *to);
}

static void fill(double *numbers, int64_t n, double value)
{
    for (int64_t i = 0; i < n; i++) numbers[i] = value;
}

static void clear(struct vecs vecs, int64_t n)
{
    fill(vecs.x, n, 0.0);
    fill(vecs.y, n, 0.0);
    fill(vecs.z, n, 0.0);
}

static void rest(const struct body *body, double *numbers)
{
    const double *start = start_of(body, numbers);
    if (start)
        copy(numbers, start, body->n_padded);
    else
        fill(numbers, body->n_padded, rest_of(body, numbers));
}

static bool rests(const struct body *body, const double *numbers)
{
    const double *start = start_of(body, numbers), value = rest_of(body, numbers);
    const int64_t n = body->n_padded;
    if (start) return memcmp(numbers, start, (size_t)n * sizeof *numbers) == 0;
    int64_t moved = 0;
    for (int64_t i = 0; i < n; i++) moved += numbers[i] != value;
    return moved == 0;
}

static void rest_others(struct body *body)
{
    clear(body->voxels.force, body->n_padded);
    clear(body->voxels.torque, body->n_padded);
    fill(body->voxels.size, body->n_padded, body->model->settings.voxel_size);
    body->time = body->top_speed = body->farthest = 0.0;
}

void vox_body_rest(struct body *body)
{
    const struct state state = state_of(body);
    for (int i = 0; i < N_STATE; i++) rest(body, state.numbers[i]);
    rest_others(body);
}

void vox_body_actuate(struct body *body, const double *phase_cycles)
{
    struct voxels *v = &body->voxels;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        if (v->amplitude[slot] == 0.0) continue;
        v->phase[slot] = (double)(float)phase_cycles[body->cells[i]];
        v->phase_sine[slot] = sine(TWO_PI * v->phase[slot]);
        v->phase_cosine[slot] = cosine(TWO_PI * v->phase[slot]);
    }
}

void vox_first_keep(struct body *body, double limit)
{
    const struct state state = state_of(body);
    struct first *first = &body->first;
    first->limit = limit;
    first->top_speed = body->top_speed;
    first->farthest = body->farthest;
    for (int i = 0; i < N_STATE; i++) {
        first->moved[i] = !rests(body, state.numbers[i]);
        if (first->moved[i]) copy(first->numbers[i], state.numbers[i], body->n_padded);
    }
}

void vox_first_make(struct body *body, double limit)
{
    const struct state state = state_of(body);
    const struct first *first = &body->first;
    for (int i = 0; i < N_STATE; i++) {
        if (first->moved[i])
            copy(state.numbers[i], first->numbers[i], body->n_padded);
        else
            rest(body, state.numbers[i]);
    }
    rest_others(body);
    body->model->kernel->sizes_advance(body, limit);
    body->time = body->census.dt;
    body->top_speed = first->top_speed;
    body->farthest = first->farthest;
}
