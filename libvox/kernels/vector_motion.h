/* Motion of voxels and actuation of their sizes (sections 4, 7 and 8) in the fast kernel; included
 * by vector_kernel.h. */

/* Squares of the largest speed and distance from the start in each lane. */
struct extremes {
    lanes speed2, way2;
} IN_LINES;

/* Move the free voxels of a tile up to a depth; return the number of diverged ones. The constant
 * `complete` means that the forces include slow damping and weight. */
IN_LOOP int64_t move_tile(const struct voxels *v, int64_t base, struct range range, double dt,
                          double too_far, double limit, bool complete,
                          struct extremes *restrict extremes)
{
    double *restrict px = v->position.x + base, *restrict py = v->position.y + base,
                     *restrict pz = v->position.z + base;
    double *restrict mx = v->momentum.x + base, *restrict my = v->momentum.y + base,
                     *restrict mz = v->momentum.z + base;
    const double *restrict fx = v->force.x + base, *restrict fy = v->force.y + base,
                           *restrict fz = v->force.z + base;
    const double *restrict sx = v->start.x + base, *restrict sy = v->start.y + base,
                           *restrict sz = v->start.z + base;
    const double *restrict mobility = v->mobility + base, *restrict depth = v->depth + base;
    const double *restrict drag_rate = v->drag_rate + base, *restrict weight = v->weight + base;
    counts lost = {0};
    FOR_LANES(i, range)
    {
        const bool moves = depth[i] <= limit;
        const struct vec last = {mx[i], my[i], mz[i]}, bare = {fx[i], fy[i], fz[i]};
        const struct vec force = complete ? bare : loaded(bare, drag_rate[i], last, weight[i]);
        const struct vec momentum = {last.x + dt * force.x, last.y + dt * force.y,
                                     last.z + dt * force.z};
        const struct vec velocity = vec_scale(mobility[i], momentum);
        const struct vec position = {px[i] + dt * velocity.x, py[i] + dt * velocity.y,
                                     pz[i] + dt * velocity.z};
        const struct vec way = {position.x - sx[i], position.y - sy[i], position.z - sz[i]};
        const double speed2 = choose(moves, vec_dot(velocity, velocity), 0.0);
        const double way2 = choose(moves, vec_dot(way, way), 0.0);
        lost[i - vector] += moves & !(way2 <= too_far * too_far);
        extremes->speed2[i] = choose(speed2 > extremes->speed2[i], speed2, extremes->speed2[i]);
        extremes->way2[i] = choose(way2 > extremes->way2[i], way2, extremes->way2[i]);
        mx[i] = choose(moves, momentum.x, mx[i]);
        my[i] = choose(moves, momentum.y, my[i]);
        mz[i] = choose(moves, momentum.z, mz[i]);
        px[i] = choose(moves, position.x, px[i]);
        py[i] = choose(moves, position.y, py[i]);
        pz[i] = choose(moves, position.z, pz[i]);
    }
    return sum_of(lost);
}

/* Add slow damping, weight and the floor to the forces on the free voxels of a tile. */
static void stand_tile(struct body *body, int64_t base, struct range range, double limit)
{
    const struct voxels *v = &body->voxels;
    const double rise = body->model->floor_rise;
    const double *restrict px = v->position.x + base, *restrict pz = v->position.z + base;
    const double *restrict mx = v->momentum.x + base, *restrict my = v->momentum.y + base,
                           *restrict mz = v->momentum.z + base;
    double *restrict fx = v->force.x + base, *restrict fy = v->force.y + base,
                     *restrict fz = v->force.z + base;
    const double *restrict size = v->size + base, *restrict depth = v->depth + base;
    const double *restrict drag_rate = v->drag_rate + base, *restrict weight = v->weight + base;
    lanes below = {0.0};
    FOR_LANES(i, range)
    {
        const struct vec bare = {fx[i], fy[i], fz[i]}, momentum = {mx[i], my[i], mz[i]};
        const struct vec force = loaded(bare, drag_rate[i], momentum, weight[i]);
        fx[i] = force.x;
        fy[i] = force.y;
        fz[i] = force.z;
        below[i] = choose(depth[i] <= limit, depth_in_floor(size[i], px[i], pz[i], rise), 0.0);
    }
    for (int64_t i = range.first; i < range.last; i++)
        if (below[i] > 0.0) vox_floor_apply(body, base + i);
}

