/* cppn: pattern-producing networks, compiled once and then evaluated at many points at a time.
 *
 * A network is compiled from its nodes and links and is read-only afterwards, so any number of
 * threads may use it at the same time. The library prints nothing, has no global state and trusts
 * no input: every call checks its arguments and returns a status.
 *
 * The value of a node is activation(bias + response * sum), the sum being 0.0 + source * weight +
 * ... in the order of the links. Inputs, and the arguments and values of activations, are
 * clamped to +-1e50, and NaN becomes 0, so that all values are finite. Every operation is rounded
 * as written and functions come from the C library. The value at a point therefore does not depend
 * on other points, and equals that of any program that performs the same operations in double
 * precision with the same library.
 *
 * This header is read by the C compiler and, without its directive lines, by cffi. For C++, include
 * it inside extern "C".
 */
#ifndef CPPN_H
#define CPPN_H

#include <stdint.h>

/* Version of this library. The second number increases with every change of the interface or of a
 * bit of the results, the third with all other changes. */
#define CPPN_VERSION "0.1.0"

/* Maximum counts of a network. */
enum {
    CPPN_MAX_NODES = 65536, /* inputs, outputs or nodes */
    CPPN_MAX_LINKS = 1048576
};

/* Result of a call. Brackets contain the meaning of `culprit`, which is -1 if no single item is at
 * fault. */
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
    CPPN_CYCLE,              /* [node], one of the cycle */
    CPPN_BAD_POINTS
};

/* The 23 functions of the experiment. If a range is given, z is clamped first. */
enum cppn_activation {
    CPPN_SIGMOID,      /* 1 / (1 + e^-5z), 5z within +-60 */
    CPPN_TANH,         /* tanh(2.5z), 2.5z within +-60 */
    CPPN_SIN,          /* sin(5z), 5z within +-60 */
    CPPN_SOFTPLUS,     /* 0.2 ln(1 + e^5z), 5z within +-60 */
    CPPN_GAUSS,        /* e^(-5 z^2), z within +-3.4 */
    CPPN_RELU,         /* z if positive, else 0 */
    CPPN_ELU,          /* z if positive, else e^z - 1 */
    CPPN_LELU,         /* z if positive, else 0.005z */
    CPPN_SELU,         /* 1.0507 (z if positive, else 1.6733 (e^z - 1)) */
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
    CPPN_NEG_SIN       /* -sin z, not scaled by 5 */
};

struct cppn_node {
    int64_t id;         /* unique, not negative; outputs have the ids 0, 1, ... */
    int32_t activation; /* one of enum cppn_activation */
    double bias;
    double response;
};

struct cppn_link {
    int64_t source; /* id of a node, or -1, -2, ... for inputs */
    int64_t target; /* id of a node */
    double weight;
};

typedef struct cppn_network cppn_network;

/* Compile a network.
 *
 * Nodes may have any order; a node sums its inputs in the order of the links. Both arrays are
 * copied. Nodes that no output depends on are omitted, and nodes that do not depend on inputs are
 * computed here, once. *network is NULL unless CPPN_OK is returned. `nodes` and `links` may be NULL
 * if they are empty; `culprit` may always be NULL.
 */
enum cppn_status cppn_compile(int64_t inputs, int64_t outputs, int64_t n_nodes,
                              const struct cppn_node *nodes, int64_t n_links,
                              const struct cppn_link *links, cppn_network **network,
                              int64_t *culprit);

void cppn_destroy(cppn_network *network); /* NULL is allowed */

/* Number of nodes that are evaluated at each point; the others are constants, or no output depends
 * on them. */
int64_t cppn_evaluated_nodes(const cppn_network *network); /* 0 for NULL */

/* Evaluate a network.
 *
 * points   [n_points][inputs] any numbers
 * outputs  [n_points][outputs] finite; must not overlap the points
 *
 * A call that fails leaves the outputs unchanged.
 */
enum cppn_status cppn_evaluate(const cppn_network *network, int64_t n_points, const double *points,
                               double *outputs);

/* CPPN_VERSION of the linked library, which may differ from the one in this header; never NULL. */
const char *cppn_version(void);

/* Description of a status, a sentence without a period; never NULL. */
const char *cppn_status_message(enum cppn_status status);

#endif
