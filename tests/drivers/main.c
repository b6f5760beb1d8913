/*
 * Draws the scenes of scenes.c with one driver, and compares two folders of them.
 *
 *   drivers draw WAY DIR [SCENE..]   writes DIR/SCENE.ppm; prints a line for each scene: its name and the number of
 *                                    values that are not numbers
 *   drivers compare DIR DIR          prints a line for each scene: its name, and the 95th percentile and the greatest
 *                                    difference, of 255
 *   drivers list                     the scenes' names
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scenes.h"
#include "target.h"

static const double PI = 3.14159265358979323846;

/* The host's picture: a road on level ground to the north, checkered land and a wall on its left. */
static float world_color[PIXELS][4], world_depth[PIXELS];
static unsigned char world_classes[PIXELS];

/* Reversed infinite depth; this plane has the depth 1. */
#define NEAR_M 0.1

static void paint(const scene *s, double luminance, bool upside_down)
{
    const double tilt = s->elevation_deg * PI / 180.0, half = tan(0.5 * s->fov_y_deg * PI / 180.0);
    int row, column;
    for (row = 0; row < HEIGHT; row++)
        for (column = 0; column < WIDTH; column++) {
            const int pixel = (upside_down ? HEIGHT - 1 - row : row) * WIDTH + column;
            const double up = half * (1.0 - 2.0 * (row + 0.5) / HEIGHT);
            const double right = half * WIDTH / HEIGHT * (2.0 * (column + 0.5) / WIDTH - 1.0);
            /* The ray's north and up for each metre along the axis. */
            const double north = cos(tilt) - up * sin(tilt), rise = sin(tilt) + up * cos(tilt);
            double along = rise < 0.0 ? s->eye_m / -rise : INFINITY, albedo = 0.12;
            unsigned char class_here = s->class_of_land;
            const double wall = 15.0 / north, wall_x = wall * right, wall_z = s->eye_m + wall * rise;
            if (north > 0.0 && wall < along && wall_x > -9.0 && wall_x < -1.5 && wall_z >= 0.0 && wall_z < 4.0) {
                along = wall, albedo = 0.06, class_here = WK_SURFACE_CLASS_BUILDING;
            } else if (fabs(along * right) < 3.0) {
                albedo = 0.09, class_here = WK_SURFACE_CLASS_PAVED;
            } else if (isfinite(along)) {
                const int square = (int)floor(along * right / 4.0) + (int)floor(along * north / 4.0);
                albedo = square & 1 ? 0.2 : 0.12;
            }
            const float value = isfinite(along) ? (float)(albedo * luminance) : 0.0f;
            world_color[pixel][0] = world_color[pixel][1] = world_color[pixel][2] = value;
            world_color[pixel][3] = 1.0f;
            world_depth[pixel] = isfinite(along) ? (float)fmin(NEAR_M / along, 1.0) : 0.0f;
            world_classes[pixel] = class_here;
        }
}

/* Illuminance of level ground, lux, by sun, moon, sky and a flash of lightning. */
static bool arriving(wk_context *context, const scene *s, double *lux)
{
    const double at[3] = {0.0, 0.0, 0.0};
    wk_ground_light light;
    wk_flash_light flash = WK_FLASH_LIGHT_INIT;
    if (!passed(wk_context_get_light(context, &at, 1, sizeof at, &light, sizeof light)) ||
        !passed(wk_context_get_flash_light(context, &at, s->time_s, 1.0 / 60.0, &flash)))
        return false;
    *lux = fmax(fmax(light.total_lux, flash.level_lux), 1e-4);
    return true;
}

static void camera(wk_frame *f, const scene *s)
{
    const double tilt = s->elevation_deg * PI / 180.0, focal = 1.0 / tan(0.5 * s->fov_y_deg * PI / 180.0);
    /* Columns: east, north and up as the eye sees them (right, up, towards the viewer). */
    const double view[16] = {1, 0, 0, 0, 0, -sin(tilt), -cos(tilt), 0, 0, cos(tilt), -sin(tilt), 0, 0, 0, 0, 1};
    memcpy(f->view, view, sizeof view);
    memset(f->projection, 0, sizeof f->projection);
    f->projection[0] = focal * HEIGHT / WIDTH;
    f->projection[5] = focal;
    f->projection[11] = -1.0;
    f->projection[14] = NEAR_M;
    f->position_m[2] = s->eye_m;
}

static bool write_picture(const char *folder, const char *name, const float (*color)[4], bool upside_down)
{
    char path[1024];
    static unsigned char bytes[PIXELS][3];
    FILE *file;
    bool ok;
    int i, k;
    for (i = 0; i < PIXELS; i++) {
        const int from = upside_down ? (HEIGHT - 1 - i / WIDTH) * WIDTH + i % WIDTH : i;
        for (k = 0; k < 3; k++) {
            const double x = fmin(fmax(color[from][k], 0.0), 1.0); /* a NaN becomes 0 */
            bytes[i][k] = (unsigned char)(255.0 * (x < 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055) + 0.5);
        }
    }
    snprintf(path, sizeof path, "%s/%s.ppm", folder, name);
    file = fopen(path, "wb");
    ok = file && fprintf(file, "P6\n%d %d\n255\n", WIDTH, HEIGHT) > 0 && fwrite(bytes, sizeof bytes, 1, file) == 1;
    if (file && fclose(file) != 0)
        ok = false;
    if (!ok)
        fprintf(stderr, "%s: cannot be written\n", path);
    return ok;
}

