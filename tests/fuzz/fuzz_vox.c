/* Fuzz target of libFuzzer for the C interface of libvox: see docs/fuzzing.md.
 *
 * The sanitizers detect reads and writes out of bounds. The checks here abort the program if another guarantee fails:
 * statuses and culprits are within their ranges, a refused call leaves buffers unchanged, samples are finite up to a
 * divergence and NaN after it, fixed voxels do not move, and the results of a body depend neither on the rest of the
 * batch nor on what the solver leaves out.
 *
 * The solver is compiled with these allocators, so that any of its allocations can fail on demand.
 */
#include <inttypes.h>
#include <stdio.h>

#include "decode.h"

enum { CANARY = 0x5a };

static const double MOST_WORK = 5000.0; /* voxels times steps */

static const int64_t WIDTHS[N_TRACKS] = {3, 3, 3, 0, 2, 2, 6}; /* doubles per sample; 0: three for each cell */
enum track { TIP, FACE, BODY, VOXELS, ENERGY, STRAIN, MOMENTUM };

/* ---- allocations ------------------------------------------------------------------------------------------ */

static int64_t allocations_left = -1; /* -1: any number */

static bool fails(void)
{
    if (allocations_left > 0) allocations_left--;
    return allocations_left == 0;
}

void *fuzz_malloc(size_t size);
void *fuzz_calloc(size_t count, size_t size);

void *fuzz_malloc(size_t size)
{
    return fails() ? NULL : malloc(size);
}

void *fuzz_calloc(size_t count, size_t size)
{
    return fails() ? NULL : calloc(count, size);
}

/* ---- verdicts --------------------------------------------------------------------------------------------- */

#define CHECK(condition) check((condition), #condition, __LINE__)

/* Context of a check, printed if it fails. */
static const struct arguments *at_hand;
static struct place {
    unsigned track;
    int64_t step, diverged;
    const double *values;
    int64_t n;
} at_hand_place;

static void explain(const struct arguments *a)
{
    const struct vox_settings *s = &a->settings;
    fprintf(stderr, "canvas %" PRId64 " %" PRId64 " %" PRId64 ", voxel_size %g, time_step_fraction %g, substeps %" PRId64
            ", duration %g, step_limit %" PRId64 "\n", s->nx, s->ny, s->nz, s->voxel_size, s->time_step_fraction,
            s->substeps, s->duration, s->step_limit);
    fprintf(stderr, "temperature_amplitude %g, period %g, start_time %g, ramp %g\n", s->temperature_amplitude, s->period,
            s->start_time, s->ramp);
    fprintf(stderr, "gravity %g, floor %d, slope %g, drag %g, damping: bond %g, slow %g, floor %g, contact %g\n",
            s->gravity, s->floor, s->floor_slope, s->fluid_drag, s->bond_damping, s->slow_damping, s->floor_damping,
            s->contact_damping);
    fprintf(stderr, "collision: self %d, friction %d, complete %d, envelope %g, horizon %g, list factor %g\n",
            s->self_collision, s->contact_friction, s->complete_contacts, s->collision_envelope, s->collision_horizon,
            s->collision_list_factor);
    fprintf(stderr, "largest_strain %g, largest_distance %g\n", s->largest_strain, s->largest_distance);
    fprintf(stderr, "sizes %g to %g, clamp %d, fluid_by_size %d, falling_code %" PRId64 "\n", s->smallest_size,
            s->largest_size, s->size_clamp, s->fluid_by_size, s->falling_code);
    for (int32_t code = 0; code < a->n_codes; code++) {
        const struct vox_material *m = &a->palette[code];
        if (m->used)
            fprintf(stderr, "material %d: E %g, nu %g, rho %g, expansion %g, friction %g %g\n", code, m->youngs_modulus,
                    m->poisson_ratio, m->density, m->expansion, m->static_friction, m->dynamic_friction);
    }
    fprintf(stderr, "fault %d, bodies %" PRId64 ", samples %" PRId64 ", tracks %#x\n", a->fault, a->n_bodies,
            a->n_samples, a->wanted);
    const struct place *p = &at_hand_place;
    fprintf(stderr, "track %u after step %" PRId64 ", diverged at step %" PRId64 ":", p->track, p->step, p->diverged);
    for (int64_t i = 0; i < p->n && i < 12; i++) fprintf(stderr, " %g", p->values[i]);
    fprintf(stderr, "\n");
}

