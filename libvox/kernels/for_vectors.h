/* What compilers have to be told so that loops without jumps stay so and become vector
 * instructions. */
#ifndef VOX_FOR_VECTORS_H
#define VOX_FOR_VECTORS_H

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-pre") /* it would jump around what is needless in some lanes */
#define NO_LANE_DEPENDS_ON_ANOTHER _Pragma("GCC ivdep")
#else
#define NO_LANE_DEPENDS_ON_ANOTHER
#endif

#endif
