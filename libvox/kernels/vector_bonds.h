/* The bond law (sections 5 and 6) of the fast kernel; included by vector_kernel.h. */

/* ---- the law ------------------------------------------------------------------------------- */

/* Factor of a deformation, and of the same deformation one step before: spring and damper as one
 * linear function. */
struct factors {
    double now, last;
};

IN_LOOP struct factors factors_of(double stiffness, double damping, double per_second)
{
    return (struct factors){stiffness + damping * per_second, damping * per_second};
}

IN_LOOP double load_of(struct factors factors, double now, double last)
{
    return factors.now * now - factors.last * last;
}

/* The bond law for one end. */
struct law {
    struct factors stretch, shear, bend_shear, moment_shear, bend, twist;
};

IN_LOOP struct law law_of(const struct coupling *c, const struct damper *damper, double per_second)
{
    return (struct law){
        .stretch = factors_of(c->stretch, damper->stretch, per_second),
        .shear = factors_of(c->shear, damper->shear, per_second),
        .bend_shear = factors_of(c->bend_shear, damper->bend_shear, per_second),
        .moment_shear = factors_of(c->bend_shear, damper->moment_shear, per_second),
        .bend = factors_of(c->bend, damper->bend, per_second),
        .twist = factors_of(c->twist, damper->twist, per_second),
    };
}

/* What applies to all bonds in a step. */
struct span {
    double per_second; /* 1/dt, or 0 in the first step */
    double limit;      /* depth up to which bonds are computed */
    double most;       /* m, largest stretch */
    struct law law;    /* of all bonds, unless they differ */
};

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
    /* only if a bond is in the large frame */
    lanes onto[3];           /* w, y, z of the rotation of the bond onto x */
    lanes ratio, onto_ratio; /* lengths of both rotations' vectors and their quaternions' vectors */
    /* always */
    lanes rest;  /* m */
    lanes small; /* 1 or 0, the frame of this step */
} IN_LINES;

/* Orientations of the voxels in a tile as matrices, row by row: the lower ends of its bonds along
 * all axes. */
struct frames {
    lanes entries[9];
} IN_LINES;

