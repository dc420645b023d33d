/* Declarations shared by the files of the solver: derived constants and the state of a body.
 * Section numbers refer to docs/physics.md. Symbols with external linkage start with vox_. */
#ifndef VOX_INTERNAL_H
#define VOX_INTERNAL_H

#include <math.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

/* A lattice point near a voxel, and the shortest paths to it along bonds, each given by its last
 * bond. */
struct place {
    int32_t by[3]; /* offset from the voxel */
    int32_t n_ways;
    int32_t from[3]; /* index of the previous point */
    int32_t side[3]; /* of the previous point: 0 .. 5 for -x, +x, -y, +y, -z, +z */
};

/* A cell near another one. */
struct near_cell {
    int32_t by[3];
    int32_t place; /* index, or -1 if it is more bonds away */
};

/* The lattice around a voxel. */
struct vicinity {
    int64_t hops;
    int64_t n_places;
    struct place *places; /* within `hops` bonds, closer ones first: voxels connected this way
                             do not collide */
    int32_t *index;       /* of each point in the cube around them */
    int64_t n_cells;
    struct near_cell *cells; /* of voxels that may touch; each pair once */
};

/* Unused bodies, whose memory is reused. */
#define MOST_SPARES 8

struct spares {
    _Atomic(struct body *) bodies[MOST_SPARES];
};

struct vox_model {
    struct vox_settings settings;
    const struct kernel *kernel;
    struct spares *spares;
    int64_t cells;
    double rest_scale;              /* size / lattice edge without actuation: the edge is rounded to
                                       single precision */
    double largest_size;            /* m, of any voxel at any time */
    double fastest;                 /* 1/s2, maximum over the couplings */
    double too_far;                 /* m, distance from the start that counts as diverged */
    double floor_rise;              /* slope of the floor along x, m/m */
    struct vicinity vicinity;       /* connected voxels in it do not collide */
    int16_t of_code[VOX_MAX_CODES]; /* index into substances, or -1 */
    int32_t n_substances;
    struct substance *substances;
    struct coupling *couplings; /* [n_substances][n_substances] */
    uint8_t *fixed;             /* [cells] */
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

enum axis { AXIS_X, AXIS_Y, AXIS_Z };

/* Arrays over the slots of a body: the cells of its box, x fastest, then y, then z, followed by
 * padding slots, which are treated as empty cells. Empty slots contain finite numbers without
 * effect on results. */
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

/* Number of slots that kernels process at a time; the order in which a voxel's forces are summed
 * depends on it. */
#define TILE 32

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
    double *mobile;     /* 1 if no degree of freedom is clamped, else 0 */
    uint8_t *substance; /* index */
    uint8_t *fixed;     /* clamped degrees of freedom */
    int32_t *touching;  /* scratch: number of current contacts, if damped or with friction */
};

/* The bonds along one axis. Arrays over slots are indexed by a bond's lower end, from which it
 * points along +axis. */
struct bonds {
    int64_t n;
    int32_t *lower;                  /* [n] slots, ascending */
    int64_t step;                    /* slots from the lower to the upper end */
    double *there;                   /* 1 if the slot has a bond, else 0 */
    double *small;                   /* 1 in the small frame (section 5), 0 in the large one */
    struct vecs stretch;             /* m, at the last step without a change of frame; as below */
    double *lower_y, *lower_z;       /* rad, turn of the lower end */
    struct vecs upper;               /* rad, turn of the upper end */
    struct coupling_arrays coupling; /* of each bond, unless all are equal */
    uint8_t *tile_used;              /* 1 if the tile has a bond */
};

/* Slots of two voxels that may touch, first < second. */
struct pair {
    int32_t first, second;
};

struct pairs {
    int64_t n, capacity;
    struct pair *list;
};

/* The skin, sorted into cubes by current position. */
struct grid {
    int64_t n_skin;
    int64_t most_cubes;
    double reach;       /* m */
    double corner[3];   /* m */
    double edge;        /* m, of a cube */
    int64_t length[3];  /* cubes */
    int32_t *begin;     /* [most_cubes + 1] into `voxels` */
    int32_t *voxels;    /* [n_skin] slots, sorted by cube, ascending in each */
    struct vec *packed; /* [n_skin] m, positions of these voxels */
    int32_t *cube_of;   /* [n_skin] */
    int32_t *found;     /* [n_skin] slots */
};

