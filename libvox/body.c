/* Conversion of cells with materials to voxels and bonds (sections 2, 3 and 8). */
#include <stdlib.h>
#include <string.h>

#include "internal.h"

static const double TWO_PI_OF_TIME_STEP = 2.0 * 3.1415926; /* the engine's value */
static const double MOST_STEPS = 9007199254740992.0;       /* 2^53; times substeps fits 64 bits */
static const size_t LINE = 64; /* bytes, largest cache line of a processor */

/* ---- the cells ------------------------------------------------------------------------------- */

/* Current cell of a loop over the canvas, x fastest. */
struct cursor {
    int64_t cell, at[3];
};

static bool step_on(struct cursor *cursor, const struct vox_settings *s)
{
    cursor->cell++;
    if (++cursor->at[0] < s->nx) return true;
    cursor->at[0] = 0;
    if (++cursor->at[1] < s->ny) return true;
    cursor->at[1] = 0;
    return ++cursor->at[2] < s->nz;
}

/* Return whether a voxel has a bond along +axis: neighbors that are both clamped in all degrees of
 * freedom have none. */
static bool has_bond(const vox_model *model, const uint8_t *material, const struct cursor *cursor,
                     enum axis axis)
{
    const struct vox_settings *s = &model->settings;
    const int64_t stride[] = {1, s->nx, s->nx * s->ny}, length[] = {s->nx, s->ny, s->nz};
    if (cursor->at[axis] == length[axis] - 1) return false;
    const int64_t next = cursor->cell + stride[axis];
    if (!material[next]) return false;
    return !(model->fixed[cursor->cell] == VOX_FIX_ALL && model->fixed[next] == VOX_FIX_ALL);
}

/* Section 3. A body without bonds has a different time step, like in the engine: the square root of
 * the edge is missing. */
static enum vox_status set_clock(struct census *census, const vox_model *model, double fastest_bond,
                                 double fastest_voxel)
{
    const struct vox_settings *s = &model->settings;
    const double fastest = census->n_bonds > 0 ? fastest_bond : fastest_voxel;
    const double dt = s->time_step_fraction / (TWO_PI_OF_TIME_STEP * sqrt(fastest));
    const double periods = s->duration / dt;
    if (!(dt > 0.0 && isfinite(dt) && periods < MOST_STEPS)) return VOX_BAD_TIME_STEP;
    census->dt = dt / (double)s->substeps;
    census->steps = ((int64_t)periods + 1) * s->substeps;
    if (census->steps > s->step_limit) return VOX_TOO_MANY_STEPS;
    return census->dt > 0.0 ? VOX_OK : VOX_BAD_TIME_STEP;
}

/* Extend the box of a census by a cell; until the census is complete, `length` is the last cell. */
static void widen(struct census *census, const struct cursor *cursor)
{
    for (int axis = 0; axis < 3; axis++) {
        const int64_t at = cursor->at[axis];
        if (census->n_voxels == 1 || at < census->from[axis]) census->from[axis] = at;
        if (census->n_voxels == 1 || at > census->length[axis]) census->length[axis] = at;
    }
}

static double larger(double a, double b)
{
    return b > a ? b : a;
}

enum vox_status vox_body_census(const vox_model *model, const uint8_t *material,
                                struct census *census)
{
    double fastest_bond = 0.0, fastest_voxel = 0.0;
    *census = (struct census){0};
    for (int64_t cell = 0; cell < model->cells; cell++)
        if (material[cell] && model->of_code[material[cell]] < 0) return VOX_UNKNOWN_MATERIAL;
    const int64_t stride[] = {1, model->settings.nx, model->settings.nx * model->settings.ny};
    struct cursor cursor = {0};
    do {
        if (!material[cursor.cell]) continue;
        const int32_t own = model->of_code[material[cursor.cell]];
        census->n_voxels++;
        widen(census, &cursor);
        const struct substance *substance = &model->substances[own];
        fastest_voxel = larger(fastest_voxel, substance->youngs_modulus / substance->mass);
        for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++) {
            if (!has_bond(model, material, &cursor, axis)) continue;
            const int32_t other = model->of_code[material[cursor.cell + stride[axis]]];
            census->n_bonds++;
            fastest_bond =
                larger(fastest_bond, model->couplings[own * model->n_substances + other].fastest);
        }
    } while (step_on(&cursor, &model->settings));
    if (census->n_voxels == 0) return VOX_EMPTY_BODY;
    for (int axis = 0; axis < 3; axis++) census->length[axis] += 1 - census->from[axis];
    return set_clock(census, model, fastest_bond, fastest_voxel);
}

