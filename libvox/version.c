/* Version and compiler of the library. */
#include "vox.h"

const char *vox_version(void)
{
    return VOX_VERSION;
}

const char *vox_compiler(void)
{
#if defined(__clang__)
    return "clang " __clang_version__;
#elif defined(__GNUC__)
    return "gcc " __VERSION__;
#else
    return "an unknown compiler";
#endif
}
