/* Declarations shared by the files of the library: the compiled network, and the activation of a
 * node. Symbols with external linkage start with cppn_. */
#ifndef CPPN_INTERNAL_H
#define CPPN_INTERNAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cppn.h"

#if SIZE_MAX < 0xffffffffffffffffu
#error "libcppn computes the sizes of its arrays with 64 bits"
#endif

/* Always inlined: for the body of a loop over points. */
#ifdef __GNUC__
#define IN_LOOP static inline __attribute__((always_inline))
#else
#define IN_LOOP static inline
#endif

/* Place of a value that is constant over all points. */
enum { NOWHERE = -1 };

/* Term of a sum. */
struct term {
    int64_t place; /* of the source's values, or NOWHERE */
    double factor; /* weight; without a place, value of the term */
};

/* The evaluation of one node. */
struct step {
    enum cppn_activation activation;
    double bias, response;
    double start;       /* sum of the constant terms at the beginning */
    int64_t first_term; /* never a constant */
    int64_t n_terms;    /* at least 1 */
};

/* Value of an input or a node at every point. */
struct value {
    int64_t place;   /* index in the block's values, or NOWHERE */
    double constant; /* value without a place */
};

/* Places are numbered: inputs first, then steps. */
struct cppn_network {
    int64_t n_inputs, n_outputs, n_steps, n_terms;
    bool *used;            /* [n_inputs] whether a step reads the input */
    struct step *steps;    /* in the order of evaluation */
    struct term *terms;    /* step after step */
    struct value *outputs; /* [n_outputs] */
};

/* Clamp to +-1e50, far beyond the meaningful range of the formulas, and replace NaN by 0. */
IN_LOOP double guarded(double z)
{
    const double limit = 1e50;
    const double below = z > limit ? limit : z;
    const double within = below < -limit ? -limit : below;
    return within == within ? within : 0.0;
}

/* Replace the sums at n points by the values of the node. */
void cppn_activate(enum cppn_activation activation, double bias, double response, int64_t n,
                   double *sums);

#endif