static void check(bool fine, const char *condition, int line)
{
    if (fine) return;
    fprintf(stderr, "fuzz_vox.c:%d: a check of libvox failed: %s\n", line, condition);
    explain(at_hand);
    abort();
}

static bool same(const double *a, const double *b, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (!(a[i] == b[i] || (isnan(a[i]) && isnan(b[i])))) return false;
    return true;
}

static bool all_finite(const double *values, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (!isfinite(values[i])) return false;
    return true;
}

static bool all_nan(const double *values, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (!isnan(values[i])) return false;
    return true;
}

static void check_status(enum vox_status status, int64_t culprit, const struct arguments *a)
{
    CHECK(status >= VOX_OK && status <= VOX_SAMPLE_OUT_OF_RANGE);
    CHECK(vox_status_message(status)[0] != '\0');
    if (status == VOX_OK || (status >= VOX_NULL_ARGUMENT && status < VOX_BAD_PALETTE)) CHECK(culprit == -1);
    if (status >= VOX_BAD_PALETTE && status < VOX_BAD_FIXED) CHECK(culprit >= -1 && culprit < a->n_codes);
    if (status == VOX_BAD_FIXED) CHECK(culprit >= 0 && culprit < a->cells);
    if (status >= VOX_BAD_BATCH) CHECK(culprit >= -1 && culprit < a->n_bodies);
    if (status > VOX_BAD_BATCH) CHECK(culprit >= 0);
}

/* ---- calls ------------------------------------------------------------------------------------------------ */

/* Returns NULL if the arguments were refused. */
static vox_model *make(const struct arguments *a)
{
    vox_model *model = NULL;
    int64_t culprit = -2;
    const enum fault fault = a->fault;
    const int32_t n_codes = fault == ABSURD_CODES ? (int32_t)PICK(ABSURD, a->wanted) : a->n_codes;
    const bool absurd = n_codes < 1 || n_codes > VOX_MAX_CODES;
    if (fault == MEMORY_FOR_MODEL) allocations_left = a->fail_at;
    const enum vox_status status = vox_model_create(fault == NO_SETTINGS ? NULL : &a->settings,
                                                    fault == NO_PALETTE ? NULL : a->palette,
                                                    absurd ? n_codes : a->n_codes, a->fixed,
                                                    fault == NO_PLACE_FOR_MODEL ? NULL : &model,
                                                    fault == NO_CULPRIT ? NULL : &culprit);
    allocations_left = -1;
    CHECK((model != NULL) == (status == VOX_OK));
    if (fault == NO_SETTINGS || fault == NO_PALETTE || fault == NO_PLACE_FOR_MODEL)
        CHECK(status == VOX_NULL_ARGUMENT);
    if (fault != NO_CULPRIT && fault != NO_PLACE_FOR_MODEL) check_status(status, culprit, a);
    if (absurd || a->cells == 0) CHECK(status != VOX_OK);
    CHECK(status < VOX_BAD_BATCH);
    return model;
}

/* Returns false if a body was refused; the steps are then unknown. */
static bool count_steps(const vox_model *model, const struct arguments *a, double *dt, int64_t *steps)
{
    int64_t culprit = -2;
    const enum vox_status status = vox_time_steps(model, a->n_bodies, a->material, dt, steps, &culprit);
    check_status(status, culprit, a);
    CHECK(vox_time_steps(model, a->n_bodies, a->material, NULL, NULL, NULL) == status);
    if (status != VOX_OK) return false;
    for (int64_t body = 0; body < a->n_bodies; body++) {
        CHECK(isfinite(dt[body]) && dt[body] > 0.0);
        CHECK(steps[body] >= 1 && steps[body] <= a->settings.step_limit);
        CHECK(steps[body] % a->settings.substeps == 0);
    }
    return true;
}

