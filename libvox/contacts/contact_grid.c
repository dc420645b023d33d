/* Grid of cubes over the skin at its current position. Cubes are at least as wide as the reach, so
 * that all voxels in reach are in the same cube or in an adjacent one. */
#include <stdlib.h>

#include "internal.h"

static const double ROUNDING = 1e-12;
static const int64_t CUBES_PER_VOXEL = 4; /* maximum; a widespread body has larger cubes */

enum vox_status vox_grid_shape(struct grid *grid, int64_t n_skin)
{
    vox_grid_destroy(grid);
    grid->n_skin = n_skin;
    grid->most_cubes = CUBES_PER_VOXEL * n_skin + 1;
    grid->begin = malloc((size_t)(grid->most_cubes + 1) * sizeof *grid->begin);
    grid->voxels = malloc((size_t)(n_skin + 1) * sizeof *grid->voxels);
    grid->packed = malloc((size_t)(n_skin + 1) * sizeof *grid->packed);
    grid->cube_of = malloc((size_t)(n_skin + 1) * sizeof *grid->cube_of);
    grid->found = malloc((size_t)(n_skin + 1) * sizeof *grid->found);
    return grid->begin && grid->voxels && grid->packed && grid->cube_of && grid->found
               ? VOX_OK
               : VOX_NO_MEMORY;
}

void vox_grid_destroy(struct grid *grid)
{
    free(grid->begin);
    free(grid->voxels);
    free(grid->packed);
    free(grid->cube_of);
    free(grid->found);
    *grid = (struct grid){0};
}

struct span {
    double least[3], most[3];
};

static void coordinates(const struct body *body, int64_t slot, double at[3])
{
    const struct vec position = vec_at(body->voxels.position, slot);
    at[0] = position.x;
    at[1] = position.y;
    at[2] = position.z;
}

static struct span span_of(const struct body *body)
{
    struct span span = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    for (int64_t i = 0; i < body->contacts.n_skin; i++) {
        double at[3];
        coordinates(body, body->contacts.skin[i], at);
        for (int axis = 0; axis < 3; axis++) {
            span.least[axis] = fmin(span.least[axis], at[axis]);
            span.most[axis] = fmax(span.most[axis], at[axis]);
        }
    }
    return span;
}

/* Enlarge the cubes until their number is small enough. */
static void choose_cubes(struct grid *grid, const struct span *span, double reach)
{
    double cubes;
    grid->edge = reach * (1.0 + ROUNDING);
    do {
        cubes = 1.0;
        for (int axis = 0; axis < 3; axis++) {
            grid->corner[axis] = span->least[axis];
            cubes *= floor((span->most[axis] - span->least[axis]) / grid->edge) + 1.0;
        }
        grid->edge *= cubes > (double)grid->most_cubes ? 1.5 : 1.0;
    } while (cubes > (double)grid->most_cubes);
    for (int axis = 0; axis < 3; axis++)
        grid->length[axis] = (int64_t)((span->most[axis] - span->least[axis]) / grid->edge) + 1;
}

/* Index of a coordinate along an axis of the grid; limited because rounding may exceed the end. */
static int64_t place_in(const struct grid *grid, int axis, double at)
{
    const int64_t place = (int64_t)((at - grid->corner[axis]) / grid->edge);
    return place < grid->length[axis] ? place : grid->length[axis] - 1;
}

static int64_t cube_at(const struct grid *grid, const int64_t place[3])
{
    return place[0] + grid->length[0] * (place[1] + grid->length[1] * place[2]);
}

void vox_grid_fill(struct grid *grid, const struct body *body, double reach)
{
    const struct span span = span_of(body);
    grid->reach = reach;
    choose_cubes(grid, &span, reach);
    const int64_t n_cubes = grid->length[0] * grid->length[1] * grid->length[2];
    for (int64_t cube = 0; cube <= n_cubes; cube++) grid->begin[cube] = 0;
    for (int64_t i = 0; i < grid->n_skin; i++) {
        double at[3];
        int64_t place[3];
        coordinates(body, body->contacts.skin[i], at);
        for (int axis = 0; axis < 3; axis++) place[axis] = place_in(grid, axis, at[axis]);
        grid->cube_of[i] = (int32_t)cube_at(grid, place);
        grid->begin[grid->cube_of[i]]++;
    }
    for (int64_t cube = 1; cube <= n_cubes; cube++) grid->begin[cube] += grid->begin[cube - 1];
    for (int64_t i = grid->n_skin - 1; i >= 0; i--) {
        const int32_t at = --grid->begin[grid->cube_of[i]];
        grid->voxels[at] = (int32_t)i;
        grid->packed[at] = vec_at(body->voxels.position, body->contacts.skin[i]);
    }
}

/* Add the voxels after `first` in a row of cubes that are within its reach. */
static int64_t find_in_cubes(const struct grid *grid, int64_t cube, int64_t last, int32_t first,
                             struct vec position, int64_t n)
{
    const double reach2 = grid->reach * grid->reach;
    for (int32_t k = grid->begin[cube]; k < grid->begin[last + 1]; k++) {
        const int32_t other = grid->voxels[k];
        const struct vec apart = vec_sub(grid->packed[k], position);
        grid->found[n] = other; /* overwritten by the next one unless it counts; avoids a jump */
        n += (other > first) & (vec_dot(apart, apart) < reach2);
    }
    return n;
}

/* Insertion sort, for few numbers. */
static void sort(int32_t *numbers, int64_t n)
{
    for (int64_t i = 1; i < n; i++) {
        const int32_t number = numbers[i];
        int64_t at = i;
        for (; at > 0 && numbers[at - 1] > number; at--) numbers[at] = numbers[at - 1];
        numbers[at] = number;
    }
}

int64_t vox_grid_find(const struct grid *grid, const struct body *body, int32_t first)
{
    double at[3];
    int64_t from[3], to[3], n = 0;
    const int32_t slot = body->contacts.skin[first];
    const struct vec position = vec_at(body->voxels.position, slot);
    coordinates(body, slot, at);
    for (int axis = 0; axis < 3; axis++) {
        const int64_t place = place_in(grid, axis, at[axis]);
        from[axis] = place > 0 ? place - 1 : 0;
        to[axis] = place < grid->length[axis] - 1 ? place + 1 : place;
    }
    for (int64_t z = from[2]; z <= to[2]; z++)
        for (int64_t y = from[1]; y <= to[1]; y++)
            n = find_in_cubes(grid, cube_at(grid, (int64_t[]){from[0], y, z}),
                              cube_at(grid, (int64_t[]){to[0], y, z}), first, position, n);
    sort(grid->found, n);
    return n;
}
