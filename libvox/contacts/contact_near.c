/* Self collision: pairs that can touch as long as no voxel is far from its start. The search for
 * voxels in near cells that are not connected by a few bonds processes 64 cells at a time. */
#include <stdlib.h>
#include <string.h>

#include "internal.h"

/* ---- bits, one for each cell of the box ------------------------------------------------------ */

static int64_t words_of(const struct body *body)
{
    return (body->n_box_cells + 63) / 64;
}

static bool is_set(const uint64_t *bits, int64_t cell)
{
    return bits[cell / 64] >> cell % 64 & 1;
}

static void set(uint64_t *bits, int64_t cell)
{
    bits[cell / 64] |= (uint64_t)1 << cell % 64;
}

/* Return 64 bits starting at a cell; bits before and after all cells are 0. */
static uint64_t bits_from(const uint64_t *bits, int64_t n_words, int64_t cell)
{
    const int64_t word = cell >= 0 ? cell / 64 : -((63 - cell) / 64), shift = cell - 64 * word;
    const uint64_t low = word >= 0 && word < n_words ? bits[word] : 0;
    if (shift == 0) return low;
    const uint64_t high = word + 1 >= 0 && word + 1 < n_words ? bits[word + 1] : 0;
    return low >> shift | high << (64 - shift);
}

static int lowest(uint64_t word)
{
#ifdef __GNUC__
    return __builtin_ctzll(word);
#else
    int n = 0;
    for (; !(word & 1); word >>= 1) n++;
    return n;
#endif
}

/* Return the difference of the indices of two cells in the box. */
static int64_t cells_by(const struct body *body, const int32_t by[3])
{
    return by[0] + by[1] * body->row[1] + by[2] * body->row[2];
}

/* ---- voxels that are connected by a few bonds ------------------------------------------------ */

/* Mark the voxels from which a shortest path to a place has all bonds. */
static void join(const struct body *body, const struct near_by *near_by, int64_t place_index)
{
    const int64_t n_words = words_of(body);
    const struct place *places = body->model->vicinity.places, *place = &places[place_index];
    uint64_t *joined = near_by->joined + place_index * n_words;
    for (int32_t way = 0; way < place->n_ways; way++) {
        const uint64_t *before = near_by->joined + place->from[way] * n_words;
        const uint64_t *bonds = near_by->bonds + place->side[way] * n_words;
        const int64_t by = cells_by(body, places[place->from[way]].by);
        for (int64_t word = 0; word < n_words; word++)
            joined[word] |= before[word] & bits_from(bonds, n_words, 64 * word + by);
    }
}

static void join_all(const struct body *body, const struct near_by *near_by)
{
    const size_t size = (size_t)words_of(body) * sizeof(uint64_t);
    memset(near_by->joined, 0, (size_t)body->model->vicinity.n_places * size);
    memset(near_by->bonds, 0, 6 * size);
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i], cell = box_cell(body, slot);
        set(near_by->joined, cell); /* the first place is the voxel itself */
        for (int side = 0; side < 6; side++)
            if (body->bonded[slot] >> side & 1) set(near_by->bonds + side * words_of(body), cell);
    }
    for (int64_t place = 1; place < body->model->vicinity.n_places; place++)
        join(body, near_by, place);
}

/* Mark the voxels within `hops` bonds by a breadth-first search. */
static void search_from(const struct body *body, struct search *search, int32_t from, int64_t hops)
{
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
                if (!(body->bonded[slot] >> side & 1)) continue;
                const int64_t step = body->step[side / 2],
                              next = side % 2 ? slot + step : slot - step;
                if (search->reached[next] == search->number) continue;
                search->reached[next] = search->number;
                search->queue[n++] = (int32_t)next;
            }
        }
    }
}

/* Return whether two voxels are connected by a few bonds on a detour, which has at least two bonds
 * more than the shortest paths on the lattice. */
