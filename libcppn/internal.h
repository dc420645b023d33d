/* What the files of the library share: the compiled network, and the step from a sum to a node's
 * value. What the linker sees begins with cppn_, here too. */
#ifndef CPPN_INTERNAL_H
#define CPPN_INTERNAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cppn.h"

#if SIZE_MAX < 0xffffffffffffffffu
#error "libcppn computes the sizes of its arrays with 64 bits"
#endif

/* Inlined wherever it is called: part of a loop over points. */
#ifdef __GNUC__
#define IN_LOOP static inline __attribute__((always_inline))
#else
#define IN_LOOP static inline
#endif

/* Stands for the place of a value that is the same at all points. */
enum { NOWHERE = -1 };

/* Part of a sum. */
struct term {
    int64_t place; /* of the source's values, or NOWHERE */
    double factor; /* the weight; if there is no place, the whole term */
};

/* The evaluation of one node. */
struct step {
    enum cppn_activation activation;
    double bias, response;
    double start;       /* the sum of the constant terms that come first */
    int64_t first_term; /* never a constant */
    int64_t n_terms;    /* at least 1 */
};

/* What an input or a node has at every point. */
struct value {
    int64_t place;   /* of the block's values, or NOWHERE */
    double constant; /* if there is no place */
};

/* Places are numbered: first the inputs, then the steps. */
struct cppn_network {
    int64_t n_inputs, n_outputs, n_steps, n_terms;
    bool *used;            /* [n_inputs] whether any step reads it */
    struct step *steps;    /* in the order of evaluation */
    struct term *terms;    /* step after step */
    struct value *outputs; /* [n_outputs] */
};

/* Clamp to +-1e50, far beyond any value at which the formulas still mean something, and make a NaN
 * 0. */
IN_LOOP double guarded(double z)
{
    const double limit = 1e50;
    const double below = z > limit ? limit : z;
    const double within = below < -limit ? -limit : below;
    return within == within ? within : 0.0;
}

/* Replace the sums of n points by the node's values there. */
void cppn_activate(enum cppn_activation activation, double bias, double response, int64_t n,
                   double *sums);

#endif
