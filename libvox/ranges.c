/* Ranges of settings and material properties: one table each, used for checks and messages. */
#include "internal.h"

struct row {
    struct vox_range range;
    size_t offset; /* of the field in the struct */
    const char *message;
};

/* Row for a field of OWNER; messages contain the numbers as written here. */
#define ROW(status, field, low, low_in, high, high_in, words)              \
    {{#field, status, IS_WHOLE(field), low, high, low_in, high_in, words}, \
     offsetof(OWNER, field),                                               \
     #field " must be " words}
#define IS_WHOLE(field) _Generic(((OWNER *)0)->field, int64_t: 1, double: 0)

#define BETWEEN(status, field, low, high, unit) \
    ROW(status, field, low, 1, high, 1, "between " #low " and " #high unit)
#define ABOVE(status, field, low, high, unit) \
    ROW(status, field, low, 0, high, 1, "above " #low " and at most " #high unit)
#define AT_LEAST(status, field, low) ROW(status, field, low, 1, INFINITY, 0, "at least " #low)
#define NOT_NEGATIVE(status, field) ROW(status, field, 0, 1, INFINITY, 0, "finite and not negative")
#define FINITE(status, field) ROW(status, field, -INFINITY, 0, INFINITY, 0, "finite")

#define OWNER struct vox_settings
static const struct row settings[] = {
    BETWEEN(VOX_BAD_VOXEL_SIZE, voxel_size, 1e-6, 1e6, " m"),
    ABOVE(VOX_BAD_TIME_STEP_FRACTION, time_step_fraction, 0, 1, ""),
    BETWEEN(VOX_BAD_SUBSTEPS, substeps, 1, 1000, ""),
    AT_LEAST(VOX_BAD_STEP_LIMIT, step_limit, 1),
    ABOVE(VOX_BAD_DURATION, duration, 0, 1e9, " s"),
    FINITE(VOX_BAD_TEMPERATURE_AMPLITUDE, temperature_amplitude),
    BETWEEN(VOX_BAD_PERIOD, period, 1e-9, 1e9, " s"),
    BETWEEN(VOX_BAD_START_TIME, start_time, 0, 1e9, " s"),
    BETWEEN(VOX_BAD_RAMP, ramp, 0, 1e9, " s"),
    BETWEEN(VOX_BAD_SMALLEST_SIZE, smallest_size, 1e-3, 1, ""),
    BETWEEN(VOX_BAD_LARGEST_SIZE, largest_size, 1, 10, ""),
    FINITE(VOX_BAD_GRAVITY, gravity),
    BETWEEN(VOX_BAD_FLOOR_SLOPE, floor_slope, -89, 89, " degrees"),
    BETWEEN(VOX_BAD_FALLING_CODE, falling_code, 0, 255, ""),
    NOT_NEGATIVE(VOX_BAD_FLUID_DRAG, fluid_drag),
    NOT_NEGATIVE(VOX_BAD_BOND_DAMPING, bond_damping),
    NOT_NEGATIVE(VOX_BAD_SLOW_DAMPING, slow_damping),
    NOT_NEGATIVE(VOX_BAD_FLOOR_DAMPING, floor_damping),
    NOT_NEGATIVE(VOX_BAD_CONTACT_DAMPING, contact_damping),
    BETWEEN(VOX_BAD_COLLISION_ENVELOPE, collision_envelope, 1, 2, ""),
    BETWEEN(VOX_BAD_COLLISION_HORIZON, collision_horizon, 1, 10, ""),
    BETWEEN(VOX_BAD_COLLISION_LIST_FACTOR, collision_list_factor, 1, 2, ""),
    ABOVE(VOX_BAD_LARGEST_STRAIN, largest_strain, 0, 1e9, ""),
    ABOVE(VOX_BAD_LARGEST_DISTANCE, largest_distance, 0, 1e9, ""),
};
#undef OWNER

#define OWNER struct vox_material
static const struct row properties[] = {
    BETWEEN(VOX_BAD_YOUNGS_MODULUS, youngs_modulus, 1e-6, 1e18, " Pa"),
    BETWEEN(VOX_BAD_POISSON_RATIO, poisson_ratio, 0, 0.5, ""),
    BETWEEN(VOX_BAD_DENSITY, density, 1e-6, 1e18, " kg/m3"),
    FINITE(VOX_BAD_EXPANSION, expansion),
    NOT_NEGATIVE(VOX_BAD_STATIC_FRICTION, static_friction),
    NOT_NEGATIVE(VOX_BAD_DYNAMIC_FRICTION, dynamic_friction),
};
#undef OWNER

enum {
    N_SETTINGS = sizeof settings / sizeof *settings,
    N_PROPERTIES = sizeof properties / sizeof *properties
};

const struct vox_range *vox_setting_range(int32_t number)
{
    return number >= 0 && number < N_SETTINGS ? &settings[number].range : NULL;
}

const struct vox_range *vox_property_range(int32_t number)
{
    return number >= 0 && number < N_PROPERTIES ? &properties[number].range : NULL;
}

/* Return whether a number is in a range; false for NaN. */
static bool is_in(const struct vox_range *range, double x)
{
    return (range->lower_included ? x >= range->lower : x > range->lower) &&
           (range->upper_included ? x <= range->upper : x < range->upper);
}

static enum vox_status check(const struct row *rows, int n, const void *numbers)
{
    for (int i = 0; i < n; i++) {
        const void *field = (const char *)numbers + rows[i].offset;
        const double x =
            rows[i].range.whole ? (double)*(const int64_t *)field : *(const double *)field;
        if (!is_in(&rows[i].range, x)) return rows[i].range.status;
    }
    return VOX_OK;
}

enum vox_status vox_settings_check(const struct vox_settings *s)
{
    return check(settings, N_SETTINGS, s);
}

enum vox_status vox_properties_check(const struct vox_material *material)
{
    return check(properties, N_PROPERTIES, material);
}

static const char *message_in(const struct row *rows, int n, enum vox_status status)
{
    for (int i = 0; i < n; i++)
        if (rows[i].range.status == status) return rows[i].message;
    return NULL;
}

const char *vox_range_message(enum vox_status status)
{
    const char *message = message_in(settings, N_SETTINGS, status);
    return message ? message : message_in(properties, N_PROPERTIES, status);
}
