/* The fast kernel: the bond law (sections 5 and 6) and the motion (sections 4, 7 and 8) of a tile
 * of slots at a time, in loops that the compiler turns into vector instructions. One file per
 * instruction set includes this file, after a #pragma that enables these instructions; VECTOR(name)
 * defines its own names. Without floating-point contraction all return the same bits.
 *
 * A missing bond is computed like any other and then discarded: no lane depends on another. */
#include <float.h>
#include <string.h>

#include "axes.h"
#include "for_vectors.h"
#include "internal.h"
#include "lanes.h"

/* Aligned for vectors of any size. */
#ifdef __GNUC__
#define IN_LINES __attribute__((aligned(64)))
#else
#define IN_LINES
#endif

/* One number per slot of a tile. */
typedef double lanes[TILE];

/* Lanes of a tile, in whole groups. */
struct range {
    int64_t first, last; /* excluding `last`; both are equal if there are none */
};

/* A loop over the vectors of a range, and over the lanes of a vector, whose number WIDTH is a
 * constant of the instruction set. */
#define FOR_LANES(i, range)                                                      \
    for (int64_t vector = (range).first; vector < (range).last; vector += WIDTH) \
        NO_LANE_DEPENDS_ON_ANOTHER                                               \
    for (int64_t i = vector; i < vector + WIDTH; i++)

/* Return the range of the groups of a tile up to a depth. */
IN_LOOP struct range range_of(const double *group_depth, int64_t base, double limit)
{
    struct range range = {TILE, 0};
    for (int64_t i = 0; i < TILE; i += GROUP) {
        if (group_depth[(base + i) / GROUP] > limit) continue;
        if (i < range.first) range.first = i;
        range.last = i + GROUP;
    }
    return range.last == 0 ? (struct range){0, 0} : range;
}

/* Numbers of events in the lanes of vectors; a sum over lanes within a loop would be slow. */
typedef int64_t counts[WIDTH];

IN_LOOP int64_t sum_of(const counts numbers)
{
    int64_t sum = 0;
    for (int i = 0; i < WIDTH; i++) sum += numbers[i];
    return sum;
}

/* Return the smallest range that contains two others. */
IN_LOOP struct range both(struct range one, struct range other)
{
    if (one.first == one.last) return other;
    if (other.first == other.last) return one;
    return (struct range){one.first < other.first ? one.first : other.first,
                          one.last > other.last ? one.last : other.last};
}

#include "vector_bonds.h"
#include "vector_motion.h"

#define VECTOR_KERNEL(name, usable) \
    {name,                          \
     usable,                        \
     VECTOR(bonds_apply),           \
     VECTOR(voxels_advance),        \
     VECTOR(phases_set),            \
     VECTOR(sizes_advance)}
