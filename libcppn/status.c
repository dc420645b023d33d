/* Messages for statuses. */
#include "cppn.h"

const char *cppn_status_message(enum cppn_status status)
{
    switch (status) {
    case CPPN_OK: return "no error";
    case CPPN_NO_MEMORY: return "not enough memory";
    case CPPN_NULL_ARGUMENT: return "a required array is missing";
    case CPPN_BAD_INPUTS: return "the number of inputs must be between 1 and 65536";
    case CPPN_BAD_OUTPUTS: return "the number of outputs must be between 1 and 65536";
    case CPPN_BAD_NODES: return "the number of nodes must be between 0 and 65536";
    case CPPN_BAD_LINKS: return "the number of connections must be between 0 and 1048576";
    case CPPN_BAD_NODE_ID: return "the id of a node is negative";
    case CPPN_REPEATED_NODE: return "two nodes have the same id";
    case CPPN_UNKNOWN_ACTIVATION: return "a node has an unknown activation";
    case CPPN_UNKNOWN_END: return "a connection leads from or to a node that does not exist";
    case CPPN_MISSING_OUTPUT: return "an output node does not exist";
    case CPPN_CYCLE: return "the network has a cycle";
    case CPPN_BAD_POINTS: return "the number of points is negative or too large";
    }
    return "unknown status";
}
