/* Self collision: which voxels may touch (section 10).
 *
 * Lists are sorted by their first voxel, then by the second, so that forces are added in an order that does not depend
 * on how a list was found. */
#include <stdlib.h>
#include <string.h>

#include "internal.h"

static const double CROWDING = 2.0; /* how much denser than the lattice voxels may lie while all contacts are listed */
static const double STRAYED = 0.35; /* lattice edges; to be near by holds until a voxel is further from its start */

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* ---- distances -------------------------------------------------------------------------------------------- */

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

/* ---- voxels that are joined by a few bonds ---------------------------------------------------------------- */

/* Lattice vector between two voxels. */
struct offset {
    int64_t by[3];
};

static struct offset offset_between(const struct body *body, int64_t first, int64_t second)
{
    struct offset offset;
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++)
        offset.by[axis] = place_of(body, second, axis) - place_of(body, first, axis);
    return offset;
}

static int64_t hops_of(const struct offset *offset)
{
    return llabs(offset->by[0]) + llabs(offset->by[1]) + llabs(offset->by[2]);
}

static bool is_bonded(const struct body *body, int64_t slot, int axis, bool upwards)
{
    return body->bonded[slot] >> (2 * axis + upwards) & 1;
}

/* Whether one of the shortest ways to a voxel, all of whose steps lead closer, consists of bonds. */
static bool is_joined_straight(const struct body *body, int64_t slot, struct offset offset)
{
    if (hops_of(&offset) == 0) return true;
    for (int axis = 0; axis < 3; axis++) {
        if (offset.by[axis] == 0) continue;
        const bool upwards = offset.by[axis] > 0;
        if (!is_bonded(body, slot, axis, upwards)) continue;
        struct offset rest = offset;
        rest.by[axis] += upwards ? -1 : 1;
        if (is_joined_straight(body, upwards ? slot + body->step[axis] : slot - body->step[axis], rest)) return true;
    }
    return false;
}

/* Marks the voxels to which a way of at most so many bonds leads: a breadth-first search. */
static void search_from(struct body *body, int32_t from, int64_t hops)
{
    struct search *search = &body->contacts.search;
    int64_t begin = 0, n = 0;
    search->from = from;
    search->number++;
    search->queue[n++] = from;
    search->reached[from] = search->number;
    for (int64_t hop = 0; hop < hops; hop++) {
        const int64_t end = n;
        for (; begin < end; begin++) {
            const int32_t slot = search->queue[begin];
            for (int side = 0; side < 6; side++) {
                if (!is_bonded(body, slot, side / 2, side % 2)) continue;
                const int64_t step = body->step[side / 2], next = side % 2 ? slot + step : slot - step;
                if (search->reached[next] == search->number) continue;
                search->reached[next] = search->number;
                search->queue[n++] = (int32_t)next;
            }
        }
    }
}

static bool is_joined_anyhow(struct body *body, int32_t from, int32_t to, int64_t hops)
{
    struct search *search = &body->contacts.search;
    if (search->from != from) search_from(body, from, hops);
    return search->reached[to] == search->number;
}

/* Whether two voxels are too close along bonds to collide. A way on the lattice that is no shortest one is longer by
 * two bonds at least. */
static bool is_left_out(struct body *body, int32_t first, int32_t second)
{
    const struct vox_settings *s = &body->model->settings;
    const int64_t most = (int64_t)(s->collision_list_factor * s->collision_horizon);
    const struct offset offset = offset_between(body, first, second);
    const int64_t hops = hops_of(&offset);
    if (hops > most) return false;
    if (is_joined_straight(body, first, offset)) return true;
    return hops + 2 <= most && is_joined_anyhow(body, first, second, most);
}

/* Whether two voxels may ever be listed. */
static bool may_collide(struct body *body, int32_t first, int32_t second)
{
    const uint8_t *fixed = body->voxels.fixed;
    if (fixed[first] == VOX_FIX_ALL && fixed[second] == VOX_FIX_ALL) return false;
    return !is_left_out(body, first, second);
}