/* ---- slots ----------------------------------------------------------------------------------- */

static int64_t slot_of(const struct body *body, const struct cursor *cursor)
{
    int64_t slot = 0;
    for (int axis = 0; axis < 3; axis++)
        slot += body->step[axis] * (cursor->at[axis] - body->census.from[axis]);
    return slot;
}

/* ---- memory ---------------------------------------------------------------------------------- */

/* Allocator in a block of memory; without a block, it only counts the required size. */
struct arena {
    char *base;
    size_t used;
};

/* Allocate an odd number of cache lines, so that arrays of the same length do not map to the same
 * set of the cache. */
static void *take(struct arena *arena, int64_t n, size_t size)
{
    const size_t lines = ((size_t)n * size + LINE - 1) / LINE | 1;
    void *part = arena->base ? arena->base + arena->used : NULL;
    arena->used += lines * LINE;
    return part;
}

static double *take_numbers(struct arena *arena, int64_t n)
{
    return take(arena, n, sizeof(double));
}

/* Allocate `n` numbers, with `before` more in front of them. */
static double *take_numbers_after(struct arena *arena, int64_t before, int64_t n)
{
    double *all = take_numbers(arena, before + n);
    return all ? all + before : NULL;
}

static struct vecs take_vecs_after(struct arena *arena, int64_t before, int64_t n)
{
    double *x = take_numbers_after(arena, before, n), *y = take_numbers_after(arena, before, n),
           *z = take_numbers_after(arena, before, n);
    return (struct vecs){x, y, z};
}

static struct vecs take_vecs(struct arena *arena, int64_t n)
{
    double *x = take_numbers(arena, n), *y = take_numbers(arena, n), *z = take_numbers(arena, n);
    return (struct vecs){x, y, z};
}

/* Lay out the arrays that are 0 at first. */
static void lay_out_cleared(struct body *body, struct arena *arena)
{
    const int64_t n = body->n_padded, n_groups = body->n_tiles * (TILE / GROUP);
    struct voxels *v = &body->voxels;
    v->force = take_vecs(arena, n);
    v->torque = take_vecs(arena, n);
    double **const constants[] = {&v->phase,     &v->phase_sine,  &v->phase_cosine,
                                  &v->amplitude, &v->mobility,    &v->drag_rate,
                                  &v->weight,    &v->turnability, &v->spin_kept};
    for (size_t i = 0; i < sizeof constants / sizeof *constants; i++)
        *constants[i] = take_numbers(arena, n);
    v->substance = take(arena, n, sizeof *v->substance);
    v->fixed = take(arena, n, sizeof *v->fixed);
    v->touching = take(arena, n, sizeof *v->touching);
    for (int axis = 0; axis < 3; axis++) {
        struct bonds *bonds = &body->bonds[axis];
        bonds->pull = take_vecs_after(arena, bonds->step, n);
        bonds->wrench = take_vecs_after(arena, bonds->step, n);
#define LAY_OUT(field) bonds->coupling.field = body->coupling ? NULL : take_numbers(arena, n);
        BOND_LAW(LAY_OUT)
#undef LAY_OUT
        bonds->group_depth = take_numbers(arena, n_groups);
    }
    body->group_depth = take_numbers(arena, n_groups);
    body->depth = take(arena, n, sizeof *body->depth);
    body->queued = take(arena, body->n_slots, sizeof *body->queued);
    body->occupied = take(arena, n, sizeof *body->occupied);
    body->bonded = take(arena, n, sizeof *body->bonded);
}

