/* From cells with materials to voxels and bonds (sections 2, 3 and 8). */
#include <stdlib.h>

#include "internal.h"

static const double TWO_PI_OF_TIME_STEP = 2.0 * 3.1415926; /* the engine's own */
static const double MOST_STEPS = 9007199254740992.0;       /* 2^53; substeps still fit 64 bits */

int64_t cell_beside(const vox_model *model, int64_t cell, enum axis axis, bool upwards)
{
    const struct vox_settings *s = &model->settings;
    const int64_t stride[] = {1, s->nx, s->nx * s->ny}, length[] = {s->nx, s->ny, s->nz};
    const int64_t at = cell / stride[axis] % length[axis];
    if (at == (upwards ? length[axis] - 1 : 0)) return -1;
    return upwards ? cell + stride[axis] : cell - stride[axis];
}

/* Index of the cell at the other end of a bond along +axis, or -1 if there is no bond: neighbours that are both
 * held in all degrees of freedom have none. */
static int64_t bonded_cell_after(const vox_model *model, const uint8_t *material, int64_t cell, enum axis axis)
{
    const int64_t next = cell_beside(model, cell, axis, true);
    if (next < 0 || !material[next]) return -1;
    return model->fixed[cell] == VOX_FIX_ALL && model->fixed[next] == VOX_FIX_ALL ? -1 : next;
}

static const struct substance *substance_at(const vox_model *model, uint8_t code)
{
    return &model->substances[model->of_code[code]];
}

/* Section 3. A body without bonds has another step, as the engine does: the square root of the edge is missing. */
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

enum vox_status body_census(const vox_model *model, const uint8_t *material, struct census *census)
{
    double fastest_bond = 0.0, fastest_voxel = 0.0;
    *census = (struct census){0};
    for (int64_t cell = 0; cell < model->cells; cell++)
        if (material[cell] && model->of_code[material[cell]] < 0) return VOX_UNKNOWN_MATERIAL;
    for (int64_t cell = 0; cell < model->cells; cell++) {
        if (!material[cell]) continue;
        const struct substance *own = substance_at(model, material[cell]);
        census->n_voxels++;
        fastest_voxel = fmax(fastest_voxel, own->youngs_modulus / own->mass);
        for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++) {
            const int64_t next = bonded_cell_after(model, material, cell, axis);
            if (next < 0) continue;
            census->n_bonds++;
            fastest_bond = fmax(fastest_bond, coupling_of(model, own, substance_at(model, material[next]))->fastest);
        }
    }
    if (census->n_voxels == 0) return VOX_EMPTY_BODY;
    return set_clock(census, model, fastest_bond, fastest_voxel);
}

static struct voxel voxel_at_rest(const vox_model *model, int64_t cell, uint8_t code, double phase_cycles)
{
    const struct vox_settings *s = &model->settings;
    const struct vec start = {
        s->voxel_size * ((double)(cell % s->nx) + 0.5),
        s->voxel_size * ((double)(cell / s->nx % s->ny) + 0.5),
        s->voxel_size * ((double)(cell / (s->nx * s->ny)) + 0.5),
    };
    const struct substance *substance = substance_at(model, code);
    return (struct voxel){
        .position = start,
        .start = start,
        .orientation = {1.0, 0.0, 0.0, 0.0},
        .size = s->voxel_size,
        .phase = substance->strain_amplitude != 0.0 ? (double)(float)phase_cycles : 0.0,
        .substance = substance,
        .cell = (int32_t)cell,
        .fixed = model->fixed[cell],
    };
}

static void place_voxels(struct body *body, const uint8_t *material, const double *phase_cycles)
{
    int32_t n = 0;
    for (int64_t cell = 0; cell < body->model->cells; cell++) {
        body->voxel_in[cell] = material[cell] ? n : -1;
        if (material[cell]) body->voxels[n++] = voxel_at_rest(body->model, cell, material[cell], phase_cycles[cell]);
    }
}

/* Bonds of one axis stand together, so that the branches on the axis are foreseeable. */
static void place_bonds(struct body *body, const uint8_t *material)
{
    struct bond *bond = body->bonds;
    for (int64_t i = 0; i < body->census.n_voxels; i++)
        for (int side = 0; side < 6; side++) body->bonded[i][side] = -1;
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++) {
        for (int32_t lower = 0; lower < body->census.n_voxels; lower++) {
            const int64_t next = bonded_cell_after(body->model, material, body->voxels[lower].cell, axis);
            if (next < 0) continue;
            const int32_t upper = body->voxel_in[next];
            *bond++ = (struct bond){
                .lower = lower,
                .upper = upper,
                .axis = axis,
                .small = true,
                .coupling = coupling_of(body->model, body->voxels[lower].substance, body->voxels[upper].substance),
            };
            body->bonded[lower][2 * axis + 1] = upper;
            body->bonded[upper][2 * axis] = lower;
        }
    }
}

enum vox_status body_create(struct body *body, const vox_model *model, const struct census *census,
                            const uint8_t *material, const double *phase_cycles)
{
    const size_t n_voxels = (size_t)census->n_voxels, n_bonds = (size_t)census->n_bonds;
    *body = (struct body){.model = model, .census = *census};
    body->voxels = malloc(n_voxels * sizeof *body->voxels);
    body->bonded = malloc(n_voxels * sizeof *body->bonded);
    body->bonds = malloc((n_bonds > 0 ? n_bonds : 1) * sizeof *body->bonds);
    body->voxel_in = malloc((size_t)model->cells * sizeof *body->voxel_in);
    if (!body->voxels || !body->bonded || !body->bonds || !body->voxel_in) return VOX_NO_MEMORY;
    place_voxels(body, material, phase_cycles);
    place_bonds(body, material);
    if (model->settings.fluid_drag > 0.0) {
        const enum vox_status status = surface_create(body);
        if (status != VOX_OK) return status;
    }
    return model->settings.self_collision ? contacts_create(body) : VOX_OK;
}

void body_destroy(struct body *body)
{
    contacts_destroy(&body->contacts);
    surface_destroy(&body->surface);
    free(body->voxels);
    free(body->bonded);
    free(body->bonds);
    free(body->voxel_in);
}
