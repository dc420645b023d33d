/* Settings and materials: their checks, and the constants that follow from them (sections 1, 5 and 6). */
#include <stdlib.h>
#include <string.h>

#include "internal.h"

static bool positive(double x)
{
    return isfinite(x) && x > 0.0;
}

static bool not_negative(double x)
{
    return isfinite(x) && x >= 0.0;
}

static bool within(double low, double x, double high)
{
    return low <= x && x <= high; /* false for a NaN */
}

static bool canvas_fits(const struct vox_settings *s)
{
    const int64_t most = VOX_MAX_CELLS;
    return s->nx >= 1 && s->ny >= 1 && s->nz >= 1 && s->nx <= most && s->ny <= most / s->nx &&
           s->nz <= most / (s->nx * s->ny);
}

static enum vox_status check_settings(const struct vox_settings *s)
{
    if (!canvas_fits(s)) return VOX_BAD_CANVAS;
    if (!within(1e-6, s->voxel_size, 1e6)) return VOX_BAD_VOXEL_SIZE;
    if (!(s->time_step_fraction > 0.0 && s->time_step_fraction <= 1.0)) return VOX_BAD_TIME_STEP_FRACTION;
    if (!positive(s->duration)) return VOX_BAD_DURATION;
    if (!isfinite(s->temperature_amplitude)) return VOX_BAD_TEMPERATURE_AMPLITUDE;
    if (!positive(s->period)) return VOX_BAD_PERIOD;
    if (!not_negative(s->bond_damping)) return VOX_BAD_BOND_DAMPING;
    if (!not_negative(s->slow_damping)) return VOX_BAD_SLOW_DAMPING;
    if (!within(1.0, s->collision_horizon, 4.0)) return VOX_BAD_COLLISION_HORIZON;
    if (!within(1.0, s->collision_list_factor, 2.0)) return VOX_BAD_COLLISION_LIST_FACTOR;
    return VOX_OK;
}

static enum vox_status check_material(const struct vox_material *m, const struct vox_settings *s)
{
    if (!positive(m->youngs_modulus)) return VOX_BAD_YOUNGS_MODULUS;
    if (!(m->poisson_ratio >= 0.0 && m->poisson_ratio < 0.5)) return VOX_BAD_POISSON_RATIO;
    if (!positive(m->density)) return VOX_BAD_DENSITY;
    if (!isfinite(m->expansion) || !isfinite(m->expansion * s->temperature_amplitude)) return VOX_BAD_EXPANSION;
    return VOX_OK;
}

static struct substance substance_of(const struct vox_material *m, const struct vox_settings *s)
{
    const double edge = s->voxel_size;
    const double mass = m->density * edge * edge * edge;
    const double inertia = mass * edge * edge / 6.0;
    const double critical_drag = 2.0 * sqrt(mass * m->youngs_modulus * edge);
    const double critical_spin_drag = 2.0 * sqrt(inertia * m->youngs_modulus * edge * edge * edge);
    return (struct substance){
        .youngs_modulus = m->youngs_modulus,
        .poisson_ratio = m->poisson_ratio,
        .mass = mass,
        .inertia = inertia,
        .strain_amplitude = m->expansion * s->temperature_amplitude,
        .slow_drag = s->slow_damping * critical_drag,
        .slow_spin_rate = 10.0 * s->slow_damping * critical_spin_drag / inertia,
    };
}

static double harmonic_mean(double a, double b)
{
    return a + b > 0.0 ? 2.0 * a * b / (a + b) : 0.0;
}

static struct damper damper_of(const struct coupling *c, const struct substance *end, const struct vox_settings *s)
{
    const double first_moment = end->mass * s->voxel_size / 2.0;
    const double share = s->bond_damping / 2.0;
    const double bend_shear = 2.0 * sqrt(c->bend_shear * first_moment);
    return (struct damper){
        .stretch = share * 2.0 * sqrt(c->stretch * end->mass),
        .shear = share * 2.0 * sqrt(c->shear * end->mass),
        .bend_shear = share * bend_shear,
        .moment_shear = share / 2.0 * bend_shear,
        .bend = share / 2.0 * 2.0 * sqrt(c->bend * end->inertia),
        .twist = share / 2.0 * 2.0 * sqrt(c->twist * end->inertia),
    };
}

