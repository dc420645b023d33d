/* The fast kernel with the instructions that every processor of the target has. */
#include "for_vectors.h" /* first: what it says holds for all that follows */

#define VECTOR(name) generic_##name

#include "vector_kernel.h"

const struct kernel vox_generic_kernel = VECTOR_KERNEL("generic", NULL);
