/* The vessel's hull is a prism, so that the dry region of the sea can have its outline. The rest consists of boxes. */
#include "vessel.h"

#define DRAUGHT_M 2.4
#define FREEBOARD_M 1.7
#define CORNERS 11
/* Waves shorter than this pass under the hull without lifting it, m. */
#define FELT_M 12.0

const vec3 VESSEL_HELM = {0.0, 7.9, FREEBOARD_M + 4.0};

static const vec3 RED = {0.22, 0.03, 0.02}, BLUE = {0.02, 0.05, 0.12}, DECK = {0.14, 0.17, 0.13};
static const vec3 WHITE = {0.72, 0.73, 0.70}, GLASS = {0.03, 0.04, 0.05}, ORANGE = {0.62, 0.16, 0.02};
static const vec3 STEEL = {0.10, 0.10, 0.11};

/* Corners of the hull, m to starboard and ahead, counterclockwise. */
static const double OUTLINE[CORNERS][2] = {
    {-3.6, -15.0}, {3.6, -15.0}, {4.2, -10.0}, {4.2, 4.0}, {3.7, 8.5}, {2.5, 12.8}, {0.0, 17.0},
    {-2.5, 12.8}, {-3.7, 8.5}, {-4.2, 4.0}, {-4.2, -10.0},
};

static void box(mesh *m, vec3 middle, vec3 size, vec3 albedo) { mesh_box(m, translation(middle), size, albedo); }

/* A crane's boom, lifted over the deck astern. */
static void crane(mesh *m)
{
    mat4 foot = translation(vec(-2.6, 1.0, FREEBOARD_M));
    mat4 boom = multiply(multiply(foot, translation(vec(0, 0, 3.6))), multiply(rotation(2, RAD(172.0)), rotation(0, RAD(38.0))));
    mesh_box(m, multiply(foot, translation(vec(0, 0, 1.8))), vec(0.9, 0.9, 3.6), ORANGE);
    mesh_box(m, multiply(boom, translation(vec(0, 4.5, 0))), vec(0.45, 9.0, 0.5), ORANGE);
    mesh_box(m, multiply(boom, translation(vec(0, -0.7, 0))), vec(0.9, 1.2, 0.9), STEEL);
}

void vessel_mesh(mesh *m)
{
    mesh_prism(m, OUTLINE, CORNERS, -DRAUGHT_M, 0.25, RED, RED);
    mesh_prism(m, OUTLINE, CORNERS, 0.25, FREEBOARD_M, BLUE, DECK);
    /* Bulwarks of the forecastle, house, bridge and mast. */
    for (int side = -1; side <= 1; side += 2) {
        box(m, vec(4.1 * side, -3.0, FREEBOARD_M + 0.45), vec(0.12, 14.0, 0.9), BLUE);
        mat4 flare = multiply(translation(vec(3.05 * side, 10.7, FREEBOARD_M + 0.55)), rotation(2, RAD(15.6 * side)));
        mesh_box(m, flare, vec(0.12, 4.8, 1.1), BLUE);
        mat4 bow = multiply(translation(vec(1.22 * side, 14.85, FREEBOARD_M + 0.6)), rotation(2, RAD(30.8 * side)));
        mesh_box(m, bow, vec(0.12, 4.9, 1.2), BLUE);
    }
    box(m, vec(0, 6.0, FREEBOARD_M + 1.3), vec(6.4, 6.0, 2.6), WHITE);
    box(m, vec(0, 5.6, FREEBOARD_M + 3.7), vec(5.4, 4.2, 2.2), WHITE);
    box(m, vec(0, 5.6, FREEBOARD_M + 3.9), vec(5.46, 4.26, 0.9), GLASS);
    box(m, vec(0, 5.4, FREEBOARD_M + 4.9), vec(6.0, 4.8, 0.2), ORANGE);
    box(m, vec(0, 4.4, FREEBOARD_M + 7.2), vec(0.25, 0.25, 4.6), WHITE);
    box(m, vec(0, 4.4, FREEBOARD_M + 7.6), vec(2.2, 0.18, 0.18), WHITE);
    box(m, vec(1.6, 1.9, FREEBOARD_M + 2.6), vec(1.0, 1.2, 3.2), ORANGE);
    /* Cargo. */
    box(m, vec(1.2, -6.0, FREEBOARD_M + 1.3), vec(2.44, 6.06, 2.6), vec(0.05, 0.16, 0.10));
    box(m, vec(-1.6, -10.6, FREEBOARD_M + 0.6), vec(2.2, 2.2, 1.2), STEEL);
    crane(m);
}

