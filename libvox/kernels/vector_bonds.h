/* The bond law (sections 5 and 6) of the fast kernel; included by vector_kernel.h. */

/* ---- rotations ------------------------------------------------------------------------------- */

/* A rotation as a matrix: cheaper than a quaternion for several vectors. */
struct matrix {
    struct vec x, y, z; /* rows */
};

IN_LOOP struct matrix matrix_of(struct quat q)
{
    const double ww = q.w * q.w, xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
    const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z, xy = q.x * q.y, xz = q.x * q.z,
                 yz = q.y * q.z;
    const double middle = ww - xx, apart = yy - zz;
    return (struct matrix){
        {(ww + xx) - (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)},
        {2.0 * (xy + wz), middle + apart, 2.0 * (yz - wx)},
        {2.0 * (xz - wy), 2.0 * (yz + wx), middle - apart},
    };
}

IN_LOOP struct vec turn(const struct matrix *m, struct vec v)
{
    return (struct vec){vec_dot(m->x, v), vec_dot(m->y, v), vec_dot(m->z, v)};
}

IN_LOOP struct vec turn_back(const struct matrix *m, struct vec v)
{
    return (struct vec){
        m->x.x * v.x + m->y.x * v.y + m->z.x * v.z,
        m->x.y * v.x + m->y.y * v.y + m->z.y * v.z,
        m->x.z * v.x + m->y.z * v.y + m->z.z * v.z,
    };
}

/* ---- deformation of bonds -------------------------------------------------------------------- */

/* Deformations of the bonds of a tile, each in its own frame. */
struct sight {
    lanes stretch[3];  /* m; before `straighten`, position of the upper end relative to the lower */
    lanes relative[4]; /* quaternion of the upper end relative to the frame */
    lanes onto[3];     /* w, y, z of the rotation of the bond onto x; only if a bond is in the large
                          frame */
    lanes rest;        /* m */
    lanes small;       /* 1 or 0, the frame of this step */
} IN_LINES;

/* Orientations of the voxels in a tile as matrices, row by row: the lower ends of its bonds along
 * all axes. */
struct frames {
    lanes entries[9];
} IN_LINES;

IN_LOOP void find_frames(const struct voxels *v, int64_t base, struct frames *restrict frames)
{
    const double *restrict qw = v->orientation.w + base, *restrict qx = v->orientation.x + base;
    const double *restrict qy = v->orientation.y + base, *restrict qz = v->orientation.z + base;
    for (int64_t i = 0; i < TILE; i++) {
        const struct matrix m = matrix_of((struct quat){qw[i], qx[i], qy[i], qz[i]});
        frames->entries[0][i] = m.x.x;
        frames->entries[1][i] = m.x.y;
        frames->entries[2][i] = m.x.z;
        frames->entries[3][i] = m.y.x;
        frames->entries[4][i] = m.y.y;
        frames->entries[5][i] = m.y.z;
        frames->entries[6][i] = m.z.x;
        frames->entries[7][i] = m.z.y;
        frames->entries[8][i] = m.z.z;
    }
}

IN_LOOP struct matrix frame_at(const struct frames *frames, int64_t i)
{
    return (struct matrix){
        {frames->entries[0][i], frames->entries[1][i], frames->entries[2][i]},
        {frames->entries[3][i], frames->entries[4][i], frames->entries[5][i]},
        {frames->entries[6][i], frames->entries[7][i], frames->entries[8][i]},
    };
}

/* Determine the bonds' upper ends relative to the lower ones, and their frames; return the number
 * of bonds in the large frame. */
