/* vox: a soft-body solver for voxels on a lattice.
 *
 * A model (canvas, settings, materials, clamped cells) is created once and is read-only afterwards, so any number
 * of threads may use one at the same time. A call takes a batch of bodies and writes into the caller's buffers.
 * Nothing is printed, no state is global, and no input is trusted: every call checks its arguments before it
 * simulates anything and says what is wrong with a status.
 *
 * Units: metre, second, kilogram, pascal, degree; phases in cycles. Arrays over cells have x fastest, then y, then
 * z, and a batch is body after body.
 *
 * This header is read by the C compiler and, without its directive lines, by cffi. For C++, include it inside
 * extern "C".
 */
#ifndef VOX_H
#define VOX_H

#include <stdint.h>

/* Largest sizes that a model accepts. */
enum {
    VOX_MAX_CELLS = 16777216, /* nx * ny * nz */
    VOX_MAX_CODES = 256       /* material codes, the code 0 (empty) included */
};

/* What a call has to say. In brackets: what `culprit` is then (-1 if the fault is not one item's). */
enum vox_status {
    VOX_OK = 0,
    VOX_NO_MEMORY,
    VOX_NULL_ARGUMENT,
    /* the settings; each is named after its field */
    VOX_BAD_CANVAS,
    VOX_BAD_VOXEL_SIZE,
    VOX_BAD_TIME_STEP_FRACTION,
    VOX_BAD_DURATION,
    VOX_BAD_TEMPERATURE_AMPLITUDE,
    VOX_BAD_PERIOD,
    VOX_BAD_BOND_DAMPING,
    VOX_BAD_SLOW_DAMPING,
    VOX_BAD_COLLISION_HORIZON,
    VOX_BAD_COLLISION_LIST_FACTOR,
    /* the palette [material code] */
    VOX_BAD_PALETTE,
    VOX_BAD_YOUNGS_MODULUS,
    VOX_BAD_POISSON_RATIO,
    VOX_BAD_DENSITY,
    VOX_BAD_EXPANSION,
    /* a batch [body] */
    VOX_BAD_BATCH,
    VOX_UNKNOWN_MATERIAL,
    VOX_EMPTY_BODY,
    VOX_BAD_PHASE,
    VOX_BAD_TIME_STEP,
    VOX_BAD_SAMPLE_ORDER,
    VOX_SAMPLE_OUT_OF_RANGE
};

struct vox_settings {
    int64_t nx, ny, nz;            /* cells along each axis, each > 0 */
    double voxel_size;             /* lattice edge, m; 1e-6 .. 1e6 */
    double time_step_fraction;     /* of the largest stable time step; 0 < . <= 1 */
    double duration;               /* simulated time, s; > 0 */
    double temperature_amplitude;  /* degrees, the base temperature already subtracted */
    double period;                 /* of the actuation, s; > 0 */
    double bond_damping;           /* fraction of critical; >= 0 */
    double slow_damping;           /* against the ground, fraction of critical; >= 0 */
    int32_t self_collision;        /* 0: bodies pass through themselves */
    double collision_horizon;      /* reach of the list of possible contacts, in voxel sizes; 1 .. 4 */
    double collision_list_factor;  /* the list reaches at most factor * horizon lattice edges, and leaves out voxels
                                      within floor(factor * horizon) bonds of each other; 1 .. 2 */
};

/* One entry of a palette. The index in the palette is the material code; code 0 is an empty cell. */
struct vox_material {
    int32_t used;           /* 0: no cell may have this code, and the other fields are ignored */
    double youngs_modulus;  /* Pa; > 0 */
    double poisson_ratio;   /* 0 <= . < 0.5 */
    double density;         /* kg/m3; > 0 */
    double expansion;       /* linear, per degree; negative contracts when hot */
};

/* Where to write the tracks of a batch; NULL for a track that is not wanted. Positions in m; NaN from the sample at
 * which a body diverged. With S = n_samples: */
struct vox_tracks {
    double *tip;     /* [n_bodies][S][3]        the last occupied voxel in cell order */
    double *face;    /* [n_bodies][S][3]        mass-weighted mean of the voxels with the largest initial x */
    double *body;    /* [n_bodies][S][3]        mass-weighted mean of all voxels */
    double *voxels;  /* [n_bodies][S][cells][3] every voxel, NaN in empty cells */
};

typedef struct vox_model vox_model;

/* Create a model.
 *
 * `palette` has n_codes entries (1 .. VOX_MAX_CODES). `clamped` has nx*ny*nz entries, non-zero where a voxel is held
 * with all its six degrees of freedom; NULL clamps nothing. Both are copied. *model is NULL unless VOX_OK is
 * returned. `culprit` may be NULL.
 */
enum vox_status vox_model_create(const struct vox_settings *settings, const struct vox_material *palette,
                                 int32_t n_codes, const uint8_t *clamped, vox_model **model, int64_t *culprit);

void vox_model_destroy(vox_model *model); /* NULL is fine */

/* Time step (s) and number of steps of each body: steps = floor(duration / dt) + 1. `dt` or `steps` may be NULL. */
enum vox_status vox_time_steps(const vox_model *model, int64_t n_bodies, const uint8_t *material, double *dt,
                               int64_t *steps, int64_t *culprit);

/* Simulate a batch to the end of the duration.
 *
 * material      [n_bodies][cells] material codes
 * phase_cycles  [n_bodies][cells] phase lead of each voxel's actuation, cycles, at most 1e6 either way; read only
 *               where the material expands
 * sample_steps  [n_samples] strictly ascending; 0 is the initial state, k the state after k steps; no body has
 *               fewer steps than the last
 * diverged_step [n_bodies] 0, or the step (from 1) at which the body diverged: a bond stretched by more than 100
 *               lattice edges, a voxel further than 100 times the canvas's longest edge from where it started, a
 *               NaN, or more possible contacts than min(m(m-1)/2, 256 m) for m surface voxels. Such a body stops;
 *               the others do not notice.
 *
 * The results of a body depend on nothing else in the batch, nor on which samples and tracks are asked for.
 */
enum vox_status vox_simulate(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                             const double *phase_cycles, int64_t n_samples, const int64_t *sample_steps,
                             const struct vox_tracks *tracks, int64_t *diverged_step, int64_t *culprit);

/* A sentence without a full stop; never NULL. */
const char *vox_status_message(enum vox_status status);

#endif
