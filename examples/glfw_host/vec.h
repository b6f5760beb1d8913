/* Vectors and 4x4 matrices in double precision: column-major, for column vectors, as in OpenGL and Welkin. */
#ifndef VEC_H
#define VEC_H

#include <math.h>

#define PI 3.14159265358979323846
#define RAD(degrees) ((degrees) * (PI / 180.0))

typedef struct vec3 {
    double x, y, z;
} vec3;

typedef struct mat4 {
    double m[16]; /* m[4 * column + row] */
} mat4;

static inline vec3 vec(double x, double y, double z) { return (vec3){x, y, z}; }
static inline vec3 add(vec3 a, vec3 b) { return vec(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline vec3 sub(vec3 a, vec3 b) { return vec(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline vec3 scale(vec3 a, double s) { return vec(a.x * s, a.y * s, a.z * s); }
static inline double dot(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline vec3 cross(vec3 a, vec3 b)
{
    return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline vec3 normalize(vec3 a) { return scale(a, 1.0 / sqrt(dot(a, a))); }

/* Unit vector (east, north, up) of an azimuth clockwise from north and an elevation, both in degrees. */
static inline vec3 direction(double azimuth_deg, double elevation_deg)
{
    double a = RAD(azimuth_deg), e = RAD(elevation_deg);
    return vec(sin(a) * cos(e), cos(a) * cos(e), sin(e));
}

static inline double mix(double a, double b, double t) { return a + (b - a) * t; }
static inline double clamp(double x, double lo, double hi) { return fmin(fmax(x, lo), hi); }
static inline double smoothstep(double lo, double hi, double x)
{
    double t = clamp((x - lo) / (hi - lo), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

static inline mat4 identity(void) { return (mat4){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}; }

static inline mat4 multiply(mat4 a, mat4 b)
{
    mat4 r;
    for (int c = 0; c < 4; c++)
        for (int i = 0; i < 4; i++) {
            double sum = 0.0;
            for (int k = 0; k < 4; k++)
                sum += a.m[4 * k + i] * b.m[4 * c + k];
            r.m[4 * c + i] = sum;
        }
    return r;
}

static inline mat4 translation(vec3 t)
{
    mat4 r = identity();
    r.m[12] = t.x, r.m[13] = t.y, r.m[14] = t.z;
    return r;
}

/* Right-handed rotation about an axis: 0 = x, 1 = y, 2 = z. */
static inline mat4 rotation(int axis, double angle)
{
    int i = (axis + 1) % 3, j = (axis + 2) % 3;
    mat4 r = identity();
    r.m[4 * i + i] = cos(angle), r.m[4 * j + i] = -sin(angle);
    r.m[4 * i + j] = sin(angle), r.m[4 * j + j] = cos(angle);
    return r;
}

static inline vec3 transform_point(mat4 a, vec3 p)
{
    const double *m = a.m;
    return vec(m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
               m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]);
}

static inline vec3 transform_direction(mat4 a, vec3 d)
{
    const double *m = a.m;
    return vec(m[0] * d.x + m[4] * d.y + m[8] * d.z, m[1] * d.x + m[5] * d.y + m[9] * d.z,
               m[2] * d.x + m[6] * d.y + m[10] * d.z);
}

/* World to eye for a camera at the world's origin: x right, y up, -z forward. */
static inline mat4 look_along(vec3 ahead, vec3 up)
{
    vec3 back = scale(normalize(ahead), -1.0), right = normalize(cross(up, back)), top = cross(back, right);
    return (mat4){{right.x, top.x, back.x, 0, right.y, top.y, back.y, 0, right.z, top.z, back.z, 0, 0, 0, 0, 1}};
}

static inline void to_floats(float out[16], mat4 a)
{
    for (int i = 0; i < 16; i++)
        out[i] = (float)a.m[i];
}

#endif