IN_LOOP int64_t look(const struct voxels *v, const struct bonds *bonds, enum axis axis,
                     int64_t base, const struct frames *restrict frames,
                     struct sight *restrict sight)
{
    const int64_t step = bonds->step;
    const double *restrict px = v->position.x + base, *restrict py = v->position.y + base;
    const double *restrict pz = v->position.z + base, *restrict size = v->size + base;
    const double *restrict qw = v->orientation.w + base, *restrict qx = v->orientation.x + base;
    const double *restrict qy = v->orientation.y + base, *restrict qz = v->orientation.z + base;
    const double *restrict there = bonds->there + base, *restrict was_small = bonds->small + base;
    int64_t large = 0;
    for (int64_t i = 0; i < TILE; i++) {
        const struct quat lower = {qw[i], qx[i], qy[i], qz[i]};
        const struct quat upper = {qw[i + step], qx[i + step], qy[i + step], qz[i + step]};
        const struct vec apart = {px[i + step] - px[i], py[i + step] - py[i], pz[i + step] - pz[i]};
        const struct matrix frame = frame_at(frames, i);
        const struct vec u = axis_to_x(axis, turn_back(&frame, apart));
        const struct quat turned = quat_mul(quat_conj(lower), upper);
        const struct vec turned_axis = axis_to_x(axis, (struct vec){turned.x, turned.y, turned.z});
        const double rest = 0.5 * (size[i] + size[i + step]), aside = fabs(u.y) + fabs(u.z);
        /* comparison of turn and extension to their limits without division; the turn of an
         * inverted bond is negative */
        const double was = was_small[i]; /* 1 or 0, so the limits are accurate enough */
        const double turn = SMALL_TURN + was * (LARGE_TURN - SMALL_TURN);
        const double extension = SMALL_EXTENSION + was * (LARGE_EXTENSION - SMALL_EXTENSION);
        const double cosine = SMALL_COSINE + was * (LARGE_COSINE - SMALL_COSINE);
        const bool is =
            (turned.w > cosine) & ((aside <= turn * u.x) | (u.x < 0.0)) & (u.x <= extension * rest);
        sight->stretch[0][i] = u.x;
        sight->stretch[1][i] = u.y;
        sight->stretch[2][i] = u.z;
        sight->relative[0][i] = turned.w;
        sight->relative[1][i] = turned_axis.x;
        sight->relative[2][i] = turned_axis.y;
        sight->relative[3][i] = turned_axis.z;
        sight->rest[i] = rest;
        sight->small[i] = choose(is, 1.0, 0.0);
        large += (there[i] != 0.0) & !is;
    }
    return large;
}

/* The rotation of a direction onto +x, as in bond.c; its x is 0. */
IN_LOOP struct quat onto_x(struct vec u, double length)
{
    const double slope = SLOPE_OF_SMALL_TURN * fabs(u.x), half = 0.5 / u.x;
    const bool slight = (fabs(u.y) < slope) & (fabs(u.z) < slope);
    const double cosine = u.x / length, half_cosine = sqrt(0.5 + 0.5 * cosine);
    const double k = choose(slight, half, 0.5 / (length * half_cosine));
    const double y = u.z * k, z = -u.y * k;
    return (struct quat){choose(slight, 1.0 - 0.5 * (y * y + z * z), half_cosine), 0.0, y, z};
}

/* Transform the bonds in the large frame; return the number of bonds that are turned too far to
 * replace the arc by the chord. */
IN_LOOP int64_t straighten(const double *restrict there, struct sight *restrict sight)
{
    int64_t far = 0;
    for (int64_t i = 0; i < TILE; i++) {
        const struct vec u = {sight->stretch[0][i], sight->stretch[1][i], sight->stretch[2][i]};
        const struct quat r = {sight->relative[0][i], sight->relative[1][i], sight->relative[2][i],
                               sight->relative[3][i]};
        const bool small = sight->small[i] != 0.0;
        const double length = sqrt(vec_dot(u, u));
        const struct quat large = onto_x(u, length);
        const double w = choose(small, 1.0, large.w), y = choose(small, 0.0, large.y),
                     z = choose(small, 0.0, large.z);
        const double turned = w * r.w - y * r.y - z * r.z;
        sight->onto[0][i] = w;
        sight->onto[1][i] = y;
        sight->onto[2][i] = z;
        sight->relative[0][i] = turned;
        sight->relative[1][i] = w * r.x + y * r.z - z * r.y;
        sight->relative[2][i] = w * r.y + y * r.w + z * r.x;
        sight->relative[3][i] = w * r.z - y * r.x + z * r.w;
        sight->stretch[0][i] = choose(small, u.x, length);
        sight->stretch[1][i] = choose(small, u.y, 0.0);
        sight->stretch[2][i] = choose(small, u.z, 0.0);
        far += (there[i] != 0.0) &
               ((turned <= COSINE_OF_SMALL_ROTATION) | (w <= COSINE_OF_SMALL_ROTATION));
    }
    return far;
}

