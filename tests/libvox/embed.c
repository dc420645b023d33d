/* The solver without Python: a clamped bar of ten voxels, its outer half contractile. */
#include <stdio.h>

#include "vox.h"

enum { CELLS = 10, PASSIVE = 1, CONTRACTILE = 3 };

int main(void)
{
    const struct vox_settings settings = {
        .nx = CELLS, .ny = 1, .nz = 1,
        .voxel_size = 0.05, .time_step_fraction = 0.9, .duration = 0.07,
        .temperature_amplitude = 14.4714242553, .period = 0.25,
        .bond_damping = 1.0, .slow_damping = 0.01,
        .self_collision = 1, .collision_horizon = 2.0, .collision_list_factor = 1.5,
    };
    const struct vox_material palette[] = {
        [PASSIVE] = {1, 5e6, 0.35, 1e6, 0.0},
        [CONTRACTILE] = {1, 5e6, 0.35, 1e6, 0.01},
    };
    const uint8_t clamped[CELLS] = {1};
    const uint8_t material[CELLS] = {1, 1, 1, 1, 1, 3, 3, 3, 3, 3};
    const double phase_cycles[CELLS] = {0};

    vox_model *model;
    enum vox_status status = vox_model_create(&settings, palette, sizeof palette / sizeof *palette, clamped, &model, NULL);
    if (status != VOX_OK) {
        fprintf(stderr, "%s\n", vox_status_message(status));
        return 1;
    }
    int64_t steps, diverged_step;
    double tip[3];
    status = vox_time_steps(model, 1, material, NULL, &steps, NULL);
    if (status == VOX_OK)
        status = vox_simulate(model, 1, material, phase_cycles, 1, &steps, &(struct vox_tracks){.tip = tip},
                              &diverged_step, NULL);
    if (status == VOX_OK) printf("tip after %d steps: %.9f %.9f %.9f m\n", (int)steps, tip[0], tip[1], tip[2]);
    vox_model_destroy(model);
    return status != VOX_OK || diverged_step != 0;
}
