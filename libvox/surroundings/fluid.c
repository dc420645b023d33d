/* Drag of a fluid on the outer surface (section 7). */
#include "internal.h"

static struct vec corner_of(const struct voxels *v, int64_t slot, int corner)
{
    const double half = 0.5 * v->size[slot];
    const struct vec local = {corner & 1 ? half : -half, corner & 2 ? half : -half,
                              corner & 4 ? half : -half};
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
            const struct vec own =
                vec_scale(surface->share[at], corner_of(&body->voxels, slot, corner));
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
}
