/* The bond law: a damped beam between two voxels, in one of two frames (sections 5 and 6). */
#include "axes.h"
#include "internal.h"

/* Rotation vector of a rotation. As in the engine, the chord replaces the arc below 5.6 degrees. */
static struct vec rotation_vector(struct quat q)
{
    const double w = q.w > 1.0 ? 1.0 : q.w;
    const double sine2 = 1.0 - w * w;
    if (sine2 <= 0.0) return (struct vec){0.0, 0.0, 0.0}; /* NaN propagates, and is detected */
    const double k = w > COSINE_OF_SMALL_ROTATION ? 2.0 * sqrt((2.0 - 2.0 * w) / sine2)
                                                  : 2.0 * acos(w) / sqrt(sine2);
    return vec_scale(k, (struct vec){q.x, q.y, q.z});
}

/* The rotation of a direction onto +x. As in the engine, the small-angle form is not exactly a unit
 * quaternion and is also used for inverted bonds, close to -x. */
static struct quat rotation_onto_x(struct vec u, double length)
{
    if (fabs(u.y / u.x) < SLOPE_OF_SMALL_TURN && fabs(u.z / u.x) < SLOPE_OF_SMALL_TURN) {
        const double y = 0.5 * u.z / u.x, z = -0.5 * u.y / u.x;
        return (struct quat){1.0 - 0.5 * (y * y + z * z), 0.0, y, z};
    }
    const double cosine = u.x / length;
    const double across = sqrt(u.y * u.y + u.z * u.z);
    const double half_sine = sqrt(0.5 * (1.0 - cosine)), half_cosine = sqrt(0.5 * (1.0 + cosine));
    return (struct quat){half_cosine, 0.0, half_sine * u.z / across, -half_sine * u.y / across};
}

static bool next_frame_is_small(bool small, double turn_cosine, struct vec u, double rest)
{
    const double turn = (fabs(u.y) + fabs(u.z)) / u.x, extension = u.x / rest;
    if (small)
        return !(turn_cosine <= LARGE_COSINE || turn > LARGE_TURN || extension > LARGE_EXTENSION);
    return turn_cosine > SMALL_COSINE && turn < SMALL_TURN && extension < SMALL_EXTENSION;
}

/* Deformation of a bond, or its rate: displacement of the upper end relative to the lower one, and
 * rotation of both ends. */
struct deformation {
    struct vec stretch, turn_lower, turn_upper;
};

/* Forces on, and moments of, both ends in the bond's frame. */
struct wrench {
    struct vec force_lower, force_upper, moment_lower, moment_upper;
};

/* Return the previous deformation of a bond; its lower end never turns about the bond. */
IN_LOOP struct deformation last_of(const struct bonds *bonds, int64_t slot)
{
    return (struct deformation){
        vec_at(bonds->stretch, slot),
        {0.0, bonds->lower_y[slot], bonds->lower_z[slot]},
        vec_at(bonds->upper, slot),
    };
}

IN_LOOP void keep(const struct bonds *bonds, int64_t slot, struct deformation now)
{
    vec_put(bonds->stretch, slot, now.stretch);
    bonds->lower_y[slot] = now.turn_lower.y;
    bonds->lower_z[slot] = now.turn_lower.z;
    vec_put(bonds->upper, slot, now.turn_upper);
}

IN_LOOP struct deformation rate_of(struct deformation now, struct deformation last,
                                   double per_second)
{
    return (struct deformation){
        vec_scale(per_second, vec_sub(now.stretch, last.stretch)),
        vec_scale(per_second, vec_sub(now.turn_lower, last.turn_lower)),
        vec_scale(per_second, vec_sub(now.turn_upper, last.turn_upper)),
    };
}

IN_LOOP struct wrench spring(const struct coupling *c, struct deformation d)
{
    const struct vec p = d.stretch, a = d.turn_lower, b = d.turn_upper;
    const struct vec force = {
        c->stretch * p.x,
        c->shear * p.y - c->bend_shear * (a.z + b.z),
        c->shear * p.z + c->bend_shear * (a.y + b.y),
    };
    const double twist = c->twist * (a.x - b.x), lift = c->bend_shear * p.z,
                 side = c->bend_shear * p.y;
    return (struct wrench){
        .force_lower = force,
        .force_upper = vec_scale(-1.0, force),
        .moment_lower = {twist, lift + c->bend * (2.0 * a.y + b.y),
                         -side + c->bend * (2.0 * a.z + b.z)},
        .moment_upper = {-twist, lift + c->bend * (a.y + 2.0 * b.y),
                         -side + c->bend * (a.z + 2.0 * b.z)},
    };
}