static int64_t width_of(enum track track, const struct arguments *a)
{
    return track == VOXELS ? 3 * a->cells : WIDTHS[track];
}

/* Outputs of a call. */
struct outcome {
    double *tracks[N_TRACKS]; /* NULL if not wanted */
    int64_t *diverged;
    uint8_t *repeated;
    enum vox_status status;
    int64_t culprit;
};

static struct outcome outcome_create(const struct arguments *a, unsigned wanted)
{
    struct outcome out = {.culprit = -2};
    for (unsigned track = 0; track < N_TRACKS; track++) {
        if (!(wanted >> track & 1)) continue;
        const int64_t length = a->n_bodies * a->n_samples * width_of(track, a);
        out.tracks[track] = exactly(length, sizeof(double));
        memset(out.tracks[track], CANARY, (size_t)length * sizeof(double));
    }
    out.diverged = exactly(a->n_bodies, sizeof *out.diverged);
    memset(out.diverged, CANARY, (size_t)a->n_bodies * sizeof *out.diverged);
    out.repeated = exactly(a->n_bodies, 1);
    memset(out.repeated, CANARY, (size_t)a->n_bodies);
    return out;
}

static void outcome_destroy(struct outcome *out)
{
    for (int track = 0; track < N_TRACKS; track++) free(out->tracks[track]);
    free(out->diverged);
    free(out->repeated);
}

static bool is_untouched(const void *place, int64_t length)
{
    const uint8_t *bytes = place;
    for (int64_t i = 0; i < length; i++)
        if (bytes[i] != CANARY) return false;
    return true;
}

static bool outcome_is_untouched(const struct outcome *out, const struct arguments *a)
{
    bool fine = is_untouched(out->diverged, a->n_bodies * (int64_t)sizeof *out->diverged) &&
                is_untouched(out->repeated, a->n_bodies);
    for (unsigned track = 0; track < N_TRACKS; track++) {
        const int64_t length = a->n_bodies * a->n_samples * width_of(track, a);
        if (out->tracks[track]) fine &= is_untouched(out->tracks[track], length * (int64_t)sizeof(double));
    }
    return fine;
}

static struct outcome simulate(const vox_model *model, const struct arguments *a, unsigned wanted)
{
    const enum fault fault = a->fault;
    struct outcome out = outcome_create(a, wanted);
    const struct vox_tracks tracks = {out.tracks[TIP],    out.tracks[FACE],   out.tracks[BODY],    out.tracks[VOXELS],
                                      out.tracks[ENERGY], out.tracks[STRAIN], out.tracks[MOMENTUM]};
    if (fault == MEMORY_FOR_BODIES) allocations_left = a->fail_at;
    out.status = vox_simulate(fault == NO_MODEL ? NULL : model, a->n_bodies, fault == NO_MATERIAL ? NULL : a->material,
                              fault == NO_PHASES ? NULL : a->phases, a->n_samples,
                              fault == NO_SAMPLE_STEPS ? NULL : a->samples, fault == NO_TRACKS ? NULL : &tracks,
                              fault == NO_DIVERGED_STEP ? NULL : out.diverged,
                              fault == NO_CULPRIT ? NULL : out.repeated, fault == NO_CULPRIT ? NULL : &out.culprit);
    allocations_left = -1;
    if (fault != NO_CULPRIT) check_status(out.status, out.culprit, a);
    if (out.status != VOX_OK && out.status != VOX_NO_MEMORY) CHECK(outcome_is_untouched(&out, a));
    return out;
}