IN_LOOP void find_frames(const struct voxels *v, int64_t base, struct range range,
                         struct frames *restrict frames)
{
    const double *restrict qw = v->orientation.w + base, *restrict qx = v->orientation.x + base;
    const double *restrict qy = v->orientation.y + base, *restrict qz = v->orientation.z + base;
    FOR_LANES(i, range)
    {
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
                     int64_t base, struct range range, double limit,
                     const struct frames *restrict frames, struct sight *restrict sight)
{
    const int64_t step = bonds->step;
    const double *restrict px = v->position.x + base, *restrict py = v->position.y + base;
    const double *restrict pz = v->position.z + base, *restrict size = v->size + base;
    const double *restrict qw = v->orientation.w + base, *restrict qx = v->orientation.x + base;
    const double *restrict qy = v->orientation.y + base, *restrict qz = v->orientation.z + base;
    const double *restrict depth = bonds->depth + base, *restrict was_small = bonds->small + base;
    counts large = {0};
    FOR_LANES(i, range)
    {
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
        large[i - vector] += (depth[i] <= limit) & !is;
    }
    return sum_of(large);
}

/* The rotation of a direction onto +x, as in bond.c; its x is 0. The length times the cosine of
 * half the angle gives both its sine and its cosine with one division. */
IN_LOOP struct quat onto_x(struct vec u, double length)
{
    const double slope = SLOPE_OF_SMALL_TURN * fabs(u.x);
    const bool slight = (fabs(u.y) < slope) & (fabs(u.z) < slope);
    const double sum = length + u.x, half = sqrt(0.5 * length * sum);
    const double k = 0.5 / choose(slight, u.x, half);
    const double y = u.z * k, z = -u.y * k;
    return (struct quat){choose(slight, 1.0 - 0.5 * (y * y + z * z), sum * k), 0.0, y, z};
}

/* Ratio of the lengths of a rotation vector and of its quaternion's vector part. As in bond.c, the
 * chord replaces the arc below 5.6 degrees, and a cosine beyond 1 or -1, of a quaternion that is
 * not exactly unit, means no rotation. */
IN_LOOP double chord_ratio(double cosine)
{
    return choose(cosine >= 1.0, 0.0, 2.0 * inverse_root_of_half(1.0 - cosine));
}

IN_LOOP double arc_ratio(double cosine)
{
    const double sine2 = 1.0 - cosine * cosine;
    return choose(sine2 <= 0.0, 0.0, 2.0 * arccosine(cosine) / sqrt(sine2));
}

/* Transform the bonds in the large frame; return the number of bonds that are turned too far to
 * replace the arc by the chord. */
IN_LOOP int64_t straighten(const double *restrict depth, struct range range, double limit,
                           struct sight *restrict sight)
{
    counts far = {0};
    FOR_LANES(i, range)
    {
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
        far[i - vector] += (depth[i] <= limit) &
                           ((turned <= COSINE_OF_SMALL_ROTATION) | (w <= COSINE_OF_SMALL_ROTATION));
    }
    return sum_of(far);
}

/* Replace chords by arcs where the engine does; return whether a bond is turned by more than 120
 * degrees, for which the next function is needed. */
static bool bend(const double *restrict depth, struct range range, double limit,
                 struct sight *restrict sight)
{
    counts over = {0};
    FOR_LANES(i, range)
    {
        const double w = sight->onto[0][i], turned = sight->relative[0][i];
        const double arc = short_arc_ratio(turned), onto_arc = short_arc_ratio(w);
        sight->ratio[i] = choose(turned > COSINE_OF_SMALL_ROTATION, chord_ratio(turned), arc);
        sight->onto_ratio[i] = choose(w > COSINE_OF_SMALL_ROTATION, chord_ratio(w), onto_arc);
        over[i - vector] += (depth[i] <= limit) & !((turned >= 0.5) & (w >= 0.5));
    }
    return sum_of(over) > 0;
}

static void bend_over(struct range range, struct sight *restrict sight)
{
    FOR_LANES(i, range)
    {
        const double w = sight->onto[0][i], turned = sight->relative[0][i];
        sight->ratio[i] = choose(turned >= 0.5, sight->ratio[i], arc_ratio(turned));
        sight->onto_ratio[i] = choose(w >= 0.5, sight->onto_ratio[i], arc_ratio(w));
    }
}

/* ---- forces of bonds ------------------------------------------------------------------------- */

/* Forces and moments of the bonds of a tile on their lower ends, summed over the axes. Moments of
 * bonds in the small frame are in the axes of the lower end, which are turned only once. */
struct loads {
    lanes force[3], moment[3], own_moment[3];
} IN_LINES;

IN_LOOP void add(lanes to[3], int64_t i, bool there, struct vec v)
{
    to[0][i] += choose(there, v.x, 0.0);
    to[1][i] += choose(there, v.y, 0.0);
    to[2][i] += choose(there, v.z, 0.0);
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

/* Stretch of a bond and turns of both ends; the lower end does not turn about the bond. */
struct deformation {
    struct vec p, a, b;
    double a_and_b_y, a_and_b_z; /* sums */
};

/* Force on an end in the bond's frame. */
IN_LOOP struct vec force_of(const struct law *law, const struct deformation *now,
                            const struct deformation *last)
{
    return (struct vec){
        load_of(law->stretch, now->p.x, last->p.x),
        load_of(law->shear, now->p.y, last->p.y) -
            load_of(law->bend_shear, now->a_and_b_z, last->a_and_b_z),
        load_of(law->shear, now->p.z, last->p.z) +
            load_of(law->bend_shear, now->a_and_b_y, last->a_and_b_y),
    };
}

/* Moment on the end that has turned by `own`, which counts twice, and before by `own_last`. */
IN_LOOP struct vec moment_of(const struct law *law, const struct deformation *now,
                             const struct deformation *last, double twist, struct vec own,
                             struct vec own_last)
{
    return (struct vec){
        twist,
        load_of(law->moment_shear, now->p.z, last->p.z) +
            load_of(law->bend, now->a_and_b_y + own.y, last->a_and_b_y + own_last.y),
        load_of(law->bend, now->a_and_b_z + own.z, last->a_and_b_z + own_last.z) -
            load_of(law->moment_shear, now->p.y, last->p.y),
    };
}

/* Write a vector to a slot, or 0. */
IN_LOOP void put(struct vecs to, int64_t i, bool there, struct vec v)
{
    to.x[i] = choose(there, v.x, 0.0);
    to.y[i] = choose(there, v.y, 0.0);
    to.z[i] = choose(there, v.z, 0.0);
}

IN_LOOP struct vecs from_slot(struct vecs a, int64_t slot)
{
    return (struct vecs){a.x + slot, a.y + slot, a.z + slot};
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
 * of overstrained bonds. `coupling` is NULL if bonds differ; the constant `large` means that some
 * bonds are in the large frame. */
IN_LOOP int64_t pull(const struct voxels *v, const struct bonds *bonds,
                     const struct coupling *coupling, enum axis axis, int64_t base,
                     struct range range, const struct span *span, bool large, bool far,
                     const struct frames *restrict frames, const struct sight *restrict sight,
                     struct loads *restrict loads)
{
    const double *restrict qw = v->orientation.w + base, *restrict qx = v->orientation.x + base;
    const double *restrict qy = v->orientation.y + base, *restrict qz = v->orientation.z + base;
    const double *restrict depth = bonds->depth + base;
    double *restrict small = bonds->small + base;
    double *restrict last_x = bonds->stretch.x + base, *restrict last_y = bonds->stretch.y + base;
    double *restrict last_z = bonds->stretch.z + base;
    double *restrict lower_y = bonds->lower_y + base, *restrict lower_z = bonds->lower_z + base;
    double *restrict upper_x = bonds->upper.x + base, *restrict upper_y = bonds->upper.y + base;
    double *restrict upper_z = bonds->upper.z + base;
    const struct vecs force_upper = from_slot(bonds->pull, base);
    const struct vecs moment_upper = from_slot(bonds->wrench, base);
    const double limit = span->limit, most = span->most;
    counts overstrained = {0};
    FOR_LANES(i, range)
    {
        const struct coupling c = coupling ? *coupling : coupling_in(bonds, base + i);
        const struct law law = coupling ? span->law : law_of(&c, &c.lower, span->per_second);
        const bool there = depth[i] <= limit, is_small = sight->small[i] != 0.0;
        const struct vec p = {sight->stretch[0][i] - sight->rest[i], sight->stretch[1][i],
                              sight->stretch[2][i]};
        const struct quat r = {sight->relative[0][i], sight->relative[1][i], sight->relative[2][i],
                               sight->relative[3][i]};
        const struct quat lower = {qw[i], qx[i], qy[i], qz[i]};
        struct vec a = {0.0, 0.0, 0.0};
        struct quat frame = lower;
        if (large) {
            const double w = sight->onto[0][i], y = sight->onto[1][i], z = sight->onto[2][i];
            const double k = far ? sight->onto_ratio[i] : chord_ratio(w);
            a = (struct vec){0.0, k * y, k * z};
            frame = turned_back(lower, axis, w, y, z);
        }
        const double k = far ? sight->ratio[i] : chord_ratio(r.w);
        const struct vec b = {k * r.x, k * r.y, k * r.z};
        const struct deformation now = {p, a, b, large ? a.y + b.y : b.y, large ? a.z + b.z : b.z};

        /* a change of frame has no rates, and keeps the history for the next ones */
        const bool same = sight->small[i] == small[i];
        struct deformation last = {
            {choose(same, last_x[i], p.x), choose(same, last_y[i], p.y),
             choose(same, last_z[i], p.z)},
            {0.0, choose(same, lower_y[i], a.y), choose(same, lower_z[i], a.z)},
            {choose(same, upper_x[i], b.x), choose(same, upper_y[i], b.y),
             choose(same, upper_z[i], b.z)},
            0.0,
            0.0,
        };
        last.a_and_b_y = last.a.y + last.b.y;
        last.a_and_b_z = last.a.z + last.b.z;
        small[i] = sight->small[i];
        last_x[i] = choose(same, p.x, last_x[i]);
        last_y[i] = choose(same, p.y, last_y[i]);
        last_z[i] = choose(same, p.z, last_z[i]);
        lower_y[i] = choose(same, a.y, lower_y[i]);
        lower_z[i] = choose(same, a.z, lower_z[i]);
        upper_x[i] = choose(same, b.x, upper_x[i]);
        upper_y[i] = choose(same, b.y, upper_y[i]);
        upper_z[i] = choose(same, b.z, upper_z[i]);

        const struct matrix m = large ? matrix_of(frame) : frame_at(frames, i);
        const struct vec force = turn(&m, x_to_axis(axis, force_of(&law, &now, &last)));
        const double twist = load_of(law.twist, b.x, last.b.x);
        const struct vec moment_lower =
            x_to_axis(axis, moment_of(&law, &now, &last, -twist, a, last.a));
        add(loads->force, i, there, force);
        add(loads->own_moment, i, there & is_small, moment_lower);
        if (large) add(loads->moment, i, there & !is_small, turn(&m, moment_lower));
        if (coupling) {
            put(force_upper, i, there, force);
            const struct vec moment = moment_of(&law, &now, &last, twist, b, last.b);
            put(moment_upper, i, there, turn(&m, x_to_axis(axis, moment)));
        } else {
            const struct law other = law_of(&c, &c.upper, span->per_second);
            const struct vec own = force_of(&other, &now, &last);
            const struct vec moment =
                moment_of(&other, &now, &last, load_of(other.twist, b.x, last.b.x), b, last.b);
            put(force_upper, i, there, turn(&m, x_to_axis(axis, own)));
            put(moment_upper, i, there, turn(&m, x_to_axis(axis, moment)));
        }
        overstrained[i - vector] += there & !(fabs(p.x) <= most);
    }
    return sum_of(overstrained);
}

IN_LOOP bool bonds_of_tile(const struct body *body, const struct coupling *coupling, enum axis axis,
                           int64_t base, struct range range, const struct span *span,
                           const struct frames *frames, struct loads *loads)
{
    if (range.first == range.last) return true;
    const struct voxels *v = &body->voxels;
    const struct bonds *b = &body->bonds[axis];
    struct sight sight;
    const double *depth = b->depth + base;
    if (look(v, b, axis, base, range, span->limit, frames, &sight) == 0)
        return pull(v, b, coupling, axis, base, range, span, false, false, frames, &sight, loads) ==
               0;
    if (straighten(depth, range, span->limit, &sight) == 0)
        return pull(v, b, coupling, axis, base, range, span, true, false, frames, &sight, loads) ==
               0;
    if (bend(depth, range, span->limit, &sight)) bend_over(range, &sight);
    return pull(v, b, coupling, axis, base, range, span, true, true, frames, &sight, loads) == 0;
}

/* Set one component of the forces on the voxels of a tile: the forces on them as lower ends of
 * bonds, less the pulls on them as upper ends, which belong to this tile or to earlier ones. */
IN_LOOP void collect(double *restrict total, const double *restrict lower, const double *along_x,
                     const double *along_y, const double *along_z)
{
    NO_LANE_DEPENDS_ON_ANOTHER
    for (int64_t i = 0; i < TILE; i++)
        total[i] = ((lower[i] - along_x[i]) - along_y[i]) - along_z[i];
}

/* Set the forces and torques on the voxels of a tile to those of their bonds. */
IN_LOOP void unload(const struct body *body, int64_t base, struct range range,
                    const struct frames *restrict frames, struct loads *restrict loads)
{
    FOR_LANES(i, range)
    {
        const struct matrix m = frame_at(frames, i);
        const struct vec own =
            turn(&m, (struct vec){loads->own_moment[0][i], loads->own_moment[1][i],
                                  loads->own_moment[2][i]});
        loads->moment[0][i] = -(own.x + loads->moment[0][i]);
        loads->moment[1][i] = -(own.y + loads->moment[1][i]);
        loads->moment[2][i] = -(own.z + loads->moment[2][i]);
    }
    const struct bonds *bonds = body->bonds;
    const struct vecs x = from_slot(bonds[AXIS_X].pull, base - bonds[AXIS_X].step),
                      y = from_slot(bonds[AXIS_Y].pull, base - bonds[AXIS_Y].step),
                      z = from_slot(bonds[AXIS_Z].pull, base - bonds[AXIS_Z].step);
    const struct vecs force = from_slot(body->voxels.force, base);
    collect(force.x, loads->force[0], x.x, y.x, z.x);
    collect(force.y, loads->force[1], x.y, y.y, z.y);
    collect(force.z, loads->force[2], x.z, y.z, z.z);
    const struct vecs a = from_slot(bonds[AXIS_X].wrench, base - bonds[AXIS_X].step),
                      b = from_slot(bonds[AXIS_Y].wrench, base - bonds[AXIS_Y].step),
                      c = from_slot(bonds[AXIS_Z].wrench, base - bonds[AXIS_Z].step);
    const struct vecs torque = from_slot(body->voxels.torque, base);
    collect(torque.x, loads->moment[0], a.x, b.x, c.x);
    collect(torque.y, loads->moment[1], a.y, b.y, c.y);
    collect(torque.z, loads->moment[2], a.z, b.z, c.z);
}

/* Process all axes of a tile while its voxels are in the cache; whether there is one coupling is a
 * constant. */
IN_LOOP bool bonds_of_body(const struct body *body, const struct coupling *coupling,
                           const struct span *span)
{
    struct frames frames;
    struct loads loads;
    bool fine = true;
    for (int64_t base = 0; base < body->n_slots; base += TILE) {
        const struct range x = range_of(body->bonds[AXIS_X].group_depth, base, span->limit),
                           y = range_of(body->bonds[AXIS_Y].group_depth, base, span->limit),
                           z = range_of(body->bonds[AXIS_Z].group_depth, base, span->limit),
                           voxels = range_of(body->group_depth, base, span->limit);
        const struct range all = both(both(x, y), both(z, voxels));
        if (all.first == all.last) continue;
        find_frames(&body->voxels, base, all, &frames);
        memset(&loads, 0, sizeof loads);
        fine &= bonds_of_tile(body, coupling, AXIS_X, base, x, span, &frames, &loads);
        fine &= bonds_of_tile(body, coupling, AXIS_Y, base, y, span, &frames, &loads);
        fine &= bonds_of_tile(body, coupling, AXIS_Z, base, z, span, &frames, &loads);
        unload(body, base, voxels, &frames, &loads);
    }
    return fine;
}

static bool VECTOR(bonds_apply)(struct body *body, double per_second, double limit)
{
    const struct vox_settings *s = &body->model->settings;
    struct span span = {
        .per_second = per_second, .limit = limit, .most = s->largest_strain * s->voxel_size};
    if (!body->coupling) return bonds_of_body(body, NULL, &span);
    span.law = law_of(body->coupling, &body->coupling->lower, per_second);
    return bonds_of_body(body, body->coupling, &span);
}