/* Damping force on an end, with the constants of that end. */
static struct vec damping_force(const struct damper *c, struct deformation rate)
{
    const struct vec v = rate.stretch, a = rate.turn_lower, b = rate.turn_upper;
    return (struct vec){
        c->stretch * v.x,
        c->shear * v.y - c->bend_shear * (a.z + b.z),
        c->shear * v.z + c->bend_shear * (a.y + b.y),
    };
}

/* Damping moment on an end with rotation rate `own`; the other end has the rate `other`. */
static struct vec damping_moment(const struct damper *c, struct vec v, struct vec own,
                                 struct vec other)
{
    return (struct vec){
        c->twist * (own.x - other.x),
        c->moment_shear * v.z + c->bend * (2.0 * own.y + other.y),
        -c->moment_shear * v.y + c->bend * (2.0 * own.z + other.z),
    };
}

IN_LOOP void add_damping(struct wrench *wrench, const struct coupling *c, struct deformation rate)
{
    const struct vec v = rate.stretch, a = rate.turn_lower, b = rate.turn_upper;
    wrench->force_lower = vec_add(wrench->force_lower, damping_force(&c->lower, rate));
    wrench->force_upper = vec_sub(wrench->force_upper, damping_force(&c->upper, rate));
    wrench->moment_lower = vec_add(wrench->moment_lower, damping_moment(&c->lower, v, a, b));
    wrench->moment_upper = vec_add(wrench->moment_upper, damping_moment(&c->upper, v, b, a));
}

/* Add the force and moment of an end, given in the bond's frame, to a voxel. */
IN_LOOP void load(const struct voxels *v, int64_t slot, enum axis axis, struct quat frame,
                  struct vec force, struct vec moment)
{
    vec_put(v->force, slot,
            vec_add(vec_at(v->force, slot), quat_rotate(frame, x_to_axis(axis, force))));
    vec_put(v->torque, slot,
            vec_sub(vec_at(v->torque, slot), quat_rotate(frame, x_to_axis(axis, moment))));
}

/* Current deformation of a bond. */
struct pose {
    struct deformation deformation;
    struct quat frame; /* rotation from the bond's frame, in axes of the world, to the world */
    bool small;
};

IN_LOOP struct pose pose_of(const struct voxels *v, enum axis axis, int64_t lower, int64_t upper,
                            bool small)
{
    const double rest = 0.5 * (v->size[lower] + v->size[upper]);
    const struct quat orientation = quat_at(v->orientation, lower), back = quat_conj(orientation);
    const struct vec apart = vec_sub(vec_at(v->position, upper), vec_at(v->position, lower));
    const struct vec u = axis_to_x(axis, quat_rotate(back, apart));
    const struct quat turn = quat_mul(back, quat_at(v->orientation, upper));
    const struct vec turn_axis = axis_to_x(axis, (struct vec){turn.x, turn.y, turn.z});
    const struct quat relative = {turn.w, turn_axis.x, turn_axis.y, turn_axis.z};

    if (next_frame_is_small(small, relative.w, u, rest)) {
        const struct deformation slight = {
            {u.x - rest, u.y, u.z}, {0.0, 0.0, 0.0}, rotation_vector(relative)};
        return (struct pose){slight, orientation, true};
    }
    const double length = sqrt(vec_dot(u, u));
    const struct quat onto_x = rotation_onto_x(u, length);
    const struct vec straighten = x_to_axis(axis, (struct vec){onto_x.x, onto_x.y, onto_x.z});
    const struct deformation large = {{length - rest, 0.0, 0.0},
                                      rotation_vector(onto_x),
                                      rotation_vector(quat_mul(onto_x, relative))};
    const struct quat frame =
        quat_mul(orientation, (struct quat){onto_x.w, -straighten.x, -straighten.y, -straighten.z});
    return (struct pose){large, frame, false};
}

