/* Reads heights from the file, cuts the road and the pad into them, and builds the terrain mesh from rings. */
#include "ground.h"

#include <stdio.h>
#include <stdlib.h>

#include "png_file.h"

/* Cell size, 3 arc seconds at 36.59 degrees north, and position of the site relative to the middle of the data. */
#define SPACING_EAST_M 74.4
#define SPACING_NORTH_M 92.5
#define SITE_EAST_M 8400.0
#define SITE_NORTH_M 4800.0

#define ROAD_FROM_M (-400.0)
#define ROAD_TO_M 9000.0
#define ROAD_STEP_M 5.0
#define ROAD_POINTS ((int)((ROAD_TO_M - ROAD_FROM_M) / ROAD_STEP_M) + 1)

#define PAD_ALONG_M 42.0
#define PAD_RIGHT_M (-12.0)

#define RINGS 400
#define SECTORS 540
#define FIRST_RING_M 3.0
#define LAST_RING_M 120000.0

/* Mirrors an index back into 0..n-1, so that the terrain repeats mirrored beyond the data. */
static int fold(int i, int n)
{
    int period = 2 * (n - 1);
    i = ((i % period) + period) % period;
    return i < n ? i : period - i;
}

static double sample(const ground *g, int column, int row)
{
    return g->heights[fold(row, g->height) * g->width + fold(column, g->width)];
}

/* Catmull-Rom interpolation of four values. */
static double cubic(const double p[4], double t)
{
    return p[1] + 0.5 * t * (p[2] - p[0] + t * (2 * p[0] - 5 * p[1] + 4 * p[2] - p[3] + t * (3 * (p[1] - p[2]) + p[3] - p[0])));
}

/* Terrain height without road and pad. */
static double natural_height(const ground *g, double x, double y)
{
    double c = (x + SITE_EAST_M) / SPACING_EAST_M + 0.5 * (g->width - 1);
    double r = 0.5 * (g->height - 1) - (y + SITE_NORTH_M) / SPACING_NORTH_M;
    int column = (int)floor(c), row = (int)floor(r);
    double rows[4];
    for (int j = 0; j < 4; j++) {
        double p[4];
        for (int i = 0; i < 4; i++)
            p[i] = sample(g, column - 1 + i, row - 1 + j);
        rows[j] = cubic(p, c - column);
    }
    return cubic(rows, r - row);
}

/* Position in metres along the site's view axis, and to the right of it. */
static void to_site(double x, double y, double *along, double *right)
{
    vec3 d = direction(SITE_VIEW_AZIMUTH_DEG, 0.0);
    *along = x * d.x + y * d.y;
    *right = x * d.y - y * d.x;
}

static void from_site(double along, double right, double *x, double *y)
{
    vec3 d = direction(SITE_VIEW_AZIMUTH_DEG, 0.0);
    *x = along * d.x + right * d.y;
    *y = along * d.y - right * d.x;
}

/* Distance of the road to the right of the site's view axis, m; the road winds around the axis. */
static double road_right(double along)
{
    return 10.0 + 26.0 * sin((along - 30.0) / 150.0) + 60.0 * (1.0 - cos(along / 620.0));
}

static double road_slope(double along)
{
    return 26.0 / 150.0 * cos((along - 30.0) / 150.0) + 60.0 / 620.0 * sin(along / 620.0);
}

void ground_road_point(double along, double right, double *x, double *y)
{
    from_site(along, road_right(along) + right, x, y);
}

double ground_road_offset(double x, double y)
{
    double along, right;
    to_site(x, y, &along, &right);
    if (along < ROAD_FROM_M || along > ROAD_TO_M)
        return 1e4;
    return (right - road_right(along)) / hypot(1.0, road_slope(along));
}

static double road_height(const ground *g, double along)
{
    double i = clamp((along - ROAD_FROM_M) / ROAD_STEP_M, 0.0, ROAD_POINTS - 1.001);
    int k = (int)i;
    return mix(g->road_profile[k], g->road_profile[k + 1], i - k);
}

void ground_pad(double *x, double *y)
{
    from_site(PAD_ALONG_M, PAD_RIGHT_M, x, y);
}

