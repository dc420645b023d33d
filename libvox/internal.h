/* What the files of the solver share: vectors, quaternions, the derived constants and the state of one body.
 * Section numbers are those of docs/physics.md. */
#ifndef VOX_INTERNAL_H
#define VOX_INTERNAL_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vox.h"

#if SIZE_MAX < 0xffffffffffffffffu
#error "libvox computes the sizes of its arrays with 64 bits"
#endif

/* Inlined wherever it is called: part of a loop over all bonds or contacts. */
#ifdef __GNUC__
#define IN_LOOP static inline __attribute__((always_inline))
#else
#define IN_LOOP static inline
#endif

/* ---- vectors and quaternions ------------------------------------------------------------------------------ */

struct vec {
    double x, y, z;
};

struct quat {
    double w, x, y, z;
};

static inline struct vec vec_add(struct vec a, struct vec b)
{
    return (struct vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec vec_sub(struct vec a, struct vec b)
{
    return (struct vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec vec_scale(double k, struct vec a)
{
    return (struct vec){k * a.x, k * a.y, k * a.z};
}

static inline double vec_dot(struct vec a, struct vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec vec_cross(struct vec a, struct vec b)
{
    return (struct vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline struct quat quat_conj(struct quat q)
{
    return (struct quat){q.w, -q.x, -q.y, -q.z};
}

static inline struct quat quat_mul(struct quat a, struct quat b)
{
    return (struct quat){
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
    };
}

/* q v q*: rotates, and scales by |q|^2. */
static inline struct vec quat_rotate(struct quat q, struct vec v)
{
    const struct vec axis = {q.x, q.y, q.z};
    const struct vec along = vec_scale(2.0 * vec_dot(axis, v), axis);
    const struct vec across = vec_scale(2.0 * q.w, vec_cross(axis, v));
    return vec_add(vec_scale(q.w * q.w - vec_dot(axis, axis), v), vec_add(along, across));
}

/* A voxel's size stays within these (section 4), in lattice edges. */
#define SMALLEST_SCALE 0.1
#define LARGEST_SCALE 3.0

/* ---- constants of a model --------------------------------------------------------------------------------- */

/* A voxel of one material (sections 1, 4, 6 and 9). */
struct substance {
    double youngs_modulus;   /* Pa */
    double poisson_ratio;
    double mass;             /* kg */
    double inertia;          /* kg m2 */
    double strain_amplitude; /* of the actuation */
    double slow_drag;        /* N s/m */
    double slow_spin_rate;   /* 1/s, share of the angular momentum lost to slow damping */
    double floor_stiffness;  /* N/m */
    double floor_drag;       /* N s/m */
    double static_friction, dynamic_friction;
};

/* Damping of one end of a bond (section 6). */
struct damper {
    double stretch, shear, bend_shear;    /* N s/m, N s/m, N s */
    double moment_shear, bend, twist;     /* N s, N m s, N m s */
};

/* A bond between two materials, the lower-indexed voxel's first (sections 5 and 6). */
struct coupling {
    double stretch;    /* a1, N/m */
    double twist;      /* a2, N m */
    double shear;      /* b1, N/m */
    double bend_shear; /* b2, N */
    double bend;       /* b3, N m */
    struct damper lower, upper;
    double fastest;    /* larger of stretch / mass of the two ends, 1/s2 */
    double touch_drag; /* N s/m, of voxels that touch */
    double touch_friction;
};

struct vox_model {
    struct vox_settings settings;
    int64_t cells;
    double rest_scale;           /* size / lattice edge without actuation: the edge was rounded to single precision */
    double largest_size;         /* m, of any voxel at any time */
    double too_far;              /* m, a voxel further from its start has diverged */
    double floor_rise;           /* of the floor along x, m/m */
    int16_t of_code[VOX_MAX_CODES]; /* index into substances, or -1 */
    int32_t n_substances;
    struct substance *substances;
    struct coupling *couplings;  /* [n_substances][n_substances] */
    uint8_t *fixed;              /* [cells] */
};

static inline const struct coupling *coupling_of(const vox_model *model, const struct substance *lower,
                                                 const struct substance *upper)
{
    return &model->couplings[(lower - model->substances) * model->n_substances + (upper - model->substances)];
}

/* ---- one body --------------------------------------------------------------------------------------------- */

/* Number of things in a body, and its clock; found without building it. */
struct census {
    int64_t n_voxels;
    int64_t n_bonds;
    double dt;     /* s */
    int64_t steps; /* to the end of the duration */
};

struct voxel {
    struct vec position;     /* m */
    struct quat orientation; /* unit */
    double size;             /* m, of the step before */
    struct vec force;        /* N, of bonds, contacts and fluid in this step */
    struct vec torque;       /* N m */
    struct vec momentum;     /* kg m/s */
    struct vec spin;         /* kg m2/s, angular momentum in the world frame */
    struct vec start;        /* m, initial position */
    double phase;            /* cycles */
    const struct substance *substance;
    int32_t cell;            /* index in the canvas */
    int32_t touching;        /* voxels that it touches in this step, if they are damped or rub */
    uint8_t fixed;           /* degrees of freedom that it has not */
};

static inline struct vec velocity_of(const struct voxel *voxel)
{
    return vec_scale(1.0 / voxel->substance->mass, voxel->momentum);
}

enum axis { AXIS_X, AXIS_Y, AXIS_Z };

struct bond {
    int32_t lower, upper; /* voxels; the bond points from lower to upper, along +axis */
    enum axis axis;
    bool small;           /* which of the two frames (section 5) */
    const struct coupling *coupling;
    struct vec stretch;   /* m, of the last step on which the frame did not change; likewise */
    struct vec turn_lower, turn_upper; /* rad */
};

struct contact {
    int32_t first, second; /* voxels, first < second */
    const struct coupling *coupling;
};

/* A voxel that may touch another. */
struct skin {
    int32_t voxel;
    int64_t near_begin, near_end; /* range of contacts.near: voxels too close along bonds to collide with it */
    double along;                 /* m, position along the canvas's longest axis; the skin is sorted by it */
};

struct contacts {
    int64_t n_skin;
    struct skin *skin;
    int32_t *near;
    int32_t *stamp;       /* [n_voxels] the last voxel near which this one was found */
    int64_t capacity, n;
    struct contact *list;
    double travelled;     /* lattice edges, of the fastest voxel since the list was made */
    enum axis longest;
};

/* A face of a voxel that is exposed to the fluid. */
struct facet {
    int32_t voxel;
    int32_t corners[4]; /* counter-clockwise, seen from outside */
};

/* The outer surface of a body: where voxels meet, their corners are one. */
struct surface {
    int64_t n_corners, n_facets;
    int32_t (*corners_of)[8]; /* [n_voxels] of the corner (x, y, z), each 0 or 1, at x + 2 y + 4 z; -1 within */
    double *share;            /* [n_corners] 1 / number of voxels that meet there */
    struct vec *corners;      /* [n_corners] m */
    struct facet *facets;
};

struct body {
    const vox_model *model;
    struct census census;
    struct voxel *voxels;
    struct bond *bonds;
    int32_t *voxel_in; /* [cells] index of the voxel, or -1 */
    int32_t (*bonded)[6]; /* [n_voxels] voxels bonded to each along -x, +x, -y, +y, -z, +z, or -1 */
    struct contacts contacts;
    struct surface surface;
    double time;       /* s */
    double top_speed;  /* m/s, after the step before */
};

/* body.c */

/* Checks the material codes of a body and counts what it is made of. */
enum vox_status body_census(const vox_model *model, const uint8_t *material, struct census *census);

/* The body at rest at time 0. To be destroyed in any case. */
enum vox_status body_create(struct body *body, const vox_model *model, const struct census *census,
                            const uint8_t *material, const double *phase_cycles);
void body_destroy(struct body *body);

/* Index of the cell one further along an axis (upwards or not), or -1 at the end of the canvas. */
int64_t cell_beside(const vox_model *model, int64_t cell, enum axis axis, bool upwards);

/* bond.c */

/* Adds the forces and torques of all bonds to their voxels. `per_second` is 1/dt, or 0 on the first step, which has no
 * rates yet. False if a bond has diverged. */
bool bonds_apply(struct body *body, double per_second);

/* What the bonds store, and how far they are stretched. */
struct tension {
    double energy;         /* J */
    double least, greatest; /* strain */
};
struct tension bonds_tension(const struct body *body);

/* contact_list.c */

enum vox_status contacts_create(struct body *body);
void contacts_destroy(struct contacts *contacts);

/* Makes the list of possible contacts anew where that is due; false if they do not fit. */
bool contacts_refresh(struct body *body, bool first_step);

/* contact_force.c */

/* Adds the forces of all contacts to their voxels. */
void contacts_apply(struct body *body);

/* surface.c */

enum vox_status surface_create(struct body *body);
void surface_destroy(struct surface *surface);

/* fluid.c */

/* Adds the drag of the fluid to the voxels at the surface. */
void fluid_apply(struct body *body);

/* floor.c */

/* Adds the push and the friction of the floor to the force on a voxel, which has all others already; a voxel that
 * sticks loses its lateral momentum. */
struct vec floor_apply(const vox_model *model, struct voxel *voxel, struct vec force, double dt);

/* motion.c */

/* Moves every voxel by one time step under the forces that were added to it. False if one has diverged. */
bool voxels_advance(struct body *body);

/* sample.c */

/* Writes one sample of every track that is wanted; `row` counts the samples of the whole batch. */
void sample_write(const struct body *body, const struct vox_tracks *tracks, int64_t row);

/* Writes that there is nothing. */
void sample_write_nothing(const vox_model *model, const struct vox_tracks *tracks, int64_t begin, int64_t end);

#endif
