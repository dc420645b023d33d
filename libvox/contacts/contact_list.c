/* Self collision: list of contact candidates (section 10).
 *
 * Lists are sorted by first, then by second voxel, so that the order in which forces are added does
 * not depend on the algorithm. */
#include <stdlib.h>
#include <string.h>

#include "contacts/touch.h"

/* Density of voxels, relative to the lattice, up to which the list holds all contacts. */
static const double CROWDING = 2.0;

/* ---- distances ------------------------------------------------------------------------------- */

/* Distance that the fastest voxel may move before the list is rebuilt, in lattice edges. */
static double leeway(const struct vox_settings *s)
{
    return (s->collision_horizon - 1.0) / 2.0;
}

/* Distance beyond which the original engine lists no pairs, m. */
static double engine_reach(const struct vox_settings *s)
{
    return s->collision_list_factor * s->collision_horizon * s->voxel_size;
}

/* A complete list contains all pairs that can touch before the next list. */
double vox_contacts_reach(const vox_model *model)
{
    const struct vox_settings *s = &model->settings;
    if (s->complete_contacts)
        return s->collision_envelope * model->largest_size + 2.0 * (leeway(s) * s->voxel_size);
    return fmin(engine_reach(s), s->collision_horizon * model->largest_size);
}

/* Maximum number of listed pairs per voxel: half of the voxels in a sphere, as each pair is listed
 * once. */
static int64_t pairs_per_voxel(const vox_model *model)
{
    const double radius = vox_contacts_reach(model) / model->settings.voxel_size + 1.0;
    return (int64_t)(CROWDING * 0.5 * 4.19 * radius * radius * radius);
}

/* ---- shape ----------------------------------------------------------------------------------- */

static void place_skin(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    contacts->n_skin = 0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int32_t slot = body->slots[i];
        if (body->bonded[slot] != ALL_SIDES) contacts->skin[contacts->n_skin++] = slot;
    }
}

/* Reserve the memory for all later lists, so that steps never allocate. */
static enum vox_status make_room(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    const int64_t n = contacts->n_skin;
    const int64_t all = n * (n - 1) / 2, most = pairs_per_voxel(body->model) * n;
    contacts->most = all < most ? all : most;
    if (!vox_pairs_reserve(&contacts->now, contacts->most)) return VOX_NO_MEMORY;
    if (!vox_pairs_reserve(&contacts->first, contacts->near_by.pairs.n)) return VOX_NO_MEMORY;
    return vox_grid_shape(&contacts->grid, n);
}

void vox_contacts_destroy(struct contacts *contacts)
{
    free(contacts->skin);
    free(contacts->first.list);
    free(contacts->now.list);
    vox_near_by_destroy(&contacts->near_by);
    vox_grid_destroy(&contacts->grid);
}

size_t vox_contacts_memory(const struct body *body)
{
    const struct contacts *contacts = &body->contacts;
    const int64_t n_pairs =
        contacts->first.capacity + contacts->now.capacity + contacts->watch.pairs.capacity;
    const int64_t groups = contacts->watch.begin ? (body->model->largest2 + 1) * DEPTHS : 0;
    return vox_near_by_memory(body) + (size_t)n_pairs * sizeof(struct pair) +
           (size_t)groups * sizeof *contacts->watch.begin +
           (size_t)contacts->grid.most_cubes * sizeof *contacts->grid.begin;
}

/* ---- building a list ------------------------------------------------------------------------- */

struct limits vox_contacts_limits(const vox_model *model)
{
    const struct vox_settings *s = &model->settings;
    if (s->complete_contacts) return (struct limits){vox_contacts_reach(model), HUGE_VAL, HUGE_VAL};
    return (struct limits){vox_contacts_reach(model), engine_reach(s), s->collision_horizon};
}

IN_LOOP bool is_due(const struct voxels *v, struct pair pair, const struct limits *limits)
{
    const struct vec apart = between(v, pair);
    return is_listed(limits, v->size[pair.first], vec_dot(apart, apart));
}

static bool has_strayed(const struct body *body)
{
    const struct voxels *v = &body->voxels;
    const double most = STRAYED * body->model->settings.voxel_size;
    for (int64_t i = 0; i < body->contacts.n_skin; i++) {
        const int32_t slot = body->contacts.skin[i];
        const struct vec way = vec_sub(vec_at(v->position, slot), vec_at(v->start, slot));
        if (vec_dot(way, way) > most * most) return true;
    }
    return false;
}

/* Add a pair to the list; like the next two functions, return false if it is full. */
static bool list_one(struct contacts *contacts, struct pair pair)
{
    if (contacts->now.n == contacts->most) return false;
    contacts->now.list[contacts->now.n++] = pair;
    return true;
}

static bool list_from_near_by(struct body *body)
{
    const struct pairs *pairs = &body->contacts.near_by.pairs;
    const struct limits limits = vox_contacts_limits(body->model);
    for (int64_t i = 0; i < pairs->n; i++)
        if (is_due(&body->voxels, pairs->list[i], &limits) &&
            !list_one(&body->contacts, pairs->list[i]))
            return false;
    return true;
}

static bool list_from_grid(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    const struct limits limits = vox_contacts_limits(body->model);
    vox_grid_fill(&contacts->grid, body, limits.reach);
    for (int64_t i = 0; i < contacts->n_skin; i++) {
        const int64_t n = vox_grid_find(&contacts->grid, body, (int32_t)i);
        for (int64_t k = 0; k < n; k++) {
            const struct pair pair = {contacts->skin[i], contacts->skin[contacts->grid.found[k]]};
            if (!is_due(&body->voxels, pair, &limits) ||
                !vox_near_by_may_collide(body, &contacts->near_by, pair))
                continue;
            if (!list_one(contacts, pair)) return false;
        }
    }
    return true;
}

static bool list_contacts(struct body *body)
{
    body->contacts.now.n = 0;
    return has_strayed(body) ? list_from_grid(body) : list_from_near_by(body);
}

static void copy(struct pairs *to, const struct pairs *from)
{
    to->n = from->n;
    if (from->n > 0) memcpy(to->list, from->list, (size_t)from->n * sizeof *from->list);
}

/* ---- a body ---------------------------------------------------------------------------------- */

enum vox_status vox_contacts_shape(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    free(contacts->skin);
    contacts->skin = malloc((size_t)body->census.n_voxels * sizeof *contacts->skin);
    if (!contacts->skin) return VOX_NO_MEMORY;
    place_skin(body);
    enum vox_status status = vox_near_by_shape(body, &contacts->near_by);
    if (status == VOX_OK) status = make_room(body);
    if (status != VOX_OK) return status;
    list_contacts(body); /* a body at rest is not crowded */
    copy(&contacts->first, &contacts->now);
    return VOX_OK;
}

void vox_contacts_rest(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    contacts->travelled = 0.0;
    copy(&contacts->now, &contacts->first);
}

bool vox_contacts_refresh(struct body *body)
{
    const struct vox_settings *settings = &body->model->settings;
    struct contacts *contacts = &body->contacts;
    contacts->travelled += body->top_speed * body->census.dt / settings->voxel_size;
    if (contacts->travelled <= leeway(settings)) return true;
    contacts->travelled = 0.0;
    return list_contacts(body);
}
