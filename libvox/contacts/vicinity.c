/* The lattice around a voxel: places within a few bonds, and near cells. */
#include <stdlib.h>

#include "internal.h"

static int64_t steps_to(const int32_t by[3])
{
    return labs(by[0]) + labs(by[1]) + labs(by[2]);
}

/* ---- the places within a few bonds ----------------------------------------------------------- */

int64_t vox_vicinity_index(const struct vicinity *vicinity, const int32_t by[3])
{
    const int64_t hops = vicinity->hops, width = 2 * hops + 1;
    if (steps_to(by) > hops) return -1;
    return vicinity->index[by[0] + hops + width * (by[1] + hops + width * (by[2] + hops))];
}

/* Find the last bonds of the shortest paths to a place. */
static void find_ways(const struct vicinity *vicinity, struct place *place)
{
    for (int axis = 0; axis < 3; axis++) {
        if (place->by[axis] == 0) continue;
        const bool upwards = place->by[axis] > 0;
        int32_t before[] = {place->by[0], place->by[1], place->by[2]};
        before[axis] += upwards ? -1 : 1;
        place->from[place->n_ways] = (int32_t)vox_vicinity_index(vicinity, before);
        place->side[place->n_ways++] = 2 * axis + upwards;
    }
}

/* Append the places at a distance of `steps` from the center. */
static void append_shell(struct vicinity *vicinity, int64_t steps)
{
    const int32_t hops = (int32_t)vicinity->hops;
    int64_t i = 0;
    for (int32_t z = -hops; z <= hops; z++) {
        for (int32_t y = -hops; y <= hops; y++) {
            for (int32_t x = -hops; x <= hops; x++, i++) {
                struct place place = {.by = {x, y, z}};
                if (steps_to(place.by) != steps) continue;
                find_ways(vicinity, &place);
                vicinity->index[i] = (int32_t)vicinity->n_places;
                vicinity->places[vicinity->n_places++] = place;
            }
        }
    }
}

/* ---- the cells within a radius --------------------------------------------------------------- */

/* Return whether an offset in the lattice leads to a later cell. */
static bool leads_on(int32_t x, int32_t y, int32_t z)
{
    return z > 0 || (z == 0 && (y > 0 || (y == 0 && x > 0)));
}

/* Append the later cells within a radius, in edges, in their order. */
static void append_cells(struct vicinity *vicinity, double radius)
{
    const int32_t most = (int32_t)radius;
    for (int32_t z = 0; z <= most; z++) {
        for (int32_t y = -most; y <= most; y++) {
            for (int32_t x = -most; x <= most; x++) {
                if (!leads_on(x, y, z) || !((double)(x * x + y * y + z * z) < radius * radius))
                    continue;
                struct near_cell *cell = &vicinity->cells[vicinity->n_cells++];
                *cell = (struct near_cell){.by = {x, y, z}};
                cell->place = (int32_t)vox_vicinity_index(vicinity, cell->by);
            }
        }
    }
}

enum vox_status vox_vicinity_create(struct vicinity *vicinity, int64_t hops, double radius)
{
    const size_t width = 2 * (size_t)hops + 1, most = (size_t)radius;
    /* points in an octahedron */
    const size_t n_places = width * (2 * (size_t)hops * (size_t)hops + 2 * (size_t)hops + 3) / 3;
    const size_t n_cells = (most + 1) * (2 * most + 1) * (2 * most + 1);
    vicinity->hops = hops;
    vicinity->reach = (int64_t)most > hops ? (int64_t)most : hops;
    vicinity->index = malloc(width * width * width * sizeof *vicinity->index);
    vicinity->places = malloc(n_places * sizeof *vicinity->places);
    vicinity->cells = malloc(n_cells * sizeof *vicinity->cells);
    if (!vicinity->index || !vicinity->places || !vicinity->cells) return VOX_NO_MEMORY;
    for (int64_t steps = 0; steps <= hops; steps++) append_shell(vicinity, steps);
    append_cells(vicinity, radius);
    return VOX_OK;
}

void vox_vicinity_destroy(struct vicinity *vicinity)
{
    free(vicinity->index);
    free(vicinity->places);
    free(vicinity->cells);
}
