/* Draws the gallery's pictures one after the other. Each has a new device and context, so no picture depends on an
 * earlier one. */
#include "gallery.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "palette.h"
#include "png_file.h"
#include "shots.h"

#define SAMPLES_A_SIDE 2
#define RAIN_ON_GLASS_S 50.0
#define GLASS_STEP_S (1.0 / 20.0)

/* Water on glass has a history, so its earlier frames are simulated without drawing a picture. */
static bool let_it_rain_on_the_glass(demo *d, const shot *s)
{
    int steps = (int)(RAIN_ON_GLASS_S / GLASS_STEP_S);
    for (int i = 0; i <= steps; i++) {
        double time_s = i * GLASS_STEP_S;
        if (!s->windscreen(d, time_s) || !weather_prepare(&d->weather, &d->picture, d->still, time_s, d->frame++))
            return false;
    }
    d->time_s = RAIN_ON_GLASS_S;
    d->history = true;
    d->cut = false;
    return true;
}

static bool write(const char *path, const uint8_t *rgb, int width, int height)
{
    palette colors;
    uint8_t *indices = malloc((size_t)width * (size_t)height);
    bool ok = indices && palette_choose(&colors, rgb, width, height, indices) &&
              png_write_indexed(path, indices, width, height, (const uint8_t(*)[3])colors.rgb, colors.count);
    free(indices);
    return ok;
}

/* Averages each 2 x 2 square of pixels. */
static void halve(uint8_t *rgb, int *width, int *height)
{
    int w = *width / 2, h = *height / 2;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int c = 0; c < 3; c++) {
                const uint8_t *from = rgb + ((size_t)(2 * y) * (size_t)*width + (size_t)(2 * x)) * 3 + c;
                int sum = from[0] + from[3] + from[(size_t)*width * 3] + from[(size_t)*width * 3 + 3];
                rgb[((size_t)y * (size_t)w + (size_t)x) * 3 + (size_t)c] = (uint8_t)((sum + 2) / 4);
            }
    *width = w, *height = h;
}

static bool take(demo *d, const shot *s, const char *out, uint8_t *rgb)
{
    char path[1024];
    camera c = shot_camera(s, &d->scene.ground);
    d->still = &c;
    d->lamps = (lamp_pair){0};
    d->time_s = 0.0;
    d->history = false;
    d->scene.extra = s->world == WITH_BRIDGE ? BRIDGE : s->world == WITH_BARN ? BARN : s->world == WITH_VESSEL ? VESSEL : NO_EXTRA;
    d->scene.empty = s->world == NO_WORLD || s->world == OPEN_SEA;
    d->scene.at_sea = s->world == WITH_VESSEL;
    d->scene.landless = s->world == LANDLESS;
    weather_close(&d->weather);
    bool ok = weather_open(&d->weather, d->platform, NULL) && s->prepare(d) &&
              (!s->windscreen || let_it_rain_on_the_glass(d, s)) && demo_draw(d);
    d->still = NULL;
    if (!ok)
        return false;
    picture_read(&d->picture, rgb);
    int width = d->picture.shown_width, height = d->picture.shown_height;
    if (s->small)
        halve(rgb, &width, &height);
    snprintf(path, sizeof path, "%s/%s.png", out, s->name);
    if (!write(path, rgb, width, height))
        return false;
    printf("%s: %s\n", path, s->caption);
    fflush(stdout);
    return true;
}

static bool wanted(const shot *s, char *const *names, int count)
{
    for (int i = 0; i < count; i++)
        if (strcmp(names[i], s->name) == 0)
            return true;
    return count == 0;
}

bool gallery_has(char *const *names, int count)
{
    for (int n = 0; n < count; n++) {
        int i = 0;
        while (i < SHOT_COUNT && strcmp(names[n], SHOTS[i].name) != 0)
            i++;
        if (i < SHOT_COUNT)
            continue;
        fprintf(stderr, "glfw_host: the gallery has no picture %s; it has:", names[n]);
        for (i = 0; i < SHOT_COUNT; i++)
            fprintf(stderr, " %s", SHOTS[i].name);
        fputc('\n', stderr);
        return false;
    }
    return true;
}

static bool take_all(demo *d, const char *out, char *const *names, int count)
{
    uint8_t *rgb = malloc((size_t)d->picture.shown_width * (size_t)d->picture.shown_height * 3);
    bool ok = rgb != NULL;
    for (int i = 0, taken = 0; i < SHOT_COUNT && ok; i++)
        if (wanted(&SHOTS[i], names, count)) {
            fprintf(stderr, "drawing %s, %d of %d\n", SHOTS[i].name, ++taken, count > 0 ? count : SHOT_COUNT);
            ok = take(d, &SHOTS[i], out, rgb);
        }
    free(rgb);
    return ok;
}

int gallery_run(const char *data, const char *out, int width, int height, char *const *names, int count)
{
    platform p;
    demo d;
    bool ok = false;
    if (!headless_open(&p))
        return 1;
    if (gl_load(&p) && demo_open(&d, &p, data, &(demo_world){0}, width, height, SAMPLES_A_SIDE)) {
        d.picture.plain = true;
        printf("adapter: %s\n", weather_adapter(&d.weather));
        ok = take_all(&d, out, names, count);
        demo_close(&d);
    }
    headless_close(&p);
    return ok ? 0 : 1;
}
