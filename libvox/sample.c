/* Recording of tracks. Nothing in this file changes a body. */
#include "internal.h"

static void write_vec(double *out, struct vec v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/* Mass-weighted mean position of the voxels whose initial x is at least `from_x`. */
static struct vec mean_position(const struct body *body, double from_x)
{
    struct vec moment = {0};
    double mass = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        if (body->voxels.start.x[slot] < from_x) continue;
        const double own = substance_of_voxel(body, slot)->mass;
        moment = vec_add(moment, vec_scale(own, vec_at(body->voxels.position, slot)));
        mass += own;
    }
    return vec_scale(1.0 / mass, moment);
}

static double largest_start_x(const struct body *body)
{
    return body->voxels.start.x[(body->census.length[0] - 1) * body->step[AXIS_X]];
}

static void write_voxels(const struct body *body, double *out)
{
    for (int64_t i = 0; i < 3 * body->model->cells; i++) out[i] = NAN;
    for (int64_t i = 0; i < body->census.n_voxels; i++)
        write_vec(out + 3 * body->cells[i], vec_at(body->voxels.position, body->slots[i]));
}

static double kinetic_energy(const struct body *body)
{
    const struct voxels *v = &body->voxels;
    double energy = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        const struct vec momentum = vec_at(v->momentum, slot), spin = vec_at(v->spin, slot);
        energy += 0.5 * vec_dot(momentum, momentum) * v->mobility[slot];
        energy += 0.5 * vec_dot(spin, spin) * v->turnability[slot];
    }
    return energy;
}

static void write_tension(const struct body *body, const struct vox_tracks *tracks, int64_t row)
{
    const struct tension tension = vox_bonds_tension(body);
    if (tracks->energy) {
        tracks->energy[2 * row] = tension.energy;
        tracks->energy[2 * row + 1] = kinetic_energy(body);
    }
    if (tracks->strain) {
        tracks->strain[2 * row] = tension.least;
        tracks->strain[2 * row + 1] = tension.greatest;
    }
}

static void write_momentum(const struct body *body, double *out)
{
    const struct voxels *v = &body->voxels;
    struct vec linear = {0}, angular = {0};
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        const struct vec momentum = vec_at(v->momentum, slot);
        const struct vec orbital = vec_cross(vec_at(v->position, slot), momentum);
        linear = vec_add(linear, momentum);
        angular = vec_add(angular, vec_add(orbital, vec_at(v->spin, slot)));
    }
    write_vec(out, linear);
    write_vec(out + 3, angular);
}

void vox_sample_write(const struct body *body, const struct vox_tracks *tracks, int64_t row)
{
    const int32_t last = body->slots[body->census.n_voxels - 1];
    if (tracks->tip) write_vec(tracks->tip + 3 * row, vec_at(body->voxels.position, last));
    if (tracks->face) write_vec(tracks->face + 3 * row, mean_position(body, largest_start_x(body)));
    if (tracks->body) write_vec(tracks->body + 3 * row, mean_position(body, 0.0));
    if (tracks->voxels) write_voxels(body, tracks->voxels + 3 * row * body->model->cells);
    if (tracks->energy || tracks->strain) write_tension(body, tracks, row);
    if (tracks->momentum) write_momentum(body, tracks->momentum + 6 * row);
}

static void write_nan(double *track, int64_t width, int64_t begin, int64_t end)
{
    if (!track) return;
    for (int64_t i = width * begin; i < width * end; i++) track[i] = NAN;
}

void vox_sample_write_nothing(const vox_model *model, const struct vox_tracks *tracks,
                              int64_t begin, int64_t end)
{
    write_nan(tracks->tip, 3, begin, end);
    write_nan(tracks->face, 3, begin, end);
    write_nan(tracks->body, 3, begin, end);
    write_nan(tracks->voxels, 3 * model->cells, begin, end);
    write_nan(tracks->energy, 2, begin, end);
    write_nan(tracks->strain, 2, begin, end);
    write_nan(tracks->momentum, 6, begin, end);
}
