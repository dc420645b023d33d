/* Functions for batches: check all arguments, then simulate one body after another (sections 3 and
 * 7). */
#include <string.h>

#include "internal.h"

static const double MOST_CYCLES = 1e6;
/* With a larger share of the work left, the saving would not be worth the risk of a second
 * simulation. */
static const double LARGEST_SHARE = 0.75;

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

/* Check a body; `steps` is their number for the same body before, or 0. */
static enum vox_status check_body(const vox_model *model, const uint8_t *material,
                                  const double *phase_cycles, int64_t n_samples,
                                  const int64_t *sample_steps, int64_t *steps)
{
    if (*steps == 0) {
        struct census census;
        const enum vox_status status = vox_body_census(model, material, &census);
        if (status != VOX_OK) return status;
        *steps = census.steps;
    }
    if (!phases_are_sane(model, material, phase_cycles)) return VOX_BAD_PHASE;
    if (!ascending(n_samples, sample_steps)) return VOX_BAD_SAMPLE_ORDER;
    if (n_samples > 0 && sample_steps[n_samples - 1] > *steps) return VOX_SAMPLE_OUT_OF_RANGE;
    return VOX_OK;
}

/* Return whether a body of a batch has the same materials as the previous one. */
static bool is_same(const vox_model *model, const uint8_t *material, int64_t i)
{
    const uint8_t *own = material + i * model->cells;
    return i > 0 && memcmp(own - model->cells, own, (size_t)model->cells) == 0;
}

enum outcome { ADVANCED, DIVERGED, UNCERTAIN };

/* Make a step of the voxels up to a depth; UNCERTAIN means that the whole body is needed. No voxel
 * moves before all forces are complete. */
static enum outcome advance(struct body *body, bool first_step, double limit)
{
    const vox_model *model = body->model;
    const bool collides = model->settings.self_collision, whole = limit == WHOLE_BODY;
    if (collides && whole && !first_step && !vox_contacts_refresh(body)) return DIVERGED;
    if (!model->kernel->bonds_apply(body, first_step ? 0.0 : 1.0 / body->census.dt, limit))
        return DIVERGED;
    if (collides && whole) vox_contacts_apply(body);
    if (collides && !whole && !vox_watch_apply(body, limit)) return UNCERTAIN;
    if (model->settings.fluid_drag > 0.0) vox_fluid_apply(body);
    if (!model->kernel->voxels_advance(body, limit)) return DIVERGED;
    model->kernel->sizes_advance(body, limit);
    body->time += body->census.dt;
    return ADVANCED;
}

/* Return whether a voxel whose contact ends the motion is below the plane of the floor. */
static bool has_fallen(const struct body *body, const uint8_t *material)
{
    const int64_t code = body->model->settings.falling_code;
    for (int64_t i = 0; code != 0 && i < body->census.n_voxels; i++)
        if (material[body->cells[i]] == code && floor_depth(body, body->slots[i]) > 0.0)
            return true;
    return false;
}

/* Samples of one body to write from `row` on. */
struct samples {
    int64_t n;
    const int64_t *steps;
    const struct vox_tracks *tracks;
    int64_t row;
};

/* The body diverged, or is UNCERTAIN, in a step. */
struct end {
    enum outcome outcome;
    int64_t step; /* from 1 */
};

/* Return whether all controllers have the first step in common, and nothing looks at the state
 * before it. */
static bool shares_first_step(const struct body *body, const struct samples *samples)
{
    const struct vox_settings *s = &body->model->settings;
    const bool sampled = samples->n > 0 && samples->steps[0] == 0;
    return !sampled && s->falling_code == 0 && s->fluid_drag == 0.0;
}

/* Reset everything but the state itself. */
static void rest_surroundings(struct body *body, bool whole)
{
    const struct vox_settings *s = &body->model->settings;
    if (s->fluid_drag > 0.0) vox_fluid_rest(body);
    if (s->self_collision && whole) vox_contacts_rest(body);
    if (s->self_collision && !whole) vox_watch_rest(body);
}

/* Return the points that tracks record. */
static enum sources sources_of(const struct vox_tracks *tracks)
{
    if (tracks->body || tracks->voxels || tracks->energy || tracks->strain || tracks->momentum)
        return SOURCE_ALL;
    return (enum sources)((tracks->tip ? SOURCE_TIP : 0) | (tracks->face ? SOURCE_FACE : 0));
}

/* Return the number of steps to make: up to the last sample, unless everything is wanted. */
static int64_t last_step(const struct body *body, const struct samples *samples)
{
    if (body->model->settings.whole_body) return body->census.steps;
    const bool recorded = samples->n > 0 && sources_of(samples->tracks) != 0;
    return recorded ? samples->steps[samples->n - 1] : 0;
}

