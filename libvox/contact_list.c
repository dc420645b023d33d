/* Self collision: which voxels may touch (section 10). */
#include <stdlib.h>

#include "internal.h"

static const double CROWDING = 2.0; /* how much denser than the lattice voxels may lie while all contacts are listed */

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static bool on_surface(const int32_t bonded[6])
{
    for (int side = 0; side < 6; side++)
        if (bonded[side] < 0) return true;
    return false;
}

static double coordinate(struct vec v, enum axis axis)
{
    switch (axis) {
    case AXIS_X: return v.x;
    case AXIS_Y: return v.y;
    case AXIS_Z: break;
    }
    return v.z;
}

static int hops_left_out(const struct vox_settings *s)
{
    return (int)(s->collision_list_factor * s->collision_horizon);
}

/* Most voxels within so many bonds of one, itself included: the points of an octahedron on the lattice. */
static int64_t most_near(int hops)
{
    const int64_t h = hops;
    return (2 * h + 1) * (2 * h * h + 2 * h + 3) / 3;
}

/* Writes the voxels within `hops` bonds of one, itself first, and returns how many there are. What it writes is also
 * the queue of its breadth-first search. */
static int64_t gather_near(const struct body *body, int32_t voxel, int hops, int32_t *near)
{
    int32_t *stamp = body->contacts.stamp;
    int64_t begin = 0, n = 0;
    near[n++] = voxel;
    stamp[voxel] = voxel;
    for (int hop = 0; hop < hops; hop++) {
        const int64_t end = n;
        for (; begin < end; begin++) {
            const int32_t *bonded = body->bonded[near[begin]];
            for (int side = 0; side < 6; side++) {
                if (bonded[side] < 0 || stamp[bonded[side]] == voxel) continue;
                stamp[bonded[side]] = voxel;
                near[n++] = bonded[side];
            }
        }
    }
    return n;
}

/* Cells in an order in which the longest axis is the slowest, so that the skin starts sorted along it. */
static int64_t nth_cell(const struct vox_settings *s, enum axis longest, int64_t n)
{
    switch (longest) {
    case AXIS_X: return n / (s->ny * s->nz) + s->nx * (n % (s->ny * s->nz));
    case AXIS_Y: return n % s->nx + s->nx * (n / (s->nx * s->nz) + s->ny * (n / s->nx % s->nz));
    case AXIS_Z: break;
    }
    return n;
}

static enum axis longest_axis(const struct vox_settings *s)
{
    if (s->nx >= s->ny && s->nx >= s->nz) return AXIS_X;
    return s->ny >= s->nz ? AXIS_Y : AXIS_Z;
}

static int64_t count_surface(const struct body *body)
{
    int64_t n = 0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) n += on_surface(body->bonded[i]);
    return n;
}

static void place_skin(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    const struct vox_settings *settings = &body->model->settings;
    const int hops = hops_left_out(settings);
    int64_t n = 0, n_near = 0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) contacts->stamp[i] = -1;
    for (int64_t i = 0; i < body->model->cells; i++) {
        const int32_t voxel = body->voxel_in[nth_cell(settings, contacts->longest, i)];
        if (voxel < 0 || !on_surface(body->bonded[voxel])) continue;
        const int64_t begin = n_near;
        n_near += gather_near(body, voxel, hops, contacts->near + n_near);
        contacts->skin[n++] = (struct skin){.voxel = voxel, .near_begin = begin, .near_end = n_near};
    }
}

/* How far the fastest voxel may move before the list is made anew, m. */
static double leeway(const struct vox_settings *s)
{
    return (s->collision_horizon - 1.0) / 2.0 * s->voxel_size;
}

/* The original engine lists nothing beyond, m. */
static double engine_reach(const struct vox_settings *s)
{
    return s->collision_list_factor * s->collision_horizon * s->voxel_size;
}

/* Distance beyond which no pair is listed at any time. A complete list has all that can touch before the next one. */
static double farthest_listed(const vox_model *model)
{
    const struct vox_settings *s = &model->settings;
    if (s->complete_contacts) return s->collision_envelope * model->largest_size + 2.0 * leeway(s);
    return fmin(engine_reach(s), s->collision_horizon * model->largest_size);
}

/* Most pairs that are listed for each voxel: half of the voxels of a sphere, a pair being listed once. */
static int64_t pairs_per_voxel(const vox_model *model)
{
    const double radius = farthest_listed(model) / model->settings.voxel_size + 1.0;
    return (int64_t)(CROWDING * 0.5 * 4.19 * radius * radius * radius);
}

