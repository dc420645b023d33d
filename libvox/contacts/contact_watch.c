/* Self collision of the voxels that can affect a sample, without the rest of the body.
 *
 * The list of contact candidates is rebuilt when the fastest voxel of the whole body may have moved
 * far, which is not known here. Only the list at rest is used. It is sufficient if the voxels in
 * question would have the same contacts with any other list: every pair that touches is in the list
 * at rest, and has always been in the reach of a new one. Otherwise the whole body must be
 * simulated.
 *
 * A voxel that is no longer computed is assumed to move at most twice as fast as the fastest voxel
 * that has been computed, or twice as fast as a wave of the largest strain moves the material, and
 * to gain more speed only by its weight. A body whose voxels gain speed much faster is unstable,
 * and is simulated as a whole. */
#include <stdlib.h>
#include <string.h>

#include "contacts/touch.h"

static const double FASTER = 2.0;
static const double GAIN = 1.15; /* of the largest speed in a step; in ten steps about FASTER */
static const double STRONGEST = 1.25; /* bond damping times the fraction of the largest time step */
static const double STEPS_PER_EDGE =
    SPACE * 1.7320508075688772;                    /* cells per edge: at most root 3 */
static const double DIAGONAL = 1.4142135623730951; /* edges, distance of unconnected neighbors */
static const int64_t MOST_MEASURED = 1024; /* voxels; the pairs of more would take too long */
static const double ROUNDING = 1e-9;       /* relative, of distances */

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

/* Return whether no damper is so strong that it increases speeds, because of the time step. */
static bool damping_is_stable(const struct body *body)
{
    const struct vox_settings *s = &body->model->settings;
    const struct voxels *v = &body->voxels;
    bool stable = s->bond_damping * s->time_step_fraction <= STRONGEST * (double)s->substeps;
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i];
        stable &= v->drag_rate[slot] * body->census.dt <= 1.0 && v->spin_kept[slot] >= 0.0;
    }
    return stable;
}

bool vox_watch_is_possible(const struct body *body)
{
    const struct vox_settings *s = &body->model->settings;
    return s->contact_damping == 0.0 && !s->contact_friction &&
           largest_touch(body->model) < near_radius(body->model) && damping_is_stable(body);
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
    watch->measured = false;
    watch->deepest = 0.0;
    for (int64_t i = 0; i < body->census.n_voxels; i++)
        watch->deepest = fmax(watch->deepest, body->depth[body->slots[i]]);
    return VOX_OK;
}

/* Speed of the material in a wave of the largest strain, by actuation or by contacts at rest, m/s.
 */
static double wave_speed(const vox_model *model)
{
    const struct vox_settings *s = &model->settings;
    double strain = 0.0;
    for (int32_t i = 0; i < model->n_substances; i++)
        strain = fmax(strain, fabs(model->substances[i].strain_amplitude));
    strain = fmin(strain, fmax(s->largest_size - 1.0, 1.0 - s->smallest_size));
    strain = fmax(strain, s->collision_envelope - DIAGONAL);
    return strain * s->voxel_size * sqrt(model->fastest) * fmax(1.0, s->bond_damping);
}

void vox_watch_rest(struct body *body)
{
    struct watch *watch = &body->contacts.watch;
    if (watch->lost) memset(watch->lost, 0, (size_t)body->contacts.first.n);
    watch->wave_speed = watch->top_speed = wave_speed(body->model);
}

void vox_watch_destroy(struct watch *watch)
{
    free(watch->begin);
    free(watch->pairs.list);
    free(watch->lost);
}

/* ---- in a step ------------------------------------------------------------------------------- */

/* Update the largest speed; return whether it is not much larger than before. */
static bool speeds_are_stable(const struct body *body, struct watch *watch)
{
    const double before = fmax(watch->top_speed, FASTER * watch->wave_speed);
    const double weight = fabs(body->model->settings.gravity) * body->census.dt;
    watch->top_speed = fmax(watch->top_speed, body->top_speed);
    return body->top_speed <= GAIN * before + weight;
}

/* Return how far a voxel may have moved since it was computed some steps ago, m. */
static double way_in(const struct body *body, double steps)
{
    const double dt = body->census.dt, gravity = fabs(body->model->settings.gravity);
    return steps * dt * (FASTER * body->contacts.watch.top_speed + steps * dt * gravity);
}

/* Return the number of steps from the start. */
static double steps_made(const struct body *body)
{
    return body->time / body->census.dt;
}

/* Return by how many steps the state of a voxel is older than this step. */
static double absence(const struct body *body, int32_t slot, double limit)
{
    return fmax(0.0, fmin((double)body->depth[slot] - limit - 1.0, steps_made(body)));
}

/* Return the size of a voxel, or the largest one if it is too old. */
static double size_in(const struct body *body, int32_t slot, double steps)
{
    return steps > 0.0 ? body->model->largest_size : body->voxels.size[slot];
}