/* An Euler-Bernoulli beam of square section, as thick as it is long. */
static struct coupling coupling_between(const struct substance *lower, const struct substance *upper,
                                        const struct vox_settings *s)
{
    const double edge = s->voxel_size;
    const double modulus = harmonic_mean(lower->youngs_modulus, upper->youngs_modulus);
    const double poisson = harmonic_mean(lower->poisson_ratio, upper->poisson_ratio);
    struct coupling c = {
        .stretch = modulus * edge,
        .twist = modulus * edge * edge * edge / (12.0 * (1.0 + poisson)),
        .shear = modulus * edge,
        .bend_shear = modulus * edge * edge / 2.0,
        .bend = modulus * edge * edge * edge / 6.0,
    };
    c.lower = damper_of(&c, lower, s);
    c.upper = damper_of(&c, upper, s);
    c.fastest = fmax(c.stretch / lower->mass, c.stretch / upper->mass);
    return c;
}

static enum vox_status read_palette(vox_model *model, const struct vox_material *palette, int32_t n_codes,
                                    int64_t *culprit)
{
    for (int32_t code = 0; code < VOX_MAX_CODES; code++) model->of_code[code] = -1;
    for (int32_t code = 1; code < n_codes; code++) {
        if (!palette[code].used) continue;
        const enum vox_status status = check_material(&palette[code], &model->settings);
        if (status != VOX_OK) {
            *culprit = code;
            return status;
        }
        model->of_code[code] = (int16_t)model->n_substances++;
    }
    return model->n_substances > 0 ? VOX_OK : VOX_BAD_PALETTE;
}

static void derive_constants(vox_model *model, const struct vox_material *palette)
{
    const struct vox_settings *s = &model->settings;
    model->rest_scale = (double)(float)s->voxel_size / s->voxel_size;
    model->too_far = 100.0 * s->voxel_size * (double)(s->nx > s->ny ? (s->nx > s->nz ? s->nx : s->nz)
                                                                     : (s->ny > s->nz ? s->ny : s->nz));
    for (int32_t code = 0; code < VOX_MAX_CODES; code++)
        if (model->of_code[code] >= 0) model->substances[model->of_code[code]] = substance_of(&palette[code], s);
    for (int32_t i = 0; i < model->n_substances; i++)
        for (int32_t j = 0; j < model->n_substances; j++)
            model->couplings[i * model->n_substances + j] =
                coupling_between(&model->substances[i], &model->substances[j], s);
}

static enum vox_status fill(vox_model *model, const struct vox_material *palette, int32_t n_codes,
                            const uint8_t *clamped, int64_t *culprit)
{
    const enum vox_status status = read_palette(model, palette, n_codes, culprit);
    if (status != VOX_OK) return status;
    const size_t n = (size_t)model->n_substances;
    model->cells = model->settings.nx * model->settings.ny * model->settings.nz;
    model->substances = malloc(n * sizeof *model->substances);
    model->couplings = malloc(n * n * sizeof *model->couplings);
    model->clamped = calloc((size_t)model->cells, 1);
    if (!model->substances || !model->couplings || !model->clamped) return VOX_NO_MEMORY;
    derive_constants(model, palette);
    if (clamped) memcpy(model->clamped, clamped, (size_t)model->cells);
    return VOX_OK;
}

enum vox_status vox_model_create(const struct vox_settings *settings, const struct vox_material *palette,
                                 int32_t n_codes, const uint8_t *clamped, vox_model **model, int64_t *culprit)
{
    int64_t nobody;
    if (!culprit) culprit = &nobody;
    *culprit = -1;
    if (!model) return VOX_NULL_ARGUMENT;
    *model = NULL;
    if (!settings || !palette) return VOX_NULL_ARGUMENT;
    if (n_codes < 1 || n_codes > VOX_MAX_CODES) return VOX_BAD_PALETTE;
    enum vox_status status = check_settings(settings);
    if (status != VOX_OK) return status;
    vox_model *made = calloc(1, sizeof *made);
    if (!made) return VOX_NO_MEMORY;
    made->settings = *settings;
    status = fill(made, palette, n_codes, clamped, culprit);
    if (status != VOX_OK) {
        vox_model_destroy(made);
        return status;
    }
    *model = made;
    return VOX_OK;
}

void vox_model_destroy(vox_model *model)
{
    if (!model) return;
    free(model->substances);
    free(model->couplings);
    free(model->clamped);
    free(model);
}
