/* Decodes bytes into arguments of libvox: mostly valid ones, sometimes arbitrary ones.
 *
 * Most values of a byte encode a valid number, so that short inputs reach far; the other values encode extreme or
 * arbitrary numbers. An input that ends early is padded with zeros.
 */
#ifndef DECODE_H
#define DECODE_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "vox.h"

enum { MOST_CELLS = 216, MOST_BODIES = 3, MOST_SAMPLES = 4, N_TRACKS = 7 };

/* Faults of a call as a whole; a call has at most one. */
enum fault {
    NO_FAULT = 0,
    NO_SETTINGS,
    NO_PALETTE,
    NO_PLACE_FOR_MODEL,
    NO_CULPRIT,
    NO_MODEL,
    NO_MATERIAL,
    NO_PHASES,
    NO_SAMPLE_STEPS,
    NO_TRACKS,
    NO_DIVERGED_STEP,
    ABSURD_CODES,
    ABSURD_BODIES,
    ABSURD_SAMPLES,
    MEMORY_FOR_MODEL,
    MEMORY_FOR_BODIES,
    N_FAULTS
};

struct source {
    const uint8_t *at;
    size_t left;
};

/* Every array has exactly the size that the call may read. */
struct arguments {
    enum fault fault;
    int64_t fail_at; /* the allocation that fails, with the MEMORY faults */
    struct vox_settings settings;
    int32_t n_codes;
    struct vox_material *palette;
    uint8_t *fixed;
    int64_t cells; /* 0 for a canvas that must be refused */
    int64_t n_bodies;
    uint8_t *material;
    double *phases;
    int64_t n_samples;
    int64_t *samples;
    unsigned wanted; /* tracks, as bits */
};

static const double AWKWARD[] = {
    0.0, -0.0, 1.0, -1.0, 0.5, -0.5, 89.0, -89.5, 1e-6, 1e6, 1e-160, 1e160, 1e-300, 1e300, 4.9e-324, DBL_MIN, DBL_MAX,
    -DBL_MAX, DBL_EPSILON, 9007199254740993.0, 9.3e18, INFINITY, -INFINITY, NAN,
};
static const int64_t ABSURD[] = {0, -1, INT64_MIN, INT64_MAX, INT64_C(1) << 61, INT64_C(1) << 32, VOX_MAX_CELLS,
                                 VOX_MAX_CELLS + 1, 4096, 257, INT32_MAX};

#define PICK(list, n) ((list)[(size_t)(n) % (sizeof(list) / sizeof *(list))])

static uint8_t next_byte(struct source *source)
{
    if (source->left == 0) return 0;
    source->left--;
    return *source->at++;
}

static double next_raw(struct source *source)
{
    uint8_t bytes[sizeof(double)];
    for (size_t i = 0; i < sizeof bytes; i++) bytes[i] = next_byte(source);
    double number;
    memcpy(&number, bytes, sizeof number);
    return number;
}

/* Returns the lower end, a number up to the upper end, or an arbitrary number. */
static double next_number(struct source *source, double low, double high)
{
    const uint8_t byte = next_byte(source);
    if (byte == 255) return next_raw(source);
    if (byte == 254) return PICK(AWKWARD, next_byte(source));
    if (byte < 16) return low;
    return low + (high - low) * (byte - 16) / 237.0;
}

/* Returns the same on a logarithmic scale. */
static double next_scale(struct source *source, double low, double high)
{
    const uint8_t byte = next_byte(source);
    if (byte == 255) return next_raw(source);
    if (byte == 254) return PICK(AWKWARD, next_byte(source));
    return low * pow(high / low, byte / 253.0);
}

static int64_t next_count(struct source *source, int64_t low, int64_t high)
{
    const uint8_t byte = next_byte(source);
    if (byte == 255) return PICK(ABSURD, next_byte(source));
    return low + byte % (high - low + 1);
}

/* Allocates exactly the required size, also 0, so that the sanitizer detects any access beyond it. */
static void *exactly(int64_t count, size_t size)
{
    void *place = malloc((size_t)count * size);
    if (!place) abort();
    return place;
}

/* ---- the model -------------------------------------------------------------------------------------------- */

static struct vox_material next_material(struct source *source)
{
    return (struct vox_material){
        .used = 1,
        .youngs_modulus = next_scale(source, 1e3, 1e8),
        .poisson_ratio = next_number(source, 0.0, 0.5),
        .density = next_scale(source, 1e2, 1e6),
        .expansion = next_number(source, -0.02, 0.02),
        .static_friction = next_number(source, 0.0, 2.0),
        .dynamic_friction = next_number(source, 0.0, 1.0),
    };
}

