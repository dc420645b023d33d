/* The fast kernel with AVX-512 instructions, if compiler and processor support them. */
#include "for_vectors.h" /* first: it affects everything below */

#include "internal.h"

#ifdef VOX_X86_KERNELS
#pragma GCC target("avx512f,avx512dq,avx512vl,avx512bw,prefer-vector-width=512")
#define VECTOR(name) avx512_##name
#define WIDTH 8

#include "vector_kernel.h"

static bool avx512_usable(void)
{
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
}

const struct kernel vox_avx512_kernel = VECTOR_KERNEL("avx512", avx512_usable);
#endif