/* Simulate a body, either as a whole or what can affect the samples, and write them. */
static struct end run(struct body *body, const uint8_t *material, struct samples samples,
                      bool whole)
{
    const int64_t *next = samples.steps;
    const int64_t end = samples.row + samples.n;
    const int64_t last = last_step(body, &samples);
    const double first_limit = whole ? WHOLE_BODY : (double)(last - 1);
    const bool shares = last > 0 && shares_first_step(body, &samples);
    const bool is_made = shares && body->first.limit == first_limit;
    int64_t row = samples.row;
    rest_surroundings(body, whole);
    if (is_made)
        vox_first_make(body, first_limit);
    else
        vox_body_rest(body);
    for (int64_t step = is_made ? 1 : 0;; step++) {
        if (row < end && *next == step) {
            vox_sample_write(body, samples.tracks, row++);
            next++;
        }
        if (step == last) return (struct end){ADVANCED, 0};
        if (has_fallen(body, material)) {
            while (row < end) vox_sample_write(body, samples.tracks, row++);
            return (struct end){ADVANCED, 0};
        }
        const double limit = whole ? WHOLE_BODY : (double)(last - step - 1);
        const enum outcome outcome = advance(body, step == 0, limit);
        if (outcome != ADVANCED) {
            vox_sample_write_nothing(body->model, samples.tracks, row, end);
            return (struct end){outcome, step + 1};
        }
        if (step == 0 && shares) vox_first_keep(body, limit);
    }
}

/* Return whether effects spread only along bonds and across pairs of voxels. */
static bool has_cone(const struct body *body)
{
    const struct vox_settings *s = &body->model->settings;
    if (s->whole_body || s->fluid_drag > 0.0) return false;
    return !s->self_collision || vox_watch_is_possible(body);
}

/* Prepare a body for samples, and decide whether it is simulated as a whole. */
static enum vox_status prepare(struct body *body, const struct samples *samples, bool *whole)
{
    const vox_model *model = body->model;
    *whole = !has_cone(body);
    const enum sources sources = *whole ? SOURCE_ALL : sources_of(samples->tracks);
    if (body->sources != sources) {
        vox_cone_shape(body, sources);
        if (!*whole && model->settings.self_collision) {
            const enum vox_status status = vox_watch_shape(body);
            if (status != VOX_OK) {
                body->sources = SOURCE_UNKNOWN; /* the next call tries again */
                return status;
            }
        }
    }
    if (model->settings.self_collision)
        *whole |= vox_cone_share(body, last_step(body, samples)) > LARGEST_SHARE;
    return VOX_OK;
}

static enum vox_status simulate(struct body *body, const uint8_t *material,
                                const double *phase_cycles, struct samples samples,
                                int64_t *diverged_step, uint8_t *repeated)
{
    bool whole;
    vox_body_actuate(body, phase_cycles);
    const enum vox_status status = prepare(body, &samples, &whole);
    if (status != VOX_OK) return status;
    struct end end = run(body, material, samples, whole);
    *repeated = end.outcome == UNCERTAIN;
    if (*repeated) end = run(body, material, samples, true);
    *diverged_step = end.step;
    return VOX_OK;
}

/* Exchange a body, which may be NULL, for one with these materials, unless it has them. */
static enum vox_status next_body(const vox_model *model, const uint8_t *material,
                                 struct body **body)
{
    if (*body && vox_body_has(*body, material)) return VOX_OK;
    vox_body_return(model, *body);
    *body = vox_body_take(model, material);
    if (!*body) return VOX_NO_MEMORY;
    if (vox_body_has(*body, material)) return VOX_OK;
    struct census census;
    const enum vox_status status = vox_body_census(model, material, &census);
    return status == VOX_OK ? vox_body_shape(*body, model, &census, material) : status;
}

/* Return the sample steps of a body; the array may be NULL without samples. */
static const int64_t *own_steps(const int64_t *sample_steps, int64_t body, int64_t n_samples)
{
    return n_samples > 0 ? sample_steps + body * n_samples : sample_steps;
}

enum vox_status vox_simulate(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                             const double *phase_cycles, int64_t n_samples,
                             const int64_t *sample_steps, const struct vox_tracks *tracks,
                             int64_t *diverged_step, uint8_t *repeated, int64_t *culprit)
{
    int64_t nobody;
    uint8_t unknown;
    if (!culprit) culprit = &nobody;
    *culprit = -1;
    if (!model || !tracks) return VOX_NULL_ARGUMENT;
    if (n_bodies > 0 && (!material || !phase_cycles || !diverged_step)) return VOX_NULL_ARGUMENT;
    if (n_bodies > 0 && n_samples > 0 && !sample_steps) return VOX_NULL_ARGUMENT;
    if (!batch_fits(n_bodies, n_samples, model->cells)) return VOX_BAD_BATCH;
    enum vox_status status = VOX_OK;
    int64_t steps = 0;
    for (int64_t i = 0; i < n_bodies && status == VOX_OK; i++) {
        const int64_t at = i * model->cells;
        if (!is_same(model, material, i)) steps = 0;
        status = check_body(model, material + at, phase_cycles + at, n_samples,
                            own_steps(sample_steps, i, n_samples), &steps);
        *culprit = i;
    }
    struct body *body = NULL;
    for (int64_t i = 0; i < n_bodies && status == VOX_OK; i++) {
        const int64_t at = i * model->cells;
        const struct samples samples = {n_samples, own_steps(sample_steps, i, n_samples), tracks,
                                        i * n_samples};
        *culprit = i;
        status = next_body(model, material + at, &body);
        if (status != VOX_OK) break;
        status = simulate(body, material + at, phase_cycles + at, samples, &diverged_step[i],
                          repeated ? &repeated[i] : &unknown);
    }
    vox_body_return(model, body);
    if (status == VOX_OK) *culprit = -1;
    return status;
}