/* Turn the free voxels of a tile up to a depth; return the number of diverged ones. */
static int64_t turn_tile(const struct voxels *v, int64_t base, struct range range, double dt,
                         double limit)
{
    double *restrict qw = v->orientation.w + base, *restrict qx = v->orientation.x + base;
    double *restrict qy = v->orientation.y + base, *restrict qz = v->orientation.z + base;
    double *restrict sx = v->spin.x + base, *restrict sy = v->spin.y + base,
                     *restrict sz = v->spin.z + base;
    const double *restrict tx = v->torque.x + base, *restrict ty = v->torque.y + base,
                           *restrict tz = v->torque.z + base;
    const double *restrict kept = v->spin_kept + base;
    const double *restrict turnability = v->turnability + base;
    const double *restrict depth = v->depth + base;
    counts lost = {0};
    FOR_LANES(i, range)
    {
        const bool moves = depth[i] <= limit;
        const struct vec spin = {kept[i] * (sx[i] + dt * tx[i]), kept[i] * (sy[i] + dt * ty[i]),
                                 kept[i] * (sz[i] + dt * tz[i])};
        const struct vec rate = vec_scale(turnability[i], spin);
        const struct quat q = {qw[i], qx[i], qy[i], qz[i]};
        const struct quat dq = quat_mul((struct quat){0.0, rate.x, rate.y, rate.z}, q);
        const double half = 0.5 * dt;
        const struct quat r = {q.w + half * dq.w, q.x + half * dq.x, q.y + half * dq.y,
                               q.z + half * dq.z};
        const double norm = 1.0 / sqrt(r.x * r.x + r.y * r.y + r.z * r.z + r.w * r.w);
        const bool straight = r.w * norm >= 1.0;
        lost[i - vector] += moves & !(vec_dot(spin, spin) * turnability[i] <= DBL_MAX);
        sx[i] = choose(moves, spin.x, sx[i]);
        sy[i] = choose(moves, spin.y, sy[i]);
        sz[i] = choose(moves, spin.z, sz[i]);
        qw[i] = choose(moves, choose(straight, 1.0, r.w * norm), q.w);
        qx[i] = choose(moves, choose(straight, 0.0, r.x * norm), q.x);
        qy[i] = choose(moves, choose(straight, 0.0, r.y * norm), q.y);
        qz[i] = choose(moves, choose(straight, 0.0, r.z * norm), q.z);
    }
    return sum_of(lost);
}

/* Update the sizes of a tile's voxels as in motion.c; `swing` and `sway` are the sine and cosine of
 * the actuation. */
static void size_tile(const struct voxels *v, int64_t base, const struct actuation *actuation,
                      double swing, double sway)
{
    const double edge = actuation->edge, rest = actuation->rest, gain = actuation->gain;
    const double smallest = actuation->smallest, largest = actuation->largest;
    const bool clamp = actuation->clamp;
    const double *restrict amplitude = v->amplitude + base;
    const double *restrict phase_sine = v->phase_sine + base;
    const double *restrict phase_cosine = v->phase_cosine + base;
    double *restrict size = v->size + base;
    if (gain == 0.0) {
        for (int64_t i = 0; i < TILE; i++)
            size[i] = limited(edge * rest, size[i], smallest, largest, clamp);
        return;
    }
    for (int64_t i = 0; i < TILE; i++) {
        const double next =
            edge * (rest + gain * amplitude[i] * (swing * phase_cosine[i] + sway * phase_sine[i]));
        size[i] = limited(next, size[i], smallest, largest, clamp);
    }
}

/* Advance partly clamped voxels one by one. */
static bool advance_partly_held(struct body *body, double limit)
{
    bool fine = true;
    for (int64_t i = 0; i < body->n_partly; i++)
        if (body->depth[body->partly[i]] <= limit) fine &= vox_voxel_advance(body, body->partly[i]);
    return fine;
}

IN_LOOP int64_t advance_tile(struct body *body, int64_t base, struct range range, double limit,
                             struct extremes *extremes)
{
    const struct voxels *v = &body->voxels;
    const double dt = body->census.dt, too_far = body->model->too_far;
    const bool stands = body->model->settings.floor;
    if (stands) stand_tile(body, base, range, limit);
    return (stands ? move_tile(v, base, range, dt, too_far, limit, true, extremes)
                   : move_tile(v, base, range, dt, too_far, limit, false, extremes)) +
           turn_tile(v, base, range, dt, limit);
}

/* Return the larger of a number and the roots of some squares. */
static double raised(double number, const double *squares)
{
    double largest = 0.0;
    for (int64_t i = 0; i < TILE; i++) largest = choose(squares[i] > largest, squares[i], largest);
    return sqrt(largest) > number ? sqrt(largest) : number;
}

static bool VECTOR(voxels_advance)(struct body *body, double limit)
{
    struct extremes extremes = {{0.0}, {0.0}};
    int64_t lost = 0;
    body->top_speed = 0.0;
    const bool fine = advance_partly_held(body, limit);
    for (int64_t tile = 0; tile < body->n_tiles; tile++) {
        const struct range range = range_of(body->group_depth, tile * TILE, limit);
        if (range.first == range.last) continue;
        lost += advance_tile(body, tile * TILE, range, limit, &extremes);
    }
    body->top_speed = raised(body->top_speed, extremes.speed2);
    body->farthest = raised(body->farthest, extremes.way2);
    return fine && lost == 0;
}

/* The sine of a sum of time and phase follows from the sines and cosines of both. */
static void VECTOR(phases_set)(struct body *body)
{
    const double *restrict phase = body->voxels.phase;
    double *restrict phase_sine = body->voxels.phase_sine;
    double *restrict phase_cosine = body->voxels.phase_cosine;
    for (int64_t i = 0; i < body->n_tiles * TILE; i++) {
        phase_sine[i] = sine(TWO_PI * phase[i]);
        phase_cosine[i] = cosine(TWO_PI * phase[i]);
    }
}

static void VECTOR(sizes_advance)(struct body *body, double limit)
{
    const struct actuation actuation = vox_actuation_at(body->model, body->time);
    const double swing = sine(TWO_PI * actuation.cycles), sway = cosine(TWO_PI * actuation.cycles);
    for (int64_t tile = 0; tile < body->n_tiles; tile++) {
        const struct range range = range_of(body->group_depth, tile * TILE, limit);
        if (range.first == range.last) continue;
        size_tile(&body->voxels, tile * TILE, &actuation, swing, sway);
    }
}
