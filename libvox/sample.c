/* What is recorded of a simulation. Nothing here changes a body. */
#include "internal.h"

static void write_vec(double *out, struct vec v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

/* Mass-weighted mean of the voxels whose initial x is at least so large. */
static struct vec mean_position(const struct body *body, double from_x)
{
    struct vec moment = {0};
    double mass = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const struct voxel *voxel = &body->voxels[i];
        if (voxel->start.x < from_x) continue;
        moment = vec_add(moment, vec_scale(voxel->substance->mass, voxel->position));
        mass += voxel->substance->mass;
    }
    return vec_scale(1.0 / mass, moment);
}

static double largest_start_x(const struct body *body)
{
    double largest = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) largest = fmax(largest, body->voxels[i].start.x);
    return largest;
}

static void write_voxels(const struct body *body, double *out)
{
    const struct vec nowhere = {NAN, NAN, NAN};
    for (int64_t cell = 0; cell < body->model->cells; cell++) {
        const int32_t voxel = body->voxel_in[cell];
        write_vec(out + 3 * cell, voxel < 0 ? nowhere : body->voxels[voxel].position);
    }
}

static double kinetic_energy(const struct body *body)
{
    double energy = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const struct voxel *v = &body->voxels[i];
        energy += 0.5 * vec_dot(v->momentum, v->momentum) / v->substance->mass;
        energy += 0.5 * vec_dot(v->spin, v->spin) / v->substance->inertia;
    }
    return energy;
}

static void write_tension(const struct body *body, const struct vox_tracks *tracks, int64_t row)
{
    const struct tension tension = bonds_tension(body);
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
    struct vec linear = {0}, angular = {0};
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const struct voxel *v = &body->voxels[i];
        linear = vec_add(linear, v->momentum);
        angular = vec_add(angular, vec_add(vec_cross(v->position, v->momentum), v->spin));
    }
    write_vec(out, linear);
    write_vec(out + 3, angular);
}

void sample_write(const struct body *body, const struct vox_tracks *tracks, int64_t row)
{
    if (tracks->tip) write_vec(tracks->tip + 3 * row, body->voxels[body->census.n_voxels - 1].position);
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

void sample_write_nothing(const vox_model *model, const struct vox_tracks *tracks, int64_t begin, int64_t end)
{
    write_nan(tracks->tip, 3, begin, end);
    write_nan(tracks->face, 3, begin, end);
    write_nan(tracks->body, 3, begin, end);
    write_nan(tracks->voxels, 3 * model->cells, begin, end);
    write_nan(tracks->energy, 2, begin, end);
    write_nan(tracks->strain, 2, begin, end);
    write_nan(tracks->momentum, 6, begin, end);
}