/* Return whether the voxels of a pair that is not listed may touch; at most one of them is not
 * computed any more. */
static bool may_touch(const struct body *body, struct pair pair, double limit)
{
    const struct voxels *v = &body->voxels;
    const double first = absence(body, pair.first, limit),
                 second = absence(body, pair.second, limit);
    const int32_t later = first > second ? pair.first : pair.second;
    const double sizes =
        0.5 * (size_in(body, pair.first, first) + size_in(body, pair.second, second));
    const double way =
        v->fixed[later] == VOX_FIX_ALL ? 0.0 : way_in(body, first > second ? first : second);
    const double reach = body->model->settings.collision_envelope * sizes + way;
    const struct vec apart = between(v, pair);
    return !(vec_dot(apart, apart) > reach * reach * (1.0 + ROUNDING));
}

/* Return whether no voxel up to a depth can touch one that was not near at rest.
 *
 * Let d be their distance at rest, at least the radius of the near pairs. They touch only if d is
 * at most `touching` (the largest distance of touching voxels, plus twice the farthest that a
 * computed voxel has moved) plus the way of the other voxel since it was computed n steps ago.
 * Depths grow by at most 2 per cell of the lattice, along any line STEPS_PER_EDGE per edge of
 * distance, so that n <= STEPS_PER_EDGE * d / edge - 1; n is also limited by the deepest voxel and
 * by the time from the start. The way grows with n faster than linearly, and the bound on d
 * linearly. Both ends of the range of n are therefore sufficient: the n that belongs to the radius
 * (`closest`), and the largest n (`longest`), which belongs to a distance of at least `farther`. */
static bool far_are_apart(const struct body *body, double limit, double touching)
{
    const double edge = body->model->settings.voxel_size, radius = near_radius(body->model);
    const double most = fmin(body->contacts.watch.deepest - limit - 1.0, steps_made(body));
    const double longest = fmax(0.0, most);
    const double closest = fmin(longest, STEPS_PER_EDGE * radius / edge - 1.0);
    const double farther = fmax(radius, (longest + 1.0) / STEPS_PER_EDGE * edge);
    return touching + way_in(body, closest) < radius && touching + way_in(body, longest) < farther;
}

/* Find the smallest distances at rest for all_are_apart(). */
static void measure(const struct body *body, struct watch *watch)
{
    const double edge = body->model->settings.voxel_size, radius = near_radius(body->model) / edge;
    const int64_t near2 = (int64_t)ceil(radius * radius * (1.0 - ROUNDING));
    const struct contacts *contacts = &body->contacts;
    for (int k = 0; k < DEPTHS; k++) watch->apart2[k] = INT64_MAX;
    for (int64_t i = 0; i < contacts->n_skin; i++) {
        if (body->voxels.fixed[contacts->skin[i]] == VOX_FIX_ALL) continue;
        for (int64_t j = i + 1; j < contacts->n_skin; j++) {
            const struct pair pair = {contacts->skin[i], contacts->skin[j]};
            const int64_t distance2 = start_distance2(body, pair);
            const int64_t by = labs(body->depth[pair.first] - body->depth[pair.second]);
            int64_t *least = &watch->apart2[by < DEPTHS ? by : DEPTHS - 1];
            if (distance2 >= near2 && distance2 < *least &&
                body->voxels.fixed[pair.second] != VOX_FIX_ALL)
                *least = distance2;
        }
    }
    watch->measured = true;
}

/* Like far_are_apart(), but from the smallest distance at rest of the pairs of voxels whose depths
 * differ by the same number of steps. */
static bool all_are_apart(const struct body *body, struct watch *watch, double touching)
{
    const double edge = body->model->settings.voxel_size;
    if (touching >= near_radius(body->model) || body->contacts.n_skin > MOST_MEASURED) return false;
    if (!watch->measured) measure(body, watch);
    for (int k = 1; k < DEPTHS; k++) {
        if (watch->apart2[k] == INT64_MAX) continue;
        const double steps = fmin(k < DEPTHS - 1 ? k - 1.0 : watch->deepest, steps_made(body));
        if (touching + way_in(body, steps) >= edge * sqrt((double)watch->apart2[k])) return false;
    }
    return true;
}

/* Return whether a pair of voxels up to a depth that is not listed at rest may touch. */
static bool others_may_touch(struct body *body, double limit)
{
    struct watch *watch = &body->contacts.watch;
    const vox_model *model = body->model;
    const double edge = model->settings.voxel_size;
    const double touching = largest_touch(model) + 2.0 * body->farthest;
    if (!far_are_apart(body, limit, touching) && !all_are_apart(body, watch, touching)) return true;
    const double reach = fmin(touching + way_in(body, LONGEST_PAIR - 1), near_radius(model));
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
    if (!speeds_are_stable(body, watch) || others_may_touch(body, limit)) return false;
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
