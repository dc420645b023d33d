/* vox: a soft-body solver for voxels on a lattice.
 *
 * A model (canvas, settings, materials, fixed cells) is created once and is read-only afterwards,
 * so any number of threads may use it at the same time. A call takes a batch of bodies and writes
 * into the caller's buffers. The library prints nothing, has no global state and trusts no input:
 * every call checks its arguments before simulating and returns a status. A body requires memory
 * for its bounding box: about 1000 bytes per cell, 1400 if its materials differ, and more for
 * contacts. A model keeps up to eight bodies, and at most about 32 MiB, for later calls.
 *
 * Units: meter, second, kilogram, pascal, degree; phases in cycles. Arrays over cells have x
 * fastest, then y, then z, and a batch is body after body.
 *
 * This header is read by the C compiler and, without its directive lines, by cffi. For C++, include
 * it inside extern "C".
 */
#ifndef VOX_H
#define VOX_H

#include <stdint.h>

/* Version of this library. The second number increases with every change of the interface or of a
 * bit of the results, the third with all other changes. */
#define VOX_VERSION "0.3.0"

/* Maximum sizes of a model. */
enum {
    VOX_MAX_CELLS = 16777216, /* nx * ny * nz */
    VOX_MAX_CODES = 256       /* material codes, including 0 (empty) */
};

/* Result of a call. Brackets contain the meaning of `culprit`, which is -1 if no single item is at
 * fault. */
enum vox_status {
    VOX_OK = 0,
    VOX_NO_MEMORY,
    VOX_NULL_ARGUMENT,
    /* settings; each is named after its field */
    VOX_BAD_CANVAS,
    VOX_BAD_VOXEL_SIZE,
    VOX_BAD_TIME_STEP_FRACTION,
    VOX_BAD_SUBSTEPS,
    VOX_BAD_STEP_LIMIT,
    VOX_BAD_DURATION,
    VOX_BAD_TEMPERATURE_AMPLITUDE,
    VOX_BAD_PERIOD,
    VOX_BAD_START_TIME,
    VOX_BAD_RAMP,
    VOX_BAD_SMALLEST_SIZE,
    VOX_BAD_LARGEST_SIZE,
    VOX_BAD_GRAVITY,
    VOX_BAD_FLOOR_SLOPE,
    VOX_BAD_FALLING_CODE,
    VOX_BAD_FLUID_DRAG,
    VOX_BAD_BOND_DAMPING,
    VOX_BAD_SLOW_DAMPING,
    VOX_BAD_FLOOR_DAMPING,
    VOX_BAD_CONTACT_DAMPING,
    VOX_BAD_COLLISION_ENVELOPE,
    VOX_BAD_COLLISION_HORIZON,
    VOX_BAD_COLLISION_LIST_FACTOR,
    VOX_BAD_KERNEL,
    VOX_BAD_LARGEST_STRAIN,
    VOX_BAD_LARGEST_DISTANCE,
    /* palette [material code] */
    VOX_BAD_PALETTE,
    VOX_BAD_YOUNGS_MODULUS,
    VOX_BAD_POISSON_RATIO,
    VOX_BAD_DENSITY,
    VOX_BAD_EXPANSION,
    VOX_BAD_STATIC_FRICTION,
    VOX_BAD_DYNAMIC_FRICTION,
    /* fixed cells [cell] */
    VOX_BAD_FIXED,
    /* batch [body] */
    VOX_BAD_BATCH,
    VOX_UNKNOWN_MATERIAL,
    VOX_EMPTY_BODY,
    VOX_BAD_PHASE,
    VOX_BAD_TIME_STEP,
    VOX_TOO_MANY_STEPS,
    VOX_BAD_SAMPLE_ORDER,
    VOX_SAMPLE_OUT_OF_RANGE
};

/* Clamped degrees of freedom of a voxel as bits: translation along, and rotation about, the axes of
 * the world. A clamped rotation receives no torque. */
enum {
    VOX_FIX_X = 1,
    VOX_FIX_Y = 2,
    VOX_FIX_Z = 4,
    VOX_FIX_ROTATION_X = 8,
    VOX_FIX_ROTATION_Y = 16,
    VOX_FIX_ROTATION_Z = 32,
    VOX_FIX_ALL = 63 /* the voxel does not move, but its size follows the actuation */
};

