/* Compiler options that keep loops free of jumps, so that they become vector instructions. */
#ifndef VOX_FOR_VECTORS_H
#define VOX_FOR_VECTORS_H

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-pre") /* it would add jumps around work of single lanes */
#define NO_LANE_DEPENDS_ON_ANOTHER _Pragma("GCC ivdep")
#else
#define NO_LANE_DEPENDS_ON_ANOTHER
#endif

#endif
