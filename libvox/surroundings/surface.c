/* The surface of a body in a fluid (section 7). In the original engine, it has all faces without a
 * neighbor, and all voxels around a lattice point share a corner there. The other surface has the
 * faces that are connected to the outside, and only voxels with common faces share corners. */
#include <stdlib.h>

#include "internal.h"

/* ---- corners --------------------------------------------------------------------------------- */

/* Return the cells that share a face with one of `cells`. Bits are the eight cells around a lattice
 * point; cell (x, y, z), each 0 or 1, has bit x + 2 y + 4 z. */
static unsigned beside(unsigned cells)
{
    return (cells & 0x55u) << 1 | (cells & 0xAAu) >> 1 | (cells & 0x33u) << 2 |
           (cells & 0xCCu) >> 2 | (cells & 0x0Fu) << 4 | (cells & 0xF0u) >> 4;
}

/* Return the cells of `cells` that are connected to `one` by common faces. */
static unsigned joined_to(unsigned one, unsigned cells)
{
    unsigned joined = one, before;
    do {
        before = joined;
        joined |= beside(joined) & cells;
    } while (joined != before);
    return joined;
}

/* Return the slot of the voxel at (x, y, z) in the box; -1 if it is empty or outside the box. */
static int64_t voxel_at(const struct body *body, int64_t x, int64_t y, int64_t z)
{
    const int64_t *length = body->census.length;
    if (x < 0 || y < 0 || z < 0 || x >= length[0] || y >= length[1] || z >= length[2]) return -1;
    const int64_t slot = body->slot_of[x + body->row[1] * y + body->row[2] * z];
    return body->occupied[slot] ? slot : -1;
}

/* Create a corner for each group of voxels that share it around the lattice point (x, y, z). */
static void meet_at(struct body *body, int64_t x, int64_t y, int64_t z)
{
    struct surface *surface = &body->surface;
    int64_t voxels[8];
    unsigned left = 0;
    for (int i = 0; i < 8; i++) {
        voxels[i] = voxel_at(body, x - 1 + (i & 1), y - 1 + (i >> 1 & 1), z - 1 + (i >> 2));
        if (voxels[i] >= 0) left |= 1u << i;
    }
    while (left) {
        const unsigned group =
            body->model->settings.fluid_by_size ? joined_to(left & (~left + 1u), left) : left;
        int n = 0;
        for (int i = 0; i < 8; i++) {
            if (!(group >> i & 1u)) continue;
            surface->corners_of[voxels[i]][7 - i] = (int32_t)surface->n_corners;
            n++;
        }
        surface->share[surface->n_corners++] = 1.0 / n;
        left &= ~group;
    }
}

static void join_corners(struct body *body)
{
    const int64_t *length = body->census.length;
    for (int64_t z = 0; z <= length[2]; z++)
        for (int64_t y = 0; y <= length[1]; y++)
            for (int64_t x = 0; x <= length[0]; x++) meet_at(body, x, y, z);
}

/* ---- faces ----------------------------------------------------------------------------------- */

static bool at_border(const struct body *body, int64_t slot)
{
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++)
        if (slot_beside(body, slot, axis, false) < 0 || slot_beside(body, slot, axis, true) < 0)
            return true;
    return false;
}

/* Mark the empty slots that are connected to the outside of the box. `queue` has one entry per
 * slot. */
static void flood(const struct body *body, bool *outside, int32_t *queue)
{
    int64_t n = 0;
    const bool everywhere = !body->model->settings.fluid_by_size; /* also in sealed cavities */
    for (int64_t slot = 0; slot < body->n_slots; slot++) {
        outside[slot] = !body->occupied[slot] && (everywhere || at_border(body, slot));
        if (outside[slot]) queue[n++] = (int32_t)slot;
    }
    for (int64_t i = 0; i < n; i++) {
        for (int side = 0; side < 6; side++) {
            const int64_t next = slot_beside(body, queue[i], (enum axis)(side / 2), side % 2);
            if (next < 0 || outside[next] || body->occupied[next]) continue;
            outside[next] = true;
            queue[n++] = (int32_t)next;
        }
    }
}