struct vox_settings {
    int64_t nx, ny, nz; /* cells along each axis, each > 0 */
    double voxel_size;  /* lattice edge, m; 1e-6 .. 1e6 */
    /* time */
    double time_step_fraction; /* time step / largest stable one; 0 < . <= 1 */
    int64_t substeps;          /* steps in each such step; 1 .. 1000 */
    double duration;           /* simulated time, s; 0 < . <= 1e9 */
    int64_t step_limit;        /* maximum number of steps of a body; >= 1 */
    /* actuation: strain = expansion * temperature_amplitude * sin(2 pi (t / period + phase)) */
    double temperature_amplitude; /* degrees above the base temperature */
    double period;                /* s; 1e-9 .. 1e9 */
    double start_time;            /* s; 0 .. 1e9; the phase still runs from time 0 */
    double ramp;                  /* s, from the start to full amplitude; 0 .. 1e9 */
    double smallest_size;         /* of a voxel, in lattice edges; 1e-3 .. 1 */
    double largest_size;          /* of a voxel, in lattice edges; 1 .. 10 */
    int32_t size_clamp;           /* 0: a size that would pass a limit keeps its last value; else it
                                     becomes the limit */
    /* environment */
    double gravity;        /* acceleration along z, m/s2; negative is down */
    int32_t floor;         /* 0: none; else the plane z = x tan(floor_slope) */
    double floor_slope;    /* angular degrees; -89 .. 89; the normal force stays vertical */
    int64_t falling_code;  /* the motion of a body ends when a voxel of this material code touches
                              the plane of the floor; 0 .. 255, 0: none */
    double fluid_drag;     /* kg/m3, half the fluid's density times drag coefficient; >= 0 */
    int32_t fluid_by_size; /* surface on which the fluid acts. 0: that of the original engine, a
                              voxel reaches half an edge plus the strain of the bond on each side;
                              else: a voxel reaches half its size */
    /* damping, each as a fraction of critical */
    double bond_damping;    /* >= 0 */
    double slow_damping;    /* of all motion relative to the ground; >= 0 */
    double floor_damping;   /* >= 0 */
    double contact_damping; /* of contacts, limited to what is stable; >= 0 */
    /* contact between voxels */
    int32_t self_collision;       /* 0: voxels pass through each other */
    int32_t contact_friction;     /* 0: none; else the mean of both dynamic frictions */
    int32_t complete_contacts;    /* 0: the original engine's list of contact candidates, which may
                                     be late; else a complete list */
    double collision_envelope;    /* distance of contact, in mean sizes; 1 .. 2 */
    double collision_horizon;     /* reach of the candidate list, in voxel sizes; 1 .. 10. It is
                                     rebuilt when the fastest voxel may have moved by
                                     (horizon - 1) / 2 lattice edges */
    double collision_list_factor; /* the list excludes voxels within floor(factor * horizon) bonds
                                     of each other; the original engine's also excludes those
                                     beyond factor * horizon edges; 1 .. 2 */
    /* computation; all kernels except the scalar one return the same bits, the scalar one differs
     * by rounding */
    int32_t kernel;     /* 0: the fastest for this processor; else a number of
                           vox_kernel_name */
    int32_t whole_body; /* 0: compute only what can affect the samples; else all steps of all
                           voxels; see docs/solver.md, and diverged_step below */
    /* divergence */
    double largest_strain;   /* absolute, of a bond; 0 < . <= 1e9 */
    double largest_distance; /* of a voxel from its start, in longest edges of the canvas;
                                0 < . <= 1e9 */
};

/* Entry of a palette. Its index is the material code; code 0 is an empty cell. */
struct vox_material {
    int32_t used;            /* 0: invalid code, the other fields are ignored */
    double youngs_modulus;   /* Pa; 1e-6 .. 1e18 */
    double poisson_ratio;    /* 0 .. 0.5 */
    double density;          /* kg/m3; 1e-6 .. 1e18 */
    double expansion;        /* linear, per degree; negative: contracts when hot */
    double static_friction;  /* >= 0 */
    double dynamic_friction; /* >= 0 */
};

/* Buffers for the tracks of a batch; NULL omits a track. Values are NaN from the sample at which a
 * body diverged. With S = n_samples: */
