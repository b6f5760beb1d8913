/* A host without graphics of its own: a window of X11 or Win32 that shows the sky. Welkin gets the window's handle.
 *
 *     window_host [--gl]                    until the window is closed; the sun moves, the left button turns the view
 *     window_host [--gl] --check [OUT.ppm]  draws, resizes, hides and shows itself, and checks the screen's pixels
 *
 * With --gl, Welkin draws with OpenGL instead of the best interface available.
 *
 * The host owns the window, its events and its size (window.h; window_x11.c and window_win32.c). Changes of the window
 * reach it as a status of Welkin's calls. */
#include "window.h"

#include <math.h>
#include <string.h>

#include "../command_line.h"

#define WK_CHECK(call)                                                                                 \
    do {                                                                                               \
        wk_status status_ = (call);                                                                    \
        if (status_ < 0) {                                                                             \
            fprintf(stderr, "%s: %s: %s\n", #call, wk_status_name(status_), wk_last_error_message()); \
            exit(1);                                                                                   \
        }                                                                                              \
    } while (0)

typedef struct app {
    host_window window;
    bool outdated;
    double azimuth, pitch; /* view direction, rad */
    wk_device *device;
    wk_surface *surface;
    wk_context *context;
    wk_view *view;
    uint64_t frame_id;
} app;

/* ---- Welkin ---- */

static void open_welkin(app *a, wk_backend_flags backends)
{
    wk_device_desc desc = WK_DEVICE_DESC_INIT;
    desc.backends = backends;
    WK_CHECK(wk_device_create_for_window(&desc, &a->window.named, &a->device));
    WK_CHECK(wk_surface_create(a->device, &a->window.named, &a->surface));
    WK_CHECK(wk_context_create(a->device, NULL, &a->context));
    WK_CHECK(wk_view_create(a->context, NULL, &a->view));
    wk_caps caps = WK_CAPS_INIT;
    WK_CHECK(wk_device_get_caps(a->device, &caps));
    printf("%s (%s), tier %u\n", caps.adapter_name, caps.driver, caps.tier);
}

static void close_welkin(app *a)
{
    WK_CHECK(wk_view_destroy(a->view));
    WK_CHECK(wk_context_destroy(a->context));
    WK_CHECK(wk_surface_destroy(a->surface));
    WK_CHECK(wk_device_destroy(a->device));
}

static void configure(app *a)
{
    wk_surface_config config = WK_SURFACE_CONFIG_INIT;
    config.width = a->window.width;
    config.height = a->window.height;
    WK_CHECK(wk_surface_configure(a->surface, &config));
    a->outdated = false;
}

/* World (east, north, up) to eye (right, up, back), column by column. */
static void look(double m[16], double azimuth, double pitch)
{
    const double sa = sin(azimuth), ca = cos(azimuth), sp = sin(pitch), cp = cos(pitch);
    const double right[3] = {ca, -sa, 0.0}, up[3] = {-sa * sp, -ca * sp, cp}, back[3] = {-sa * cp, -ca * cp, -sp};
    memset(m, 0, 16 * sizeof *m);
    for (int c = 0; c < 3; c++) {
        m[4 * c] = right[c];
        m[4 * c + 1] = up[c];
        m[4 * c + 2] = back[c];
    }
    m[15] = 1.0;
}

static void record(app *a)
{
    wk_own_target target = WK_OWN_TARGET_INIT;
    target.surface = a->surface;
    wk_frame frame = WK_FRAME_INIT;
    frame.frame_id = a->frame_id++;
    frame.target = &target;
    frame.position_m[2] = 2.0;
    frame.flags = WK_FRAME_DEPTH_REVERSED;
    look(frame.view, a->azimuth, a->pitch);
    /* Vertical field of view 60 degrees, reversed infinite depth, near plane at 0.1 m. */
    const double focal = 1.7320508;
    const double across = focal * a->window.height / a->window.width;
    const double projection[16] = {across, 0, 0, 0, 0, focal, 0, 0, 0, 0, 0, -1, 0, 0, 0.1, 0};
    memcpy(frame.projection, projection, sizeof projection);
    WK_CHECK(wk_view_record(a->view, &frame, WK_STAGE_ALL));
}

static void take_events(app *a)
{
    window_take_events(&a->window);
    a->outdated |= a->window.resized;
    if (a->window.dragged) {
        a->azimuth = 6.2831853 * a->window.drag_x;
        a->pitch = 1.5 * (0.5 - a->window.drag_y);
    }
    a->window.resized = a->window.dragged = false;
}

/* Draws and shows one frame if the window can show one now. */
static bool draw(app *a)
{
    take_events(a);
    if (a->outdated) configure(a);
    const wk_status got = wk_surface_acquire(a->surface);
    if (got == WK_PENDING) return false; /* hidden: there is nothing to draw to */
    if (got == WK_ERROR_SURFACE_OUTDATED) {
        a->outdated = true; /* the events before the next frame bring the new size */
        return false;
    }
    WK_CHECK(got);
    record(a);
    const wk_status shown = wk_surface_present(a->surface);
    if (shown == WK_ERROR_SURFACE_OUTDATED) {
        a->outdated = true;
        return false;
    }
    WK_CHECK(shown);
    return true;
}

static void set_sun(app *a, double azimuth_deg, double elevation_deg)
{
    wk_given_direction sun = WK_GIVEN_DIRECTION_INIT;
    sun.azimuth_deg = azimuth_deg;
    sun.elevation_deg = elevation_deg;
    WK_CHECK(wk_context_set_sun(a->context, &sun));
}

/* ---- checking the pixels that the screen shows ---- */

typedef struct rgb {
    int r, g, b;
} rgb;

static rgb pixel(const app *a, const unsigned char *pixels, uint32_t x, uint32_t y)
{
    const unsigned char *p = pixels + 3 * ((size_t)y * a->window.width + x);
    return (rgb){p[0], p[1], p[2]};
}

static bool is_sky(rgb p) { return p.b > p.r && p.b > 40; }

/* Draws frames until one is on the screen and its corners show sky, because presenting is asynchronous. */
static unsigned char *draw_until_sky(app *a)
{
    for (int attempt = 0; attempt < 50; attempt++) {
        if (!draw(a)) continue;
        window_sleep_ms(20);
        unsigned char *pixels = window_pixels(&a->window);
        const uint32_t right = a->window.width - 1, bottom = a->window.height - 1;
        if (is_sky(pixel(a, pixels, 0, 0)) && is_sky(pixel(a, pixels, right, 0)) &&
            is_sky(pixel(a, pixels, right, bottom)) && is_sky(pixel(a, pixels, 0, bottom))) {
            return pixels;
        }
        free(pixels);
    }
    EXPECT(false, "the sky never filled the window's %u x %u pixels", a->window.width, a->window.height);
    return NULL;
}

static void write_picture(const app *a, const char *path, const unsigned char *pixels)
{
    const size_t bytes = 3 * (size_t)a->window.width * a->window.height;
    FILE *f = fopen(part_begin(path), "wb");
    EXPECT(f, "cannot write %s", path);
    fprintf(f, "P6\n%u %u\n255\n", a->window.width, a->window.height);
    const bool written = fwrite(pixels, 1, bytes, f) == bytes, complete = fclose(f) == 0 && written;
    EXPECT(part_end(path, complete), "cannot write %s", path);
}

static void check(app *a, const char *picture)
{
    a->pitch = 0.6; /* the horizon is just below the picture */
    set_sun(a, 200.0, 35.0);
    configure(a);
    unsigned char *pixels = draw_until_sky(a);
    const rgb top = pixel(a, pixels, 160, 4), bottom = pixel(a, pixels, 160, a->window.height - 5);
    EXPECT(bottom.r + bottom.g > top.r + top.g, "the sky is brighter and paler near the horizon");
    if (picture) write_picture(a, picture, pixels);
    free(pixels);

    window_resize(&a->window, 480, 300);
    free(draw_until_sky(a));
    EXPECT(a->window.width == 480 && a->window.height == 300, "the window is %u x %u now", a->window.width,
           a->window.height);

    window_show(&a->window, false);
    for (int i = 0; i < 3; i++) draw(a); /* any result is accepted */
    window_show(&a->window, true);
    a->outdated = true;
    free(draw_until_sky(a));

    wk_surface_config minimised = WK_SURFACE_CONFIG_INIT;
    WK_CHECK(wk_surface_configure(a->surface, &minimised));
    EXPECT(wk_surface_acquire(a->surface) == WK_ERROR_SURFACE_OUTDATED, "no area, no image");
    EXPECT(wk_surface_present(a->surface) == WK_ERROR_WRONG_ORDER, "nothing was acquired");
    a->outdated = true;
    free(draw_until_sky(a));
    printf("ok\n");
}

static const char NAME[] = "window_host";

static const char USAGE[] =
    "window_host [--gl] [--check [PICTURE.ppm]]\n"
    "  --gl       Welkin draws with OpenGL instead of the best interface there is\n"
    "  --check    draw, resize, hide and show the window, look at its pixels, end\n"
    "  PICTURE.ppm  where the window's pixels are written\n"
    "  --help, --version\n";

int main(int argc, char **argv)
{
    wk_backend_flags backends = WK_BACKEND_ANY;
    bool checking = false;
    const char *picture = NULL;
    if (command_line_answered(argc, argv, NAME, USAGE)) return 0;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--gl") == 0) backends = WK_BACKEND_GL;
        else if (strcmp(argv[i], "--check") == 0) checking = true;
        else if (argv[i][0] == '-' || !checking || picture) return command_line_unknown(NAME, argv[i]);
        else picture = argv[i];
    }
    app a = {.outdated = true, .pitch = 0.3};
    window_open(&a.window, 320, 200);
    open_welkin(&a, backends);
    if (checking) {
        check(&a, picture);
    } else {
        for (double degrees = 0.0; a.window.open; degrees += 0.2) {
            set_sun(&a, degrees, 40.0 * sin(degrees / 57.29578));
            if (!draw(&a)) window_sleep_ms(10);
        }
    }
    close_welkin(&a);
    window_close(&a.window);
    return 0;
}