static void lay_out_others(struct body *body, struct arena *arena)
{
    const int64_t n = body->n_padded;
    struct voxels *v = &body->voxels;
    v->position = take_vecs(arena, n);
    double *w = take_numbers(arena, n);
    const struct vecs q = take_vecs(arena, n);
    v->orientation = (struct quats){w, q.x, q.y, q.z};
    v->momentum = take_vecs(arena, n);
    v->spin = take_vecs(arena, n);
    v->size = take_numbers(arena, n);
    v->start = take_vecs(arena, n);
    v->depth = take_numbers(arena, n);
    for (int axis = 0; axis < 3; axis++) {
        struct bonds *bonds = &body->bonds[axis];
        bonds->small = take_numbers(arena, n);
        bonds->stretch = take_vecs(arena, n);
        bonds->lower_y = take_numbers(arena, n);
        bonds->lower_z = take_numbers(arena, n);
        bonds->upper = take_vecs(arena, n);
        bonds->depth = take_numbers(arena, n);
        bonds->lower = take(arena, n, sizeof *bonds->lower);
    }
    for (int i = 0; i < N_STATE; i++) body->first.numbers[i] = take_numbers(arena, n);
    body->slots = take(arena, body->census.n_voxels, sizeof *body->slots);
    body->cells = take(arena, body->census.n_voxels, sizeof *body->cells);
    body->partly = take(arena, body->census.n_voxels, sizeof *body->partly);
    body->coordinates = take(arena, n, sizeof *body->coordinates);
    body->slot_of = take(arena, body->n_slots, sizeof *body->slot_of);
    body->ring = take(arena, body->n_slots, sizeof *body->ring);
}

static enum vox_status allocate(struct body *body)
{
    struct arena arena = {0};
    lay_out_cleared(body, &arena);
    const size_t cleared = arena.used;
    lay_out_others(body, &arena);
    if (arena.used > body->memory_size) {
        free(body->memory);
        body->memory_size = 0;
        body->memory = malloc(arena.used + LINE);
        if (!body->memory) return VOX_NO_MEMORY;
        body->memory_size = arena.used;
    }
    arena.base = (char *)body->memory + (LINE - (uintptr_t)body->memory % LINE);
    memset(arena.base, 0, cleared);
    arena.used = 0;
    lay_out_cleared(body, &arena);
    lay_out_others(body, &arena);
    return VOX_OK;
}

/* ---- the body -------------------------------------------------------------------------------- */

static void place_voxel(struct body *body, const struct cursor *cursor, int32_t substance_index)
{
    const vox_model *model = body->model;
    const struct substance *substance = &model->substances[substance_index];
    const int64_t slot = slot_of(body, cursor);
    const uint8_t fixed = model->fixed[cursor->cell];
    struct voxels *v = &body->voxels;
    v->substance[slot] = (uint8_t)substance_index;
    v->fixed[slot] = fixed;
    v->amplitude[slot] = substance->strain_amplitude;
    v->mobility[slot] = 1.0 / substance->mass;
    v->drag_rate[slot] = substance->slow_drag / substance->mass;
    v->weight[slot] = substance->mass * model->settings.gravity;
    v->turnability[slot] = 1.0 / substance->inertia;
    v->spin_kept[slot] = 1.0 - substance->slow_spin_rate * body->census.dt;
    body->occupied[slot] = 1;
    if (fixed != 0 && fixed != VOX_FIX_ALL) body->partly[body->n_partly++] = (int32_t)slot;
}

/* Set the cells of slots in the box and their positions in the lattice, including the padding after
 * the box. */
static void place_starts(struct body *body)
{
    const double edge = body->model->settings.voxel_size;
    const enum axis *order = body->model->order;
    const int64_t *from = body->census.from, *length = body->census.length;
    int64_t at[3] = {0, 0, 0};
    for (int64_t slot = 0; slot < body->n_padded; slot++) {
        for (int axis = 0; axis < 3; axis++) body->coordinates[slot][axis] = (int32_t)at[axis];
        vec_put(body->voxels.start, slot,
                (struct vec){edge * ((double)(from[0] + at[0]) + 0.5),
                             edge * ((double)(from[1] + at[1]) + 0.5),
                             edge * ((double)(from[2] + at[2]) + 0.5)});
        if (slot < body->n_slots) body->slot_of[box_cell(body, slot)] = (int32_t)slot;
        for (int i = 0; i < 3; i++) {
            if (++at[order[i]] < length[order[i]] || i == 2) break;
            at[order[i]] = 0;
        }
    }
}