static struct facet facet_of(const struct body *body, int32_t slot, enum axis axis, bool upwards)
{
    const int32_t *corners = body->surface.corners_of[slot];
    const int along = 1 << axis, first = 1 << (axis + 1) % 3, second = 1 << (axis + 2) % 3;
    const int from = upwards ? along : 0;
    if (upwards)
        return (struct facet){slot,
                              {corners[from], corners[from + first], corners[from + first + second],
                               corners[from + second]}};
    return (struct facet){slot,
                          {corners[from], corners[from + second], corners[from + first + second],
                           corners[from + first]}};
}

static void find_facets(struct body *body, const bool *outside)
{
    struct surface *surface = &body->surface;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int32_t slot = body->slots[i];
        for (int side = 0; side < 6; side++) {
            const enum axis axis = (enum axis)(side / 2);
            const int64_t next = slot_beside(body, slot, axis, side % 2);
            if (next < 0 || outside[next])
                surface->facets[surface->n_facets++] = facet_of(body, slot, axis, side % 2);
        }
    }
}

/* Remove the corners that do not belong to a facet. */
static void drop_inner_corners(struct body *body, bool *outer)
{
    struct surface *surface = &body->surface;
    for (int64_t i = 0; i < surface->n_corners; i++) outer[i] = false;
    for (int64_t i = 0; i < surface->n_facets; i++)
        for (int corner = 0; corner < 4; corner++) outer[surface->facets[i].corners[corner]] = true;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        int32_t *corners = surface->corners_of[body->slots[i]];
        for (int corner = 0; corner < 8; corner++)
            if (!outer[corners[corner]]) corners[corner] = -1;
    }
}

static enum vox_status place_facets(struct body *body)
{
    const size_t n_slots = (size_t)body->n_slots;
    bool *outside = malloc(n_slots * sizeof *outside);
    int32_t *queue = malloc(n_slots * sizeof *queue);
    bool *outer = malloc((size_t)body->surface.n_corners * sizeof *outer);
    const bool enough = outside && queue && outer;
    if (enough) {
        flood(body, outside, queue);
        find_facets(body, outside);
        drop_inner_corners(body, outer);
    }
    free(outside);
    free(queue);
    free(outer);
    return enough ? VOX_OK : VOX_NO_MEMORY;
}

enum vox_status vox_surface_shape(struct body *body)
{
    struct surface *surface = &body->surface;
    const size_t n = (size_t)body->census.n_voxels;
    vox_surface_destroy(surface);
    *surface = (struct surface){0};
    surface->corners_of = malloc((size_t)body->n_slots * sizeof *surface->corners_of);
    surface->share = malloc(8 * n * sizeof *surface->share);
    surface->corners = malloc(8 * n * sizeof *surface->corners);
    surface->facets = malloc(6 * n * sizeof *surface->facets);
    surface->reach = malloc((size_t)body->n_slots * sizeof *surface->reach);
    if (!surface->corners_of || !surface->share || !surface->corners || !surface->facets ||
        !surface->reach)
        return VOX_NO_MEMORY;
    join_corners(body);
    return place_facets(body);
}

size_t vox_surface_memory(const struct body *body)
{
    const struct surface *surface = &body->surface;
    const size_t n = (size_t)body->census.n_voxels, n_slots = (size_t)body->n_slots;
    if (!surface->reach) return 0;
    return n_slots * (sizeof *surface->corners_of + sizeof *surface->reach) +
           8 * n * (sizeof *surface->share + sizeof *surface->corners) +
           6 * n * sizeof *surface->facets;
}

void vox_surface_destroy(struct surface *surface)
{
    free(surface->corners_of);
    free(surface->share);
    free(surface->corners);
    free(surface->facets);
    free(surface->reach);
}
