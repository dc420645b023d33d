/* Declarations shared by the files of the solver: derived constants and the state of a body.
 * Section numbers refer to docs/physics.md. Symbols with external linkage start with vox_. */
#ifndef VOX_INTERNAL_H
#define VOX_INTERNAL_H

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "contacts/contacts.h"
#include "vectors.h"
#include "vox.h"

#if SIZE_MAX < 0xffffffffffffffffu
#error "libvox computes the sizes of its arrays with 64 bits"
#endif

/* For the actuation: the engine's value, in single precision (section 4). */
#define TWO_PI 6.283185005187988

/* Limits between a bond's two frames (section 5), with hysteresis: a bond leaves the small frame at
 * a larger deformation than it returns to it. */
#define SMALL_COSINE 0.9999625024343469 /* cos(0.01732 / 2) */
#define LARGE_COSINE 0.9999546280051071 /* cos(1.1 * 0.01732 / 2) */
#define SMALL_TURN 0.05
#define LARGE_TURN 0.055
#define SMALL_EXTENSION 1.30
#define LARGE_EXTENSION 1.43

/* Limits of the engine's formulas for small angles (section 5). */
#define SLOPE_OF_SMALL_TURN 0.01732
#define COSINE_OF_SMALL_ROTATION 0.9988

enum axis { AXIS_X, AXIS_Y, AXIS_Z };

/* ---- constants of a model -------------------------------------------------------------------- */

/* Constants of a voxel made of one material (sections 1, 4, 6 and 9). */
struct substance {
    double youngs_modulus; /* Pa */
    double poisson_ratio;
    double mass;             /* kg */
    double inertia;          /* kg m2 */
    double strain_amplitude; /* of the actuation */
    double slow_drag;        /* N s/m */
    double slow_spin_rate;   /* 1/s, relative loss of angular momentum to slow damping */
    double floor_stiffness;  /* N/m */
    double floor_drag;       /* N s/m */
    double static_friction, dynamic_friction;
};

/* The constants of the bond law (sections 5 and 6), each as FIELD(name): used for structs of
 * numbers, for structs of arrays, and in loops over slots. */
#define STIFFNESSES(FIELD)          \
    FIELD(stretch)    /* a1, N/m */ \
    FIELD(twist)      /* a2, N m */ \
    FIELD(shear)      /* b1, N/m */ \
    FIELD(bend_shear) /* b2, N */   \
    FIELD(bend)       /* b3, N m */
#define DAMPINGS(FIELD, end)            \
    FIELD(end stretch)      /* N s/m */ \
    FIELD(end shear)        /* N s/m */ \
    FIELD(end bend_shear)   /* N s */   \
    FIELD(end moment_shear) /* N s */   \
    FIELD(end bend)         /* N m s */ \
    FIELD(end twist)        /* N m s */
#define BOND_LAW(FIELD)     \
    STIFFNESSES(FIELD)      \
    DAMPINGS(FIELD, lower.) \
    DAMPINGS(FIELD, upper.)

#define NUMBER(field) double field;

/* Damping at one end of a bond. */
struct damper {
    DAMPINGS(NUMBER, )
};

/* Constants of a bond between two materials; the lower-indexed voxel's is the first. */
struct coupling {
    STIFFNESSES(NUMBER)
    struct damper lower, upper;
    /* the bond law ends here */
    double fastest;    /* larger of stretch / mass of the two ends, 1/s2 */
    double touch_drag; /* N s/m, of contacts */
    double touch_friction;
};

#undef NUMBER
#define ARRAY(field) double *field;

/* The bond law of each slot. */
struct damper_arrays {
    DAMPINGS(ARRAY, )
};

struct coupling_arrays {
    STIFFNESSES(ARRAY)
    struct damper_arrays lower, upper;
};

#undef ARRAY

struct kernel;

/* Bodies that are not in use. They are kept for calls with the same materials, since elites and
 * collaborators of an evolution recur, and then for their memory. */
#define MOST_SPARES 8

struct spares {
    atomic_flag busy; /* a thread uses this struct */
    int64_t n;
    struct body *bodies[MOST_SPARES]; /* the least recently used one first */
};

