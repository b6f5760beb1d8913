/* The excavator's boxes, the posts and the trees. */
#include "objects.h"

static const vec3 YELLOW = {0.60, 0.33, 0.03}, STEEL = {0.06, 0.06, 0.065}, GLASS = {0.03, 0.04, 0.05};
static const vec3 WHITE = {0.75, 0.75, 0.72}, BLACK = {0.025, 0.025, 0.025};

const double POST_DISTANCES_M[POST_COUNT] = {50, 100, 200, 500, 1000, 2000, 5000};

vec3 objects_survey_eye(const ground *g)
{
    return vec(0.0, 0.0, ground_z(g, 0.0, 0.0) + 9.0);
}

/* Adds a box in the frame of `parent`, centred at (x, y, z). */
static void part(mesh *m, mat4 parent, vec3 middle, vec3 size, vec3 albedo)
{
    mesh_box(m, multiply(parent, translation(middle)), size, albedo);
}

/* Adds a beam of `length` along the arm's y axis, starting at a joint; returns the frame at its far end. */
static mat4 beam(mesh *m, mat4 joint, double pitch_deg, double length, double width, double depth)
{
    mat4 turned = multiply(joint, rotation(0, RAD(pitch_deg)));
    part(m, turned, vec(0, 0.5 * length, 0), vec(width, length, depth), YELLOW);
    return multiply(turned, translation(vec(0, length, 0)));
}

static void bucket(mesh *m, mat4 end)
{
    mat4 b = multiply(end, rotation(0, RAD(-70.0)));
    part(m, b, vec(0, 0.55, -0.45), vec(1.25, 1.1, 0.06), STEEL);
    part(m, b, vec(0, 0.05, 0.0), vec(1.25, 0.06, 0.9), STEEL);
    part(m, b, vec(-0.62, 0.5, -0.05), vec(0.05, 1.0, 0.85), STEEL);
    part(m, b, vec(0.62, 0.5, -0.05), vec(0.05, 1.0, 0.85), STEEL);
    for (int tooth = -2; tooth <= 2; tooth++)
        part(m, b, vec(0.27 * tooth, 1.18, -0.45), vec(0.1, 0.24, 0.05), STEEL);
}

static void undercarriage(mesh *m, mat4 base)
{
    for (int side = -1; side <= 1; side += 2) {
        part(m, base, vec(1.2 * side, 0, 0.45), vec(0.6, 4.3, 0.75), STEEL);
        part(m, base, vec(1.2 * side, 0, 0.45), vec(0.6, 4.8, 0.35), STEEL);
        for (int shoe = -10; shoe <= 10; shoe++)
            part(m, base, vec(1.2 * side, 0.2 * shoe, 0.85), vec(0.62, 0.12, 0.06), scale(STEEL, 1.6));
    }
    part(m, base, vec(0, 0, 0.75), vec(2.0, 1.8, 0.5), STEEL);
}

static void excavator(const ground *g, mesh *m)
{
    double x, y;
    ground_pad(&x, &y);
    /* The excavator faces to the right of the view axis, so that both boom and cab are visible from the hillside. */
    mat4 base = multiply(translation(vec(x, y, ground_z(g, x, y))), rotation(2, RAD(-SITE_VIEW_AZIMUTH_DEG - 70.0)));
    undercarriage(m, base);
    mat4 house = multiply(base, multiply(translation(vec(0, 0, 1.1)), rotation(2, RAD(12.0))));
    part(m, house, vec(0, -0.6, 0.6), vec(2.7, 3.6, 1.0), YELLOW);
    part(m, house, vec(0, -2.2, 0.65), vec(2.74, 0.7, 1.1), STEEL);
    part(m, house, vec(0.5, -1.3, 1.2), vec(1.5, 1.5, 0.3), YELLOW);
    part(m, house, vec(-0.85, 0.7, 1.35), vec(0.95, 1.7, 1.6), GLASS);
    part(m, house, vec(-0.85, 0.7, 2.2), vec(1.05, 1.8, 0.12), YELLOW);
    for (int post = 0; post < 4; post++)
        part(m, house, vec(post % 2 ? -0.36 : -1.34, post / 2 ? 1.55 : -0.15, 1.35), vec(0.09, 0.09, 1.7), YELLOW);
    mat4 joint = multiply(house, translation(vec(0.35, 1.0, 0.7)));
    mat4 elbow = beam(m, joint, 52.0, 2.9, 0.5, 0.6);
    mat4 knee = beam(m, elbow, -45.0, 2.6, 0.45, 0.5);
    mat4 end = beam(m, knee, -80.0, 2.7, 0.35, 0.42);
    part(m, elbow, vec(0, -1.2, 0.5), vec(0.14, 2.4, 0.14), scale(STEEL, 3.0));
    bucket(m, end);
}

