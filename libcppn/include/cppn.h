/* cppn: pattern-producing networks, compiled once and then evaluated at many points at a time.
 *
 * A network is compiled from its nodes and links and is read-only afterwards, so any number of
 * threads may use one at the same time. Nothing is printed, no state is global, and no input is
 * trusted: every call checks its arguments and says what is wrong with a status.
 *
 * The value of a node is activation(bias + response * sum), the sum being 0.0 + source * weight +
 * ... in the order of the links. Inputs, and what enters and leaves an activation, are clamped to
 * +-1e50, and a NaN becomes 0: no network can leave the finite numbers. Every operation is rounded
 * as it stands, and functions are those of the C library, so that a point has the same value alone
 * as among others, and that of any program which does the same in double precision with the same
 * library.
 *
 * This header is read by the C compiler and, without its directive lines, by cffi. For C++, include
 * it inside extern "C".
 */
#ifndef CPPN_H
#define CPPN_H

#include <stdint.h>

/* The one place where the version of this library stands. Its second number rises with whatever
 * changes the interface or a bit of the results, its third with all else. */
#define CPPN_VERSION "0.1.0"

/* Largest counts that a network accepts. */
enum {
    CPPN_MAX_NODES = 65536, /* inputs, outputs or nodes */
    CPPN_MAX_LINKS = 1048576
};

/* What a call has to say. In brackets: what `culprit` is then (-1 if the fault is not one
 * item's). */
enum cppn_status {
    CPPN_OK = 0,
    CPPN_NO_MEMORY,
    CPPN_NULL_ARGUMENT,
    CPPN_BAD_INPUTS,
    CPPN_BAD_OUTPUTS,
    CPPN_BAD_NODES,
    CPPN_BAD_LINKS,
    CPPN_BAD_NODE_ID,        /* [node] */
    CPPN_REPEATED_NODE,      /* [node] */
    CPPN_UNKNOWN_ACTIVATION, /* [node] */
    CPPN_UNKNOWN_END,        /* [link] */
    CPPN_MISSING_OUTPUT,     /* [output] */
    CPPN_CYCLE,              /* [node], one of those in the cycle */
    CPPN_BAD_POINTS
};

/* The 23 functions of the experiment. z is clamped first where a range is given. */
enum cppn_activation {
    CPPN_SIGMOID,      /* 1 / (1 + e^-5z), 5z within +-60 */
    CPPN_TANH,         /* tanh(2.5z), 2.5z within +-60 */
    CPPN_SIN,          /* sin(5z), 5z within +-60 */
    CPPN_SOFTPLUS,     /* 0.2 ln(1 + e^5z), 5z within +-60 */
    CPPN_GAUSS,        /* e^(-5 z^2), z within +-3.4 */
    CPPN_RELU,         /* z if above 0, else 0 */
    CPPN_ELU,          /* z if above 0, else e^z - 1 */
    CPPN_LELU,         /* z if above 0, else 0.005z */
    CPPN_SELU,         /* 1.0507 (z if above 0, else 1.6733 (e^z - 1)) */
    CPPN_IDENTITY,     /* z */
    CPPN_CLAMPED,      /* z within +-1 */
    CPPN_INV,          /* 1 / z, 0 at 0 */
    CPPN_LOG,          /* ln z, z at least 1e-7 */
    CPPN_EXP,          /* e^z, z within +-60 */
    CPPN_ABS,          /* |z| */
    CPPN_HAT,          /* 1 - |z|, at least 0 */
    CPPN_SQUARE,       /* z^2 */
    CPPN_CUBE,         /* z^3 */
    CPPN_NEG_ABS,      /* -|z| */
    CPPN_NEG_SQUARE,   /* -z^2 */
    CPPN_SQRT_ABS,     /* sqrt |z| */
    CPPN_NEG_SQRT_ABS, /* -sqrt |z| */
    CPPN_NEG_SIN       /* -sin z, which is not scaled by 5 */
};

struct cppn_node {
    int64_t id;         /* not negative, of this node only; outputs have the ids 0, 1, ... */
    int32_t activation; /* one of enum cppn_activation */
    double bias;
    double response;
};

struct cppn_link {
    int64_t source; /* id of a node, or -1, -2, ... for the inputs */
    int64_t target; /* id of a node */
    double weight;
};

typedef struct cppn_network cppn_network;

/* Compile a network.
 *
 * The nodes may come in any order, and the order of the links is that in which a node sums what
 * flows in. Both are copied. Nodes that no output depends on are left out, and those that no input
 * acts on are computed here, once. *network is NULL unless CPPN_OK is returned. `nodes` and `links`
 * may be NULL if there are none, and `culprit` always.
 */
enum cppn_status cppn_compile(int64_t inputs, int64_t outputs, int64_t n_nodes,
                              const struct cppn_node *nodes, int64_t n_links,
                              const struct cppn_link *links, cppn_network **network,
                              int64_t *culprit);

void cppn_destroy(cppn_network *network); /* NULL is fine */

/* How many nodes are evaluated at each point: the others are constants, or no output depends on
 * them. */
int64_t cppn_evaluated_nodes(const cppn_network *network); /* 0 for NULL */

/* Evaluate a network.
 *
 * points   [n_points][inputs] any numbers
 * outputs  [n_points][outputs] finite; must not overlap the points
 *
 * What is refused leaves the outputs as they were.
 */
enum cppn_status cppn_evaluate(const cppn_network *network, int64_t n_points, const double *points,
                               double *outputs);

/* CPPN_VERSION of the library that is linked, which may not be the one of this header; never
 * NULL. */
const char *cppn_version(void);

/* A sentence without a full stop; never NULL. */
const char *cppn_status_message(enum cppn_status status);

#endif
