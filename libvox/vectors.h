/* Vectors and quaternions. */
#ifndef VOX_VECTORS_H
#define VOX_VECTORS_H

/* Always inlined: for the body of a loop over all bonds or contacts. */
#ifdef __GNUC__
#define IN_LOOP static inline __attribute__((always_inline))
#else
#define IN_LOOP static inline
#endif

struct vec {
    double x, y, z;
};

struct quat {
    double w, x, y, z;
};

static inline struct vec vec_add(struct vec a, struct vec b)
{
    return (struct vec){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec vec_sub(struct vec a, struct vec b)
{
    return (struct vec){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec vec_scale(double k, struct vec a)
{
    return (struct vec){k * a.x, k * a.y, k * a.z};
}

static inline double vec_dot(struct vec a, struct vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec vec_cross(struct vec a, struct vec b)
{
    return (struct vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static inline struct quat quat_conj(struct quat q)
{
    return (struct quat){q.w, -q.x, -q.y, -q.z};
}

static inline struct quat quat_mul(struct quat a, struct quat b)
{
    return (struct quat){
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
    };
}

/* q v q*: rotate, and scale by |q|^2. */
static inline struct vec quat_rotate(struct quat q, struct vec v)
{
    const struct vec axis = {q.x, q.y, q.z};
    const struct vec along = vec_scale(2.0 * vec_dot(axis, v), axis);
    const struct vec across = vec_scale(2.0 * q.w, vec_cross(axis, v));
    return vec_add(vec_scale(q.w * q.w - vec_dot(axis, axis), v), vec_add(along, across));
}

#endif