/* Leaves gaps of unused codes in the palette. */
static void next_palette(struct source *source, struct arguments *a)
{
    const int64_t n_materials = 1 + next_byte(source) % 3, spread = 1 + next_byte(source) % 4;
    a->n_codes = (int32_t)(n_materials * spread + 1);
    a->palette = exactly(a->n_codes, sizeof *a->palette);
    memset(a->palette, 0, (size_t)a->n_codes * sizeof *a->palette);
    for (int64_t i = 1; i <= n_materials; i++) a->palette[i * spread] = next_material(source);
}

/* Returns the number of cells, or 0 if it exceeds the limit of a model. */
static int64_t cells_of(const struct vox_settings *s)
{
    const int64_t sides[] = {s->nx, s->ny, s->nz};
    int64_t cells = 1;
    for (int i = 0; i < 3; i++) {
        if (sides[i] < 1 || sides[i] > VOX_MAX_CELLS / cells) return 0;
        cells *= sides[i];
    }
    return cells;
}

static void next_canvas(struct source *source, struct vox_settings *s)
{
    s->nx = next_count(source, 1, 6);
    s->ny = next_count(source, 1, 6);
    s->nz = next_count(source, 1, 6);
    s->voxel_size = next_scale(source, 1e-3, 1.0);
}

/* Durations are multiples of the time step of the last material, so that the number of steps is positive but small. */
static void next_times(struct source *source, const struct vox_material *material, struct vox_settings *s)
{
    s->time_step_fraction = next_number(source, 0.05, 1.0);
    const double stiffness = material->youngs_modulus / material->density;
    const double guess = s->time_step_fraction * s->voxel_size / (6.2832 * sqrt(stiffness));
    const double unit = isfinite(guess) && guess > 0.0 ? guess : 1e-3;
    s->substeps = next_count(source, 1, 3);
    s->duration = unit * next_number(source, 1.0, 120.0);
    s->step_limit = next_byte(source) < 250 ? 10000 : next_count(source, 0, 100);
    s->temperature_amplitude = next_number(source, -60.0, 60.0);
    s->period = unit * next_scale(source, 1.0, 1000.0);
    s->start_time = unit * next_number(source, 0.0, 60.0);
    s->ramp = unit * next_number(source, 0.0, 60.0);
}

static void next_surroundings(struct source *source, struct vox_settings *s)
{
    const uint8_t switches = next_byte(source);
    s->floor = switches & 1 ? (switches & 16 ? INT32_MIN : 1) : 0;
    s->self_collision = switches & 2 ? 1 : 0;
    s->contact_friction = switches & 4 ? 1 : 0;
    s->complete_contacts = switches & 8 ? 1 : 0;
    s->kernel = (switches >> 5) % 3;
    s->whole_body = switches >> 5 > 5;
    s->gravity = next_number(source, -100.0, 30.0);
    s->floor_slope = next_number(source, -60.0, 60.0);
    s->fluid_drag = next_number(source, 0.0, 2000.0);
}

static void next_dampings(struct source *source, struct vox_settings *s)
{
    s->bond_damping = next_number(source, 0.0, 3.0);
    s->slow_damping = next_number(source, 0.0, 0.5);
    s->floor_damping = next_number(source, 0.0, 2.0);
    s->contact_damping = next_number(source, 0.0, 2.0);
}

static void next_limits(struct source *source, struct vox_settings *s)
{
    s->collision_envelope = next_number(source, 1.0, 2.0);
    s->collision_horizon = next_number(source, 1.0, 10.0);
    s->collision_list_factor = next_number(source, 1.0, 2.0);
    s->largest_strain = next_scale(source, 100.0, 0.01);
    s->largest_distance = next_scale(source, 100.0, 0.01);
}

/* Settings that came later; they are decoded last, so that older inputs keep their meaning. */
static void next_additions(struct source *source, struct arguments *a)
{
    struct vox_settings *s = &a->settings;
    const uint8_t chosen = next_byte(source);
    s->smallest_size = chosen & 1 ? next_number(source, 0.5, 1.0) : 0.1;
    s->largest_size = chosen & 2 ? next_number(source, 1.0, 1.5) : 3.0;
    s->size_clamp = chosen & 4 ? 1 : 0;
    s->fluid_by_size = chosen & 8 ? 1 : 0;
    s->falling_code = chosen & 16 ? a->n_codes - 1 : chosen & 32 ? next_count(source, 0, 256) : 0;
}

