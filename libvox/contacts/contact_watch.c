/* Self collision of the voxels that can affect a sample, without the rest of the body.
 *
 * The list of contact candidates is rebuilt when the fastest voxel of the whole body may have moved
 * far, which is not known here. Only the list at rest is used. It is sufficient if the voxels in
 * question would have the same contacts with any other list: every pair that touches is in the list
 * at rest, and has always been in the reach of a new one. Otherwise the whole body must be
 * simulated. A voxel that is no longer computed is assumed to become no faster than twice the
 * fastest voxel that has been computed. */
#include <stdlib.h>
#include <string.h>

#include "contacts/touch.h"

static const double FASTER = 2.0;
static const double ROUNDING = 1e-9; /* relative, of distances */

/* Largest distance of two voxels that touch, m. */
static double largest_touch(const vox_model *model)
{
    return model->settings.collision_envelope * model->largest_size;
}

/* Radius of the near pairs, m. */
static double near_radius(const vox_model *model)
{
    return vox_contacts_reach(model) + 2.0 * STRAYED * model->settings.voxel_size;
}

bool vox_watch_is_possible(const vox_model *model)
{
    const struct vox_settings *s = &model->settings;
    return s->contact_damping == 0.0 && !s->contact_friction &&
           largest_touch(model) < near_radius(model);
}

/* ---- the pairs to watch ---------------------------------------------------------------------- */

/* Depth of a voxel; forces on voxels that cannot move have no effect. */
static int32_t free_depth(const struct body *body, int32_t slot)
{
    return body->voxels.fixed[slot] == VOX_FIX_ALL ? UNREACHED : body->depth[slot];
}

static int32_t depth_of(const struct body *body, struct pair pair)
{
    const int32_t first = free_depth(body, pair.first), second = free_depth(body, pair.second);
    return first < second ? first : second;
}

/* Return the place in the order of a near pair. */
static int64_t group_of(const struct body *body, int64_t near)
{
    const struct near_by *near_by = &body->contacts.near_by;
    const int64_t depth = depth_of(body, near_by->pairs.list[near]);
    return near_by->distance2[near] * DEPTHS + (depth < DEPTHS ? depth : DEPTHS - 1);
}

static bool is_pair(struct pair one, struct pair other)
{
    return one.first == other.first && one.second == other.second;
}

/* Count the near pairs that are not listed at rest in `begin`, or move them to `list` unless it is
 * NULL; `begin` is then the index of the next pair of a group. The list at rest is a part of the
 * near pairs in the same order. */
static void visit(const struct body *body, int64_t *begin, struct pair *list)
{
    const struct pairs *near_by = &body->contacts.near_by.pairs, *first = &body->contacts.first;
    int64_t listed = 0;
    for (int64_t i = 0; i < near_by->n; i++) {
        const struct pair pair = near_by->list[i];
        if (listed < first->n && is_pair(first->list[listed], pair)) {
            listed++;
            continue;
        }
        const int64_t group = group_of(body, i);
        if (list) list[begin[group]] = pair;
        begin[group]++;
    }
}

enum vox_status vox_watch_shape(struct body *body)
{
    struct contacts *contacts = &body->contacts;
    struct watch *watch = &contacts->watch;
    const int64_t groups = (body->model->largest2 + 1) * DEPTHS;
    if (!watch->begin) watch->begin = malloc((size_t)(groups + 2) * sizeof *watch->begin);
    free(watch->lost);
    watch->lost = malloc((size_t)contacts->first.n + 1);
    if (!watch->begin || !watch->lost) return VOX_NO_MEMORY;
    if (!vox_pairs_reserve(&watch->pairs, contacts->near_by.pairs.n)) return VOX_NO_MEMORY;
    memset(watch->begin, 0, (size_t)(groups + 2) * sizeof *watch->begin);
    visit(body, watch->begin + 2, NULL);
    for (int64_t group = 0; group < groups; group++)
        watch->begin[group + 2] += watch->begin[group + 1];
    visit(body, watch->begin + 1, watch->pairs.list);
    return VOX_OK;
}

void vox_watch_rest(struct body *body)
{
    struct watch *watch = &body->contacts.watch;
    if (watch->lost) memset(watch->lost, 0, (size_t)body->contacts.first.n);
    watch->top_speed = 0.0;
}

void vox_watch_destroy(struct watch *watch)
{
    free(watch->begin);
    free(watch->pairs.list);
    free(watch->lost);
}

/* ---- in a step ------------------------------------------------------------------------------- */

/* Return by how many steps the position of a voxel is older than this step. */
static double absence(const struct body *body, int32_t slot, double limit)
{
    return body->voxels.fixed[slot] == VOX_FIX_ALL
               ? 0.0
               : fmax(0.0, (double)body->depth[slot] - limit - 1.0);
}

/* Return whether the voxels of a pair that is not listed may touch. */
static bool may_touch(const struct body *body, struct pair pair, double limit)
{
    const struct voxels *v = &body->voxels;
    const double first = absence(body, pair.first, limit),
                 second = absence(body, pair.second, limit);
    const double missed = first > second ? first : second;
    const double most = body->model->largest_size;
    const double sizes = 0.5 * ((first > 0.0 ? most : v->size[pair.first]) +
                                (second > 0.0 ? most : v->size[pair.second]));
    const double way = missed * FASTER * body->contacts.watch.top_speed * body->census.dt;
    const double reach = body->model->settings.collision_envelope * sizes + way;
    const struct vec apart = between(v, pair);
    return !(vec_dot(apart, apart) > reach * reach * (1.0 + ROUNDING));
}

/* Return whether a pair of voxels up to a depth that is not listed at rest may touch. */
static bool others_may_touch(const struct body *body, double limit)
{
    const struct watch *watch = &body->contacts.watch;
    const vox_model *model = body->model;
    const double edge = model->settings.voxel_size;
    const double step = FASTER * watch->top_speed * body->census.dt;
    const double reach = largest_touch(model) + 2.0 * body->farthest + (LONGEST_PAIR - 1) * step;
    if (reach >= near_radius(model)) return true;
    const double reach2 = reach / edge * (reach / edge) * (1.0 + ROUNDING);
    const int64_t last = limit < DEPTHS - 1 ? (int64_t)limit : DEPTHS - 1;
    for (int64_t distance2 = 0; (double)distance2 <= reach2; distance2++) {
        const int64_t end = watch->begin[distance2 * DEPTHS + last + 1];
        for (int64_t i = watch->begin[distance2 * DEPTHS]; i < end; i++)
            if (may_touch(body, watch->pairs.list[i], limit)) return true;
    }
    return false;
}

bool vox_watch_apply(struct body *body, double limit)
{
    struct watch *watch = &body->contacts.watch;
    const struct pairs *first = &body->contacts.first;
    const struct limits limits = vox_contacts_limits(body->model);
    const struct voxels *v = &body->voxels;
    const double half_envelope = 0.5 * body->model->settings.collision_envelope;
    struct touch touch;
    watch->top_speed = fmax(watch->top_speed, body->top_speed);
    if (others_may_touch(body, limit)) return false;
    for (int64_t i = 0; i < first->n; i++) {
        const struct pair pair = first->list[i];
        if ((double)depth_of(body, pair) > limit) continue;
        const struct vec apart = between(v, pair);
        watch->lost[i] |= !is_listed(&limits, v->size[pair.first], vec_dot(apart, apart));
        if (!touches(v, pair, apart, half_envelope, &touch)) continue;
        if (watch->lost[i]) return false;
        repel(body, &touch);
    }
    return true;
}