/* Calls the solver with a number of bodies or samples that exceeds any array. */
static void call_with_absurd_numbers(const vox_model *model, const struct arguments *a)
{
    const int64_t numbers[] = {-1, INT64_MIN, INT64_MAX, INT64_C(1) << 61};
    const int64_t absurd = PICK(numbers, a->wanted);
    const bool bodies = a->fault == ABSURD_BODIES;
    if (!bodies && a->n_bodies == 0 && absurd > 0) return; /* without bodies, any number of samples is valid */
    struct outcome out = outcome_create(a, ~0u);
    const struct vox_tracks tracks = {out.tracks[TIP],    out.tracks[FACE],   out.tracks[BODY],    out.tracks[VOXELS],
                                      out.tracks[ENERGY], out.tracks[STRAIN], out.tracks[MOMENTUM]};
    out.status = vox_simulate(model, bodies ? absurd : a->n_bodies, a->material, a->phases,
                              bodies ? a->n_samples : absurd, a->samples, &tracks, out.diverged, out.repeated,
                              &out.culprit);
    CHECK(out.status == VOX_BAD_BATCH && out.culprit == -1);
    CHECK(vox_status_message(out.status)[0] != '\0' && vox_status_message((enum vox_status)1000)[0] != '\0');
    if (bodies) CHECK(vox_time_steps(model, absurd, a->material, NULL, NULL, NULL) == VOX_BAD_BATCH);
    CHECK(outcome_is_untouched(&out, a));
    outcome_destroy(&out);
}

/* ---- guarantees ------------------------------------------------------------------------------------------- */

/* Checks the voxels of one body at one time. */
static void check_voxels(const struct arguments *a, int64_t body, const double *positions)
{
    const double edge = a->settings.voxel_size;
    for (int64_t cell = 0; cell < a->cells; cell++) {
        const double *position = positions + 3 * cell;
        const int64_t place[] = {cell % a->settings.nx, cell / a->settings.nx % a->settings.ny,
                                 cell / a->settings.nx / a->settings.ny};
        if (!a->material[body * a->cells + cell]) {
            CHECK(all_nan(position, 3));
            continue;
        }
        CHECK(all_finite(position, 3));
        for (int axis = 0; axis < 3; axis++)
            if (a->fixed && a->fixed[cell] >> axis & 1)
                CHECK(fabs(position[axis] - edge * ((double)place[axis] + 0.5)) <= 1e-12 * edge);
    }
}

static void check_sample(const struct arguments *a, const struct outcome *out, int64_t body, int64_t sample)
{
    const int64_t row = body * a->n_samples + sample;
    const bool gone = out->diverged[body] > 0 && a->samples[row] >= out->diverged[body];
    for (unsigned track = 0; track < N_TRACKS; track++) {
        if (!out->tracks[track]) continue;
        const int64_t width = width_of(track, a);
        const double *values = out->tracks[track] + row * width;
        at_hand_place = (struct place){track, a->samples[row], out->diverged[body], values, width};
        if (gone) CHECK(all_nan(values, width));
        else if (track == VOXELS) check_voxels(a, body, values);
        else CHECK(all_finite(values, width));
        if (!gone && track == STRAIN) CHECK(values[0] <= values[1]);
        if (!gone && track == ENERGY) CHECK(values[1] >= 0.0);
    }
}

static void check_outcome(const struct arguments *a, const struct outcome *out, const int64_t *steps)
{
    for (int64_t body = 0; body < a->n_bodies; body++) {
        CHECK(out->diverged[body] >= 0 && out->diverged[body] <= steps[body]);
        CHECK(out->repeated[body] <= 1);
        if (a->settings.whole_body) CHECK(!out->repeated[body]);
        for (int64_t sample = 0; sample < a->n_samples; sample++) check_sample(a, out, body, sample);
    }
}