/* Returns NULL, a mask with one end fixed, or a pattern of bits, some of them invalid. */
static uint8_t *next_fixed(struct source *source, const struct arguments *a)
{
    const uint8_t kind = next_byte(source);
    if (kind < 64 || a->cells == 0) return NULL;
    uint8_t *fixed = exactly(a->cells, 1), pattern[8];
    const uint8_t bits = kind == 255 ? 255 : VOX_FIX_ALL;
    for (size_t i = 0; i < sizeof pattern; i++) pattern[i] = kind < 128 ? 0 : next_byte(source) & bits;
    for (int64_t cell = 0; cell < a->cells; cell++)
        fixed[cell] = kind < 128 ? (cell % a->settings.nx == 0 ? VOX_FIX_ALL : 0) : PICK(pattern, cell);
    return fixed;
}

/* ---- the batch -------------------------------------------------------------------------------------------- */

/* Repeats a pattern of materials and one of phases over each body. */
static void next_body(struct source *source, const struct arguments *a, int64_t body)
{
    uint8_t codes[11];
    double cycles[5];
    const int64_t spread = a->n_codes > 2 ? a->n_codes - 1 : 1;
    const size_t length = 1 + next_byte(source) % sizeof codes;
    for (size_t i = 0; i < length; i++) {
        const uint8_t byte = next_byte(source);
        codes[i] = (uint8_t)(byte < 160 ? spread : byte < 250 ? byte % a->n_codes : byte);
    }
    for (size_t i = 0; i < 5; i++) cycles[i] = next_number(source, -1.0, 1.0);
    for (int64_t cell = 0; cell < a->cells; cell++) {
        a->material[body * a->cells + cell] = codes[(size_t)cell % length];
        a->phases[body * a->cells + cell] = PICK(cycles, cell);
    }
}

static void next_bodies(struct source *source, struct arguments *a)
{
    a->n_bodies = a->cells > MOST_CELLS ? 0 : next_byte(source) % (MOST_BODIES + 1);
    a->n_samples = next_byte(source) % (MOST_SAMPLES + 1);
    a->material = exactly(a->n_bodies * a->cells, 1);
    a->phases = exactly(a->n_bodies * a->cells, sizeof *a->phases);
    for (int64_t body = 0; body < a->n_bodies; body++) next_body(source, a, body);
}

/* Generates ascending steps up to the number of each body; rarely, they do not ascend or exceed it. */
static void next_samples(struct source *source, struct arguments *a, const int64_t *steps)
{
    const bool anything = next_byte(source) > 240;
    a->samples = exactly(a->n_bodies * a->n_samples, sizeof *a->samples);
    for (int64_t body = 0; body < a->n_bodies; body++) {
        int64_t step = -1;
        for (int64_t i = 0; i < a->n_samples; i++) {
            const int64_t last = steps[body] + 1 - a->n_samples + i; /* leaves steps for the other samples */
            const bool ascend = !anything && step >= -1 && step < last;
            const int64_t more = ascend ? 1 + next_byte(source) % (last - step) : next_count(source, 0, 40);
            step = (int64_t)((uint64_t)step + (uint64_t)more); /* may overflow */
            a->samples[body * a->n_samples + i] = step;
        }
    }
}

/* Decodes all arguments except the samples, which depend on the model. */
static struct arguments next_arguments(struct source *source)
{
    struct arguments a = {0};
    const uint8_t fault = next_byte(source);
    a.fault = fault < 224 ? NO_FAULT : (enum fault)(fault % N_FAULTS);
    if (a.fault == MEMORY_FOR_MODEL || a.fault == MEMORY_FOR_BODIES) a.fail_at = next_byte(source) % 24;
    next_palette(source, &a);
    next_canvas(source, &a.settings);
    a.cells = cells_of(&a.settings);
    next_times(source, &a.palette[a.n_codes - 1], &a.settings);
    next_surroundings(source, &a.settings);
    next_dampings(source, &a.settings);
    next_limits(source, &a.settings);
    a.fixed = next_fixed(source, &a);
    a.wanted = next_byte(source) ^ 0xffu;
    next_bodies(source, &a);
    next_additions(source, &a);
    return a;
}

static void arguments_destroy(struct arguments *a)
{
    free(a->palette);
    free(a->fixed);
    free(a->material);
    free(a->phases);
    free(a->samples);
}

#endif
