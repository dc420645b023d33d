/* Bodies that are not in use, for later calls. */
#include <stdlib.h>
#include <string.h>

#include "internal.h"

/* bytes, of all spares of a model together */
static const size_t MOST_SPARE_MEMORY = (size_t)1 << 25;

static void body_destroy(struct body *body)
{
    if (!body) return;
    vox_contacts_destroy(&body->contacts);
    vox_watch_destroy(&body->contacts.watch);
    vox_surface_destroy(&body->surface);
    free(body->memory);
    free(body->material);
    free(body);
}

static struct body *body_create(const vox_model *model)
{
    struct body *body = calloc(1, sizeof *body);
    if (body) body->material = malloc((size_t)model->cells);
    if (body && body->material) return body;
    body_destroy(body);
    return NULL;
}

bool vox_body_has(const struct body *body, const uint8_t *material)
{
    return body->complete && memcmp(body->material, material, (size_t)body->model->cells) == 0;
}

/* Wait until no other thread uses the spares: while it compares the materials of a few bodies. */
static void lock(struct spares *spares)
{
    while (atomic_flag_test_and_set_explicit(&spares->busy, memory_order_acquire)) continue;
}

static void unlock(struct spares *spares)
{
    atomic_flag_clear_explicit(&spares->busy, memory_order_release);
}

static struct body *take_out(struct spares *spares, int64_t i)
{
    struct body *body = spares->bodies[i];
    spares->n--;
    memmove(&spares->bodies[i], &spares->bodies[i + 1],
            (size_t)(spares->n - i) * sizeof *spares->bodies);
    return body;
}

struct body *vox_body_take(const vox_model *model, const uint8_t *material)
{
    struct spares *spares = model->spares;
    struct body *found = NULL;
    lock(spares);
    for (int64_t i = spares->n - 1; i >= 0 && !found; i--)
        if (vox_body_has(spares->bodies[i], material)) found = take_out(spares, i);
    if (!found && spares->n == MOST_SPARES) found = take_out(spares, 0);
    unlock(spares);
    return found ? found : body_create(model);
}

static size_t memory_of(const struct body *body)
{
    return body->memory_size + vox_contacts_memory(body) + vox_surface_memory(body);
}

static size_t memory_of_all(const struct spares *spares)
{
    size_t sum = 0;
    for (int64_t i = 0; i < spares->n; i++) sum += memory_of(spares->bodies[i]);
    return sum;
}

void vox_body_return(const vox_model *model, struct body *body)
{
    struct spares *spares = model->spares;
    struct body *surplus[MOST_SPARES];
    int n = 0;
    if (!body) return;
    if (memory_of(body) > MOST_SPARE_MEMORY) {
        body_destroy(body);
        return;
    }
    lock(spares);
    while (spares->n == MOST_SPARES || memory_of_all(spares) + memory_of(body) > MOST_SPARE_MEMORY)
        surplus[n++] = take_out(spares, 0);
    spares->bodies[spares->n++] = body;
    unlock(spares);
    while (n > 0) body_destroy(surplus[--n]);
}

void vox_bodies_destroy(vox_model *model)
{
    for (int64_t i = 0; model->spares && i < model->spares->n; i++)
        body_destroy(model->spares->bodies[i]);
    free(model->spares);
}