/* ---- lists ------------------------------------------------------------------------------------------------ */

static bool reserve(struct pairs *pairs, int64_t capacity)
{
    if (capacity <= pairs->capacity) return true;
    struct pair *list = realloc(pairs->list, (size_t)capacity * sizeof *list);
    if (!list) return false;
    pairs->list = list;
    pairs->capacity = capacity;
    return true;
}

static bool append(struct pairs *pairs, struct pair pair)
{
    if (pairs->n == pairs->capacity && !reserve(pairs, 2 * pairs->capacity + 64)) return false;
    pairs->list[pairs->n++] = pair;
    return true;
}

/* Whether the original engine lists two voxels: its reach is that of the first; voxels exactly at it are out. */
static bool engine_lists(double first_size, double distance, const struct vox_settings *s)
{
    return distance < s->collision_horizon * first_size && distance < engine_reach(s);
}

/* Whether two voxels that may collide are close enough to be listed now. */
static bool is_due(const struct body *body, struct pair pair)
{
    const struct vox_settings *s = &body->model->settings;
    const struct voxels *v = &body->voxels;
    const struct vec apart = vec_sub(vec_at(v->position, pair.second), vec_at(v->position, pair.first));
    const double distance2 = vec_dot(apart, apart), farthest = farthest_listed(body->model);
    if (distance2 >= farthest * farthest) return false;
    return s->complete_contacts || engine_lists(v->size[pair.first], sqrt(distance2), s);
}

/* ---- the neighbourhood on the lattice --------------------------------------------------------------------- */

/* Adds the voxels after a voxel in a row of the canvas that are near it. */
static bool append_row(struct body *body, int32_t first, int64_t row, int64_t begin, int64_t end)
{
    for (int64_t x = begin; x < end; x++) {
        const int32_t second = (int32_t)(row + x);
        if (!body->occupied[second] || body->bonded[second] == ALL_SIDES) continue;
        if (may_collide(body, first, second) && !append(&body->contacts.near_by, (struct pair){first, second}))
            return false;
    }
    return true;
}

/* Adds the voxels after a voxel within so many edges of it at rest. */
static bool append_near(struct body *body, int32_t first, double radius)
{
    const int64_t *length = body->census.length, most = (int64_t)radius;
    const int64_t at[] = {place_of(body, first, AXIS_X), place_of(body, first, AXIS_Y), place_of(body, first, AXIS_Z)};
    for (int64_t dz = 0; dz <= most && at[2] + dz < length[2]; dz++) {
        for (int64_t dy = dz > 0 ? -most : 0; dy <= most && at[1] + dy < length[1]; dy++) {
            const double left2 = radius * radius - (double)(dy * dy + dz * dz);
            if (at[1] + dy < 0 || !(left2 > 0.0)) continue;
            const int64_t width = (int64_t)ceil(sqrt(left2)) - 1; /* dx * dx < left2 */
            const int64_t begin = dy != 0 || dz != 0 ? (at[0] > width ? at[0] - width : 0) : at[0] + 1;
            const int64_t row = body->step[1] * (at[1] + dy) + body->step[2] * (at[2] + dz);
            if (!append_row(body, first, row, begin, least(length[0], at[0] + width + 1))) return false;
        }
    }
    return true;
}

/* All pairs that can be listed while no voxel has strayed from its start. */
static bool list_near_by(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    const double radius = farthest_listed(body->model) / body->model->settings.voxel_size + 2.0 * STRAYED;
    contacts->near_by.n = 0;
    for (int64_t i = 0; i < contacts->n_skin; i++)
        if (!append_near(body, contacts->skin[i], radius)) return false;
    return true;
}

static void place_skin(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    contacts->n_skin = 0;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int32_t slot = body->slots[i];
        if (body->bonded[slot] != ALL_SIDES) contacts->skin[contacts->n_skin++] = slot;
    }
}

