/* Functions for batches: check all arguments, then simulate one body after another (sections 3 and
 * 7). */
#include <string.h>

#include "internal.h"

static const double MOST_CYCLES = 1e6;

/* Return whether the sizes of all tracks can be represented: a sample of a body has 24 bytes per
 * cell in `voxels`, and at most 48 bytes in other tracks. */
static bool batch_fits(int64_t n_bodies, int64_t n_samples, int64_t cells)
{
    const int64_t most = (int64_t)(PTRDIFF_MAX / 48) / cells;
    return n_bodies >= 0 && n_samples >= 0 && n_bodies <= most &&
           (n_bodies == 0 || n_samples <= most / n_bodies);
}

enum vox_status vox_time_steps(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                               double *dt, int64_t *steps, int64_t *culprit)
{
    int64_t nobody;
    if (!culprit) culprit = &nobody;
    *culprit = -1;
    if (!model || (!material && n_bodies > 0)) return VOX_NULL_ARGUMENT;
    if (!batch_fits(n_bodies, 0, model->cells)) return VOX_BAD_BATCH;
    for (int64_t i = 0; i < n_bodies; i++) {
        struct census census;
        const enum vox_status status = vox_body_census(model, material + i * model->cells, &census);
        if (status != VOX_OK) {
            *culprit = i;
            return status;
        }
        if (dt) dt[i] = census.dt;
        if (steps) steps[i] = census.steps;
    }
    return VOX_OK;
}

static bool ascending(int64_t n_samples, const int64_t *sample_steps)
{
    for (int64_t i = 0; i < n_samples; i++)
        if (sample_steps[i] < 0 || (i > 0 && sample_steps[i] <= sample_steps[i - 1])) return false;
    return true;
}

static bool phases_are_sane(const vox_model *model, const uint8_t *material,
                            const double *phase_cycles)
{
    for (int64_t cell = 0; cell < model->cells; cell++) {
        if (!material[cell] ||
            model->substances[model->of_code[material[cell]]].strain_amplitude == 0.0)
            continue;
        if (!(fabs(phase_cycles[cell]) <= MOST_CYCLES)) return false;
    }
    return true;
}

static enum vox_status check_body(const vox_model *model, const uint8_t *material,
                                  const double *phase_cycles, int64_t n_samples,
                                  const int64_t *sample_steps)
{
    struct census census;
    const enum vox_status status = vox_body_census(model, material, &census);
    if (status != VOX_OK) return status;
    if (!phases_are_sane(model, material, phase_cycles)) return VOX_BAD_PHASE;
    if (!ascending(n_samples, sample_steps)) return VOX_BAD_SAMPLE_ORDER;
    if (n_samples > 0 && sample_steps[n_samples - 1] > census.steps) return VOX_SAMPLE_OUT_OF_RANGE;
    return VOX_OK;
}

/* Make a step; return false if the body diverged. No voxel moves before all forces are complete. */
static bool advance(struct body *body, bool first_step, bool needed)
{
    const vox_model *model = body->model;
    const bool collides = model->settings.self_collision;
    if (collides && !vox_contacts_refresh(body, first_step)) return false;
    if (!needed && vox_next_step_is_harmless(body)) return true;
    if (!model->kernel->bonds_apply(body, first_step ? 0.0 : 1.0 / body->census.dt)) return false;
    if (collides) vox_contacts_apply(body);
    if (model->settings.fluid_drag > 0.0) vox_fluid_apply(body);
    return model->kernel->voxels_advance(body);
}

/* Return whether a voxel whose contact ends the motion is below the plane of the floor. */
static bool has_fallen(const struct body *body, const uint8_t *material)
{
    const int64_t code = body->model->settings.falling_code;
    for (int64_t i = 0; code != 0 && i < body->census.n_voxels; i++)
        if (material[body->cells[i]] == code && vox_floor_depth(body, body->slots[i]) > 0.0)
            return true;
    return false;
}

/* Simulate a body to the end and write its samples from `row` on. Return 0 or the step at which it
 * diverged. The last step is skipped if no sample follows it and it cannot diverge. */
static int64_t run(struct body *body, const uint8_t *material, int64_t n_samples,
                   const int64_t *sample_steps, const struct vox_tracks *tracks, int64_t row)
{
    const int64_t end = row + n_samples, last = body->census.steps - 1;
    for (int64_t step = 0;; step++) {
        if (row < end && *sample_steps == step) {
            vox_sample_write(body, tracks, row++);
            sample_steps++;
        }
        if (step == body->census.steps) return 0;
        if (has_fallen(body, material)) {
            while (row < end) vox_sample_write(body, tracks, row++);
            return 0;
        }
        const bool needed = step < last || row < end || body->model->settings.whole_body;
        if (advance(body, step == 0, needed)) continue;
        vox_sample_write_nothing(body->model, tracks, row, end);
        return step + 1;
    }
}

/* Return whether a body has the same materials as the previous one. */
static bool is_same(const vox_model *model, const uint8_t *material, int64_t i)
{
    const uint8_t *own = material + i * model->cells;
    return i > 0 && memcmp(own - model->cells, own, (size_t)model->cells) == 0;
}

static enum vox_status set_body(struct body *body, const vox_model *model, const uint8_t *material)
{
    struct census census;
    const enum vox_status status = vox_body_census(model, material, &census);
    return status == VOX_OK ? vox_body_shape(body, model, &census, material) : status;
}

/* Return the sample steps of a body; the array may be NULL without samples. */
static const int64_t *own_steps(const int64_t *sample_steps, int64_t body, int64_t n_samples)
{
    return n_samples > 0 ? sample_steps + body * n_samples : sample_steps;
}

enum vox_status vox_simulate(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                             const double *phase_cycles, int64_t n_samples,
                             const int64_t *sample_steps, const struct vox_tracks *tracks,
                             int64_t *diverged_step, int64_t *culprit)
{
    int64_t nobody;
    if (!culprit) culprit = &nobody;
    *culprit = -1;
    if (!model || !tracks) return VOX_NULL_ARGUMENT;
    if (n_bodies > 0 && (!material || !phase_cycles || !diverged_step)) return VOX_NULL_ARGUMENT;
    if (n_bodies > 0 && n_samples > 0 && !sample_steps) return VOX_NULL_ARGUMENT;
    if (!batch_fits(n_bodies, n_samples, model->cells)) return VOX_BAD_BATCH;
    enum vox_status status = VOX_OK;
    for (int64_t i = 0; i < n_bodies && status == VOX_OK; i++) {
        const int64_t at = i * model->cells;
        status = check_body(model, material + at, phase_cycles + at, n_samples,
                            own_steps(sample_steps, i, n_samples));
        *culprit = i;
    }
    struct body *body = status == VOX_OK ? vox_body_take(model) : NULL;
    if (status == VOX_OK && !body) status = VOX_NO_MEMORY;
    for (int64_t i = 0; i < n_bodies && status == VOX_OK; i++) {
        *culprit = i;
        if (!is_same(model, material, i))
            status = set_body(body, model, material + i * model->cells);
        if (status != VOX_OK) break;
        vox_body_rest(body, phase_cycles + i * model->cells);
        diverged_step[i] = run(body, material + i * model->cells, n_samples,
                               own_steps(sample_steps, i, n_samples), tracks, i * n_samples);
    }
    vox_body_return(model, body);
    if (status == VOX_OK) *culprit = -1;
    return status;
}
