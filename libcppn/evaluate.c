/* Evaluation of a compiled network in blocks of points, so that all values stay in the fastest
 * cache. */
#include <stdlib.h>

#include "internal.h"

enum { BLOCK = 128 }; /* points; 1 KiB per place */

/* Read the inputs at n points, guarded and transposed. */
static void read_points(const cppn_network *network, int64_t n, const double *restrict points,
                        double *restrict values)
{
    for (int64_t input = 0; input < network->n_inputs; input++) {
        if (!network->used[input]) continue;
        for (int64_t i = 0; i < n; i++)
            values[input * BLOCK + i] = guarded(points[i * network->n_inputs + input]);
    }
}

static void begin_sums(double start, double weight, int64_t n, const double *restrict values,
                       double *restrict sums)
{
    for (int64_t i = 0; i < n; i++) sums[i] = start + values[i] * weight;
}

static void add_weighted(double weight, int64_t n, const double *restrict values,
                         double *restrict sums)
{
    for (int64_t i = 0; i < n; i++) sums[i] += values[i] * weight;
}

static void add_constant(double term, int64_t n, double *sums)
{
    for (int64_t i = 0; i < n; i++) sums[i] += term;
}

/* The places of a step's sources precede its own place. */
static void take_step(const struct step *step, const struct term *terms, int64_t n,
                      const double *values, double *own)
{
    const struct term *term = terms + step->first_term;
    const struct term *end = term + step->n_terms;
    begin_sums(step->start, term->factor, n, values + term->place * BLOCK, own);
    for (term++; term < end; term++) {
        if (term->place == NOWHERE)
            add_constant(term->factor, n, own);
        else
            add_weighted(term->factor, n, values + term->place * BLOCK, own);
    }
    cppn_activate(step->activation, step->bias, step->response, n, own);
}

static void write_outputs(const cppn_network *network, int64_t n, const double *restrict values,
                          double *restrict outputs)
{
    for (int64_t output = 0; output < network->n_outputs; output++) {
        const struct value value = network->outputs[output];
        for (int64_t i = 0; i < n; i++)
            outputs[i * network->n_outputs + output] =
                value.place == NOWHERE ? value.constant : values[value.place * BLOCK + i];
    }
}

static void evaluate_block(const cppn_network *network, int64_t n, const double *points,
                           double *values, double *outputs)
{
    read_points(network, n, points, values);
    for (int64_t k = 0; k < network->n_steps; k++)
        take_step(&network->steps[k], network->terms, n, values,
                  values + (network->n_inputs + k) * BLOCK);
    write_outputs(network, n, values, outputs);
}

enum cppn_status cppn_evaluate(const cppn_network *network, int64_t n_points, const double *points,
                               double *outputs)
{
    if (!network || !points || !outputs) return CPPN_NULL_ARGUMENT;
    const int64_t most = PTRDIFF_MAX / (int64_t)sizeof(double);
    if (n_points < 0 || n_points > most / network->n_inputs || n_points > most / network->n_outputs)
        return CPPN_BAD_POINTS;
    const int64_t places = network->n_inputs + network->n_steps;
    double *values = malloc((size_t)places * BLOCK * sizeof *values);
    if (!values) return CPPN_NO_MEMORY;
    for (int64_t done = 0; done < n_points; done += BLOCK) {
        const int64_t n = n_points - done < BLOCK ? n_points - done : BLOCK;
        evaluate_block(network, n, points + done * network->n_inputs, values,
                       outputs + done * network->n_outputs);
    }
    free(values);
    return CPPN_OK;
}