/* Ratio of the lengths of a rotation vector and of its quaternion's vector part, as in bond.c: the
 * chord replaces the arc below 5.6 degrees, and a cosine beyond 1 or -1, of a quaternion that is
 * not exactly unit, means no rotation. */
IN_LOOP double arc_ratio(double cosine, bool far)
{
    const double chord = choose(cosine >= 1.0, 0.0, 2.0 * inverse_root_of_half(1.0 - cosine));
    if (!far) return chord;
    const double sine2 = 1.0 - cosine * cosine;
    const double arc = choose(sine2 <= 0.0, 0.0, 2.0 * arccosine(cosine) / sqrt(sine2));
    return choose(cosine > COSINE_OF_SMALL_ROTATION, chord, arc);
}

/* ---- forces of bonds ------------------------------------------------------------------------- */

/* Forces and moments of the bonds of a tile on their ends, in the world. */
struct loads {
    lanes force_lower[3], moment_lower[3]; /* summed over the axes */
    lanes force_upper[3], moment_upper[3];
} IN_LINES;

IN_LOOP void add(lanes to[3], int64_t i, bool there, struct vec v)
{
    to[0][i] += choose(there, v.x, 0.0);
    to[1][i] += choose(there, v.y, 0.0);
    to[2][i] += choose(there, v.z, 0.0);
}

IN_LOOP void put(lanes to[3], int64_t i, bool there, struct vec v)
{
    to[0][i] = choose(there, v.x, 0.0);
    to[1][i] = choose(there, v.y, 0.0);
    to[2][i] = choose(there, v.z, 0.0);
}

/* Stiffnesses and dampers of the bond in a slot. */
IN_LOOP struct coupling coupling_in(const struct bonds *bonds, int64_t i)
{
    const struct coupling_arrays *arrays = &bonds->coupling;
#define LOAD(field) .field = arrays->field[i],
    return (struct coupling)
    {
        BOND_LAW(LOAD)
    };
#undef LOAD
}

/* Stretch and turns of both ends, or their rates. */
struct change {
    struct vec p, a, b;
};

/* Force of a spring, or of a damper with its constants, on an end in the bond's frame. */
IN_LOOP struct vec force_of(double stretch, double shear, double bend_shear, const struct change *c)
{
    return (struct vec){
        stretch * c->p.x,
        shear * c->p.y - bend_shear * (c->a.z + c->b.z),
        shear * c->p.z + bend_shear * (c->a.y + c->b.y),
    };
}

/* Moment of a spring or damper on the end that turned by `own`, which counts twice. */
IN_LOOP struct vec moment_of(double twist, double bend_shear, double bend, const struct change *c,
                             struct vec own)
{
    return (struct vec){
        twist,
        bend_shear * c->p.z + bend * ((c->a.y + c->b.y) + own.y),
        bend * ((c->a.z + c->b.z) + own.z) - bend_shear * c->p.y,
    };
}

/* The orientation of a bond in the large frame: lower * (w, 0, -y, -z), the latter in the bond's
 * axes. */
IN_LOOP struct quat turned_back(struct quat lower, enum axis axis, double w, double y, double z)
{
    const struct vec v = axis_to_x(axis, (struct vec){lower.x, lower.y, lower.z});
    const struct vec turned = {
        w * v.x + (v.z * y - v.y * z),
        w * v.y + (v.x * z - lower.w * y),
        w * v.z - (v.x * y + lower.w * z),
    };
    const struct vec back = x_to_axis(axis, turned);
    return (struct quat){lower.w * w + (v.y * y + v.z * z), back.x, back.y, back.z};
}

/* Compute the forces and moments of a tile's bonds, and store the deformations; return the number
 * of overstrained bonds. `coupling` is NULL if bonds differ; the constants `large` and `far` mean
 * that some bonds are in the large frame, or are turned far. */