/* Return false if the bond is stretched or compressed by more than `most`, or by NaN. */
IN_LOOP bool bond_apply(const struct body *body, enum axis axis, int64_t lower, double most,
                        double per_second)
{
    const struct bonds *bonds = &body->bonds[axis];
    const int64_t upper = lower + bonds->step;
    const struct coupling *coupling = coupling_of(body, lower, upper);
    const bool small = bonds->small[lower] != 0.0;
    const struct pose pose = pose_of(&body->voxels, axis, lower, upper, small);
    const struct deformation *now = &pose.deformation;

    struct wrench wrench = spring(coupling, *now);
    /* a change of frame keeps the history for the next rates */
    if (pose.small == small) {
        add_damping(&wrench, coupling, rate_of(*now, last_of(bonds, lower), per_second));
        keep(bonds, lower, *now);
    }
    bonds->small[lower] = pose.small ? 1.0 : 0.0;
    load(&body->voxels, lower, axis, pose.frame, wrench.force_lower, wrench.moment_lower);
    load(&body->voxels, upper, axis, pose.frame, wrench.force_upper, wrench.moment_upper);
    return fabs(now->stretch.x) <= most;
}

/* The axis is a constant in each call. */
IN_LOOP bool bonds_along(const struct body *body, enum axis axis, double most, double per_second,
                         double limit)
{
    const struct bonds *bonds = &body->bonds[axis];
    bool fine = true;
    for (int64_t i = 0; i < bonds->n; i++)
        if (bonds->depth[bonds->lower[i]] <= limit)
            fine &= bond_apply(body, axis, bonds->lower[i], most, per_second);
    return fine;
}

bool vox_scalar_bonds_apply(struct body *body, double per_second, double limit)
{
    const struct vox_settings *s = &body->model->settings;
    const double most = s->largest_strain * s->voxel_size;
    bool fine = bonds_along(body, AXIS_X, most, per_second, limit);
    fine &= bonds_along(body, AXIS_Y, most, per_second, limit);
    fine &= bonds_along(body, AXIS_Z, most, per_second, limit);
    return fine;
}

/* The potential of the spring's forces and moments. */
static double spring_energy(const struct coupling *c, struct deformation d)
{
    const struct vec p = d.stretch, a = d.turn_lower, b = d.turn_upper;
    const double stretched = 0.5 * (c->stretch * p.x * p.x + c->shear * (p.y * p.y + p.z * p.z));
    const double twisted = 0.5 * c->twist * (a.x - b.x) * (a.x - b.x);
    const double sheared = c->bend_shear * (p.z * (a.y + b.y) - p.y * (a.z + b.z));
    const double bent = a.y * a.y + a.y * b.y + b.y * b.y + a.z * a.z + a.z * b.z + b.z * b.z;
    return stretched + twisted + sheared + c->bend * bent;
}

double vox_bond_stretch(const struct body *body, enum axis axis, int64_t lower)
{
    const struct bonds *bonds = &body->bonds[axis];
    const bool small = bonds->small[lower] != 0.0;
    return pose_of(&body->voxels, axis, lower, lower + bonds->step, small).deformation.stretch.x;
}

static void add_tension(const struct body *body, enum axis axis, struct tension *tension)
{
    const struct bonds *bonds = &body->bonds[axis];
    for (int64_t i = 0; i < bonds->n; i++) {
        const int64_t lower = bonds->lower[i], upper = lower + bonds->step;
        const struct pose pose =
            pose_of(&body->voxels, axis, lower, upper, bonds->small[lower] != 0.0);
        const double strain = pose.deformation.stretch.x / body->model->settings.voxel_size;
        tension->energy += spring_energy(coupling_of(body, lower, upper), pose.deformation);
        tension->least = fmin(tension->least, strain);
        tension->greatest = fmax(tension->greatest, strain);
    }
}

struct tension vox_bonds_tension(const struct body *body)
{
    const bool any = body->census.n_bonds > 0;
    struct tension tension = {0.0, any ? HUGE_VAL : 0.0, any ? -HUGE_VAL : 0.0};
    for (enum axis axis = AXIS_X; axis <= AXIS_Z; axis++) add_tension(body, axis, &tension);
    return tension;
}
