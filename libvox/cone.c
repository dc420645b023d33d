/* The cone of influence: the voxels and bonds whose motion can reach a sample in time. In one step,
 * an effect spreads along bonds and contacts by one voxel (docs/solver.md). */
#include <stdlib.h>

#include "internal.h"

/* Steps across a pair of voxels that is near, but not listed: one more for each of these gaps
 * between them, in edges, which no voxel crosses in a step; at most LONGEST_PAIR. */
static const double GAP = 0.15;

enum vox_status vox_cone_prepare(vox_model *model)
{
    const struct vox_settings *s = &model->settings;
    const double touching = s->collision_envelope * model->largest_size / s->voxel_size;
    const int64_t radius = model->vicinity.reach + 1;
    model->largest2 = radius * radius;
    model->steps_across = malloc((size_t)model->largest2 + 1);
    if (!model->steps_across) return VOX_NO_MEMORY;
    for (int64_t distance2 = 0; distance2 <= model->largest2; distance2++) {
        const double gap = sqrt((double)distance2) - touching, steps = 1.0 + fmax(0.0, gap / GAP);
        model->steps_across[distance2] = (uint8_t)fmin(steps, LONGEST_PAIR);
    }
    return VOX_OK;
}

/* ---- depths ---------------------------------------------------------------------------------- */

/* Voxels whose depth has become lower, in a ring with one place for each slot. */
struct ring {
    int32_t *slots;
    uint8_t *queued; /* [slots] */
    int64_t size, begin, n;
};

static void lower_to(const struct body *body, struct ring *ring, int64_t slot, int32_t depth)
{
    if (body->depth[slot] <= depth) return;
    body->depth[slot] = depth;
    if (ring->queued[slot]) return;
    ring->queued[slot] = 1;
    ring->slots[(ring->begin + ring->n++) % ring->size] = (int32_t)slot;
}

/* Return the steps from a slot to its neighbor on a side: one along a bond, unless the voxel cannot
 * move, or those through space. */
static int32_t steps_along(const struct body *body, int64_t slot, int side)
{
    const bool leads = body->bonded[slot] >> side & 1 && body->voxels.fixed[slot] != VOX_FIX_ALL;
    return leads ? 1 : SPACE;
}

/* Spread depths along bonds and, if voxels collide, through space. */
static void spread(const struct body *body, struct ring *ring)
{
    const int32_t longest = body->model->settings.self_collision ? SPACE : 1;
    while (ring->n > 0) {
        const int64_t slot = ring->slots[ring->begin];
        ring->begin = (ring->begin + 1) % ring->size;
        ring->n--;
        ring->queued[slot] = 0;
        for (int side = 0; side < 6; side++) {
            const int32_t steps = steps_along(body, slot, side);
            if (steps > longest) continue;
            const int64_t next = slot_beside(body, slot, (enum axis)(side / 2), side % 2);
            if (next >= 0) lower_to(body, ring, next, body->depth[slot] + steps);
        }
    }
}

/* Spread depths across pairs; return whether one became lower. */
static bool spread_across(const struct body *body, struct ring *ring, struct pair pair,
                          int32_t steps)
{
    const uint8_t *fixed = body->voxels.fixed;
    const int32_t first = body->depth[pair.first], second = body->depth[pair.second];
    if (first < second - steps && fixed[pair.first] != VOX_FIX_ALL)
        lower_to(body, ring, pair.second, first + steps);
    else if (second < first - steps && fixed[pair.second] != VOX_FIX_ALL)
        lower_to(body, ring, pair.first, second + steps);
    return ring->n > 0;
}

static bool spread_across_pairs(const struct body *body, struct ring *ring)
{
    const struct contacts *contacts = &body->contacts;
    bool changed = false;
    for (int64_t i = 0; i < contacts->first.n; i++)
        changed |= spread_across(body, ring, contacts->first.list[i], 1);
    for (int64_t i = 0; i < contacts->near_by.pairs.n; i++) {
        const struct pair pair = contacts->near_by.pairs.list[i];
        const uint8_t steps = body->model->steps_across[contacts->near_by.distance2[i]];
        changed |= spread_across(body, ring, pair, steps);
    }
    return changed;
}

/* ---- sources --------------------------------------------------------------------------------- */

static bool is_source(const struct body *body, int64_t slot, enum sources sources)
{
    const vox_model *model = body->model;
    const int64_t falling = model->settings.falling_code;
    if (sources & SOURCE_ALL) return true;
    if (falling != 0 && model->of_code[falling] == body->voxels.substance[slot]) return true;
    if ((sources & SOURCE_TIP) && slot == body->slots[body->census.n_voxels - 1]) return true;
    return (sources & SOURCE_FACE) && body->coordinates[slot][0] == body->census.length[0] - 1;
}

static void find_depths(struct body *body, enum sources sources)
{
    struct ring ring = {.slots = body->ring, .queued = body->queued, .size = body->n_slots};
    for (int64_t slot = 0; slot < body->n_slots; slot++) body->depth[slot] = UNREACHED;
    for (int64_t i = 0; i < body->census.n_voxels; i++)
        if (is_source(body, body->slots[i], sources)) lower_to(body, &ring, body->slots[i], 0);
    spread(body, &ring);
    if (!body->model->settings.self_collision) return;
    while (spread_across_pairs(body, &ring)) spread(body, &ring);
}

/* ---- depths for the kernels ------------------------------------------------------------------ */

static void lower(double *number, double other)
{
    if (other < *number) *number = other;
}

static int64_t groups_of(const struct body *body)
{
    return body->n_tiles * (TILE / GROUP);
}

static void place_depths_of_voxels(struct body *body)
{
    for (int64_t group = 0; group < groups_of(body); group++) body->group_depth[group] = ABSENT;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        if (body->voxels.fixed[slot] == 0) body->voxels.depth[slot] = body->depth[slot];
        lower(&body->group_depth[slot / GROUP], body->depth[slot]);
    }
}

/* A bond acts on both ends; one that cannot move needs no forces. */
static void place_depths_of_bonds(struct body *body, struct bonds *bonds)
{
    const uint8_t *fixed = body->voxels.fixed;
    for (int64_t group = 0; group < groups_of(body); group++) bonds->group_depth[group] = ABSENT;
    for (int64_t i = 0; i < bonds->n; i++) {
        const int64_t slot = bonds->lower[i], ends[] = {slot, slot + bonds->step};
        bonds->depth[slot] = UNREACHED;
        for (int end = 0; end < 2; end++)
            if (fixed[ends[end]] != VOX_FIX_ALL) lower(&bonds->depth[slot], body->depth[ends[end]]);
        lower(&bonds->group_depth[slot / GROUP], bonds->depth[slot]);
    }
}

void vox_cone_shape(struct body *body, enum sources sources)
{
    find_depths(body, sources);
    place_depths_of_voxels(body);
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++)
        place_depths_of_bonds(body, &body->bonds[axis]);
    body->sources = sources;
    body->first.limit = -1.0;
}

double vox_cone_share(const struct body *body, int64_t steps)
{
    double left = 0.0, all = 0.0;
    for (int64_t group = 0; group < groups_of(body); group++) {
        if (body->group_depth[group] == ABSENT) continue;
        left += fmax(0.0, (double)steps - body->group_depth[group]);
        all += (double)steps;
    }
    return all > 0.0 ? left / all : 0.0;
}
