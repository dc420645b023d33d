/* Version of the library. */
#include "cppn.h"

const char *cppn_version(void)
{
    return CPPN_VERSION;
}
