/* A network without Python: the distance from the center of a square, and a wave along x. */
#include <stdio.h>

#include "cppn.h"

enum { INPUTS = 2, OUTPUTS = 2, POINTS = 3 };

int main(void)
{
    const struct cppn_node nodes[] = {
        {.id = 0, .activation = CPPN_SQRT_ABS, .response = 1.0},
        {.id = 1, .activation = CPPN_SIN, .response = 1.0},
        {.id = 2, .activation = CPPN_SQUARE, .bias = -0.5, .response = 1.0},
        {.id = 3, .activation = CPPN_SQUARE, .bias = -0.5, .response = 1.0},
    };
    const struct cppn_link links[] = {
        {-1, 2, 1.0}, {-2, 3, 1.0}, {2, 0, 1.0}, {3, 0, 1.0}, {-1, 1, 1.0},
    };
    const double points[POINTS][INPUTS] = {{0.5, 0.5}, {1.0, 0.5}, {0.0, 0.0}};
    double outputs[POINTS][OUTPUTS];

    cppn_network *network;
    enum cppn_status status = cppn_compile(INPUTS, OUTPUTS, 4, nodes, 5, links, &network, NULL);
    if (status == CPPN_OK) status = cppn_evaluate(network, POINTS, points[0], outputs[0]);
    cppn_destroy(network);
    if (status != CPPN_OK) {
        fprintf(stderr, "%s\n", cppn_status_message(status));
        return 1;
    }
    for (int i = 0; i < POINTS; i++)
        printf("%.9f %.9f\n", outputs[i][0], outputs[i][1]);
    return 0;
}