IN_LOOP int64_t pull(const struct voxels *v, const struct bonds *bonds,
                     const struct coupling *coupling, enum axis axis, int64_t base,
                     double per_second, double most, bool large, bool far,
                     const struct frames *restrict frames, const struct sight *restrict sight,
                     struct loads *restrict loads)
{
    const double *restrict qw = v->orientation.w + base, *restrict qx = v->orientation.x + base;
    const double *restrict qy = v->orientation.y + base, *restrict qz = v->orientation.z + base;
    const double *restrict is_there = bonds->there + base;
    double *restrict small = bonds->small + base;
    double *restrict last_x = bonds->stretch.x + base, *restrict last_y = bonds->stretch.y + base;
    double *restrict last_z = bonds->stretch.z + base;
    double *restrict lower_y = bonds->lower_y + base, *restrict lower_z = bonds->lower_z + base;
    double *restrict upper_x = bonds->upper.x + base, *restrict upper_y = bonds->upper.y + base;
    double *restrict upper_z = bonds->upper.z + base;
    int64_t overstrained = 0;
    NO_LANE_DEPENDS_ON_ANOTHER
    for (int64_t i = 0; i < TILE; i++) {
        const struct coupling c = coupling ? *coupling : coupling_in(bonds, base + i);
        const struct vec p = {sight->stretch[0][i] - sight->rest[i], sight->stretch[1][i],
                              sight->stretch[2][i]};
        const struct quat r = {sight->relative[0][i], sight->relative[1][i], sight->relative[2][i],
                               sight->relative[3][i]};
        const struct quat lower = {qw[i], qx[i], qy[i], qz[i]};
        struct vec a = {0.0, 0.0, 0.0};
        struct quat frame = lower;
        if (large) {
            const double w = sight->onto[0][i], y = sight->onto[1][i], z = sight->onto[2][i];
            const double k = arc_ratio(w, far);
            a = (struct vec){0.0, k * y, k * z};
            frame = turned_back(lower, axis, w, y, z);
        }
        const double k = arc_ratio(r.w, far);
        const struct vec b = {k * r.x, k * r.y, k * r.z};

        /* a change of frame keeps the history for the next rates */
        const bool same = sight->small[i] == small[i];
        const double rate = choose(same, per_second, 0.0);
        const struct change now = {p, a, b};
        const struct change speed = {
            {rate * (p.x - last_x[i]), rate * (p.y - last_y[i]), rate * (p.z - last_z[i])},
            {0.0, rate * (a.y - lower_y[i]), rate * (a.z - lower_z[i])},
            {rate * (b.x - upper_x[i]), rate * (b.y - upper_y[i]), rate * (b.z - upper_z[i])},
        };
        small[i] = sight->small[i];
        last_x[i] = choose(same, p.x, last_x[i]);
        last_y[i] = choose(same, p.y, last_y[i]);
        last_z[i] = choose(same, p.z, last_z[i]);
        lower_y[i] = choose(same, a.y, lower_y[i]);
        lower_z[i] = choose(same, a.z, lower_z[i]);
        upper_x[i] = choose(same, b.x, upper_x[i]);
        upper_y[i] = choose(same, b.y, upper_y[i]);
        upper_z[i] = choose(same, b.z, upper_z[i]);

        const struct damper *lower_end = &c.lower, *upper_end = coupling ? &c.lower : &c.upper;
        const struct vec spring = force_of(c.stretch, c.shear, c.bend_shear, &now);
        const struct vec brake =
            force_of(lower_end->stretch, lower_end->shear, lower_end->bend_shear, &speed);
        const double twist = c.twist * b.x, twisting = speed.b.x;
        const struct vec moment_lower =
            vec_add(moment_of(-twist, c.bend_shear, c.bend, &now, a),
                    moment_of(-lower_end->twist * twisting, lower_end->moment_shear,
                              lower_end->bend, &speed, speed.a));
        const struct vec moment_upper =
            vec_add(moment_of(twist, c.bend_shear, c.bend, &now, b),
                    moment_of(upper_end->twist * twisting, upper_end->moment_shear, upper_end->bend,
                              &speed, speed.b));
        const struct matrix m = large ? matrix_of(frame) : frame_at(frames, i);
        const bool there = is_there[i] != 0.0;
        const struct vec force_lower = turn(&m, x_to_axis(axis, vec_add(spring, brake)));
        add(loads->force_lower, i, there, force_lower);
        add(loads->moment_lower, i, there, turn(&m, x_to_axis(axis, moment_lower)));
        put(loads->moment_upper, i, there, turn(&m, x_to_axis(axis, moment_upper)));
        if (coupling) {
            put(loads->force_upper, i, there, force_lower);
        } else {
            const struct vec own =
                force_of(upper_end->stretch, upper_end->shear, upper_end->bend_shear, &speed);
            put(loads->force_upper, i, there, turn(&m, x_to_axis(axis, vec_add(spring, own))));
        }
        overstrained += there & !(fabs(p.x) <= most);
    }
    return overstrained;
}

