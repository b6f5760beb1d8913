/* Draws every report at every hour offscreen and writes each picture as a PNG, and all, scaled down, on one sheet. */
#include "contact.h"

#include <stdio.h>
#include <stdlib.h>

#include "demo.h"
#include "png_file.h"
#include "sheet.h"

typedef struct cost {
    double frame_ms, weather_ms, worst_ms;
    int count;
} cost;

/* Draws three frames and keeps the last: the first compiles shaders and builds tables, the second times each effect. */
static bool draw(demo *d, cost *sum)
{
    d->cut = true;
    if (!demo_draw(d))
        return false;
    double first = d->weather_ms;
    d->measure = true;
    bool measured = demo_draw(d);
    d->measure = false;
    if (!measured || !demo_draw(d))
        return false;
    sum->frame_ms += d->ms;
    sum->weather_ms += d->weather_ms;
    sum->worst_ms = first > sum->worst_ms ? first : sum->worst_ms;
    sum->count++;
    return true;
}

static bool save(demo *d, sheet *s, int row, const char *out, uint8_t *rgb)
{
    char path[1024], name[32];
    const picture *p = &d->picture;
    picture_read(p, rgb);
    sheet_put(s, d->hour, row, rgb, p->shown_width, p->shown_height);
    snprintf(name, sizeof name, "%.31s", HOURS[d->hour].name);
    for (char *c = name; *c; c++)
        *c = *c == ' ' ? '_' : *c;
    snprintf(path, sizeof path, "%s/%02d_%s.png", out, d->report + 1, name);
    if (!png_write_rgb8(path, rgb, p->shown_width, p->shown_height))
        return false;
    /* All pictures take minutes on a software driver, so each path is printed as soon as its file is written. */
    printf("%s\n", path);
    fflush(stdout);
    return true;
}

static bool draw_all(demo *d, sheet *s, int first, int rows, const char *out, uint8_t *rgb, cost *sum)
{
    char caption[400];
    for (int h = 0; h < HOUR_COUNT; h++)
        sheet_title(s, h, HOURS[h].name);
    for (int row = 0; row < rows; row++) {
        d->report = first + row;
        if (!demo_next_report(d, 0))
            return false;
        snprintf(caption, sizeof caption, "%s   %s", d->reports.items[d->report].metar, weather_summary(&d->weather));
        sheet_caption(s, row, caption);
        for (int h = 0; h < HOUR_COUNT; h++) {
            d->hour = h;
            fprintf(stderr, "drawing %d of %d\n", row * HOUR_COUNT + h + 1, rows * HOUR_COUNT);
            if (!demo_next_hour(d, 0) || !draw(d, sum) || !save(d, s, row, out, rgb))
                return false;
        }
    }
    return true;
}

static int write_sheet(demo *d, int first, int rows, const char *out)
{
    const picture *p = &d->picture;
    uint8_t *rgb = malloc((size_t)p->width * (size_t)p->height * 3);
    char path[1024];
    sheet s = {0};
    cost sum = {0};
    int shrink = p->width > 480 ? 2 : 1;
    bool ok = rgb && sheet_create(&s, HOUR_COUNT, rows, p->width / shrink, p->height / shrink) &&
              draw_all(d, &s, first, rows, out, rgb, &sum);
    snprintf(path, sizeof path, "%s/contact_sheet.png", out);
    ok = ok && png_write_rgb8(path, s.rgb, s.width, s.height);
    if (ok) {
        printf("%d pictures of %d x %d: %.1f ms a frame, of it weather %.1f ms; longest first frame of a new weather "
               "or hour %.1f ms\n", sum.count, p->width, p->height, sum.frame_ms / sum.count,
               sum.weather_ms / sum.count, sum.worst_ms);
        weather_print_costs(&d->weather);
        printf("%s\n", path);
    }
    sheet_destroy(&s);
    free(rgb);
    return ok ? 0 : 1;
}

int contact_run(const char *data, const demo_world *world, const char *out, int width, int height, int only)
{
    platform p;
    demo d;
    int code = 1;
    if (!headless_open(&p))
        return 1;
    if (gl_load(&p) && demo_open(&d, &p, data, world, width, height, 1)) {
        bool one = only > 0 && only <= d.reports.count;
        printf("no display: writing pictures to %s\nadapter: %s\n", out, weather_adapter(&d.weather));
        code = one ? write_sheet(&d, only - 1, 1, out) : write_sheet(&d, 0, d.reports.count, out);
        demo_close(&d);
    }
    headless_close(&p);
    return code;
}