struct vox_model {
    struct vox_settings settings;
    const struct kernel *kernel;
    struct spares *spares; /* the only part that changes */
    int64_t cells;
    double rest_scale;              /* size / lattice edge without actuation: the edge is rounded to
                                       single precision */
    double largest_size;            /* m, of any voxel at any time */
    double fastest;                 /* 1/s2, maximum over the couplings */
    double too_far;                 /* m, distance from the start that counts as diverged */
    double floor_rise;              /* slope of the floor along x, m/m */
    enum axis order[3];             /* of slots: from the axis along which neighbors have successive
                                       slots to the one along which they are farthest apart */
    struct vicinity vicinity;       /* connected voxels in it do not collide */
    int16_t of_code[VOX_MAX_CODES]; /* index into substances, or -1 */
    int32_t n_substances;
    struct substance *substances;
    struct coupling *couplings; /* [n_substances][n_substances] */
    uint8_t *fixed;             /* [cells] */
    int64_t largest2;           /* square of the largest distance of a near pair, edges */
    uint8_t *steps_across;      /* [largest2 + 1] difference of the depths of a near pair, by the
                                   square of its distance */
};

/* ---- one body -------------------------------------------------------------------------------- */

/* Counts, bounding box and clock of a body; determined without building it. */
struct census {
    int64_t n_voxels;
    int64_t n_bonds;
    int64_t from[3], length[3]; /* cells, along each axis */
    double dt;                  /* s */
    int64_t steps;              /* to the end of the duration */
};

/* Arrays over the slots of a body: the cells of its box in the order of the model, followed by
 * padding slots, which are treated as empty cells. Empty slots contain finite numbers without
 * effect on results. No result depends on the order: voxels, bonds and contacts are summed up in
 * the order of cells, x fastest, then y, then z. */
struct vecs {
    double *x, *y, *z;
};

struct quats {
    double *w, *x, *y, *z;
};

static inline struct vec vec_at(struct vecs a, int64_t i)
{
    return (struct vec){a.x[i], a.y[i], a.z[i]};
}

static inline void vec_put(struct vecs a, int64_t i, struct vec v)
{
    a.x[i] = v.x;
    a.y[i] = v.y;
    a.z[i] = v.z;
}

static inline struct quat quat_at(struct quats a, int64_t i)
{
    return (struct quat){a.w[i], a.x[i], a.y[i], a.z[i]};
}

static inline void quat_put(struct quats a, int64_t i, struct quat q)
{
    a.w[i] = q.w;
    a.x[i] = q.x;
    a.y[i] = q.y;
    a.z[i] = q.z;
}

/* Number of slots that kernels process at a time, in groups that are computed together. */
#define TILE 32
#define GROUP 8

/* Depth of a voxel (cone.c): the number of steps after which its motion can first affect a sample.
 * In each step, voxels and bonds up to a depth are computed. */
#define UNREACHED INT32_MAX /* of a voxel that no sample depends on */
#define ABSENT HUGE_VAL     /* of an empty slot, and of a voxel that is not free to move */
#define WHOLE_BODY 1e300    /* limit of the depth that includes all voxels and bonds */
#define LONGEST_PAIR 4      /* largest difference of the depths of two voxels that are near */
#define SPACE 2 /* largest difference of the depths of neighboring cells, if voxels collide */

/* Constants and state of the voxels. */
struct voxels {
    struct vecs position;              /* m */
    struct quats orientation;          /* unit */
    double *size;                      /* m, of the previous step */
    struct vecs force;                 /* N, from bonds, contacts and fluid in this step */
    struct vecs torque;                /* N m */
    struct vecs momentum;              /* kg m/s */
    struct vecs spin;                  /* kg m2/s, angular momentum in the world frame */
    struct vecs start;                 /* m, initial position */
    double *phase;                     /* cycles */
    double *phase_sine, *phase_cosine; /* of this angle */
    double *amplitude;                 /* strain, of the actuation */
    double *mobility;                  /* 1/kg, the inverse of the mass */
    double *drag_rate;                 /* 1/s, slow damping of the momentum */
    double *weight;                    /* N, along z */
    double *turnability;               /* 1/(kg m2), the inverse of the inertia */
    double *spin_kept;  /* ratio of the spin after and before slow damping in a step */
    double *depth;      /* of a free voxel; ABSENT if a degree of freedom is clamped */
    uint8_t *substance; /* index */
    uint8_t *fixed;     /* clamped degrees of freedom */
    int32_t *touching;  /* scratch: number of current contacts, if damped or with friction */
};

