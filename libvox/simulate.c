/* The calls on a batch: check everything, then simulate body after body (sections 3 and 7). */
#include "internal.h"

static const double MOST_CYCLES = 1e6;

/* Whether a batch of so many bodies fits an array of so many doubles each. */
static bool batch_fits(int64_t n_bodies, int64_t n_samples, int64_t cells)
{
    const int64_t most = (int64_t)(PTRDIFF_MAX / 64) / cells;
    return n_bodies >= 0 && n_samples >= 0 && n_bodies <= most && (n_bodies == 0 || n_samples <= most / n_bodies);
}

enum vox_status vox_time_steps(const vox_model *model, int64_t n_bodies, const uint8_t *material, double *dt,
                               int64_t *steps, int64_t *culprit)
{
    int64_t nobody;
    if (!culprit) culprit = &nobody;
    *culprit = -1;
    if (!model || (!material && n_bodies > 0)) return VOX_NULL_ARGUMENT;
    if (!batch_fits(n_bodies, 0, model->cells)) return VOX_BAD_BATCH;
    for (int64_t i = 0; i < n_bodies; i++) {
        struct census census;
        const enum vox_status status = body_census(model, material + i * model->cells, &census);
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

static bool phases_are_sane(const vox_model *model, const uint8_t *material, const double *phase_cycles)
{
    for (int64_t cell = 0; cell < model->cells; cell++) {
        if (!material[cell] || model->substances[model->of_code[material[cell]]].strain_amplitude == 0.0) continue;
        if (!(fabs(phase_cycles[cell]) <= MOST_CYCLES)) return false;
    }
    return true;
}

static enum vox_status check_body(const vox_model *model, const uint8_t *material, const double *phase_cycles,
                                  int64_t n_samples, const int64_t *sample_steps)
{
    struct census census;
    const enum vox_status status = body_census(model, material, &census);
    if (status != VOX_OK) return status;
    if (!phases_are_sane(model, material, phase_cycles)) return VOX_BAD_PHASE;
    if (n_samples > 0 && sample_steps[n_samples - 1] > census.steps) return VOX_SAMPLE_OUT_OF_RANGE;
    return VOX_OK;
}

static void write_vec(double *out, struct vec v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/* Mass-weighted mean of the voxels whose initial x is at least so large. */
static struct vec mean_position(const struct body *body, double from_x)
{
    struct vec moment = {0};
    double mass = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const struct voxel *voxel = &body->voxels[i];
        if (voxel->start.x < from_x) continue;
        moment = vec_add(moment, vec_scale(voxel->substance->mass, voxel->position));
        mass += voxel->substance->mass;
    }
    return vec_scale(1.0 / mass, moment);
}

static double largest_start_x(const struct body *body)
{
    double largest = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) largest = fmax(largest, body->voxels[i].start.x);
    return largest;
}

static void write_voxels(const struct body *body, double *out)
{
    const struct vec nowhere = {NAN, NAN, NAN};
    for (int64_t cell = 0; cell < body->model->cells; cell++) {
        const int32_t voxel = body->voxel_in[cell];
        write_vec(out + 3 * cell, voxel < 0 ? nowhere : body->voxels[voxel].position);
    }
}

/* One sample of every track that is wanted; `row` counts the samples of the whole batch. */
static void write_sample(const struct body *body, const struct vox_tracks *tracks, int64_t row)
{
    if (tracks->tip) write_vec(tracks->tip + 3 * row, body->voxels[body->census.n_voxels - 1].position);
    if (tracks->face) write_vec(tracks->face + 3 * row, mean_position(body, largest_start_x(body)));
    if (tracks->body) write_vec(tracks->body + 3 * row, mean_position(body, 0.0));
    if (tracks->voxels) write_voxels(body, tracks->voxels + 3 * row * body->model->cells);
}

static void write_nan(double *track, int64_t width, int64_t begin, int64_t end)
{
    if (!track) return;
    for (int64_t i = width * begin; i < width * end; i++) track[i] = NAN;
}

static void write_nothing(const vox_model *model, const struct vox_tracks *tracks, int64_t begin, int64_t end)
{
    write_nan(tracks->tip, 3, begin, end);
    write_nan(tracks->face, 3, begin, end);
    write_nan(tracks->body, 3, begin, end);
    write_nan(tracks->voxels, 3 * model->cells, begin, end);
}

/* False if the body diverged. All forces are complete before any voxel moves. */
static bool advance(struct body *body, bool first_step)
{
    const bool collides = body->model->settings.self_collision;
    if (collides && !contacts_refresh(body, first_step)) return false;
    if (!bonds_apply(body, first_step ? 0.0 : 1.0 / body->census.dt)) return false;
    if (collides) contacts_apply(body);
    return voxels_advance(body);
}

/* Runs one body to its end, its samples going to `row` and the rows after it. Returns 0 or the step at which it
 * diverged. */
static int64_t run(struct body *body, int64_t n_samples, const int64_t *sample_steps, const struct vox_tracks *tracks,
                   int64_t row)
{
    const int64_t end = row + n_samples;
    for (int64_t step = 0;; step++) {
        if (row < end && *sample_steps == step) {
            write_sample(body, tracks, row++);
            sample_steps++;
        }
        if (step == body->census.steps) return 0;
        if (advance(body, step == 0)) continue;
        write_nothing(body->model, tracks, row, end);
        return step + 1;
    }
}

static enum vox_status simulate_one(const vox_model *model, const uint8_t *material, const double *phase_cycles,
                                    int64_t n_samples, const int64_t *sample_steps, const struct vox_tracks *tracks,
                                    int64_t row, int64_t *diverged_step)
{
    struct census census;
    enum vox_status status = body_census(model, material, &census);
    if (status != VOX_OK) return status;
    struct body body;
    status = body_create(&body, model, &census, material, phase_cycles);
    if (status == VOX_OK) *diverged_step = run(&body, n_samples, sample_steps, tracks, row);
    body_destroy(&body);
    return status;
}

enum vox_status vox_simulate(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                             const double *phase_cycles, int64_t n_samples, const int64_t *sample_steps,
                             const struct vox_tracks *tracks, int64_t *diverged_step, int64_t *culprit)
{
    int64_t nobody;
    if (!culprit) culprit = &nobody;
    *culprit = -1;
    if (!model || !tracks || (n_samples > 0 && !sample_steps)) return VOX_NULL_ARGUMENT;
    if (n_bodies > 0 && (!material || !phase_cycles || !diverged_step)) return VOX_NULL_ARGUMENT;
    if (!batch_fits(n_bodies, n_samples, model->cells)) return VOX_BAD_BATCH;
    if (!ascending(n_samples, sample_steps)) return VOX_BAD_SAMPLE_ORDER;
    enum vox_status status = VOX_OK;
    for (int64_t i = 0; i < n_bodies && status == VOX_OK; i++) {
        const int64_t at = i * model->cells;
        status = check_body(model, material + at, phase_cycles + at, n_samples, sample_steps);
        *culprit = i;
    }
    for (int64_t i = 0; i < n_bodies && status == VOX_OK; i++) {
        const int64_t at = i * model->cells;
        status = simulate_one(model, material + at, phase_cycles + at, n_samples, sample_steps, tracks, i * n_samples,
                              &diverged_step[i]);
        *culprit = i;
    }
    if (status == VOX_OK) *culprit = -1;
    return status;
}
