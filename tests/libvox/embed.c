/* The solver without Python: a bar of ten voxels on a floor, with one end pinned and the outer half
 * contractile. */
#include <stdio.h>

#include "vox.h"

enum { CELLS = 10, PASSIVE = 1, CONTRACTILE = 3 };

int main(void)
{
    const struct vox_settings settings = {
        .nx = CELLS, .ny = 1, .nz = 1,
        .voxel_size = 0.05,
        .time_step_fraction = 0.9, .substeps = 2, .duration = 0.07, .step_limit = 1000,
        .temperature_amplitude = 14.4714242553, .period = 0.25, .start_time = 0.01, .ramp = 0.02,
        .smallest_size = 0.1, .largest_size = 3.0,
        .gravity = -9.81, .floor = 1, .fluid_drag = 750.0,
        .bond_damping = 1.0, .slow_damping = 0.01, .floor_damping = 0.8, .contact_damping = 0.5,
        .self_collision = 1, .contact_friction = 1, .complete_contacts = 1,
        .collision_envelope = 1.0, .collision_horizon = 2.0, .collision_list_factor = 1.5,
        .largest_strain = 100.0, .largest_distance = 100.0,
    };
    const struct vox_material passive = {
        .used = 1, .youngs_modulus = 5e6, .poisson_ratio = 0.35, .density = 1e6, .expansion = 0.0,
        .static_friction = 1.0, .dynamic_friction = 0.5,
    };
    struct vox_material palette[CONTRACTILE + 1] = {[PASSIVE] = passive, [CONTRACTILE] = passive};
    palette[CONTRACTILE].expansion = 0.01;
    const uint8_t fixed[CELLS] = {VOX_FIX_X | VOX_FIX_Y | VOX_FIX_Z};
    const uint8_t material[CELLS] = {1, 1, 1, 1, 1, 3, 3, 3, 3, 3};
    const double phase_cycles[CELLS] = {0};

    vox_model *model;
    enum vox_status status = vox_model_create(&settings, palette, CONTRACTILE + 1, fixed, &model, NULL);
    if (status != VOX_OK) {
        fprintf(stderr, "%s\n", vox_status_message(status));
        return 1;
    }
    int64_t steps, diverged_step = 0;
    uint8_t repeated = 0;
    double tip[3], energy[2];
    const struct vox_tracks tracks = {.tip = tip, .energy = energy};
    status = vox_time_steps(model, 1, material, NULL, &steps, NULL);
    if (status == VOX_OK)
        status = vox_simulate(model, 1, material, phase_cycles, 1, &steps, &tracks, &diverged_step,
                              &repeated, NULL);
    if (status == VOX_OK && diverged_step == 0) {
        printf("tip after %d steps: %.9f %.9f %.9f m\n", (int)steps, tip[0], tip[1], tip[2]);
        printf("energy: %.9f J in bonds, %.9f J kinetic\n", energy[0], energy[1]);
    }
    vox_model_destroy(model);
    return status != VOX_OK || diverged_step != 0 || repeated;
}
