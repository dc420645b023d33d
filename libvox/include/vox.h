/* vox: a soft-body solver for voxels on a lattice.
 *
 * A model (canvas, settings, materials, fixed cells) is created once and is read-only afterwards,
 * so any number of threads may use one at the same time. A call takes a batch of bodies and writes
 * into the caller's buffers. Nothing is printed, no state is global, and no input is trusted: every
 * call checks its arguments before it simulates anything and says what is wrong with a status. A
 * body takes memory for its bounding box: some 600 bytes for each cell, 1000 if its materials
 * differ, and more for contacts. A model keeps up to eight bodies' memory for later calls.
 *
 * Units: metre, second, kilogram, pascal, degree; phases in cycles. Arrays over cells have x
 * fastest, then y, then z, and a batch is body after body.
 *
 * This header is read by the C compiler and, without its directive lines, by cffi. For C++, include
 * it inside extern "C".
 */
#ifndef VOX_H
#define VOX_H

#include <stdint.h>

/* The one place where the version of this library stands. Its second number rises with whatever
 * changes the interface or a bit of the results, its third with all else. */
#define VOX_VERSION "0.1.0"

/* Largest sizes that a model accepts. */
enum {
    VOX_MAX_CELLS = 16777216, /* nx * ny * nz */
    VOX_MAX_CODES = 256       /* material codes, the code 0 (empty) included */
};

/* What a call has to say. In brackets: what `culprit` is then (-1 if the fault is not one
 * item's). */
enum vox_status {
    VOX_OK = 0,
    VOX_NO_MEMORY,
    VOX_NULL_ARGUMENT,
    /* the settings; each is named after its field */
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
    VOX_BAD_GRAVITY,
    VOX_BAD_FLOOR_SLOPE,
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
    /* the palette [material code] */
    VOX_BAD_PALETTE,
    VOX_BAD_YOUNGS_MODULUS,
    VOX_BAD_POISSON_RATIO,
    VOX_BAD_DENSITY,
    VOX_BAD_EXPANSION,
    VOX_BAD_STATIC_FRICTION,
    VOX_BAD_DYNAMIC_FRICTION,
    /* the fixed cells [cell] */
    VOX_BAD_FIXED,
    /* a batch [body] */
    VOX_BAD_BATCH,
    VOX_UNKNOWN_MATERIAL,
    VOX_EMPTY_BODY,
    VOX_BAD_PHASE,
    VOX_BAD_TIME_STEP,
    VOX_TOO_MANY_STEPS,
    VOX_BAD_SAMPLE_ORDER,
    VOX_SAMPLE_OUT_OF_RANGE
};

/* Degrees of freedom of a voxel that are held, as bits: coordinates, and rotations about the axes
 * of the world, which nothing then sets going. */
enum {
    VOX_FIX_X = 1,
    VOX_FIX_Y = 2,
    VOX_FIX_Z = 4,
    VOX_FIX_ROTATION_X = 8,
    VOX_FIX_ROTATION_Y = 16,
    VOX_FIX_ROTATION_Z = 32,
    VOX_FIX_ALL = 63 /* such a voxel stays where and as it is, but its size follows the actuation */
};

struct vox_settings {
    int64_t nx, ny, nz; /* cells along each axis, each > 0 */
    double voxel_size;  /* lattice edge, m; 1e-6 .. 1e6 */
    /* time */
    double time_step_fraction; /* of the largest stable time step; 0 < . <= 1 */
    int64_t substeps;          /* each such step is made in so many; 1 .. 1000 */
    double duration;           /* simulated time, s; 0 < . <= 1e9 */
    int64_t step_limit;        /* a body that needs more steps is refused; >= 1 */
    /* actuation: expansion * temperature_amplitude * sin(2 pi (t / period + phase)) is the strain
     * of a voxel */
    double temperature_amplitude; /* degrees, the base temperature already subtracted */
    double period;                /* s; 1e-9 .. 1e9 */
    double start_time;            /* s; 0 .. 1e9; the sine runs from time 0 all the same */
    double ramp;                  /* s from the start to the full amplitude; 0 .. 1e9 */
    /* surroundings */
    double gravity;     /* acceleration along z, m/s2; negative is down */
    int32_t floor;      /* 0: there is none; else the plane z = x tan(floor_slope) */
    double floor_slope; /* angular degrees; -89 .. 89; tilts the plane, but not its push */
    double fluid_drag;  /* kg/m3, half the fluid's density times the drag coefficient; >= 0 */
    /* damping, each as a fraction of critical */
    double bond_damping;    /* >= 0 */
    double slow_damping;    /* against the ground, of all motion; >= 0 */
    double floor_damping;   /* >= 0 */
    double contact_damping; /* of voxels that touch, as far as a step can bear it; >= 0 */
    /* contact between voxels */
    int32_t self_collision;       /* 0: bodies pass through themselves */
    int32_t contact_friction;     /* 0: without; else with the mean of both dynamic frictions */
    int32_t complete_contacts;    /* 0: the original engine's list of possible contacts, which may
                                     come late; else one that misses nothing */
    double collision_envelope;    /* voxels touch at this many of their mean sizes; 1 .. 2 */
    double collision_horizon;     /* reach of the list of possible contacts, in voxel sizes; 1 .. 4.
                                     It is made anew when the fastest voxel may have moved by
                                     (horizon - 1) / 2 lattice edges */
    double collision_list_factor; /* the list leaves out voxels within floor(factor * horizon) bonds
                                     of each other, and the original engine's what is beyond
                                     factor * horizon edges; 1 .. 2 */
    /* what computes; all kernels but the scalar one give the same bits, that one the same but for
     * roundings */
    int32_t kernel;     /* 0: the fastest that this processor can use; else a number of
                           vox_kernel_name */
    int32_t whole_body; /* 0: leaves out what no sample can tell, which changes no bit */
    /* what counts as diverged */
    double largest_strain;   /* of a bond, either way; 0 < . <= 1e9 */
    double largest_distance; /* of a voxel from its start, in longest edges of the canvas;
                                0 < . <= 1e9 */
};