/* Returns the part of a batch that belongs to one body, as copies of exactly the required size. */
static struct arguments alone(const struct arguments *a, int64_t body, int64_t n_samples)
{
    struct arguments one = *a;
    one.n_bodies = 1;
    one.n_samples = n_samples;
    one.material = exactly(a->cells, 1);
    one.phases = exactly(a->cells, sizeof *one.phases);
    one.samples = n_samples > 0 ? exactly(n_samples, sizeof *one.samples) : NULL;
    memcpy(one.material, a->material + body * a->cells, (size_t)a->cells);
    memcpy(one.phases, a->phases + body * a->cells, (size_t)a->cells * sizeof *one.phases);
    if (one.samples) memcpy(one.samples, a->samples + body * a->n_samples, (size_t)n_samples * sizeof *one.samples);
    return one;
}

static void alone_destroy(struct arguments *one)
{
    free(one->material);
    free(one->phases);
    free(one->samples);
}

/* Checks that the first samples of a body are the same in both outcomes. */
static void check_tracks(const struct arguments *a, const struct outcome *all, int64_t body, const struct outcome *one,
                         int64_t n_samples)
{
    for (unsigned track = 0; track < N_TRACKS; track++) {
        const int64_t width = width_of(track, a);
        if (all->tracks[track])
            CHECK(same(all->tracks[track] + body * a->n_samples * width, one->tracks[track], n_samples * width));
    }
}

/* Checks that a body simulated alone has the same results as in its batch. */
static void check_alone(const vox_model *model, const struct arguments *a, const struct outcome *all, int64_t body,
                        const int64_t *steps)
{
    struct arguments one = alone(a, body, a->n_samples);
    struct outcome out = simulate(model, &one, a->wanted);
    CHECK(out.status == VOX_OK);
    CHECK(out.diverged[0] == all->diverged[body]);
    CHECK(out.repeated[0] == all->repeated[body]);
    check_outcome(&one, &out, &steps[body]);
    check_tracks(a, all, body, &out, a->n_samples);
    outcome_destroy(&out);
    alone_destroy(&one);
}

/* Checks that a body computed as a whole, with all tracks, has the same results, unless it diverges: the usual result
 * diverges at most by what can affect it, and not earlier. */
static void check_whole(const vox_model *whole, const struct arguments *a, const struct outcome *all, int64_t body,
                        const int64_t *steps)
{
    struct arguments one = alone(a, body, a->n_samples);
    struct outcome out = simulate(whole, &one, ~0u);
    const int64_t diverged = all->diverged[body];
    CHECK(out.status == VOX_OK);
    CHECK(out.repeated[0] == 0);
    check_outcome(&one, &out, &steps[body]);
    if (out.diverged[0] == 0) CHECK(diverged == 0);
    if (diverged > 0) CHECK(out.diverged[0] <= diverged);
    if (a->settings.whole_body) CHECK(out.diverged[0] == diverged);
    int64_t n = 0; /* samples before the whole body diverges */
    while (n < a->n_samples && (out.diverged[0] == 0 || one.samples[n] < out.diverged[0])) n++;
    check_tracks(a, all, body, &out, out.diverged[0] == diverged ? a->n_samples : n);
    outcome_destroy(&out);
    alone_destroy(&one);
}

/* Checks that the divergence of a whole body does not depend on what is recorded, and that otherwise nothing is
 * simulated without a sample. */
static void check_unseen(const vox_model *model, const struct arguments *a, const struct outcome *all, int64_t body)
{
    struct arguments one = alone(a, body, 0);
    struct outcome out = simulate(model, &one, 0);
    CHECK(out.status == VOX_OK);
    CHECK(out.diverged[0] == (a->settings.whole_body ? all->diverged[body] : 0));
    CHECK(out.repeated[0] == 0);
    outcome_destroy(&out);
    alone_destroy(&one);
}

static void check_bodies(const vox_model *model, const struct arguments *a, const struct outcome *all,
                         const int64_t *steps)
{
    struct arguments thorough = *a;
    thorough.settings.whole_body = 1;
    vox_model *whole = make(&thorough);
    CHECK(whole != NULL);
    check_outcome(a, all, steps);
    for (int64_t body = 0; body < a->n_bodies; body++) {
        check_alone(model, a, all, body, steps);
        check_whole(whole, a, all, body, steps);
        check_unseen(model, a, all, body);
    }
    vox_model_destroy(whole);
}

