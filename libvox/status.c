/* Messages for statuses. */
#include "internal.h"

const char *vox_status_message(enum vox_status status)
{
    switch (status) {
    case VOX_OK: return "no error";
    case VOX_NO_MEMORY: return "not enough memory";
    case VOX_NULL_ARGUMENT: return "a required array is missing";
    case VOX_BAD_CANVAS:
        return "the canvas must have at least 1 cell along each axis and at most 2^24 cells";
    case VOX_BAD_KERNEL: return "kernel must be supported by this processor";
    case VOX_BAD_PALETTE:
        return "the palette must contain at least one material, with codes from 1 to 255";
    case VOX_BAD_EXPANSION:
        return "expansion and expansion times temperature_amplitude must be finite";
    case VOX_BAD_FIXED:
        return "fixed must be at most 63: one bit for each of the six degrees of freedom";
    case VOX_BAD_BATCH: return "the number of bodies or samples is negative or too large";
    case VOX_UNKNOWN_MATERIAL: return "a cell has a material code that is not in the palette";
    case VOX_EMPTY_BODY: return "the body has no voxels";
    case VOX_BAD_PHASE:
        return "the phase of an expanding voxel must be between -1e6 and 1e6 cycles";
    case VOX_BAD_TIME_STEP:
        return "materials, voxel_size and duration give no usable time step (at most 2^53 steps)";
    case VOX_TOO_MANY_STEPS: return "the body requires more steps than step_limit";
    case VOX_BAD_SAMPLE_ORDER: return "sample_steps must be strictly ascending and not negative";
    case VOX_SAMPLE_OUT_OF_RANGE:
        return "the last value of sample_steps is beyond the end of the simulation";
    default: break;
    }
    const char *message = vox_range_message(status);
    return message ? message : "unknown status";
}