/* The bonds along one axis. Arrays over slots are indexed by a bond's lower end, from which it
 * points along +axis. */
struct bonds {
    int64_t n;
    int32_t *lower;                  /* [n] slots, in the order of cells */
    int64_t step;                    /* slots from the lower to the upper end */
    double *depth;                   /* of the end with the lower depth; ABSENT without a bond */
    double *small;                   /* 1 in the small frame (section 5), 0 in the large one */
    struct vecs stretch;             /* m, at the last step without a change of frame; as below */
    double *lower_y, *lower_z;       /* rad, turn of the lower end */
    struct vecs upper;               /* rad, turn of the upper end */
    struct coupling_arrays coupling; /* of each bond, unless all are equal */
    struct vecs pull, wrench; /* N and N m, on the upper end, with the opposite sign; 0 without
                                 a bond. Also before the first slot, by `step` slots. */
    double *group_depth;      /* lowest of the bonds in a group of slots */
};

/* `bonded` of a voxel with a bond on every side. */
#define ALL_SIDES 63

/* A face of a voxel that is exposed to the fluid. */
struct facet {
    int32_t slot;
    int32_t corners[4]; /* counter-clockwise, seen from outside */
};

/* Reach of a voxel from its center to its faces, m: toward the lower and the upper neighbor along
 * each axis. */
struct reach {
    double lower[3], upper[3];
};

/* The outer surface of a body; adjacent voxels share corners. */
struct surface {
    int64_t n_corners, n_facets;
    /* [slots] corner (x, y, z), each 0 or 1, is at x + 2 y + 4 z; -1 if not on the surface */
    int32_t (*corners_of)[8];
    double *share;       /* [n_corners] 1 / number of voxels that share the corner */
    struct vec *corners; /* [n_corners] m */
    struct facet *facets;
    struct reach *reach; /* [slots] */
};

/* Arrays of the state: 13 of the voxels, and 9 of the bonds along each axis. */
#define N_STATE (13 + 3 * 9)

/* The state after the first step, which all controllers of a body have in common. */
struct first {
    double limit; /* of the depth of what was computed in this step; -1 if it is not known */
    double top_speed, farthest;
    bool moved[N_STATE]; /* whether an array is not as at rest */
    double *numbers[N_STATE];
};

/* Points whose positions are recorded; a sum of these bits. */
enum sources { SOURCE_TIP = 1, SOURCE_FACE = 2, SOURCE_ALL = 4, SOURCE_UNKNOWN = 8 };

struct body {
    const vox_model *model;
    struct census census;
    int64_t n_slots, n_tiles;
    int64_t n_padded; /* slots with the padding after the box, where a tile may have upper ends */
    int32_t (*coordinates)[3]; /* of each slot in the box */
    int64_t step[3];           /* slots between neighboring cells along each axis */
    int32_t *slots;            /* [n_voxels] slots of the voxels, in the order of cells */
    int32_t *cells;            /* [n_voxels] cells of the voxels in the canvas, ascending */
    /* Indices of the cells of the box, x fastest, with empty cells between the rows and layers, so
     * that no near cell is in another row. */
    int64_t n_box_cells, row[3];
    int32_t *slot_of;  /* [n_box_cells] */
    uint8_t *occupied; /* 1 if the slot has a voxel */
    uint8_t *bonded;   /* bits of the sides with a bond: -x, +x, -y, +y, -z, +z */
    struct voxels voxels;
    struct bonds bonds[3];           /* along each axis */
    const struct coupling *coupling; /* of all bonds; NULL if they differ */
    int32_t *depth;                  /* [slots] of a voxel, also of one that is clamped */
    double *group_depth;             /* lowest of the voxels in a group of slots */
    enum sources sources;            /* of the depths */
    int32_t *ring;                   /* [slots] scratch */
    uint8_t *queued;                 /* [slots] scratch, 0 */
    int64_t n_partly; /* number of voxels that are clamped in some degrees of freedom only */
    int32_t *partly;  /* their slots, in the order of cells */
    struct contacts contacts;
    struct surface surface;
    struct first first;
    void *memory;       /* of all arrays except those of contacts and surface */
    size_t memory_size; /* bytes */
    uint8_t *material;  /* [cells of the canvas] from which the body was built */
    bool complete;      /* whether it was */
    double time;        /* s */
    double top_speed;   /* m/s, after the previous step */
    double farthest;    /* m, largest distance of a voxel from its start so far */
};