/* Checks that a model works after it ran out of memory. */
static void check_afterwards(const vox_model *model, const struct arguments *a, const int64_t *steps)
{
    struct arguments again = *a;
    again.fault = NO_FAULT;
    struct outcome out = simulate(model, &again, again.wanted);
    CHECK(out.status != VOX_NO_MEMORY);
    if (out.status == VOX_OK) check_bodies(model, &again, &out, steps);
    outcome_destroy(&out);
}

/* Checks that the culprit of a batch is refused alone too, for the same reason. */
static void check_culprit(const vox_model *model, const struct arguments *a, const struct outcome *all)
{
    struct arguments one = alone(a, all->culprit, a->n_samples);
    struct outcome out = simulate(model, &one, 0);
    CHECK(out.status == all->status && out.culprit == 0);
    outcome_destroy(&out);
    alone_destroy(&one);
}

static void check_missing(const struct arguments *a, enum vox_status status)
{
    const enum fault fault = a->fault;
    const bool any = a->n_bodies > 0;
    if (fault == NO_MODEL || (any && (fault == NO_MATERIAL || fault == NO_PHASES || fault == NO_DIVERGED_STEP)) ||
        (any && fault == NO_SAMPLE_STEPS && a->n_samples > 0))
        CHECK(status == VOX_NULL_ARGUMENT);
}

static void run(const vox_model *model, struct arguments *a, const int64_t *steps)
{
    struct outcome out = simulate(model, a, a->wanted);
    check_missing(a, out.status);
    const bool valid = a->fault == NO_FAULT || a->fault == ABSURD_CODES;
    if (out.status == VOX_OK && valid) check_bodies(model, a, &out, steps);
    if (out.status > VOX_BAD_BATCH && valid) check_culprit(model, a, &out);
    if (out.status == VOX_NO_MEMORY) check_afterwards(model, a, steps);
    outcome_destroy(&out);
}

/* ---- the entry point -------------------------------------------------------------------------------------- */

static double work_of(const struct arguments *a, const int64_t *steps)
{
    double work = 0.0;
    for (int64_t body = 0; body < a->n_bodies; body++)
        for (int64_t cell = 0; cell < a->cells; cell++)
            work += a->material[body * a->cells + cell] ? (double)steps[body] : 0.0;
    return work;
}

/* Creates a model and counts the steps of its bodies; if there are too many, shortens the duration and retries. */
static vox_model *make_affordable(struct arguments *a, double *dt, int64_t *steps, bool *known)
{
    *known = false;
    for (int attempt = 0; attempt < 2; attempt++) {
        vox_model *model = make(a);
        if (!model || a->cells > MOST_CELLS || !(*known = count_steps(model, a, dt, steps))) return model;
        const double work = work_of(a, steps);
        if (work <= MOST_WORK) return model;
        vox_model_destroy(model);
        a->settings.duration *= 0.9 * MOST_WORK / work;
    }
    return NULL;
}

static void fuzz(struct source *source, struct arguments *a)
{
    double dt[MOST_BODIES];
    int64_t steps[MOST_BODIES] = {0};
    bool known;
    vox_model *model = make_affordable(a, dt, steps, &known);
    if (model && a->cells <= MOST_CELLS) {
        next_samples(source, a, steps);
        if (a->fault == ABSURD_BODIES || a->fault == ABSURD_SAMPLES) call_with_absurd_numbers(model, a);
        else run(model, a, steps);
        if (!known) CHECK(a->n_bodies > 0);
    }
    vox_model_destroy(model);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct source source = {data, size};
    struct arguments arguments = next_arguments(&source);
    at_hand = &arguments;
    fuzz(&source, &arguments);
    arguments_destroy(&arguments);
    return 0;
}
