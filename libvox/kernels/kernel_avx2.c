/* The fast kernel with AVX2 instructions, if compiler and processor support them. */
#include "for_vectors.h" /* first: it affects everything below */

#include "internal.h"

#ifdef VOX_X86_KERNELS
#pragma GCC target("avx2,prefer-vector-width=256")
#define VECTOR(name) avx2_##name
#define WIDTH 4

#include "vector_kernel.h"

static bool avx2_usable(void)
{
    return __builtin_cpu_supports("avx2");
}

const struct kernel vox_avx2_kernel = VECTOR_KERNEL("avx2", avx2_usable);
#endif