/* No voxel and no bond is there; both get their depths later. */
static void place_nothing(struct body *body)
{
    for (int64_t slot = 0; slot < body->n_padded; slot++) {
        body->voxels.depth[slot] = ABSENT;
        for (int axis = 0; axis < 3; axis++) body->bonds[axis].depth[slot] = ABSENT;
    }
}

static void place_voxels(struct body *body, const uint8_t *material)
{
    int64_t n = 0;
    struct cursor cursor = {0};
    do {
        if (!material[cursor.cell]) continue;
        place_voxel(body, &cursor, body->model->of_code[material[cursor.cell]]);
        body->cells[n] = (int32_t)cursor.cell;
        body->slots[n++] = (int32_t)slot_of(body, &cursor);
    } while (step_on(&cursor, &body->model->settings));
}

static void place_bond(struct body *body, int64_t lower, enum axis axis)
{
    struct bonds *bonds = &body->bonds[axis];
    const int64_t upper = lower + bonds->step;
    bonds->lower[bonds->n++] = (int32_t)lower;
    body->bonded[lower] |= (uint8_t)(2u << 2 * axis);
    body->bonded[upper] |= (uint8_t)(1u << 2 * axis);
    if (body->coupling) return;
    const struct coupling *coupling = coupling_of(body, lower, upper);
#define KEEP(field) bonds->coupling.field[lower] = coupling->field;
    BOND_LAW(KEEP)
#undef KEEP
}

static void place_bonds(struct body *body, const uint8_t *material)
{
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++) body->bonds[axis].n = 0;
    struct cursor cursor = {0};
    do {
        if (!material[cursor.cell]) continue;
        for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++)
            if (has_bond(body->model, material, &cursor, axis))
                place_bond(body, slot_of(body, &cursor), axis);
    } while (step_on(&cursor, &body->model->settings));
}

static bool same_law(const struct coupling *one, const struct coupling *other)
{
#define COMPARE(field) \
    if (one->field != other->field) return false;
    BOND_LAW(COMPARE)
#undef COMPARE
    return true;
}

/* Return the coupling of all bonds of a model's bodies, or NULL if couplings can differ. */
static const struct coupling *only_coupling(const vox_model *model)
{
    const struct coupling *first = &model->couplings[0];
    const int64_t n = (int64_t)model->n_substances * model->n_substances;
    for (int64_t i = 1; i < n; i++)
        if (!same_law(first, &model->couplings[i])) return NULL;
    return first;
}

static void set_box(struct body *body)
{
    int64_t farthest = 1;
    body->n_slots = 1;
    for (int i = 0; i < 3; i++) {
        const enum axis axis = body->model->order[i];
        body->step[axis] = body->bonds[axis].step = body->n_slots;
        body->n_slots *= body->census.length[axis];
        if (body->census.length[axis] > 1) farthest = body->step[axis];
    }
    body->n_tiles = (body->n_slots + TILE - 1) / TILE;
    body->n_padded = body->n_tiles * TILE + farthest;
}

enum vox_status vox_body_shape(struct body *body, const vox_model *model,
                               const struct census *census, const uint8_t *material)
{
    body->complete = false;
    body->model = model;
    body->census = *census;
    body->coupling = only_coupling(model);
    body->n_partly = 0;
    set_box(body);
    enum vox_status status = allocate(body);
    if (status != VOX_OK) return status;
    body->sources = SOURCE_UNKNOWN;
    memcpy(body->material, material, (size_t)model->cells);
    place_starts(body);
    place_nothing(body);
    place_voxels(body, material);
    place_bonds(body, material);
    vox_body_rest(body);
    if (model->settings.fluid_drag > 0.0) status = vox_surface_shape(body);
    if (status == VOX_OK && model->settings.self_collision) status = vox_contacts_shape(body);
    body->complete = status == VOX_OK;
    return status;
}