/* One entry of a palette. The index in the palette is the material code; code 0 is an empty
 * cell. */
struct vox_material {
    int32_t used;            /* 0: no cell may have this code, and the other fields are ignored */
    double youngs_modulus;   /* Pa; 1e-6 .. 1e18 */
    double poisson_ratio;    /* 0 <= . < 0.5 */
    double density;          /* kg/m3; 1e-6 .. 1e18 */
    double expansion;        /* linear, per degree; negative contracts when hot */
    double static_friction;  /* >= 0 */
    double dynamic_friction; /* >= 0 */
};

/* Where to write the tracks of a batch; NULL for a track that is not wanted. NaN from the sample at
 * which a body diverged. With S = n_samples: */
struct vox_tracks {
    double *tip;      /* [n_bodies][S][3] m, the last occupied voxel in cell order */
    double *face;     /* [n_bodies][S][3] m, mass-weighted mean of the voxels with the largest
                         initial x */
    double *body;     /* [n_bodies][S][3] m, mass-weighted mean of all voxels */
    double *voxels;   /* [n_bodies][S][cells][3] m, every voxel, NaN in empty cells */
    double *energy;   /* [n_bodies][S][2] J, strain energy of the bonds, and kinetic energy */
    double *strain;   /* [n_bodies][S][2] least and greatest strain of the bonds (of lattice
                         edges), 0 without */
    double *momentum; /* [n_bodies][S][6] kg m/s, and kg m2/s about the origin */
};

typedef struct vox_model vox_model;

/* Create a model.
 *
 * `palette` has n_codes entries (1 .. VOX_MAX_CODES). `fixed` has nx*ny*nz entries, the bits of the
 * degrees of freedom that a voxel there has not; NULL fixes nothing. Both are copied. *model is
 * NULL unless VOX_OK is returned. `culprit` may be NULL.
 */
enum vox_status vox_model_create(const struct vox_settings *settings,
                                 const struct vox_material *palette, int32_t n_codes,
                                 const uint8_t *fixed, vox_model **model, int64_t *culprit);

void vox_model_destroy(vox_model *model); /* NULL is fine */

/* Time step (s) and number of steps of each body: (floor(duration / (substeps * dt)) + 1) *
 * substeps. `dt` or `steps` may be NULL. */
enum vox_status vox_time_steps(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                               double *dt, int64_t *steps, int64_t *culprit);

/* Simulate a batch to the end of the duration.
 *
 * material      [n_bodies][cells] material codes
 * phase_cycles  [n_bodies][cells] phase lead of each voxel's actuation, cycles, at most 1e6 either
 *               way; of no matter where the material does not expand
 * sample_steps  [n_bodies][n_samples] strictly ascending for each body; 0 is the initial state, k
 *               the state after k steps; at most the number of its steps
 * diverged_step [n_bodies] 0, or the step (from 1) at which the body diverged: a NaN, or a distance
 *               beyond the settings that the step led to; a strain beyond the settings, or twice as
 *               many possible contacts as a lattice without gaps has, that the step began with.
 *               Such a body stops; the others do not notice.
 *
 * What is refused leaves all buffers as they were, except that memory may run out in the middle of
 * a batch.
 *
 * The results of a body depend on nothing else in the batch, nor on which samples and tracks are
 * asked for.
 */
enum vox_status vox_simulate(const vox_model *model, int64_t n_bodies, const uint8_t *material,
                             const double *phase_cycles, int64_t n_samples,
                             const int64_t *sample_steps, const struct vox_tracks *tracks,
                             int64_t *diverged_step, int64_t *culprit);

/* What a setting, or a property of a material, may be. */
struct vox_range {
    const char *name;       /* the field of struct vox_settings or struct vox_material */
    enum vox_status status; /* of any other number */
    int32_t whole;          /* 0: the field is a double; else an int64_t */
    double lower, upper;    /* in the unit of the field; infinite if there is no bound */
    int32_t lower_included, upper_included; /* 0: the number must not be the bound itself */
    const char *words; /* what stands after "must be " in the message of the status */
};

/* Ranges of the settings but for canvas, switches and kernel, and of the properties of a material,
 * from number 0 up; NULL after the last. An expansion must also be finite when multiplied by the
 * temperature's amplitude. */
const struct vox_range *vox_setting_range(int32_t number);
const struct vox_range *vox_property_range(int32_t number);

/* Name of a kernel, from number 1 up, the fastest last: empty if this processor cannot use it, NULL
 * after the last. */
const char *vox_kernel_name(int32_t number);

/* VOX_VERSION of the library that is linked, which may not be the one of this header; never
 * NULL. */
const char *vox_version(void);

/* Name and version of the compiler that made this library; never NULL. */
const char *vox_compiler(void);

/* A sentence without a full stop; never NULL. */
const char *vox_status_message(enum vox_status status);

#endif
