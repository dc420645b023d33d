/* Peak of a core with the compiler's vector instructions: multiplications with additions, divisions, square roots,
 * and the traffic between core and memory. */
#include <math.h>
#include <stdint.h>

#if defined __AVX512F__
#define VECTOR_BYTES 64
#elif defined __AVX2__
#define VECTOR_BYTES 32
#else
#define VECTOR_BYTES 16
#endif

typedef double vector __attribute__((vector_size(VECTOR_BYTES)));

enum { LANES = VECTOR_BYTES / 8, CHAINS = 12, HELD = 512 };

/* Number of operations of chains_run in a round. */
int64_t chains_operations(void)
{
    return 2 * CHAINS * LANES;
}

/* Independent chains of a multiplication and an addition, enough to hide the latency of both. */
double chains_run(int64_t rounds, double factor, double term)
{
    vector chain[CHAINS], a, b, sum;
    for (int lane = 0; lane < LANES; lane++) {
        a[lane] = factor;
        b[lane] = term;
    }
    for (int i = 0; i < CHAINS; i++) chain[i] = a + (double)i;
    for (int64_t round = 0; round < rounds; round++) {
#pragma GCC unroll 12
        for (int i = 0; i < CHAINS; i++) chain[i] = chain[i] * a + b;
    }
    sum = chain[0];
    for (int i = 1; i < CHAINS; i++) sum += chain[i];
    return sum[0];
}

/* Number of values that the next two functions process in a round. */
int64_t held_numbers(void)
{
    return HELD;
}

double divisions_run(int64_t rounds, double dividend)
{
    double x[HELD];
    for (int i = 0; i < HELD; i++) x[i] = 1.0 + i;
    for (int64_t round = 0; round < rounds; round++)
        for (int i = 0; i < HELD; i++) x[i] = dividend / x[i];
    return x[HELD / 2];
}

double roots_run(int64_t rounds, double term)
{
    double x[HELD];
    for (int i = 0; i < HELD; i++) x[i] = 1.0 + i;
    for (int64_t round = 0; round < rounds; round++)
        for (int i = 0; i < HELD; i++) x[i] = sqrt(x[i] + term);
    return x[HELD / 2];
}

/* Reads two arrays and writes one in each round. */
void triad_run(int64_t rounds, int64_t n, double factor, double *restrict to, const double *restrict a,
               const double *restrict b)
{
    for (int64_t round = 0; round < rounds; round++) {
        for (int64_t i = 0; i < n; i++) to[i] = a[i] + factor * b[i];
        __asm__ volatile("" ::: "memory"); /* so that the compiler removes no round */
    }
}
