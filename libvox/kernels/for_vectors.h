/* Compiler options that keep loops free of jumps, so that they become vector instructions. */
#ifndef VOX_FOR_VECTORS_H
#define VOX_FOR_VECTORS_H

#if defined(__GNUC__) && !defined(__clang__)
/* both would add jumps around work of single lanes, or repeat work on both sides of a selection */
#pragma GCC optimize("no-tree-pre", "no-thread-jumps")
#define NO_LANE_DEPENDS_ON_ANOTHER _Pragma("GCC ivdep")
#else
#define NO_LANE_DEPENDS_ON_ANOTHER
#endif

#endif