double ground_height(const ground *g, double x, double y)
{
    double h = natural_height(g, x, y), along, right;
    to_site(x, y, &along, &right);
    double road = fabs(ground_road_offset(x, y));
    h = mix(road_height(g, along), h, smoothstep(5.0, 30.0, road));
    double pad = hypot(along - PAD_ALONG_M, right - PAD_RIGHT_M);
    return mix(g->pad_height, h, smoothstep(10.0, 26.0, pad));
}

double ground_z(const ground *g, double x, double y)
{
    return ground_height(g, x, y) - (x * x + y * y) / (2.0 * EARTH_RADIUS_M);
}

bool ground_load(ground *g, const char *png_path)
{
    *g = (ground){0};
    if (!png_read_grey16(png_path, &g->heights, &g->width, &g->height))
        return false;
    g->road_profile = malloc(ROAD_POINTS * sizeof *g->road_profile);
    if (!g->road_profile) {
        ground_free(g);
        return false;
    }
    /* The road is graded: its height is the terrain's, averaged over 120 m. */
    for (int i = 0; i < ROAD_POINTS; i++) {
        double sum = 0.0, x, y;
        for (int k = -12; k <= 12; k++) {
            ground_road_point(ROAD_FROM_M + i * ROAD_STEP_M + 5.0 * k, 0.0, &x, &y);
            sum += natural_height(g, x, y);
        }
        g->road_profile[i] = (float)(sum / 25.0);
    }
    double x, y;
    ground_pad(&x, &y);
    g->pad_height = natural_height(g, x, y);
    return true;
}

void ground_free(ground *g)
{
    free(g->heights);
    free(g->road_profile);
    *g = (ground){0};
}

double ground_sunlit(const ground *g, vec3 from, vec3 sun)
{
    const double disc = 0.0047; /* the sun's angular radius, rad: half the width of the penumbra */
    double flat = hypot(sun.x, sun.y), lit = 1.0;
    if (sun.z <= -disc)
        return 0.0;
    if (flat < 1e-6)
        return 1.0;
    double dx = sun.x / flat, dy = sun.y / flat, rise = sun.z / flat;
    for (double d = 60.0; d < 20000.0 && lit > 0.0; d *= 1.22) {
        double above = from.z + rise * d - ground_z(g, from.x + dx * d, from.y + dy * d);
        lit = fmin(lit, 0.5 + 0.5 * above / (disc * d));
        if (from.z + rise * d > 1100.0) /* above every summit in the data */
            break;
    }
    return clamp(lit, 0.0, 1.0);
}

static vertex ground_vertex(const ground *g, double x, double y, double step)
{
    double z = ground_z(g, x, y);
    double e = ground_z(g, x + step, y) - ground_z(g, x - step, y);
    double n = ground_z(g, x, y + step) - ground_z(g, x, y - step);
    vec3 normal = normalize(vec(-e, -n, 2.0 * step));
    return (vertex){{(float)x, (float)y, (float)z},
                    {(float)normal.x, (float)normal.y, (float)normal.z},
                    {0.1f, 0.1f, 0.1f},
                    (float)ground_road_offset(x, y)};
}

void ground_mesh(const ground *g, mesh *m)
{
    double ratio = pow(LAST_RING_M / FIRST_RING_M, 1.0 / (RINGS - 1));
    uint32_t middle = mesh_vertex(m, ground_vertex(g, 0.0, 0.0, 1.0));
    for (int ring = 0; ring < RINGS; ring++) {
        double radius = FIRST_RING_M * pow(ratio, ring), step = fmax(1.0, 0.5 * radius * (ratio - 1.0));
        for (int s = 0; s < SECTORS; s++) {
            double a = 2.0 * PI * s / SECTORS;
            mesh_vertex(m, ground_vertex(g, radius * sin(a), radius * cos(a), step));
        }
    }
    for (int ring = 0; ring < RINGS; ring++)
        for (int s = 0; s < SECTORS; s++) {
            uint32_t t = (uint32_t)((s + 1) % SECTORS), row = middle + 1 + (uint32_t)(ring * SECTORS);
            uint32_t outer = row + (uint32_t)s, outer_next = row + t;
            if (ring == 0) {
                mesh_triangle(m, middle, outer_next, outer);
                continue;
            }
            uint32_t inner = outer - SECTORS, inner_next = outer_next - SECTORS;
            mesh_triangle(m, inner, outer_next, outer);
            mesh_triangle(m, inner, inner_next, outer_next);
        }
}