struct vox_tracks {
    double *tip;      /* [n_bodies][S][3] m, the last voxel in cell order */
    double *face;     /* [n_bodies][S][3] m, mass-weighted mean of the voxels with the largest
                         initial x */
    double *body;     /* [n_bodies][S][3] m, mass-weighted mean of all voxels */
    double *voxels;   /* [n_bodies][S][cells][3] m, every voxel, NaN in empty cells */
    double *energy;   /* [n_bodies][S][2] J, strain energy of the bonds and kinetic energy */
    double *strain;   /* [n_bodies][S][2] smallest and largest strain of a bond, relative to
                         the lattice edge; 0 without bonds */
    double *momentum; /* [n_bodies][S][6] kg m/s, and kg m2/s about the origin */
};

typedef struct vox_model vox_model;

/* Create a model.
 *
 * `palette` has n_codes entries (1 .. VOX_MAX_CODES). `fixed` has nx*ny*nz entries, the clamped
 * degrees of freedom of the voxel in a cell as bits; NULL clamps nothing. Both are copied. *model
 * is NULL unless VOX_OK is returned. `culprit` may be NULL.
 */
enum vox_status vox_model_create(const struct vox_settings *settings,
                                 const struct vox_material *palette, int32_t n_codes,
                                 const uint8_t *fixed, vox_model **model, int64_t *culprit);

void vox_model_destroy(vox_model *model); /* NULL is allowed */

/* Time step (s) and number of steps of each body: (floor(duration / (substeps * dt)) + 1) *
 * substeps. `dt` or `steps` may be NULL. */
enum vox_status vox_time_steps(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                               double *dt, int64_t *steps, int64_t *culprit);

/* Simulate a batch up to the last sample; with whole_body, to the end of the duration.
 *
 * material      [n_bodies][cells] material codes
 * phase_cycles  [n_bodies][cells] phase lead of each voxel's actuation, cycles, -1e6 .. 1e6;
 *               ignored for materials that do not expand
 * sample_steps  [n_bodies][n_samples] strictly ascending for each body; 0 is the initial state, k
 *               the state after k steps; at most the number of its steps
 * diverged_step [n_bodies] 0, or the step (from 1) at which the body diverged: the step resulted in
 *               a NaN or in a distance beyond largest_distance, or it started with a strain beyond
 *               largest_strain or with twice as many contact candidates as in a lattice without
 *               gaps. Such a body stops; the others are not affected. What is not computed does
 *               not diverge. Unless whole_body is set, voxels that cannot affect a sample are left
 *               out where this saves work and no law forbids it (docs/solver.md).
 * repeated      [n_bodies] 1 if another list of contacts could have affected the samples, so that
 *               the whole body was simulated again, else 0; NULL is allowed
 *
 * A call that fails leaves all buffers unchanged, unless memory runs out in the middle of a batch.
 *
 * From the step at which the motion of a body ends (falling_code), samples repeat its state.
 *
 * The results of a body do not depend on the other bodies in the batch. Samples do not depend on
 * the other samples and tracks that are requested, unless the body diverges.
 */
enum vox_status vox_simulate(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                             const double *phase_cycles, int64_t n_samples,
                             const int64_t *sample_steps, const struct vox_tracks *tracks,
                             int64_t *diverged_step, uint8_t *repeated, int64_t *culprit);

/* Range of a setting, or of a property of a material. */
struct vox_range {
    const char *name;       /* the field of struct vox_settings or struct vox_material */
    enum vox_status status; /* of numbers outside the range */
    int32_t whole;          /* 0: the field is a double; else an int64_t */
    double lower, upper;    /* in the unit of the field; infinite: no bound */
    int32_t lower_included, upper_included; /* 0: excludes the bound */
    const char *words;                      /* text after "must be " in the message of the status */
};

/* Ranges of the settings (except canvas, switches and kernel) and of the properties of a material,
 * numbered from 0; NULL after the last. An expansion must also be finite when multiplied by the
 * temperature amplitude. */
const struct vox_range *vox_setting_range(int32_t number);
const struct vox_range *vox_property_range(int32_t number);

/* Name of a kernel, numbered from 1, the fastest last: empty if this processor does not support it,
 * NULL after the last. */
const char *vox_kernel_name(int32_t number);

/* VOX_VERSION of the linked library, which may differ from the one in this header; never NULL. */
const char *vox_version(void);

/* Name and version of the compiler that built this library; never NULL. */
const char *vox_compiler(void);

/* Description of a status, a sentence without a period; never NULL. */
const char *vox_status_message(enum vox_status status);

#endif