static enum vox_status allocate(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    const size_t n_slots = (size_t)body->n_slots;
    free(contacts->skin);
    free(contacts->search.reached);
    free(contacts->search.queue);
    contacts->skin = malloc((size_t)body->census.n_voxels * sizeof *contacts->skin);
    contacts->search.reached = calloc(n_slots, sizeof *contacts->search.reached);
    contacts->search.queue = malloc(n_slots * sizeof *contacts->search.queue);
    return contacts->skin && contacts->search.reached && contacts->search.queue ? VOX_OK : VOX_NO_MEMORY;
}

/* Whatever is listed later has room: that never fails for want of memory. */
static enum vox_status make_room(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    const int64_t n = contacts->n_skin;
    contacts->most = least(n * (n - 1) / 2, pairs_per_voxel(body->model) * n);
    if (!reserve(&contacts->now, contacts->most)) return VOX_NO_MEMORY;
    return grid_shape(&contacts->grid, n);
}

enum vox_status contacts_shape(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    enum vox_status status = allocate(body);
    if (status != VOX_OK) return status;
    contacts->search.from = -1;
    contacts->search.number = 0;
    contacts->first_is_known = false;
    place_skin(body);
    status = make_room(body);
    if (status != VOX_OK) return status;
    if (!list_near_by(body)) return VOX_NO_MEMORY;
    return reserve(&contacts->first, contacts->near_by.n) ? VOX_OK : VOX_NO_MEMORY;
}

void contacts_rest(struct body *body)
{
    body->contacts.travelled = 0.0;
}

void contacts_destroy(struct contacts *contacts)
{
    free(contacts->skin);
    free(contacts->search.reached);
    free(contacts->search.queue);
    free(contacts->near_by.list);
    free(contacts->first.list);
    free(contacts->now.list);
    grid_destroy(&contacts->grid);
}

/* ---- making a list ---------------------------------------------------------------------------------------- */

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

/* False if the list is full; so for the next two. */
static bool list_one(struct body *body, struct pair pair)
{
    struct contacts *contacts = &body->contacts;
    if (!is_due(body, pair)) return true;
    if (contacts->now.n == contacts->most) return false;
    contacts->now.list[contacts->now.n++] = pair;
    return true;
}

static bool list_from_near_by(struct body *body)
{
    const struct pairs *near_by = &body->contacts.near_by;
    for (int64_t i = 0; i < near_by->n; i++)
        if (!list_one(body, near_by->list[i])) return false;
    return true;
}

static bool list_from_grid(struct body *body)
{
    struct grid *grid = &body->contacts.grid;
    grid_fill(grid, body, farthest_listed(body->model));
    for (int64_t i = 0; i < body->contacts.n_skin; i++) {
        const int32_t first = body->contacts.skin[i];
        const int64_t n = grid_find(grid, body, first);
        for (int64_t k = 0; k < n; k++) {
            const struct pair pair = {first, grid->found[k]};
            if (may_collide(body, first, pair.second) && !list_one(body, pair)) return false;
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

/* At rest all controllers of a body begin with the same list. */
static bool list_at_rest(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    if (contacts->first_is_known) {
        copy(&contacts->now, &contacts->first);
        return true;
    }
    if (!list_contacts(body)) return false;
    copy(&contacts->first, &contacts->now);
    contacts->first_is_known = true;
    return true;
}

bool contacts_refresh(struct body *body, bool first_step)
{
    const struct vox_settings *settings = &body->model->settings;
    struct contacts *contacts = &body->contacts;
    contacts->travelled += body->top_speed * body->census.dt / settings->voxel_size;
    if (!first_step && contacts->travelled <= (settings->collision_horizon - 1.0) / 2.0) return true;
    contacts->travelled = 0.0;
    return first_step ? list_at_rest(body) : list_contacts(body);
}
