/* Self collision (section 10): which voxels may touch, the list of candidates, and their forces. */
#ifndef VOX_CONTACTS_H
#define VOX_CONTACTS_H

#include <stdbool.h>
#include <stdint.h>

#include "vectors.h"
#include "vox.h"

struct body;
struct vox_model;

/* ---- the lattice ----------------------------------------------------------------------------- */

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
    int64_t reach;           /* largest coordinate of a place or cell */
};

/* ---- one body -------------------------------------------------------------------------------- */

/* Slots of two voxels that may touch, in the order of their cells. */
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
    int32_t *voxels;    /* [n_skin] indices into the skin, sorted by cube, ascending in each */
    struct vec *packed; /* [n_skin] m, positions of these voxels */
    int32_t *cube_of;   /* [n_skin] */
    int32_t *found;     /* [n_skin] indices into the skin */
};

/* The latest search along bonds. */
struct search {
    int32_t from;     /* slot; -1 before the first search */
    int64_t number;   /* counts the searches */
    int64_t *reached; /* [slots] number of the last search that reached the slot */
    int32_t *queue;   /* [slots] */
};

/* All pairs that can be listed while no voxel has strayed from its start. `words` contain one bit
 * per cell of the box, see `row` of a body. */
struct near_by {
    struct pairs pairs;
    uint16_t *distance2;   /* [pairs] square of the distance at rest, edges */
    uint64_t *joined;      /* [places][words] whether a shortest path to the place has all bonds */
    uint64_t *bonds;       /* [6][words] */
    uint64_t *skin, *held; /* [words] voxels that may touch others; voxels that are clamped in
                              all degrees of freedom */
    int64_t *begin;        /* [cells of the box + 1] */
    struct search search;
};

/* Number of depths that are distinguished by their order; all larger ones count as the last. */
#define DEPTHS 256

/* Pairs near each other that are not listed at rest, sorted by the square of their distance at rest
 * in edges and, for each of them, by the lower depth. */
struct watch {
    int64_t *begin;     /* [(largest2 of the model + 1) * DEPTHS + 2] into `pairs` */
    struct pairs pairs; /* in this order */
    uint8_t *lost;  /* [first.n] whether a pair listed at rest has been out of reach since then */
    double deepest; /* largest depth of a voxel */
    bool measured;  /* whether the next array is known */
    int64_t apart2[DEPTHS]; /* square of the smallest distance at rest of two voxels that are not
                               near, edges, for each difference of their depths */
    double wave_speed;      /* m/s, of the material in a wave of the largest strain */
    double top_speed;       /* m/s, of any voxel so far, or of a wave */
};

/* The voxels that may touch others, and the list of candidate pairs (section 10). */
struct contacts {
    int64_t n_skin;
    int32_t *skin; /* slots, in the order of cells */
    int64_t most;  /* maximum number of pairs in the list */
    struct near_by near_by;
    struct pairs first; /* the list at rest */
    struct pairs now;   /* the current list */
    double travelled;   /* lattice edges, by the fastest voxel since the list was built */
    struct grid grid;
    struct watch watch;
};

/* ---- functions ------------------------------------------------------------------------------- */

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

/* Return the approximate size of its arrays, bytes; likewise the function of all contacts. */
size_t vox_near_by_memory(const struct body *body);

/* Return whether two voxels, first < second, can ever be listed: not closely connected by bonds,
 * and not both clamped. */
bool vox_near_by_may_collide(const struct body *body, struct near_by *near_by, struct pair pair);

/* contact_list.c */

/* Return the distance beyond which no pair is ever listed, m. */
double vox_contacts_reach(const struct vox_model *model);

/* Distance from its start beyond which a voxel has strayed, in lattice edges. */
#define STRAYED 0.35

/* Find the voxels of a body at rest that may touch others, and make its list of candidates. */
enum vox_status vox_contacts_shape(struct body *body);

/* Reset the list of contact candidates to that at rest. */
void vox_contacts_rest(struct body *body);

/* Free everything but the watch. */
void vox_contacts_destroy(struct contacts *contacts);

size_t vox_contacts_memory(const struct body *body);

/* Rebuild the list of contact candidates if it is due; return false if there are too many. */
bool vox_contacts_refresh(struct body *body);

/* contact_watch.c */

/* Return whether the list at rest can be sufficient for all steps. */
bool vox_watch_is_possible(const struct body *body);

/* Sort the pairs to watch, for the current depths. */
enum vox_status vox_watch_shape(struct body *body);
void vox_watch_rest(struct body *body);
void vox_watch_destroy(struct watch *watch);

/* Add the forces of the contacts listed at rest on the voxels up to the depth `limit`. Return false
 * if another list could contain other contacts of these voxels. */
bool vox_watch_apply(struct body *body, double limit);

/* contact_grid.c */

enum vox_status vox_grid_shape(struct grid *grid, int64_t n_skin);
void vox_grid_destroy(struct grid *grid);
void vox_grid_fill(struct grid *grid, const struct body *body, double reach);

/* Write the voxels of the skin after number `first` that are within its reach to `found`, in
 * ascending order; return their number. */
int64_t vox_grid_find(const struct grid *grid, const struct body *body, int32_t first);

/* contact_force.c */

/* Add the forces of all contacts to their voxels. */
void vox_contacts_apply(struct body *body);

#endif
