/* Compilation of nodes and links to a network: checks, order of evaluation, and precomputed
 * constants. */
#include <stdlib.h>

#include "internal.h"

/* A link into a target. Sources are numbered: inputs first, then nodes. */
struct arc {
    int64_t source;
    double weight;
    const struct arc *next; /* next link into the same target */
};

enum mark { UNSEEN, OPEN, DONE };

/* State of a node during compilation. */
struct vertex {
    struct arc *first, *last; /* links into the node, in their order */
    const struct arc *ahead;  /* first link that has not been followed */
    enum mark mark;           /* OPEN while its sources are being processed */
    struct value value;       /* if DONE */
};

struct name {
    int64_t id;
    int64_t node;
};

struct compiler {
    const struct cppn_node *nodes;
    const struct cppn_link *links;
    int64_t n_nodes, n_links;
    struct name *names;      /* [n_nodes] sorted by id */
    struct vertex *vertices; /* [n_nodes] */
    struct arc *arcs;        /* [n_links] */
    struct vertex **path;    /* [n_nodes] from an output to its sources */
    cppn_network *network;
    int64_t culprit;
};

static bool within(int64_t low, int64_t n, int64_t high)
{
    return low <= n && n <= high;
}

static enum cppn_status check_counts(const struct compiler *c, int64_t inputs, int64_t outputs)
{
    if (!within(1, inputs, CPPN_MAX_NODES)) return CPPN_BAD_INPUTS;
    if (!within(1, outputs, CPPN_MAX_NODES)) return CPPN_BAD_OUTPUTS;
    if (!within(0, c->n_nodes, CPPN_MAX_NODES)) return CPPN_BAD_NODES;
    if (!within(0, c->n_links, CPPN_MAX_LINKS)) return CPPN_BAD_LINKS;
    if ((!c->nodes && c->n_nodes) || (!c->links && c->n_links)) return CPPN_NULL_ARGUMENT;
    return CPPN_OK;
}

/* ---- names ----------------------------------------------------------------------------------- */

static int compare_names(const void *one, const void *other)
{
    const int64_t a = ((const struct name *)one)->id, b = ((const struct name *)other)->id;
    return (a > b) - (a < b);
}

/* Return the vertex of a node's id; NULL if it does not exist. */
static struct vertex *find(const struct compiler *c, int64_t id)
{
    const struct name wanted = {.id = id};
    const struct name *found =
        bsearch(&wanted, c->names, (size_t)c->n_nodes, sizeof wanted, compare_names);
    return found ? &c->vertices[found->node] : NULL;
}

static enum cppn_status name_nodes(struct compiler *c)
{
    for (int64_t k = 0; k < c->n_nodes; k++) {
        c->culprit = k;
        if (c->nodes[k].id < 0) return CPPN_BAD_NODE_ID;
        if (!within(CPPN_SIGMOID, c->nodes[k].activation, CPPN_NEG_SIN))
            return CPPN_UNKNOWN_ACTIVATION;
        c->names[k] = (struct name){.id = c->nodes[k].id, .node = k};
    }
    qsort(c->names, (size_t)c->n_nodes, sizeof *c->names, compare_names);
    for (int64_t k = 1; k < c->n_nodes; k++) {
        c->culprit = c->names[k].node;
        if (c->names[k].id == c->names[k - 1].id) return CPPN_REPEATED_NODE;
    }
    return CPPN_OK;
}

static void append(struct vertex *target, struct arc *arc)
{
    if (target->last)
        target->last->next = arc;
    else
        target->first = arc;
    target->last = arc;
}

static enum cppn_status connect_nodes(struct compiler *c)
{
    const int64_t n_inputs = c->network->n_inputs;
    for (int64_t k = 0; k < c->n_links; k++) {
        const struct cppn_link link = c->links[k];
        const bool from_input = within(-n_inputs, link.source, -1);
        const struct vertex *source = find(c, link.source);
        struct vertex *target = find(c, link.target);
        c->culprit = k;
        if (!target || !(source || from_input)) return CPPN_UNKNOWN_END;
        c->arcs[k].source = from_input ? -1 - link.source : n_inputs + (source - c->vertices);
        c->arcs[k].weight = link.weight;
        append(target, &c->arcs[k]);
    }
    return CPPN_OK;
}

/* ---- steps ----------------------------------------------------------------------------------- */

/* Return the value of an input or of a node that is DONE. */
static struct value value_of(const struct compiler *c, int64_t source)
{
    const int64_t n_inputs = c->network->n_inputs;
    return source < n_inputs ? (struct value){.place = source}
                             : c->vertices[source - n_inputs].value;
}

static void add_term(cppn_network *network, struct value source, double weight)
{
    struct term *term = &network->terms[network->n_terms++];
    term->place = source.place;
    term->factor = source.place == NOWHERE ? source.constant * weight : weight;
    if (within(0, source.place, network->n_inputs - 1)) network->used[source.place] = true;
}

static struct value constant(const struct cppn_node *node, double sum)
{
    cppn_activate((enum cppn_activation)node->activation, node->bias, node->response, 1, &sum);
    return (struct value){.place = NOWHERE, .constant = sum};
}

/* Add a step for a node; `start` is the sum before the remaining arcs, the first of which is not a
 * constant. */
