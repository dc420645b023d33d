/* Self collision: how voxels that touch repel each other (section 10); damping and friction are ours. */
#include "internal.h"

/* Two voxels closer than their envelopes reach. */
struct touch {
    struct voxel *first, *second;
    const struct coupling *coupling;
    struct vec towards; /* unit, from the first to the second */
    double distance;    /* m */
    double overlap;     /* m */
};

static struct vec spin_rate(const struct voxel *voxel)
{
    return vec_scale(1.0 / voxel->substance->inertia, voxel->spin);
}

/* Velocity of the second against the first where they touch, half-way between them. */
static struct vec relative_velocity(const struct touch *touch)
{
    const struct vec lever = vec_scale(0.5 * touch->distance, touch->towards);
    const struct vec spins = vec_add(spin_rate(touch->first), spin_rate(touch->second));
    const struct vec passing = vec_sub(velocity_of(touch->second), velocity_of(touch->first));
    return vec_sub(passing, vec_cross(spins, lever));
}

static void push_apart(const struct touch *touch, struct vec force)
{
    touch->first->force = vec_sub(touch->first->force, force);
    touch->second->force = vec_add(touch->second->force, force);
}

/* Forces half-way between two voxels turn both, so that their angular momentum stays. */
static void turn_both(const struct touch *touch, struct vec force)
{
    const struct vec torque = vec_cross(force, vec_scale(0.5 * touch->distance, touch->towards));
    touch->first->torque = vec_add(touch->first->torque, torque);
    touch->second->torque = vec_add(touch->second->torque, torque);
}

/* How many contacts share what a step can take from the motion of two voxels. */
static double sharers(const struct touch *touch)
{
    const int32_t first = touch->first->touching, second = touch->second->touching;
    return (double)(first > second ? first : second);
}

/* The damper of which all contacts together would end the approach within one step; none is ever stronger. */
static double strongest_drag(const struct touch *touch, double dt)
{
    const struct substance *a = touch->first->substance, *b = touch->second->substance;
    return 1.0 / (dt * sharers(touch) * (1.0 / a->mass + 1.0 / b->mass));
}

/* The force of which all contacts together would end the sliding within one step; friction never exceeds it. */
static double stopping_force(const struct touch *touch, double speed, double dt)
{
    const struct substance *a = touch->first->substance, *b = touch->second->substance;
    const double lever2 = 0.25 * touch->distance * touch->distance;
    const double mobility = 1.0 / a->mass + 1.0 / b->mass + lever2 / a->inertia + lever2 / b->inertia;
    return speed / (dt * sharers(touch) * mobility);
}

static struct vec friction(const struct touch *touch, struct vec sliding, double push, double dt)
{
    const double speed = sqrt(vec_dot(sliding, sliding));
    if (!(speed > 0.0)) return (struct vec){0.0, 0.0, 0.0};
    const double force = fmin(touch->coupling->touch_friction * push, stopping_force(touch, speed, dt));
    return vec_scale(-force / speed, sliding);
}

static void collide(const struct touch *touch, double dt)
{
    const struct coupling *c = touch->coupling;
    const struct vec velocity = relative_velocity(touch);
    const double parting = vec_dot(velocity, touch->towards);
    const double drag = fmin(c->touch_drag, strongest_drag(touch, dt));
    const double push = fmax(0.0, c->stretch * touch->overlap - drag * parting); /* never a pull */
    const struct vec rub = friction(touch, vec_sub(velocity, vec_scale(parting, touch->towards)), push, dt);
    push_apart(touch, vec_add(vec_scale(push, touch->towards), rub));
    turn_both(touch, rub);
}

/* The original engine's law. */
IN_LOOP void repel(const struct touch *touch)
{
    push_apart(touch, vec_scale(touch->coupling->stretch * touch->overlap, touch->towards));
}

/* Whether two listed voxels touch, and how. */
IN_LOOP bool touches(const struct body *body, const struct contact *contact, struct touch *touch)
{
    struct voxel *first = &body->voxels[contact->first], *second = &body->voxels[contact->second];
    const struct vec apart = vec_sub(second->position, first->position);
    const double reach = 0.5 * body->model->settings.collision_envelope * (first->size + second->size);
    const double distance2 = vec_dot(apart, apart);
    if (!(distance2 < reach * reach && distance2 > 0.0)) return false;
    const double distance = sqrt(distance2);
    *touch = (struct touch){first, second, contact->coupling, vec_scale(1.0 / distance, apart), distance,
                            reach - distance};
    return true;
}

static void count_touching(struct body *body)
{
    struct touch touch;
    for (int64_t i = 0; i < body->census.n_voxels; i++) body->voxels[i].touching = 0;
    for (int64_t i = 0; i < body->contacts.n; i++) {
        if (!touches(body, &body->contacts.list[i], &touch)) continue;
        touch.first->touching++;
        touch.second->touching++;
    }
}

void contacts_apply(struct body *body)
{
    const struct vox_settings *s = &body->model->settings;
    const bool elastic = s->contact_damping == 0.0 && !s->contact_friction;
    struct touch touch;
    if (!elastic) count_touching(body);
    for (int64_t i = 0; i < body->contacts.n; i++) {
        if (!touches(body, &body->contacts.list[i], &touch)) continue;
        if (elastic)
            repel(&touch);
        else
            collide(&touch, body->census.dt);
    }
}