enum vox_status contacts_create(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    const int64_t n_voxels = body->census.n_voxels, n_skin = count_surface(body);
    const int64_t near_each = most_near(hops_left_out(&body->model->settings));
    contacts->longest = longest_axis(&body->model->settings);
    contacts->n_skin = n_skin;
    contacts->capacity = least(n_skin * (n_skin - 1) / 2, pairs_per_voxel(body->model) * n_skin);
    contacts->skin = malloc((size_t)(n_skin + 1) * sizeof *contacts->skin);
    contacts->near = malloc((size_t)(n_skin * least(near_each, n_voxels) + 1) * sizeof *contacts->near);
    contacts->stamp = malloc((size_t)n_voxels * sizeof *contacts->stamp);
    contacts->list = malloc((size_t)(contacts->capacity + 1) * sizeof *contacts->list);
    if (!contacts->skin || !contacts->near || !contacts->stamp || !contacts->list) return VOX_NO_MEMORY;
    place_skin(body);
    return VOX_OK;
}

void contacts_destroy(struct contacts *contacts)
{
    free(contacts->skin);
    free(contacts->near);
    free(contacts->stamp);
    free(contacts->list);
}

/* By insertion: the order of one time is nearly that of the next. */
static void sort_skin(struct body *body)
{
    struct skin *skin = body->contacts.skin;
    for (int64_t i = 0; i < body->contacts.n_skin; i++) {
        struct skin one = skin[i];
        one.along = coordinate(body->voxels[one.voxel].position, body->contacts.longest);
        int64_t j = i;
        for (; j > 0 && skin[j - 1].along > one.along; j--) skin[j] = skin[j - 1];
        skin[j] = one;
    }
}

static double largest_current_size(const struct body *body)
{
    double largest = 0.0;
    for (int64_t i = 0; i < body->contacts.n_skin; i++)
        largest = fmax(largest, body->voxels[body->contacts.skin[i].voxel].size);
    return largest;
}

/* Distance beyond which no pair is listed now. */
static double list_reach(const struct body *body)
{
    const struct vox_settings *s = &body->model->settings;
    return s->complete_contacts ? farthest_listed(body->model) : s->collision_horizon * largest_current_size(body);
}

/* Whether the original engine lists two voxels: its reach is that of the first; voxels exactly at it are out. */
static bool engine_lists(const struct voxel *first, double distance, const struct vox_settings *s)
{
    return distance < s->collision_horizon * first->size && distance < engine_reach(s);
}

/* False if the list is full. */
static bool list_contact(struct body *body, int32_t one, int32_t other, double distance)
{
    struct contacts *contacts = &body->contacts;
    const struct vox_settings *s = &body->model->settings;
    const int32_t first = one < other ? one : other, second = one < other ? other : one;
    const struct voxel *a = &body->voxels[first], *b = &body->voxels[second];
    if (a->fixed == VOX_FIX_ALL && b->fixed == VOX_FIX_ALL) return true;
    if (!s->complete_contacts && !engine_lists(a, distance, s)) return true;
    if (contacts->n == contacts->capacity) return false;
    const struct coupling *coupling = coupling_of(body->model, a->substance, b->substance);
    contacts->list[contacts->n++] = (struct contact){first, second, coupling};
    return true;
}

/* All pairs whose distance along the longest axis does not already part them. */
static bool list_contacts(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    const double reach = list_reach(body);
    int32_t *stamp = contacts->stamp;
    contacts->n = 0;
    sort_skin(body);
    for (int64_t i = 0; i < contacts->n_skin; i++) {
        const struct skin *one = &contacts->skin[i];
        const struct vec position = body->voxels[one->voxel].position;
        for (int64_t k = one->near_begin; k < one->near_end; k++) stamp[contacts->near[k]] = one->voxel;
        for (int64_t j = i + 1; j < contacts->n_skin && contacts->skin[j].along - one->along < reach; j++) {
            const int32_t other = contacts->skin[j].voxel;
            const struct vec apart = vec_sub(body->voxels[other].position, position);
            const double distance2 = vec_dot(apart, apart);
            if (distance2 >= reach * reach || stamp[other] == one->voxel) continue;
            if (!list_contact(body, one->voxel, other, sqrt(distance2))) return false;
        }
    }
    return true;
}

bool contacts_refresh(struct body *body, bool first_step)
{
    const struct vox_settings *settings = &body->model->settings;
    struct contacts *contacts = &body->contacts;
    contacts->travelled += body->top_speed * body->census.dt / settings->voxel_size;
    if (!first_step && contacts->travelled <= (settings->collision_horizon - 1.0) / 2.0) return true;
    contacts->travelled = 0.0;
    return list_contacts(body);
}