vessel vessel_at(const vessel *v, double time_s)
{
    double past_s = time_s - v->at_s, half_turn = 0.5 * RAD(v->turn_deg_s) * past_s;
    /* The way along an arc: its chord, in the direction of the middle of the turn. */
    double chord = v->speed_m_s * past_s * (fabs(half_turn) > 1e-6 ? sin(half_turn) / half_turn : 1.0);
    vec3 way = scale(direction(v->heading_deg + 0.5 * v->turn_deg_s * past_s, 0.0), chord);
    vessel later = *v;
    later.x += way.x, later.y += way.y, later.at_s = time_s;
    later.heading_deg = fmod(v->heading_deg + v->turn_deg_s * past_s, 360.0);
    return later;
}

wk_status vessel_raise_wake(const vessel *v, wk_context *context)
{
    wk_sea_hull hull = WK_SEA_HULL_INIT;
    hull.length_m = 31.0, hull.beam_m = 8.4, hull.draught_m = DRAUGHT_M;
    hull.position_m[0] = v->x, hull.position_m[1] = v->y;
    hull.heading_deg = v->heading_deg;
    hull.speed_m_s = v->speed_m_s;
    hull.turn_deg_s = v->turn_deg_s;
    hull.at_s = v->at_s;
    return wk_context_set_sea_hulls(context, &hull, 1, sizeof hull);
}

wk_status vessel_keep_dry(const vessel *v, wk_context *context)
{
    wk_sea_region hull = WK_SEA_REGION_INIT;
    hull.corners_m = OUTLINE;
    hull.corner_count = CORNERS;
    hull.center_m[0] = v->x, hull.center_m[1] = v->y;
    hull.heading_deg = v->heading_deg;
    hull.turn_deg_s = v->turn_deg_s;
    hull.at_s = v->at_s;
    vec3 way = scale(direction(v->heading_deg, 0.0), v->speed_m_s);
    hull.velocity_m_s[0] = way.x, hull.velocity_m_s[1] = way.y;
    return wk_context_set_sea_regions(context, &hull, 1, sizeof hull);
}

mat4 vessel_level(const vessel *v, double time_s)
{
    vessel now = vessel_at(v, time_s);
    return multiply(translation(vec(now.x, now.y, 0)), rotation(2, RAD(-now.heading_deg)));
}

wk_status vessel_float(const vessel *v, const wk_context *context, double time_s, mat4 *pose)
{
    /* The heights of the sea at stern, bow, port and starboard give the hull's heave, pitch and roll. */
    enum { STERN, BOW, PORT, STARBOARD, PLACES };
    const double places[PLACES][2] = {{0, -12}, {0, 12}, {-4, 0}, {4, 0}};
    double positions[PLACES][3];
    wk_sea_point points[PLACES];
    mat4 level = vessel_level(v, time_s);
    for (int i = 0; i < PLACES; i++) {
        vec3 p = transform_point(level, vec(places[i][0], places[i][1], 0));
        positions[i][0] = p.x, positions[i][1] = p.y, positions[i][2] = p.z;
    }
    wk_status status = wk_context_get_sea_at(context, (const double (*)[3])positions, PLACES, sizeof positions[0], time_s,
                                             FELT_M, points, sizeof points[0]);
    if (status != WK_OK)
        return status;
    double z[PLACES], heave = 0.0;
    for (int i = 0; i < PLACES; i++) {
        z[i] = points[i].height_m;
        heave += z[i] / PLACES;
    }
    mat4 pitched = rotation(0, atan2(z[BOW] - z[STERN], 24.0)), rolled = rotation(1, -atan2(z[STARBOARD] - z[PORT], 8.0));
    *pose = multiply(multiply(translation(vec(0, 0, heave)), level), multiply(pitched, rolled));
    return WK_OK;
}
