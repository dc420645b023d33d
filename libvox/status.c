/* What each status means, for a person. */
#include "vox.h"

const char *vox_status_message(enum vox_status status)
{
    switch (status) {
    case VOX_OK: return "no error";
    case VOX_NO_MEMORY: return "not enough memory";
    case VOX_NULL_ARGUMENT: return "a required array is missing";
    case VOX_BAD_CANVAS: return "the canvas must be at least 1 cell along each axis and at most 2^24 cells in all";
    case VOX_BAD_VOXEL_SIZE: return "voxel_size must be between 1e-6 and 1e6 m";
    case VOX_BAD_TIME_STEP_FRACTION: return "time_step_fraction must be above 0 and at most 1";
    case VOX_BAD_DURATION: return "duration must be positive and finite";
    case VOX_BAD_TEMPERATURE_AMPLITUDE: return "temperature_amplitude must be finite";
    case VOX_BAD_PERIOD: return "period must be positive and finite";
    case VOX_BAD_BOND_DAMPING: return "bond_damping must be finite and not negative";
    case VOX_BAD_SLOW_DAMPING: return "slow_damping must be finite and not negative";
    case VOX_BAD_COLLISION_HORIZON: return "collision_horizon must be between 1 and 4";
    case VOX_BAD_COLLISION_LIST_FACTOR: return "collision_list_factor must be between 1 and 2";
    case VOX_BAD_PALETTE: return "the palette must give at least one material, with codes from 1 to 255";
    case VOX_BAD_YOUNGS_MODULUS: return "youngs_modulus must be positive and finite";
    case VOX_BAD_POISSON_RATIO: return "poisson_ratio must be at least 0 and below 0.5";
    case VOX_BAD_DENSITY: return "density must be positive and finite";
    case VOX_BAD_EXPANSION: return "expansion, and expansion times temperature_amplitude, must be finite";
    case VOX_BAD_BATCH: return "the number of bodies or samples is negative or too large";
    case VOX_UNKNOWN_MATERIAL: return "a cell has a material code that is not in the palette";
    case VOX_EMPTY_BODY: return "the body has no voxel";
    case VOX_BAD_PHASE: return "the phase of an expanding voxel must be finite and within 1e6 cycles of 0";
    case VOX_BAD_TIME_STEP: return "materials, voxel_size and duration give no usable time step (at most 2^53 steps)";
    case VOX_BAD_SAMPLE_ORDER: return "sample_steps must be strictly ascending and not negative";
    case VOX_SAMPLE_OUT_OF_RANGE: return "the last of sample_steps is beyond the end of the simulation";
    }
    return "unknown status";
}