static int not_numbers(const float (*color)[4])
{
    int count = 0, i, k;
    for (i = 0; i < PIXELS; i++)
        for (k = 0; k < 3; k++)
            count += !isfinite(color[i][k]);
    return count;
}

/* Draws one picture: checks its values before the tone curve, and writes those after it. */
static bool draw(target *t, wk_context *context, wk_view *view, const scene *s, const char *folder)
{
    static float linear[PIXELS][4], shown[PIXELS][4];
    wk_frame frame = WK_FRAME_INIT;
    double lux;
    int bad;
    if (!s->prepare(context, view) || !passed(wk_context_update(context, s->time_s)) || !arriving(context, s, &lux))
        return false;
    frame.frame_id = 1;
    frame.flags = WK_FRAME_DEPTH_REVERSED | WK_FRAME_CUT | WK_FRAME_NO_HISTORY;
    /* A white card has the value 1 by day and by night, so that values stay in the range of half floats. */
    frame.cd_m2_per_unit = lux / PI;
    camera(&frame, s);
    paint(s, 1.0, target_upside_down(t));
    if (!target_write(t, world_color[0], world_depth, world_classes))
        return false;
    frame.target = target_images(t);
    if (!passed(wk_view_record(view, &frame, WK_STAGE_ALL & ~WK_STAGE_TONE)) || !target_read(t, linear[0]))
        return false;
    bad = not_numbers((const float(*)[4])linear);
    if (!passed(wk_view_record(view, &frame, WK_STAGE_TONE)) || !target_read(t, shown[0]) ||
        !write_picture(folder, s->name, (const float(*)[4])shown, target_upside_down(t)))
        return false;
    printf("%s\t%d\n", s->name, bad);
    fflush(stdout);
    return true;
}

static bool draw_in_own_context(target *t, const scene *s, const char *folder)
{
    wk_context_desc place = WK_CONTEXT_DESC_INIT;
    wk_context *context = NULL;
    wk_view *view = NULL;
    bool ok;
    place.world_kind = WK_WORLD_TANGENT;
    place.latitude_deg = 47.0;
    place.longitude_deg = 8.0;
    ok = passed(wk_context_create(target_device(t), &place, &context)) && passed(wk_view_create(context, NULL, &view)) &&
         draw(t, context, view, s, folder);
    if (view)
        passed(wk_view_destroy(view));
    if (context)
        passed(wk_context_destroy(context));
    return ok;
}

static int draw_all(const char *way, const char *folder, char **names, int name_count)
{
    target *t = target_open(way);
    wk_caps caps = WK_CAPS_INIT;
    int failed = 0, i, k;
    if (!t)
        return 3; /* no such driver here */
    if (passed(wk_device_get_caps(target_device(t), &caps)))
        printf("driver\t%s, %s, tier %u\n", caps.adapter_name, caps.driver, (unsigned)caps.tier);
    fflush(stdout);
    for (i = 0; i < SCENE_COUNT; i++) {
        bool wanted = name_count == 0;
        for (k = 0; k < name_count; k++)
            wanted = wanted || strcmp(names[k], SCENES[i].name) == 0;
        if (wanted && !draw_in_own_context(t, &SCENES[i], folder)) {
            fprintf(stderr, "%s: not drawn\n", SCENES[i].name);
            failed = 1;
        }
    }
    target_close(t);
    return failed;
}

static bool read_picture(const char *folder, const char *name, unsigned char *bytes)
{
    char path[1024];
    int width = 0, height = 0;
    FILE *file;
    bool ok;
    snprintf(path, sizeof path, "%s/%s.ppm", folder, name);
    file = fopen(path, "rb");
    ok = file && fscanf(file, "P6 %d %d 255", &width, &height) == 2 && fgetc(file) == '\n' && width == WIDTH &&
         height == HEIGHT && fread(bytes, PIXELS * 3, 1, file) == 1;
    if (file)
        fclose(file);
    return ok;
}

static int compare(const char *old, const char *new)
{
    static unsigned char a[PIXELS * 3], b[PIXELS * 3];
    int i, s;
    for (s = 0; s < SCENE_COUNT; s++) {
        long counts[256] = {0}, sum = 0;
        int p95 = 0, most = 0;
        if (!read_picture(old, SCENES[s].name, a) || !read_picture(new, SCENES[s].name, b))
            continue; /* the caller counts lines */
        for (i = 0; i < PIXELS * 3; i++)
            counts[abs(a[i] - b[i])]++;
        for (i = 0; i < 256; i++) {
            if (sum < 0.95 * PIXELS * 3)
                p95 = i;
            if (counts[i])
                most = i;
            sum += counts[i];
        }
        printf("%s\t%d\t%d\n", SCENES[s].name, p95, most);
    }
    return 0;
}

int main(int argc, char **argv)
{
    int i;
    if (argc >= 4 && strcmp(argv[1], "draw") == 0)
        return draw_all(argv[2], argv[3], argv + 4, argc - 4);
    if (argc == 4 && strcmp(argv[1], "compare") == 0)
        return compare(argv[2], argv[3]);
    if (argc == 2 && strcmp(argv[1], "list") == 0) {
        for (i = 0; i < SCENE_COUNT; i++)
            puts(SCENES[i].name);
        return 0;
    }
    fputs("drivers draw vulkan|gl|es31|es30|core45|core33 DIR [SCENE..]\ndrivers compare DIR DIR\ndrivers list\n", stderr);
    return 2;
}
