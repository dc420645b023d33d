/* The kernels, and which of them this processor can use. */
#include "internal.h"

static bool always(void)
{
    return true;
}

const struct kernel scalar_kernel = {"scalar", always, scalar_bonds_apply, scalar_voxels_advance};