/* All posts look equally tall from the eye: they differ only in the air in front of them. */
static void posts(const ground *g, mesh *m)
{
    vec3 eye = objects_survey_eye(g);
    for (int i = 0; i < POST_COUNT; i++) {
        double d = POST_DISTANCES_M[i], azimuth = SITE_VIEW_AZIMUTH_DEG - 3.0 + 3.1 * i;
        vec3 ahead = direction(azimuth, 0.0);
        double x = eye.x + ahead.x * d, y = eye.y + ahead.y * d, z = ground_z(g, x, y);
        double tall = d * 0.045, wide = d * 0.006, band = tall / 6.0;
        mat4 foot = multiply(translation(vec(x, y, z)), rotation(2, RAD(-azimuth)));
        for (int k = 0; k < 6; k++)
            part(m, foot, vec(0, 0, band * (k + 0.5)), vec(wide, wide, band), k % 2 ? WHITE : BLACK);
        part(m, foot, vec(0, 0, tall + band), vec(wide * 3.5, wide, band * 2.0), BLACK);
        part(m, foot, vec(0, 0, -tall * 0.3), vec(wide, wide, tall * 0.6), BLACK);
    }
}

/* Pseudo-random numbers in [0, 1), the same in every run. */
static double chance(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u; /* Numerical Recipes' generator: good enough for trees */
    return (double)(*state >> 8) / 16777216.0;
}

static void wood(const ground *g, mesh *m)
{
    uint32_t state = 7;
    for (int i = 0; i < 2600; i++) {
        double away = 30.0 + 870.0 * sqrt(chance(&state)), azimuth = 360.0 * chance(&state);
        vec3 at = scale(direction(azimuth, 0.0), away);
        double tall = 7.0 + 9.0 * chance(&state), green = 0.75 + 0.5 * chance(&state);
        double patch = sin(at.x / 90.0 + 1.3) + sin(at.y / 70.0) + sin((at.x + at.y) / 130.0);
        /* Trees stand in groves. None stand on the road, on the pad, or in front of the posts. */
        double side = remainder(azimuth - SITE_VIEW_AZIMUTH_DEG, 360.0);
        double pad_x, pad_y;
        ground_pad(&pad_x, &pad_y);
        if (patch < 0.3 || fabs(ground_road_offset(at.x, at.y)) < 14.0 || hypot(at.x - pad_x, at.y - pad_y) < 30.0 ||
            (side > -8.0 && side < 20.0))
            continue;
        vec3 foot = vec(at.x, at.y, ground_z(g, at.x, at.y)), albedo = scale(vec(0.030, 0.055, 0.022), green);
        mat4 trunk = translation(add(foot, vec(0, 0, 0.08 * tall)));
        mesh_box(m, trunk, vec(0.03 * tall, 0.03 * tall, 0.2 * tall), vec(0.05, 0.035, 0.02));
        mesh_cone(m, add(foot, vec(0, 0, 0.12 * tall)), 0.2 * tall, 0.5 * tall, 9, albedo);
        mesh_cone(m, add(foot, vec(0, 0, 0.38 * tall)), 0.15 * tall, 0.62 * tall, 9, scale(albedo, 1.1));
    }
}

