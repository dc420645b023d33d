/* The kernels, and their support by this processor. */
#include "internal.h"

static const struct kernel scalar_kernel = {"scalar", NULL, vox_scalar_bonds_apply,
                                            vox_scalar_voxels_advance, vox_scalar_sizes_advance};

static const struct kernel *const kernels[] = {
    &scalar_kernel,
    &vox_generic_kernel,
#ifdef VOX_X86_KERNELS
    &vox_avx2_kernel,
    &vox_avx512_kernel,
#endif
};

#define N_KERNELS ((int32_t)(sizeof kernels / sizeof *kernels))

static bool can_use(const struct kernel *kernel)
{
    return !kernel->usable || kernel->usable();
}

const struct kernel *vox_kernel_of(int32_t number)
{
    if (number < 0 || number > N_KERNELS) return NULL;
    if (number > 0) return can_use(kernels[number - 1]) ? kernels[number - 1] : NULL;
    int32_t last = N_KERNELS - 1;
    while (!can_use(kernels[last])) last--;
    return kernels[last];
}

const char *vox_kernel_name(int32_t number)
{
    if (number < 1 || number > N_KERNELS) return NULL;
    return can_use(kernels[number - 1]) ? kernels[number - 1]->name : "";
}