static bool is_joined_around(const struct body *body, struct search *search, struct pair pair,
                             const int32_t by[3])
{
    const int64_t hops = body->model->vicinity.hops;
    if (labs(by[0]) + labs(by[1]) + labs(by[2]) + 2 > hops) return false;
    if (search->from != pair.first) search_from(body, search, pair.first, hops);
    return search->reached[pair.second] == search->number;
}

static void set_offset(const struct body *body, struct pair pair, int32_t by[3])
{
    const int32_t *from = body->coordinates[pair.first], *to = body->coordinates[pair.second];
    for (int axis = 0; axis < 3; axis++) by[axis] = to[axis] - from[axis];
}

bool vox_near_by_may_collide(const struct body *body, struct near_by *near_by, struct pair pair)
{
    const uint8_t *fixed = body->voxels.fixed;
    if (fixed[pair.first] == VOX_FIX_ALL && fixed[pair.second] == VOX_FIX_ALL) return false;
    int32_t by[3];
    set_offset(body, pair, by);
    const int64_t place = vox_vicinity_index(&body->model->vicinity, by);
    if (place >= 0 && is_set(near_by->joined + place * words_of(body), box_cell(body, pair.first)))
        return false;
    return !is_joined_around(body, &near_by->search, pair, by);
}

/* ---- the list -------------------------------------------------------------------------------- */

/* Return which of 64 skin voxels have another one in a near cell without a shortest path of bonds.
 * An offset across the border of the box leads to a cell between its rows, which is empty. */
static uint64_t candidates(const struct body *body, const struct near_by *near_by,
                           const struct near_cell *cell, int64_t word)
{
    const int64_t n_words = words_of(body), from = 64 * word + cells_by(body, cell->by);
    uint64_t bits = near_by->skin[word] & bits_from(near_by->skin, n_words, from);
    bits &= ~(near_by->held[word] & bits_from(near_by->held, n_words, from));
    return cell->place < 0 ? bits : bits & ~near_by->joined[cell->place * n_words + word];
}

static uint16_t distance2_of(const int32_t by[3])
{
    return (uint16_t)(by[0] * by[0] + by[1] * by[1] + by[2] * by[2]);
}

/* Count the pairs in near cells of each voxel in `begin`; if they are to be written, `begin` is the
 * index of the next pair of a voxel. */
static void visit(const struct body *body, const struct near_by *near_by, int64_t *begin,
                  bool write)
{
    const struct vicinity *vicinity = &body->model->vicinity;
    for (int64_t i = 0; i < vicinity->n_cells; i++) {
        const struct near_cell *cell = &vicinity->cells[i];
        const int64_t by = cells_by(body, cell->by);
        const uint16_t distance2 = distance2_of(cell->by);
        for (int64_t word = 0; word < words_of(body); word++) {
            for (uint64_t left = candidates(body, near_by, cell, word); left; left &= left - 1) {
                const int64_t first = 64 * word + lowest(left), at = begin[first]++;
                if (!write) continue;
                near_by->pairs.list[at] =
                    (struct pair){body->slot_of[first], body->slot_of[first + by]};
                near_by->distance2[at] = distance2;
            }
        }
    }
}

/* Remove the pairs that are connected by a detour. A detour has at least 4 bonds, because neighbors
 * with a common face have a bond or are clamped. */
static void drop_joined(const struct body *body, struct near_by *near_by)
{
    if (body->model->vicinity.hops < 4) return;
    struct pairs *pairs = &near_by->pairs;
    int64_t kept = 0;
    for (int64_t i = 0; i < pairs->n; i++) {
        int32_t by[3];
        set_offset(body, pairs->list[i], by);
        if (is_joined_around(body, &near_by->search, pairs->list[i], by)) continue;
        near_by->distance2[kept] = near_by->distance2[i];
        pairs->list[kept++] = pairs->list[i];
    }
    pairs->n = kept;
}