#define BRIDGE_ALONG_M 82.0
#define BRIDGE_CLEARANCE_M 5.2

void objects_bridge(const ground *g, solid boxes[BRIDGE_BOXES])
{
    double x, y, ahead_x, ahead_y;
    ground_road_point(BRIDGE_ALONG_M, 0.0, &x, &y);
    ground_road_point(BRIDGE_ALONG_M + 1.0, 0.0, &ahead_x, &ahead_y);
    mat4 foot = multiply(translation(vec(x, y, ground_z(g, x, y))), rotation(2, -atan2(ahead_x - x, ahead_y - y)));
    const double clear = BRIDGE_CLEARANCE_M;
    int n = 0;
    /* x runs across the road, y along it. */
    boxes[n++] = (solid){multiply(foot, translation(vec(0, 0, clear + 0.5))), vec(70, 13, 1.0)};
    for (int side = -1; side <= 1; side += 2) {
        boxes[n++] = (solid){multiply(foot, translation(vec(0, 6.375 * side, clear + 1.5))), vec(70, 0.25, 1.0)};
        for (int pier = -1; pier <= 1; pier++)
            boxes[n++] = (solid){multiply(foot, translation(vec(8.5 * side, 4.5 * pier, 0.5 * clear - 1.5))), vec(1.1, 1.1, clear + 3.0)};
    }
}

void objects_bridge_mesh(const ground *g, mesh *m)
{
    solid boxes[BRIDGE_BOXES];
    objects_bridge(g, boxes);
    for (int i = 0; i < BRIDGE_BOXES; i++)
        mesh_box(m, boxes[i].place, boxes[i].size, vec(0.30, 0.29, 0.27));
}

#define BARN_AWAY_M 19.0

void objects_barn(const ground *g, solid boxes[BARN_BOXES])
{
    double pad_x, pad_y;
    ground_pad(&pad_x, &pad_y);
    vec3 away = scale(direction(BARN_AZIMUTH_DEG, 0.0), BARN_AWAY_M);
    double x = pad_x + away.x, y = pad_y + away.y;
    mat4 foot = multiply(translation(vec(x, y, ground_z(g, x, y))), rotation(2, RAD(-BARN_AZIMUTH_DEG)));
    /* x runs along the ridge, y to windward; the walls extend below the ground, which is not level. */
    boxes[0] = (solid){multiply(foot, translation(vec(0, 0, 1.5))), vec(16, 9, 6)};
    boxes[1] = (solid){multiply(foot, translation(vec(0, 0, 4.65))), vec(17, 10, 0.3)};
    boxes[2] = (solid){multiply(foot, translation(vec(0, -6.0, 2.9))), vec(9, 3.2, 0.15)};
    for (int side = 0; side < 2; side++)
        boxes[3 + side] = (solid){multiply(foot, translation(vec(side ? 4.2 : -4.2, -7.4, 0.9))), vec(0.18, 0.18, 4)};
}

void objects_barn_mesh(const ground *g, mesh *m)
{
    const vec3 boards = vec(0.16, 0.045, 0.035), slates = vec(0.07, 0.075, 0.08), beams = vec(0.12, 0.08, 0.05);
    solid boxes[BARN_BOXES];
    objects_barn(g, boxes);
    for (int i = 0; i < BARN_BOXES; i++)
        mesh_box(m, boxes[i].place, boxes[i].size, i == 0 ? boards : i < 3 ? slates : beams);
    /* A door under the porch, with windows beside it. */
    part(m, boxes[0].place, vec(0, -4.52, -0.1), vec(2.6, 0.06, 2.8), beams);
    for (int side = -1; side <= 1; side += 2)
        part(m, boxes[0].place, vec(5.9 * side, -4.52, 0.4), vec(1.3, 0.06, 1.1), GLASS);
}

void objects_mesh(const ground *g, mesh *m)
{
    excavator(g, m);
    posts(g, m);
    wood(g, m);
}
