/* What the files of the solver share: the derived constants and the state of one body.
 * Section numbers are those of docs/physics.md. What the linker sees begins with vox_, here too. */
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

/* Of the actuation: the engine's, in single precision (section 4). */
#define TWO_PI 6.283185005187988

/* A voxel's size stays within these (section 4), in lattice edges. */
#define SMALLEST_SCALE 0.1
#define LARGEST_SCALE 3.0

/* Limits of a bond's two frames (section 5); it leaves the small one later than it returns to
 * it. */
#define SMALL_COSINE 0.9999625024343469 /* cos(0.01732 / 2) */
#define LARGE_COSINE 0.9999546280051071 /* cos(1.1 * 0.01732 / 2) */
#define SMALL_TURN 0.05
#define LARGE_TURN 0.055
#define SMALL_EXTENSION 1.30
#define LARGE_EXTENSION 1.43

/* Up to these the engine's formulas for small angles hold (section 5). */
#define SLOPE_OF_SMALL_TURN 0.01732
#define COSINE_OF_SMALL_ROTATION 0.9988

/* ---- constants of a model -------------------------------------------------------------------- */

/* A voxel of one material (sections 1, 4, 6 and 9). */
struct substance {
    double youngs_modulus; /* Pa */
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

/* The numbers of a bond's law (sections 5 and 6), each as FIELD(number): there are structs of
 * numbers and of arrays, and loops over slots that want each array by its name. */
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

/* Damping of one end of a bond. */
struct damper {
    DAMPINGS(NUMBER, )
};

/* A bond between two materials, the lower-indexed voxel's first. */
struct coupling {
    STIFFNESSES(NUMBER)
    struct damper lower, upper;
    /* so far the bond's law */
    double fastest;    /* larger of stretch / mass of the two ends, 1/s2 */
    double touch_drag; /* N s/m, of voxels that touch */
    double touch_friction;
};

#undef NUMBER
#define ARRAY(field) double *field;

/* The bond's law in each slot. */
struct damper_arrays {
    DAMPINGS(ARRAY, )
};

struct coupling_arrays {
    STIFFNESSES(ARRAY)
    struct damper_arrays lower, upper;
};

#undef ARRAY

struct kernel;

/* A lattice point near a voxel, and the shortest ways to it along bonds: each by a last bond from a
 * point before it. */
struct place {
    int32_t by[3]; /* from the voxel */
    int32_t n_ways;
    int32_t from[3]; /* index of the point before */
    int32_t side[3]; /* on which that has the bond: 0 .. 5 for -x, +x, -y, +y, -z, +z */
};

/* A cell near another. */
struct near_cell {
    int32_t by[3];
    int32_t place; /* index, or -1 if more bonds lead there */
};

/* The lattice around a voxel. */
struct vicinity {
    int64_t hops;
    int64_t n_places;
    struct place *places; /* within so many bonds, closer ones first: voxels joined so do not
                             collide */
    int32_t *index;       /* of each point of the cube around them */
    int64_t n_cells;
    struct near_cell *cells; /* of voxels that may touch, each pair once */
};

/* Bodies that nobody uses at the moment: their memory need not be asked for again. */
#define MOST_SPARES 8

struct spares {
    _Atomic(struct body *) bodies[MOST_SPARES];
};

struct vox_model {
    struct vox_settings settings;
    const struct kernel *kernel;
    struct spares *spares;
    int64_t cells;
    double rest_scale;        /* size / lattice edge without actuation: the edge was rounded to
                                 single precision */
    double largest_size;      /* m, of any voxel at any time */
    double fastest;           /* 1/s2, the largest of its couplings */
    double too_far;           /* m, a voxel further from its start has diverged */
    double floor_rise;        /* of the floor along x, m/m */
    struct vicinity vicinity; /* voxels in it do not collide if the bonds are there */
    int16_t of_code[VOX_MAX_CODES]; /* index into substances, or -1 */
    int32_t n_substances;
    struct substance *substances;
    struct coupling *couplings; /* [n_substances][n_substances] */
    uint8_t *fixed;             /* [cells] */
};

/* ---- one body -------------------------------------------------------------------------------- */

/* Number of things in a body, the box that holds it, and its clock; found without building it. */
struct census {
    int64_t n_voxels;
    int64_t n_bonds;
    int64_t from[3], length[3]; /* cells, along each axis */
    double dt;                  /* s */
    int64_t steps;              /* to the end of the duration */
};

enum axis { AXIS_X, AXIS_Y, AXIS_Z };

/* Arrays over the slots of a body: the cells of its box, x fastest, then y, then z, and some after
 * them that are as empty as cells without a voxel. What is empty holds finite numbers that nothing
 * depends on. */
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

/* Kernels work on so many slots at a time; a voxel's forces are summed in an order that depends on
 * it. */
#define TILE 32

/* What a voxel is and how it moves. */
struct voxels {
    struct vecs position;              /* m */
    struct quats orientation;          /* unit */
    double *size;                      /* m, of the step before */
    struct vecs force;                 /* N, of bonds, contacts and fluid in this step */
    struct vecs torque;                /* N m */
    struct vecs momentum;              /* kg m/s */
    struct vecs spin;                  /* kg m2/s, angular momentum in the world frame */
    struct vecs start;                 /* m, initial position */
    double *phase;                     /* cycles */
    double *phase_sine, *phase_cosine; /* of that angle */
    double *amplitude;                 /* strain, of the actuation */
    double *mobility;                  /* 1/kg, the inverse of the mass */
    double *drag_rate;                 /* 1/s, slow damping of the momentum */
    double *weight;                    /* N, along z */
    double *turnability;               /* 1/(kg m2), the inverse of the inertia */
    double *spin_kept;                 /* share of the spin that slow damping leaves in a step */
    double *mobile;                    /* 0 if all its degrees of freedom are held, else 1 */
    uint8_t *substance;                /* index */
    uint8_t *fixed;                    /* degrees of freedom that it has not */
    int32_t *touching; /* scratch: voxels that it touches now, if they are damped or rub */
};

/* The bonds along one axis. Arrays over slots: that of a bond's lower end, the bond pointing from
 * it along +axis. */
struct bonds {
    int64_t n;
    int32_t *lower;      /* [n] slots, ascending */
    int64_t step;        /* slots from the lower to the upper end */
    double *there;       /* 1 where there is a bond, else 0 */
    double *small;       /* 1 in the small of the two frames (section 5), 0 in the large one */
    struct vecs stretch; /* m, of the last step on which the frame did not change; likewise */
    double *lower_y, *lower_z;       /* rad, turn of the lower end */
    struct vecs upper;               /* rad, turn of the upper end */
    struct coupling_arrays coupling; /* of each bond, if not all are the same */
    uint8_t *tile_used;              /* 1 where a tile has a bond */
};

/* Two voxels that may touch, first < second: slots. */
struct pair {
    int32_t first, second;
};

struct pairs {
    int64_t n, capacity;
    struct pair *list;
};

/* The skin by where it is now, in cubes. */
struct grid {
    int64_t n_skin;
    int64_t most_cubes;
    double reach;       /* m */
    double corner[3];   /* m */
    double edge;        /* m, of a cube */
    int64_t length[3];  /* cubes */
    int32_t *begin;     /* [most_cubes + 1] into `voxels` */
    int32_t *voxels;    /* [n_skin] slots, cube after cube, ascending in each */
    struct vec *packed; /* [n_skin] m, their positions */
    int32_t *cube_of;   /* [n_skin] */
    int32_t *found;     /* [n_skin] slots */
};

/* The last search along bonds. */
struct search {
    int32_t from;     /* slot; -1 before the first */
    int64_t number;   /* counts the searches */
    int64_t *reached; /* [slots] number of the last search that came here */
    int32_t *queue;   /* [slots] */
};

/* All pairs that may be listed while no voxel has strayed from its start. `words` hold a bit for
 * each slot. */
struct near_by {
    struct pairs pairs;
    uint64_t *joined;      /* [places][words] where one of the shortest ways to a place is bonds */
    uint64_t *bonds;       /* [6][words] */
    uint64_t *skin, *held; /* [words] voxels that may touch others; voxels that are held in all
                              degrees of freedom */
    int64_t *begin;        /* [slots + 1] */
    struct search search;
};

/* The voxels that may touch others, and which pairs are looked at (section 10). */
struct contacts {
    int64_t n_skin;
    int32_t *skin; /* slots, ascending */
    int64_t most;  /* pairs that may be listed at a time */
    struct near_by near_by;
    struct pairs first; /* the list at rest */
    bool first_is_known;
    struct pairs now; /* the list that is in use */
    double travelled; /* lattice edges, of the fastest voxel since the list was made */
    struct grid grid;
};

/* Of a voxel with a bond on every side. */
#define ALL_SIDES 63

/* A face of a voxel that is exposed to the fluid. */
struct facet {
    int32_t slot;
    int32_t corners[4]; /* counter-clockwise, seen from outside */
};

/* The outer surface of a body: where voxels meet, their corners are one. */
struct surface {
    int64_t n_corners, n_facets;
    /* [slots] of the corner (x, y, z), each 0 or 1, at x + 2 y + 4 z; -1 within */
    int32_t (*corners_of)[8];
    double *share;       /* [n_corners] 1 / number of voxels that meet there */
    struct vec *corners; /* [n_corners] m */
    struct facet *facets;
};

struct body {
    const vox_model *model;
    struct census census;
    int64_t n_slots, n_tiles;
    int32_t (*coordinates)[3]; /* of each slot in the box */
    int64_t step[3];           /* slots from a cell to the next along each axis */
    int32_t *slots;            /* [n_voxels] of the voxels, ascending */
    int32_t *cells;            /* [n_voxels] of the canvas, likewise */
    uint8_t *occupied;         /* 1 where there is a voxel */
    uint8_t *bonded;           /* bits of the sides with a bond: -x, +x, -y, +y, -z, +z */
    struct voxels voxels;
    struct bonds bonds[3];           /* along each axis */
    const struct coupling *coupling; /* of all bonds, or NULL if they differ */
    uint8_t *tile_used;              /* 1 where a tile has a voxel */
    int64_t n_partly; /* voxels that are held in some degrees of freedom, but not in all */
    int32_t *partly;  /* their slots, ascending */
    struct contacts contacts;
    struct surface surface;
    void *memory; /* of all arrays but those of contacts and surface */
    size_t memory_size;
    double time;      /* s */
    double top_speed; /* m/s, after the step before */
    double farthest;  /* m, of any voxel from its start at any time */
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

/* Force on a voxel with slow damping and weight. */
IN_LOOP struct vec loaded(struct vec force, double drag_rate, struct vec momentum, double weight)
{
    return (struct vec){force.x - drag_rate * momentum.x, force.y - drag_rate * momentum.y,
                        (force.z - drag_rate * momentum.z) + weight};
}

/* Slot of the cell beside a slot (upwards or not), or -1 beyond the box. */
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

/* The fault of the first number that is out of its range. */
enum vox_status vox_settings_check(const struct vox_settings *settings);
enum vox_status vox_properties_check(const struct vox_material *material);

/* A sentence for what those return; NULL for any other status. */
const char *vox_range_message(enum vox_status status);

/* body.c */

/* Checks the material codes of a body and counts what it is made of. */
enum vox_status vox_body_census(const vox_model *model, const uint8_t *material,
                                struct census *census);

/* A body to be shaped, which may have been used before; NULL if there is no memory. Threads may ask
 * at the same time. */
struct body *vox_body_take(const vox_model *model);

/* Gives it back. */
void vox_body_return(const vox_model *model, struct body *body);

/* Frees what was given back. */
void vox_bodies_destroy(vox_model *model);

/* Makes a body one of these materials; its memory is kept where it is large enough. */
enum vox_status vox_body_shape(struct body *body, const vox_model *model,
                               const struct census *census, const uint8_t *material);
/* Puts the body at rest at time 0. */
void vox_body_rest(struct body *body, const double *phase_cycles);

/* bond.c */

/* What the bonds store, and how far they are stretched. */
struct tension {
    double energy;          /* J */
    double least, greatest; /* strain */
};
struct tension vox_bonds_tension(const struct body *body);

/* motion.c */

/* How the actuation stands at a time (section 4): a voxel's size is edge * (rest + gain * amplitude
 * * sin(...)). */
struct actuation {
    double edge;   /* m */
    double rest;   /* scale of a voxel without amplitude */
    double gain;   /* share of the amplitude; 0 before the start */
    double cycles; /* without the phase */
};
struct actuation vox_actuation_at(const vox_model *model, double time);

/* Adds slow damping and weight to the force on a voxel. */
void vox_voxel_load(struct body *body, int64_t slot);

/* Moves a voxel by one time step under all forces; raises the body's top speed and its farthest
 * way. False if it has diverged. */
bool vox_voxel_advance(struct body *body, int64_t slot);

/* The reference kernel: bond.c and motion.c. */
bool vox_scalar_bonds_apply(struct body *body, double per_second);
bool vox_scalar_voxels_advance(struct body *body);

/* kernels.c */

/* One way to compute what takes nearly all the time. */
struct kernel {
    const char *name;
    bool (*usable)(void); /* whether this processor can; NULL if every one can */
    /* Adds the forces and torques of all bonds to their voxels. `per_second` is 1/dt, or 0 on the
     * first step, which has no rates yet. False if a bond has diverged. */
    bool (*bonds_apply)(struct body *body, double per_second);
    /* Moves every voxel by one time step under the forces that were added to it. False if one has
     * diverged. */
    bool (*voxels_advance)(struct body *body);
};

extern const struct kernel vox_generic_kernel, vox_avx2_kernel, vox_avx512_kernel;

/* The kernel of a number, or NULL if there is none that this processor can use. */
const struct kernel *vox_kernel_of(int32_t number);

/* Where the compiler can be told the instructions of a part of a file. */
#if defined(__x86_64__) && !defined(_WIN32) && !defined(__clang__) && defined(__GNUC__) && \
    __GNUC__ >= 8
#define VOX_X86_KERNELS
#endif

/* vicinity.c */

/* The places within so many bonds, and the cells closer than so many edges. To be destroyed in any
 * case. */
enum vox_status vox_vicinity_create(struct vicinity *vicinity, int64_t hops, double radius);
void vox_vicinity_destroy(struct vicinity *vicinity);

/* Index of a place, or -1 if it is too far. */
int64_t vox_vicinity_index(const struct vicinity *vicinity, const int32_t by[3]);

/* contact_near.c */

/* Room for so many pairs; those that are there may be lost. */
bool vox_pairs_reserve(struct pairs *pairs, int64_t capacity);

/* Lists all pairs of the skin in near cells that may collide, sorted. */
enum vox_status vox_near_by_shape(const struct body *body, struct near_by *near_by);
void vox_near_by_destroy(struct near_by *near_by);

/* Whether two voxels, first < second, may ever be listed: bonds do not join them closely, and one
 * can move. */
bool vox_near_by_may_collide(const struct body *body, struct near_by *near_by, struct pair pair);

/* contact_list.c */

/* Distance beyond which no pair is listed at any time, m. */
double vox_contacts_reach(const vox_model *model);

/* A voxel that is further from its start, in lattice edges, has strayed. */
#define STRAYED 0.35

enum vox_status vox_contacts_shape(struct body *body);
void vox_contacts_rest(struct body *body);
void vox_contacts_destroy(struct contacts *contacts);

/* Makes the list of possible contacts anew where that is due; false if there are too many. */
bool vox_contacts_refresh(struct body *body, bool first_step);

/* contact_grid.c */

enum vox_status vox_grid_shape(struct grid *grid, int64_t n_skin);
void vox_grid_destroy(struct grid *grid);
void vox_grid_fill(struct grid *grid, const struct body *body, double reach);

/* Writes the skin after a voxel that is in reach of it to `found`, ascending, and returns how many
 * there are. */
int64_t vox_grid_find(const struct grid *grid, const struct body *body, int32_t first);

/* contact_force.c */

/* Adds the forces of all contacts to their voxels. */
void vox_contacts_apply(struct body *body);

/* surface.c */

enum vox_status vox_surface_shape(struct body *body);
void vox_surface_destroy(struct surface *surface);

/* fluid.c */

/* Adds the drag of the fluid to the voxels at the surface. */
void vox_fluid_apply(struct body *body);

/* floor.c */

/* Adds the push and the friction of the floor to the force on a voxel, which has all others
 * already; a voxel that sticks loses its lateral momentum. */
void vox_floor_apply(struct body *body, int64_t slot);

/* harmless.c */

/* Whether the next step, the list of its contacts being made, cannot lead a body to what counts as
 * diverged. */
bool vox_next_step_is_harmless(struct body *body);

/* sample.c */

/* Writes one sample of every track that is wanted; `row` counts the samples of the whole batch. */
void vox_sample_write(const struct body *body, const struct vox_tracks *tracks, int64_t row);

/* Writes that there is nothing. */
void vox_sample_write_nothing(const vox_model *model, const struct vox_tracks *tracks,
                              int64_t begin, int64_t end);

#endif