static struct value add_step(const struct compiler *c, const struct cppn_node *node, double start,
                             const struct arc *arc)
{
    cppn_network *network = c->network;
    const int64_t first_term = network->n_terms;
    for (; arc; arc = arc->next) add_term(network, value_of(c, arc->source), arc->weight);
    network->steps[network->n_steps] = (struct step){
        .activation = (enum cppn_activation)node->activation,
        .bias = node->bias,
        .response = node->response,
        .start = start,
        .first_term = first_term,
        .n_terms = network->n_terms - first_term,
    };
    return (struct value){.place = network->n_inputs + network->n_steps++};
}

/* Determine a vertex's value. Constants are summed here only up to the first other term, so that
 * the order of additions and their rounding do not change. */
static void finish(const struct compiler *c, struct vertex *vertex)
{
    const struct cppn_node *node = &c->nodes[vertex - c->vertices];
    const struct arc *arc = vertex->first;
    double sum = 0.0;
    for (; arc && value_of(c, arc->source).place == NOWHERE; arc = arc->next)
        sum += value_of(c, arc->source).constant * arc->weight;
    vertex->value = arc ? add_step(c, node, sum, arc) : constant(node, sum);
    vertex->mark = DONE;
}

/* ---- order ----------------------------------------------------------------------------------- */

static void open_vertex(struct compiler *c, int64_t depth, struct vertex *vertex)
{
    vertex->mark = OPEN;
    vertex->ahead = vertex->first;
    c->path[depth] = vertex;
}

/* Finish a vertex after all its sources, depth first. */
static enum cppn_status finish_from(struct compiler *c, struct vertex *root)
{
    if (root->mark == DONE) return CPPN_OK;
    int64_t depth = 0;
    open_vertex(c, depth++, root);
    while (depth > 0) {
        struct vertex *vertex = c->path[depth - 1];
        const struct arc *arc = vertex->ahead;
        if (!arc) {
            finish(c, vertex);
            depth--;
            continue;
        }
        vertex->ahead = arc->next;
        const int64_t node = arc->source - c->network->n_inputs;
        if (node < 0 || c->vertices[node].mark == DONE) continue;
        c->culprit = node;
        if (c->vertices[node].mark == OPEN) return CPPN_CYCLE;
        open_vertex(c, depth++, &c->vertices[node]);
    }
    return CPPN_OK;
}

static enum cppn_status finish_outputs(struct compiler *c)
{
    for (int64_t output = 0; output < c->network->n_outputs; output++) {
        struct vertex *vertex = find(c, output);
        c->culprit = output;
        if (!vertex) return CPPN_MISSING_OUTPUT;
        const enum cppn_status status = finish_from(c, vertex);
        if (status != CPPN_OK) return status;
        c->network->outputs[output] = vertex->value;
    }
    return CPPN_OK;
}

static enum cppn_status compile(struct compiler *c)
{
    enum cppn_status status = name_nodes(c);
    if (status == CPPN_OK) status = connect_nodes(c);
    if (status == CPPN_OK) status = finish_outputs(c);
    return status;
}

/* ---- memory ---------------------------------------------------------------------------------- */

static void *array(int64_t n, size_t size)
{
    return calloc((size_t)n + 1, size); /* never empty, because NULL may then be returned */
}

static cppn_network *allocate_network(int64_t inputs, int64_t outputs, int64_t n_nodes,
                                      int64_t n_links)
{
    cppn_network *network = array(1, sizeof *network);
    if (!network) return NULL;
    network->n_inputs = inputs;
    network->n_outputs = outputs;
    network->used = array(inputs, sizeof *network->used);
    network->steps = array(n_nodes, sizeof *network->steps);
    network->terms = array(n_links, sizeof *network->terms);
    network->outputs = array(outputs, sizeof *network->outputs);
    if (network->used && network->steps && network->terms && network->outputs) return network;
    cppn_destroy(network);
    return NULL;
}

static bool allocate(struct compiler *c, int64_t inputs, int64_t outputs)
{
    c->names = array(c->n_nodes, sizeof *c->names);
    c->vertices = array(c->n_nodes, sizeof *c->vertices);
    c->arcs = array(c->n_links, sizeof *c->arcs);
    c->path = array(c->n_nodes, sizeof(struct vertex *));
    c->network = allocate_network(inputs, outputs, c->n_nodes, c->n_links);
    return c->names && c->vertices && c->arcs && c->path && c->network;
}

static void release(struct compiler *c)
{
    free(c->names);
    free(c->vertices);
    free(c->arcs);
    free(c->path);
}

enum cppn_status cppn_compile(int64_t inputs, int64_t outputs, int64_t n_nodes,
                              const struct cppn_node *nodes, int64_t n_links,
                              const struct cppn_link *links, cppn_network **network,
                              int64_t *culprit)
{
    if (culprit) *culprit = -1;
    if (!network) return CPPN_NULL_ARGUMENT;
    *network = NULL;
    struct compiler c = {.nodes = nodes, .links = links, .n_nodes = n_nodes, .n_links = n_links};
    enum cppn_status status = check_counts(&c, inputs, outputs);
    if (status != CPPN_OK) return status;
    c.culprit = -1;
    status = allocate(&c, inputs, outputs) ? compile(&c) : CPPN_NO_MEMORY;
    release(&c);
    if (status == CPPN_OK) {
        *network = c.network;
        return CPPN_OK;
    }
    cppn_destroy(c.network);
    if (culprit) *culprit = c.culprit;
    return status;
}

void cppn_destroy(cppn_network *network)
{
    if (!network) return;
    free(network->used);
    free(network->steps);
    free(network->terms);
    free(network->outputs);
    free(network);
}

int64_t cppn_evaluated_nodes(const cppn_network *network)
{
    return network ? network->n_steps : 0;
}