/* The latest search along bonds. */
struct search {
    int32_t from;     /* slot; -1 before the first search */
    int64_t number;   /* counts the searches */
    int64_t *reached; /* [slots] number of the last search that reached the slot */
    int32_t *queue;   /* [slots] */
};

/* All pairs that can be listed while no voxel has strayed from its start. `words` contain one bit
 * per slot. */
struct near_by {
    struct pairs pairs;
    uint64_t *joined;      /* [places][words] whether a shortest path to the place has all bonds */
    uint64_t *bonds;       /* [6][words] */
    uint64_t *skin, *held; /* [words] voxels that may touch others; voxels that are clamped in
                              all degrees of freedom */
    int64_t *begin;        /* [slots + 1] */
    struct search search;
};

/* The voxels that may touch others, and the list of candidate pairs (section 10). */
struct contacts {
    int64_t n_skin;
    int32_t *skin; /* slots, ascending */
    int64_t most;  /* maximum number of pairs in the list */
    struct near_by near_by;
    struct pairs first; /* the list at rest */
    bool first_is_known;
    struct pairs now; /* the current list */
    double travelled; /* lattice edges, by the fastest voxel since the list was built */
    struct grid grid;
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

struct body {
    const vox_model *model;
    struct census census;
    int64_t n_slots, n_tiles;
    int32_t (*coordinates)[3]; /* of each slot in the box */
    int64_t step[3];           /* slots between neighboring cells along each axis */
    int32_t *slots;            /* [n_voxels] slots of the voxels, ascending */
    int32_t *cells;            /* [n_voxels] cells of the voxels in the canvas, ascending */
    uint8_t *occupied;         /* 1 if the slot has a voxel */
    uint8_t *bonded;           /* bits of the sides with a bond: -x, +x, -y, +y, -z, +z */
    struct voxels voxels;
    struct bonds bonds[3];           /* along each axis */
    const struct coupling *coupling; /* of all bonds; NULL if they differ */
    uint8_t *tile_used;              /* 1 if the tile has a voxel */
    int64_t n_partly; /* number of voxels that are clamped in some degrees of freedom only */
    int32_t *partly;  /* their slots, ascending */
    struct contacts contacts;
    struct surface surface;
    void *memory; /* of all arrays except those of contacts and surface */
    size_t memory_size;
    double time;      /* s */
    double top_speed; /* m/s, after the previous step */
    double farthest;  /* m, largest distance of a voxel from its start so far */
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

/* Return a body to shape, possibly a reused one; NULL if memory runs out. Thread-safe. */
struct body *vox_body_take(const vox_model *model);

/* Release a body for reuse. */
void vox_body_return(const vox_model *model, struct body *body);

/* Free all unused bodies. */
void vox_bodies_destroy(vox_model *model);

/* Build a body from materials; memory that is large enough is reused. */
enum vox_status vox_body_shape(struct body *body, const vox_model *model,
                               const struct census *census, const uint8_t *material);
/* Reset the body to rest at time 0. */
void vox_body_rest(struct body *body, const double *phase_cycles);

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

/* Add slow damping and weight to the force on a voxel. */
void vox_voxel_load(struct body *body, int64_t slot);

/* Advance a voxel by one time step under all forces, and update the body's `top_speed` and
 * `farthest`. Return false if it diverges. */
bool vox_voxel_advance(struct body *body, int64_t slot);

/* The reference kernel: bond.c and motion.c. */
bool vox_scalar_bonds_apply(struct body *body, double per_second);
bool vox_scalar_voxels_advance(struct body *body);

/* kernels.c */

/* Implementation of bonds and motion, which take nearly all the time. */
struct kernel {
    const char *name;
    bool (*usable)(void); /* support by this processor; NULL: always */
    /* Add the forces and torques of all bonds to their voxels. `per_second` is 1/dt, or 0 in the
     * first step, which has no rates. Return false if a bond has diverged. */
    bool (*bonds_apply)(struct body *body, double per_second);
    /* Advance every voxel by one time step under its accumulated forces. Return false if a voxel
     * diverges. */
    bool (*voxels_advance)(struct body *body);
};

extern const struct kernel vox_generic_kernel, vox_avx2_kernel, vox_avx512_kernel;

/* Return a kernel by number; NULL if it does not exist or is not supported by this processor. */
const struct kernel *vox_kernel_of(int32_t number);

/* Compilers that can set the instruction set for a part of a file. */
#if defined(__x86_64__) && !defined(_WIN32) && !defined(__clang__) && defined(__GNUC__) && \
    __GNUC__ >= 8
#define VOX_X86_KERNELS
#endif

/* vicinity.c */

/* Find the places within `hops` bonds and the cells within `radius` edges. Destroy the vicinity
 * even after an error. */
enum vox_status vox_vicinity_create(struct vicinity *vicinity, int64_t hops, double radius);
void vox_vicinity_destroy(struct vicinity *vicinity);

/* Return the index of a place, or -1 if it is too far away. */
int64_t vox_vicinity_index(const struct vicinity *vicinity, const int32_t by[3]);

/* contact_near.c */

/* Reserve memory for `capacity` pairs; existing pairs may be lost. */
bool vox_pairs_reserve(struct pairs *pairs, int64_t capacity);

/* List all pairs of skin voxels in near cells that may collide, sorted. */
enum vox_status vox_near_by_shape(const struct body *body, struct near_by *near_by);
void vox_near_by_destroy(struct near_by *near_by);

/* Return whether two voxels, first < second, can ever be listed: not closely connected by bonds,
 * and not both clamped. */
bool vox_near_by_may_collide(const struct body *body, struct near_by *near_by, struct pair pair);

/* contact_list.c */

/* Return the distance beyond which no pair is ever listed, m. */
double vox_contacts_reach(const vox_model *model);

/* Distance from its start beyond which a voxel has strayed, in lattice edges. */
#define STRAYED 0.35

enum vox_status vox_contacts_shape(struct body *body);
void vox_contacts_rest(struct body *body);
void vox_contacts_destroy(struct contacts *contacts);

/* Rebuild the list of contact candidates if it is due; return false if there are too many. */
bool vox_contacts_refresh(struct body *body, bool first_step);

/* contact_grid.c */

enum vox_status vox_grid_shape(struct grid *grid, int64_t n_skin);
void vox_grid_destroy(struct grid *grid);
void vox_grid_fill(struct grid *grid, const struct body *body, double reach);

/* Write the skin voxels after `first` that are within its reach to `found`, in ascending order;
 * return their number. */
int64_t vox_grid_find(const struct grid *grid, const struct body *body, int32_t first);

/* contact_force.c */

/* Add the forces of all contacts to their voxels. */
void vox_contacts_apply(struct body *body);

/* surface.c */

enum vox_status vox_surface_shape(struct body *body);
void vox_surface_destroy(struct surface *surface);

/* fluid.c */

/* Reset the reach of the voxels to that of an undeformed body. */
void vox_fluid_rest(struct body *body);

/* Add the drag of the fluid to the voxels at the surface. */
void vox_fluid_apply(struct body *body);

/* floor.c */

/* Return the depth of a voxel below the plane of the floor, m; negative above it. */
double vox_floor_depth(const struct body *body, int64_t slot);

/* Add the normal force and friction of the floor to the force on a voxel, which must include all
 * other forces; a sticking voxel loses its lateral momentum. */
void vox_floor_apply(struct body *body, int64_t slot);

/* harmless.c */

/* Return whether the next step, whose contact list is up to date, cannot make a body diverge. */
bool vox_next_step_is_harmless(struct body *body);

/* sample.c */

/* Write a sample of every requested track; `row` counts the samples of the whole batch. */
void vox_sample_write(const struct body *body, const struct vox_tracks *tracks, int64_t row);

/* Write NaN to the samples of all requested tracks. */
void vox_sample_write_nothing(const vox_model *model, const struct vox_tracks *tracks,
                              int64_t begin, int64_t end);

#endif