static inline const struct substance *substance_of_voxel(const struct body *body, int64_t slot)
{
    return &body->model->substances[body->voxels.substance[slot]];
}

static inline const struct coupling *coupling_of(const struct body *body, int64_t lower,
                                                 int64_t upper)
{
    const vox_model *model = body->model;
    const uint8_t *substance = body->voxels.substance;
    return &model->couplings[substance[lower] * model->n_substances + substance[upper]];
}

/* Return a force with slow damping and weight added. */
IN_LOOP struct vec loaded(struct vec force, double drag_rate, struct vec momentum, double weight)
{
    return (struct vec){force.x - drag_rate * momentum.x, force.y - drag_rate * momentum.y,
                        (force.z - drag_rate * momentum.z) + weight};
}

/* Return the depth of a voxel below the plane of the floor, m; negative above it. */
IN_LOOP double depth_in_floor(double size, double x, double z, double rise)
{
    return 0.5 * size - z + rise * x;
}

static inline double floor_depth(const struct body *body, int64_t slot)
{
    const struct voxels *v = &body->voxels;
    return depth_in_floor(v->size[slot], v->position.x[slot], v->position.z[slot],
                          body->model->floor_rise);
}

/* Return the index of a slot's cell in the box. */
static inline int64_t box_cell(const struct body *body, int64_t slot)
{
    const int32_t *at = body->coordinates[slot];
    return at[0] + body->row[1] * at[1] + body->row[2] * at[2];
}

/* Return the square of the distance of two voxels at rest, in edges. */
static inline int64_t start_distance2(const struct body *body, struct pair pair)
{
    int64_t distance2 = 0;
    for (int axis = 0; axis < 3; axis++) {
        const int64_t by =
            body->coordinates[pair.second][axis] - body->coordinates[pair.first][axis];
        distance2 += by * by;
    }
    return distance2;
}

/* Return the neighbor of a slot along an axis, or -1 if it is outside the box. */
static inline int64_t slot_beside(const struct body *body, int64_t slot, enum axis axis,
                                  bool upwards)
{
    if (body->coordinates[slot][axis] == (upwards ? body->census.length[axis] - 1 : 0)) return -1;
    return upwards ? slot + body->step[axis] : slot - body->step[axis];
}

static inline struct vec velocity_of(const struct voxels *v, int64_t slot)
{
    return vec_scale(v->mobility[slot], vec_at(v->momentum, slot));
}

/* ranges.c */

/* Return the status of the first number that is out of range. */
enum vox_status vox_settings_check(const struct vox_settings *settings);
enum vox_status vox_properties_check(const struct vox_material *material);

/* Describe a status of these functions; return NULL for any other status. */
const char *vox_range_message(enum vox_status status);

/* body.c */

/* Check the material codes of a body and determine its census. */
enum vox_status vox_body_census(const vox_model *model, const uint8_t *material,
                                struct census *census);

/* Build a body from materials; memory that is large enough is reused. */
enum vox_status vox_body_shape(struct body *body, const vox_model *model,
                               const struct census *census, const uint8_t *material);
/* state.c */

/* Reset the body to rest at time 0. */
void vox_body_rest(struct body *body);

/* Set the phases of the actuation, in cycles, for each cell of the canvas. */
void vox_body_actuate(struct body *body, const double *phase_cycles);

/* Keep the state after the first step, of voxels up to a depth. */
void vox_first_keep(struct body *body, double limit);

/* Make the first step from the state that was kept. */
void vox_first_make(struct body *body, double limit);

/* spares.c */

/* Return a body, if possible one that is `complete` and has these materials; NULL if memory runs
 * out. Thread-safe, like the next function. */
struct body *vox_body_take(const vox_model *model, const uint8_t *material);

/* Release a body for reuse. */
void vox_body_return(const vox_model *model, struct body *body);

/* Return whether a body was built from these materials. */
bool vox_body_has(const struct body *body, const uint8_t *material);

/* Free all unused bodies. */
void vox_bodies_destroy(vox_model *model);

/* bond.c */

/* Energy and strain of the bonds. */
struct tension {
    double energy;          /* J */
    double least, greatest; /* strain */
};
struct tension vox_bonds_tension(const struct body *body);

/* Return the stretch of a bond beyond its rest length, m, in its current frame. */
double vox_bond_stretch(const struct body *body, enum axis axis, int64_t lower);

