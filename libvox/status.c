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
    case VOX_BAD_SUBSTEPS: return "substeps must be between 1 and 1000";
    case VOX_BAD_STEP_LIMIT: return "step_limit must be at least 1";
    case VOX_BAD_DURATION: return "duration must be above 0 and at most 1e9 s";
    case VOX_BAD_TEMPERATURE_AMPLITUDE: return "temperature_amplitude must be finite";
    case VOX_BAD_PERIOD: return "period must be between 1e-9 and 1e9 s";
    case VOX_BAD_START_TIME: return "start_time must be between 0 and 1e9 s";
    case VOX_BAD_RAMP: return "ramp must be between 0 and 1e9 s";
    case VOX_BAD_GRAVITY: return "gravity must be finite";
    case VOX_BAD_FLOOR_SLOPE: return "floor_slope must be between -89 and 89 degrees";
    case VOX_BAD_FLUID_DRAG: return "fluid_drag must be finite and not negative";
    case VOX_BAD_BOND_DAMPING: return "bond_damping must be finite and not negative";
    case VOX_BAD_SLOW_DAMPING: return "slow_damping must be finite and not negative";
    case VOX_BAD_FLOOR_DAMPING: return "floor_damping must be finite and not negative";
    case VOX_BAD_CONTACT_DAMPING: return "contact_damping must be finite and not negative";
    case VOX_BAD_COLLISION_ENVELOPE: return "collision_envelope must be between 1 and 2";
    case VOX_BAD_COLLISION_HORIZON: return "collision_horizon must be between 1 and 4";
    case VOX_BAD_COLLISION_LIST_FACTOR: return "collision_list_factor must be between 1 and 2";
    case VOX_BAD_KERNEL: return "kernel must be one that this processor can use";
    case VOX_BAD_LARGEST_STRAIN: return "largest_strain must be above 0 and at most 1e9";
    case VOX_BAD_LARGEST_DISTANCE: return "largest_distance must be above 0 and at most 1e9";
    case VOX_BAD_PALETTE: return "the palette must give at least one material, with codes from 1 to 255";
    case VOX_BAD_YOUNGS_MODULUS: return "youngs_modulus must be between 1e-6 and 1e18 Pa";
    case VOX_BAD_POISSON_RATIO: return "poisson_ratio must be at least 0 and below 0.5";
    case VOX_BAD_DENSITY: return "density must be between 1e-6 and 1e18 kg/m3";
    case VOX_BAD_EXPANSION: return "expansion, and expansion times temperature_amplitude, must be finite";
    case VOX_BAD_STATIC_FRICTION: return "static_friction must be finite and not negative";
    case VOX_BAD_DYNAMIC_FRICTION: return "dynamic_friction must be finite and not negative";
    case VOX_BAD_FIXED: return "fixed must be at most 63, a bit for each of the six degrees of freedom";
    case VOX_BAD_BATCH: return "the number of bodies or samples is negative or too large";
    case VOX_UNKNOWN_MATERIAL: return "a cell has a material code that is not in the palette";
    case VOX_EMPTY_BODY: return "the body has no voxel";
    case VOX_BAD_PHASE: return "the phase of an expanding voxel must be finite and within 1e6 cycles of 0";
    case VOX_BAD_TIME_STEP: return "materials, voxel_size and duration give no usable time step (at most 2^53 steps)";
    case VOX_TOO_MANY_STEPS: return "the body needs more steps than step_limit";
    case VOX_BAD_SAMPLE_ORDER: return "sample_steps must be strictly ascending and not negative";
    case VOX_SAMPLE_OUT_OF_RANGE: return "the last of sample_steps is beyond the end of the simulation";
    }
    return "unknown status";
}