IN_LOOP void add_lanes(double *restrict to, const double *restrict from)
{
    for (int64_t i = 0; i < TILE; i++) to[i] += from[i];
}

IN_LOOP void subtract_lanes(double *restrict to, const double *restrict from)
{
    for (int64_t i = 0; i < TILE; i++) to[i] -= from[i];
}

/* Add the forces and moments on lower or upper ends to the voxels; forces on both ends have
 * opposite signs. */
IN_LOOP void unload(const struct voxels *v, int64_t base, const lanes force[3],
                    const lanes moment[3], bool upper)
{
    double *const forces[] = {v->force.x, v->force.y, v->force.z};
    double *const torques[] = {v->torque.x, v->torque.y, v->torque.z};
    for (int i = 0; i < 3; i++) {
        if (upper)
            subtract_lanes(forces[i] + base, force[i]);
        else
            add_lanes(forces[i] + base, force[i]);
        subtract_lanes(torques[i] + base, moment[i]);
    }
}

IN_LOOP bool bonds_of_tile(const struct body *body, const struct coupling *coupling, enum axis axis,
                           int64_t base, double per_second, double most,
                           const struct frames *frames, struct loads *loads)
{
    if (!body->bonds[axis].tile_used[base / TILE]) return true;
    const struct voxels *v = &body->voxels;
    const struct bonds *b = &body->bonds[axis];
    struct sight sight;
    int64_t overstrained;
    if (look(v, b, axis, base, frames, &sight) == 0)
        overstrained =
            pull(v, b, coupling, axis, base, per_second, most, false, false, frames, &sight, loads);
    else if (straighten(b->there + base, &sight) == 0)
        overstrained =
            pull(v, b, coupling, axis, base, per_second, most, true, false, frames, &sight, loads);
    else
        overstrained =
            pull(v, b, coupling, axis, base, per_second, most, true, true, frames, &sight, loads);
    unload(v, base + b->step, loads->force_upper, loads->moment_upper, true);
    return overstrained == 0;
}

/* Process all axes of a tile while its voxels are in the cache; whether there is one coupling is a
 * constant. */
IN_LOOP bool bonds_of_body(const struct body *body, const struct coupling *coupling,
                           double per_second)
{
    const struct vox_settings *s = &body->model->settings;
    const double most = s->largest_strain * s->voxel_size;
    struct frames frames;
    struct loads loads;
    bool fine = true;
    for (int64_t base = 0; base < body->n_slots; base += TILE) {
        if (!body->tile_used[base / TILE]) continue;
        find_frames(&body->voxels, base, &frames);
        memset(&loads, 0, sizeof loads.force_lower + sizeof loads.moment_lower);
        fine &= bonds_of_tile(body, coupling, AXIS_X, base, per_second, most, &frames, &loads);
        fine &= bonds_of_tile(body, coupling, AXIS_Y, base, per_second, most, &frames, &loads);
        fine &= bonds_of_tile(body, coupling, AXIS_Z, base, per_second, most, &frames, &loads);
        unload(&body->voxels, base, loads.force_lower, loads.moment_lower, false);
    }
    return fine;
}

static bool VECTOR(bonds_apply)(struct body *body, double per_second)
{
    if (!body->coupling) return bonds_of_body(body, NULL, per_second);
    const struct coupling coupling = *body->coupling;
    return bonds_of_body(body, &coupling, per_second);
}
