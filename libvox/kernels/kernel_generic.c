/* The fast kernel with the instructions of every processor of the target. */
#include "for_vectors.h" /* first: it affects everything below */

#define VECTOR(name) generic_##name
#define WIDTH 2

#include "vector_kernel.h"

const struct kernel vox_generic_kernel = VECTOR_KERNEL("generic", NULL);