/* motion.c */

/* State of the actuation at a time (section 4): a voxel's size is edge * (rest + gain * amplitude *
 * sin(...)). */
struct actuation {
    double edge;              /* m */
    double rest;              /* scale of a voxel without amplitude */
    double gain;              /* fraction of the amplitude; 0 before the start */
    double cycles;            /* excluding the phase */
    double smallest, largest; /* m, limits of a size */
    bool clamp;               /* whether a size beyond a limit becomes the limit */
};
struct actuation vox_actuation_at(const vox_model *model, double time);

/* Return the size that follows the size `last`: `wanted`, unless it is beyond a limit. */
IN_LOOP double limited(double wanted, double last, double smallest, double largest, bool clamp)
{
    const bool shrinks = (wanted < smallest) & (wanted < last);
    const bool grows = (wanted > largest) & (wanted > last);
    const double limit = wanted < smallest ? smallest : largest;
    return (shrinks | grows) ? (clamp ? limit : last) : wanted;
}

/* Advance a voxel by one time step under all forces, and update the body's `top_speed` and
 * `farthest`. Return false if it diverges. */
bool vox_voxel_advance(struct body *body, int64_t slot);

/* The reference kernel: bond.c and motion.c. */
bool vox_scalar_bonds_apply(struct body *body, double per_second, double limit);
bool vox_scalar_voxels_advance(struct body *body, double limit);
void vox_scalar_phases_set(struct body *body);
void vox_scalar_sizes_advance(struct body *body, double limit);

/* kernels.c */

/* Implementation of bonds and motion, which take nearly all the time. */
struct kernel {
    const char *name;
    bool (*usable)(void); /* support by this processor; NULL: always */
    /* Set the forces and torques on the voxels up to the depth `limit` to those of their bonds.
     * `per_second` is 1/dt, or 0 in the first step, which has no rates. Return false if a bond up
     * to this depth has diverged. */
    bool (*bonds_apply)(struct body *body, double per_second, double limit);
    /* Advance the voxels up to the depth `limit` by one time step under their forces. Return false
     * if one of them diverges. */
    bool (*voxels_advance)(struct body *body, double limit);
    /* Prepare for changed phases of the actuation. */
    void (*phases_set)(struct body *body);
    /* Change the sizes of these voxels to those after this step. */
    void (*sizes_advance)(struct body *body, double limit);
};

extern const struct kernel vox_generic_kernel, vox_avx2_kernel, vox_avx512_kernel;

/* Return a kernel by number; NULL if it does not exist or is not supported by this processor. */
const struct kernel *vox_kernel_of(int32_t number);

/* Compilers that can set the instruction set for a part of a file. */
#if defined(__x86_64__) && !defined(_WIN32) && !defined(__clang__) && defined(__GNUC__) && \
    __GNUC__ >= 8
#define VOX_X86_KERNELS
#endif

/* surface.c */

enum vox_status vox_surface_shape(struct body *body);

/* Return the size of the arrays of a surface, bytes. */
size_t vox_surface_memory(const struct body *body);
void vox_surface_destroy(struct surface *surface);

/* fluid.c */

/* Reset the reach of the voxels to that of an undeformed body. */
void vox_fluid_rest(struct body *body);

/* Add the drag of the fluid to the voxels at the surface. */
void vox_fluid_apply(struct body *body);

/* floor.c */

/* Add the normal force and friction of the floor to the force on a voxel, which must include all
 * other forces; a sticking voxel loses its lateral momentum. */
void vox_floor_apply(struct body *body, int64_t slot);

/* cone.c */

/* Set the steps across pairs of a model. */
enum vox_status vox_cone_prepare(vox_model *model);

/* Set the depths of voxels and bonds for samples of some points; the list of contacts must be that
 * at rest. */
void vox_cone_shape(struct body *body, enum sources sources);

/* Return the share of the work of the whole body that is left if the last sample is taken after
 * some steps. */
double vox_cone_share(const struct body *body, int64_t steps);

/* sample.c */

/* Write a sample of every requested track; `row` counts the samples of the whole batch. */
void vox_sample_write(const struct body *body, const struct vox_tracks *tracks, int64_t row);

/* Write NaN to the samples of all requested tracks. */
void vox_sample_write_nothing(const vox_model *model, const struct vox_tracks *tracks,
                              int64_t begin, int64_t end);

#endif
