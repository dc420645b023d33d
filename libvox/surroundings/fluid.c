/* Drag of a fluid on the surface of a body (section 7). */
#include "internal.h"

/* Below this ratio of the difference to the sum of both stresses, the engine takes both ends of a
 * bond for equally strained. */
static const double EQUAL_STRESSES = 0.0005;

static void set_reach(const struct body *body, int64_t slot, double half)
{
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++)
        body->surface.reach[slot].lower[axis] = body->surface.reach[slot].upper[axis] = half;
}

void vox_fluid_rest(struct body *body)
{
    for (int64_t i = 0; i < body->census.n_voxels; i++)
        set_reach(body, body->slots[i], 0.5 * body->model->settings.voxel_size);
}

/* Return the part of a bond's strain, which is 1 on average, at an end with its own and the other
 * Young's modulus: the stresses of both ends are equal. */
static double part_of(double own, double other)
{
    return fabs(own - other) > EQUAL_STRESSES * (own + other) ? 2.0 * other / (own + other) : 1.0;
}

/* Set the reach of both ends of a bond toward each other; as in the engine, a voxel that is clamped
 * in all degrees of freedom keeps that of the start. */
static void strain_ends(struct body *body, enum axis axis, int64_t lower)
{
    const int64_t upper = lower + body->bonds[axis].step;
    const double own = substance_of_voxel(body, lower)->youngs_modulus,
                 other = substance_of_voxel(body, upper)->youngs_modulus;
    const double half = 0.5 * body->model->settings.voxel_size;
    const double stretch = 0.5 * vox_bond_stretch(body, axis, lower);
    struct reach *reach = body->surface.reach;
    if (body->voxels.fixed[lower] != VOX_FIX_ALL)
        reach[lower].upper[axis] = half + part_of(own, other) * stretch;
    if (body->voxels.fixed[upper] != VOX_FIX_ALL)
        reach[upper].lower[axis] = half + part_of(other, own) * stretch;
}

/* Update the reach of all voxels. In the engine, strains act on the surface of the next step. */
static void update_reach(struct body *body)
{
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++)
        for (int64_t i = 0; i < body->bonds[axis].n; i++)
            strain_ends(body, axis, body->bonds[axis].lower[i]);
}

static struct vec corner_of(const struct body *body, int64_t slot, int corner)
{
    const struct voxels *v = &body->voxels;
    const struct reach *reach = &body->surface.reach[slot];
    const struct vec local = {corner & 1 ? reach->upper[AXIS_X] : -reach->lower[AXIS_X],
                              corner & 2 ? reach->upper[AXIS_Y] : -reach->lower[AXIS_Y],
                              corner & 4 ? reach->upper[AXIS_Z] : -reach->lower[AXIS_Z]};
    return vec_add(vec_at(v->position, slot), quat_rotate(quat_at(v->orientation, slot), local));
}

/* Set each corner of the surface to the mean of the corners of the adjacent voxels. */
static void place_corners(struct body *body)
{
    struct surface *surface = &body->surface;
    for (int64_t i = 0; i < surface->n_corners; i++)
        surface->corners[i] = (struct vec){0.0, 0.0, 0.0};
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        for (int corner = 0; corner < 8; corner++) {
            const int32_t at = surface->corners_of[slot][corner];
            if (at < 0) continue;
            const struct vec own = vec_scale(surface->share[at], corner_of(body, slot, corner));
            surface->corners[at] = vec_add(surface->corners[at], own);
        }
    }
}

/* Drag on a moving triangle; zero on the lee side. */
static struct vec triangle_drag(double coefficient, struct vec a, struct vec b, struct vec c,
                                struct vec velocity)
{
    const struct vec doubled = vec_cross(vec_sub(b, a), vec_sub(c, a));
    const double twice_area = sqrt(vec_dot(doubled, doubled));
    const double against = vec_dot(velocity, doubled);
    if (!(against > 0.0 && twice_area > 0.0)) return (struct vec){0.0, 0.0, 0.0};
    const double speed = against / twice_area;
    return vec_scale(-0.5 * coefficient * speed * speed, doubled);
}

void vox_fluid_apply(struct body *body)
{
    const double coefficient = body->model->settings.fluid_drag;
    const struct vec *corners = body->surface.corners;
    const bool by_size = body->model->settings.fluid_by_size;
    for (int64_t i = 0; by_size && i < body->census.n_voxels; i++)
        set_reach(body, body->slots[i], 0.5 * body->voxels.size[body->slots[i]]);
    place_corners(body);
    for (int64_t i = 0; i < body->surface.n_facets; i++) {
        const struct facet *facet = &body->surface.facets[i];
        const struct vec a = corners[facet->corners[0]], b = corners[facet->corners[1]];
        const struct vec c = corners[facet->corners[2]], d = corners[facet->corners[3]];
        const struct vec velocity = velocity_of(&body->voxels, facet->slot);
        const struct vec drag = triangle_drag(coefficient, a, b, c, velocity);
        const struct vec force = vec_add(vec_at(body->voxels.force, facet->slot), drag);
        vec_put(body->voxels.force, facet->slot,
                vec_add(force, triangle_drag(coefficient, a, c, d, velocity)));
    }
    if (!by_size) update_reach(body);
}