static void mark_skin(const struct body *body, const struct near_by *near_by)
{
    const size_t size = (size_t)words_of(body) * sizeof(uint64_t);
    memset(near_by->skin, 0, size);
    memset(near_by->held, 0, size);
    for (int64_t i = 0; i < body->census.n_voxels; i++) {
        const int64_t slot = body->slots[i], cell = box_cell(body, slot);
        if (body->bonded[slot] != ALL_SIDES) set(near_by->skin, cell);
        if (body->voxels.fixed[slot] == VOX_FIX_ALL) set(near_by->held, cell);
    }
}

bool vox_pairs_reserve(struct pairs *pairs, int64_t capacity)
{
    if (pairs->list && capacity <= pairs->capacity) return true;
    free(pairs->list);
    pairs->list = malloc(((size_t)capacity + 1) * sizeof *pairs->list);
    pairs->capacity = pairs->list ? capacity : 0;
    return pairs->list != NULL;
}

static void free_bits(struct near_by *near_by)
{
    free(near_by->joined);
    free(near_by->bonds);
    free(near_by->skin);
    free(near_by->held);
    free(near_by->begin);
    free(near_by->distance2);
    near_by->distance2 = NULL;
    free(near_by->search.reached);
    free(near_by->search.queue);
}

static bool allocate(const struct body *body, struct near_by *near_by)
{
    const size_t n_slots = (size_t)body->n_slots, n_cells = (size_t)body->n_box_cells;
    const size_t n_places = (size_t)body->model->vicinity.n_places;
    const size_t size = (size_t)words_of(body) * sizeof(uint64_t);
    free_bits(near_by);
    near_by->joined = malloc(n_places * size);
    near_by->bonds = malloc(6 * size);
    near_by->skin = malloc(size);
    near_by->held = malloc(size);
    near_by->begin = calloc(n_cells + 1, sizeof *near_by->begin);
    near_by->search.reached = calloc(n_slots, sizeof *near_by->search.reached);
    near_by->search.queue = malloc(n_slots * sizeof *near_by->search.queue);
    near_by->search.from = -1;
    near_by->search.number = 0;
    return near_by->joined && near_by->bonds && near_by->skin && near_by->held && near_by->begin &&
           near_by->search.reached && near_by->search.queue;
}

enum vox_status vox_near_by_shape(const struct body *body, struct near_by *near_by)
{
    if (!allocate(body, near_by)) return VOX_NO_MEMORY;
    join_all(body, near_by);
    mark_skin(body, near_by);
    visit(body, near_by, near_by->begin + 1, false);
    for (int64_t cell = 0; cell < body->n_box_cells; cell++)
        near_by->begin[cell + 1] += near_by->begin[cell];
    near_by->pairs.n = near_by->begin[body->n_box_cells];
    if (!vox_pairs_reserve(&near_by->pairs, near_by->pairs.n)) return VOX_NO_MEMORY;
    near_by->distance2 = malloc(((size_t)near_by->pairs.n + 1) * sizeof *near_by->distance2);
    if (!near_by->distance2) return VOX_NO_MEMORY;
    visit(body, near_by, near_by->begin, true);
    drop_joined(body, near_by);
    return VOX_OK;
}

size_t vox_near_by_memory(const struct body *body)
{
    const struct near_by *near_by = &body->contacts.near_by;
    const size_t n_words = (size_t)(body->model->vicinity.n_places * words_of(body));
    return (size_t)near_by->pairs.capacity * sizeof *near_by->pairs.list +
           (size_t)near_by->pairs.n * sizeof *near_by->distance2 +
           n_words * sizeof *near_by->joined + (size_t)body->n_box_cells * sizeof *near_by->begin +
           (size_t)body->n_slots *
               (sizeof *near_by->search.reached + sizeof *near_by->search.queue);
}

void vox_near_by_destroy(struct near_by *near_by)
{
    free_bits(near_by);
    free(near_by->pairs.list);
}
