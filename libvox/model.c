/* Settings and materials: checks beyond their ranges, and derived constants (sections 1, 5, 6 and
 * 9). */
#include <stdlib.h>

#include "internal.h"

static const double RADIANS = 3.14159265358979323846 / 180.0;

static bool canvas_fits(const struct vox_settings *s)
{
    const int64_t most = VOX_MAX_CELLS;
    return s->nx >= 1 && s->ny >= 1 && s->nz >= 1 && s->nx <= most && s->ny <= most / s->nx &&
           s->nz <= most / (s->nx * s->ny);
}

static enum vox_status check_settings(const struct vox_settings *s)
{
    if (!canvas_fits(s)) return VOX_BAD_CANVAS;
    const enum vox_status status = vox_settings_check(s);
    if (status != VOX_OK) return status;
    return vox_kernel_of(s->kernel) ? VOX_OK : VOX_BAD_KERNEL;
}

static enum vox_status check_material(const struct vox_material *m, const struct vox_settings *s)
{
    const enum vox_status status = vox_properties_check(m);
    if (status != VOX_OK) return status;
    return isfinite(m->expansion * s->temperature_amplitude) ? VOX_OK : VOX_BAD_EXPANSION;
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
        .floor_stiffness = 2.0 * m->youngs_modulus * edge,
        .floor_drag = s->floor_damping * critical_drag,
        .static_friction = m->static_friction,
        .dynamic_friction = m->dynamic_friction,
    };
}

static double harmonic_mean(double a, double b)
{
    return a + b > 0.0 ? 2.0 * a * b / (a + b) : 0.0;
}

static struct damper damper_of(const struct coupling *c, const struct substance *end,
                               const struct vox_settings *s)
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

/* An Euler-Bernoulli beam of square cross section, as thick as it is long. */
static struct coupling coupling_between(const struct substance *lower,
                                        const struct substance *upper, const struct vox_settings *s)
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
    const double reduced_mass = 0.5 * harmonic_mean(lower->mass, upper->mass);
    c.touch_drag = s->contact_damping * 2.0 * sqrt(c.stretch * reduced_mass);
    c.touch_friction =
        s->contact_friction ? 0.5 * (lower->dynamic_friction + upper->dynamic_friction) : 0.0;
    return c;
}

static enum vox_status read_palette(vox_model *model, const struct vox_material *palette,
                                    int32_t n_codes, int64_t *culprit)
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

/* Upper bound of the size of a voxel under any actuation (section 4). */
static double largest_size(const vox_model *model)
{
    double amplitude = 0.0;
    for (int32_t i = 0; i < model->n_substances; i++)
        amplitude = fmax(amplitude, fabs(model->substances[i].strain_amplitude));
    return model->settings.voxel_size *
           fmax(1.0, fmin(model->settings.largest_size, fmax(1.0, model->rest_scale) + amplitude));
}

/* Put the longest axis of the canvas last: the tiles of a long body are then its slices, of which
 * those far from a sample can be left out. */
static void choose_order(vox_model *model)
{
    const int64_t length[] = {model->settings.nx, model->settings.ny, model->settings.nz};
    enum axis *order = model->order;
    for (int i = 0; i < 3; i++) {
        int at = i;
        for (; at > 0 && length[order[at - 1]] > length[i]; at--) order[at] = order[at - 1];
        order[at] = (enum axis)i;
    }
}

static void derive_constants(vox_model *model, const struct vox_material *palette)
{
    const struct vox_settings *s = &model->settings;
    choose_order(model);
    model->rest_scale = (double)(float)s->voxel_size / s->voxel_size;
    const double longest = fmax((double)s->nx, fmax((double)s->ny, (double)s->nz)); /* cells */
    model->too_far = s->largest_distance * s->voxel_size * longest;
    model->floor_rise = tan(RADIANS * s->floor_slope);
    for (int32_t code = 0; code < VOX_MAX_CODES; code++)
        if (model->of_code[code] >= 0)
            model->substances[model->of_code[code]] = substance_of(&palette[code], s);
    for (int32_t i = 0; i < model->n_substances; i++)
        for (int32_t j = 0; j < model->n_substances; j++)
            model->couplings[i * model->n_substances + j] =
                coupling_between(&model->substances[i], &model->substances[j], s);
    model->largest_size = largest_size(model);
    for (int32_t i = 0; i < model->n_substances * model->n_substances; i++)
        model->fastest = fmax(model->fastest, model->couplings[i].fastest);
}

static enum vox_status read_fixed(vox_model *model, const uint8_t *fixed, int64_t *culprit)
{
    for (int64_t cell = 0; cell < model->cells; cell++) {
        if (fixed[cell] > VOX_FIX_ALL) {
            *culprit = cell;
            return VOX_BAD_FIXED;
        }
        model->fixed[cell] = fixed[cell];
    }
    return VOX_OK;
}

static enum vox_status fill(vox_model *model, const struct vox_material *palette, int32_t n_codes,
                            const uint8_t *fixed, int64_t *culprit)
{
    const enum vox_status status = read_palette(model, palette, n_codes, culprit);
    if (status != VOX_OK) return status;
    const size_t n = (size_t)model->n_substances;
    model->cells = model->settings.nx * model->settings.ny * model->settings.nz;
    model->substances = malloc(n * sizeof *model->substances);
    model->couplings = malloc(n * n * sizeof *model->couplings);
    model->fixed = calloc((size_t)model->cells, 1);
    model->spares = calloc(1, sizeof *model->spares);
    if (!model->substances || !model->couplings || !model->fixed || !model->spares)
        return VOX_NO_MEMORY;
    atomic_flag_clear(&model->spares->busy);
    derive_constants(model, palette);
    const struct vox_settings *s = &model->settings;
    const int64_t hops = (int64_t)(s->collision_list_factor * s->collision_horizon);
    const enum vox_status built = vox_vicinity_create(
        &model->vicinity, hops,
        (vox_contacts_reach(model) / s->voxel_size + 2.0 * STRAYED) * (1.0 + 1e-12));
    if (built != VOX_OK) return built;
    if (vox_cone_prepare(model) != VOX_OK) return VOX_NO_MEMORY;
    return fixed ? read_fixed(model, fixed, culprit) : VOX_OK;
}

enum vox_status vox_model_create(const struct vox_settings *settings,
                                 const struct vox_material *palette, int32_t n_codes,
                                 const uint8_t *fixed, vox_model **model, int64_t *culprit)
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
    made->kernel = vox_kernel_of(settings->kernel);
    status = fill(made, palette, n_codes, fixed, culprit);
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
    free(model->fixed);
    free(model->steps_across);
    vox_vicinity_destroy(&model->vicinity);
    vox_bodies_destroy(model);
    free(model);
}
