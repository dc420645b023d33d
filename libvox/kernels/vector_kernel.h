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

#include "vector_bonds.h"
#include "vector_motion.h"

#define VECTOR_KERNEL(name, usable) {name, usable, VECTOR(bonds_apply), VECTOR(voxels_advance)}
