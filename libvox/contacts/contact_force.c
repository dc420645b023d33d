/* Self collision: forces between touching voxels (section 10). The engine has neither damping nor
 * friction. */
#include "contacts/touch.h"
#include "internal.h"

static struct vec spin_rate(const struct voxels *v, int64_t slot)
{
    return vec_scale(v->turnability[slot], vec_at(v->spin, slot));
}

/* Velocity of the second voxel relative to the first at the contact point, halfway between them. */
static struct vec relative_velocity(const struct voxels *v, const struct touch *touch)
{
    const struct vec lever = vec_scale(0.5 * touch->distance, touch->towards);
    const struct vec spins = vec_add(spin_rate(v, touch->first), spin_rate(v, touch->second));
    const struct vec passing = vec_sub(velocity_of(v, touch->second), velocity_of(v, touch->first));
    return vec_sub(passing, vec_cross(spins, lever));
}

IN_LOOP void push_apart(const struct voxels *v, const struct touch *touch, struct vec force)
{
    vec_put(v->force, touch->first, vec_sub(vec_at(v->force, touch->first), force));
    vec_put(v->force, touch->second, vec_add(vec_at(v->force, touch->second), force));
}

/* Apply the torques of forces halfway between two voxels, which conserve angular momentum. */
static void turn_both(const struct voxels *v, const struct touch *touch, struct vec force)
{
    const struct vec torque = vec_cross(force, vec_scale(0.5 * touch->distance, touch->towards));
    vec_put(v->torque, touch->first, vec_add(vec_at(v->torque, touch->first), torque));
    vec_put(v->torque, touch->second, vec_add(vec_at(v->torque, touch->second), torque));
}

/* Number of contacts that share the momentum change of a step. */
static double sharers(const struct voxels *v, const struct touch *touch)
{
    const int32_t first = v->touching[touch->first], second = v->touching[touch->second];
    return (double)(first > second ? first : second);
}

/* Upper limit of damping: with it, all contacts together stop the approach within one step. */
static double strongest_drag(const struct voxels *v, const struct touch *touch, double dt)
{
    return 1.0 /
           (dt * sharers(v, touch) * (v->mobility[touch->first] + v->mobility[touch->second]));
}

/* Upper limit of friction: with it, all contacts together stop the sliding within one step. */
static double stopping_force(const struct voxels *v, const struct touch *touch, double speed,
                             double dt)
{
    const double lever2 = 0.25 * touch->distance * touch->distance;
    const double turning =
        lever2 * v->turnability[touch->first] + lever2 * v->turnability[touch->second];
    const double mobility = v->mobility[touch->first] + v->mobility[touch->second] + turning;
    return speed / (dt * sharers(v, touch) * mobility);
}

static struct vec friction(const struct body *body, const struct touch *touch, struct vec sliding,
                           double push)
{
    const double speed = sqrt(vec_dot(sliding, sliding));
    if (!(speed > 0.0)) return (struct vec){0.0, 0.0, 0.0};
    const double most = coupling_of(body, touch->first, touch->second)->touch_friction * push;
    const double force = fmin(most, stopping_force(&body->voxels, touch, speed, body->census.dt));
    return vec_scale(-force / speed, sliding);
}

static void collide(const struct body *body, const struct touch *touch)
{
    const struct voxels *v = &body->voxels;
    const struct coupling *c = coupling_of(body, touch->first, touch->second);
    const struct vec velocity = relative_velocity(v, touch);
    const double parting = vec_dot(velocity, touch->towards);
    const double drag = fmin(c->touch_drag, strongest_drag(v, touch, body->census.dt));
    const double push =
        fmax(0.0, c->stretch * touch->overlap - drag * parting); /* never attractive */
    const struct vec rub =
        friction(body, touch, vec_sub(velocity, vec_scale(parting, touch->towards)), push);
    push_apart(v, touch, vec_add(vec_scale(push, touch->towards), rub));
    turn_both(v, touch, rub);
}

static void count_touching(struct body *body, double half_envelope)
{
    struct voxels *v = &body->voxels;
    struct touch touch;
    for (int64_t i = 0; i < body->census.n_voxels; i++) v->touching[body->slots[i]] = 0;
    for (int64_t i = 0; i < body->contacts.now.n; i++) {
        const struct pair pair = body->contacts.now.list[i];
        if (!touches(v, pair, between(v, pair), half_envelope, &touch)) continue;
        v->touching[touch.first]++;
        v->touching[touch.second]++;
    }
}

void vox_contacts_apply(struct body *body)
{
    const struct vox_settings *s = &body->model->settings;
    const bool elastic = s->contact_damping == 0.0 && !s->contact_friction;
    const double half_envelope = 0.5 * s->collision_envelope;
    struct touch touch;
    if (!elastic) count_touching(body, half_envelope);
    for (int64_t i = 0; i < body->contacts.now.n; i++) {
        const struct pair pair = body->contacts.now.list[i];
        if (!touches(&body->voxels, pair, between(&body->voxels, pair), half_envelope, &touch))
            continue;
        if (elastic)
            repel(body, &touch);
        else
            collide(body, &touch);
    }
}
