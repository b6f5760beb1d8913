/* A C host on the backend that draws nothing: every object made, used and destroyed once. Run plainly and under
 * valgrind, which must find no error and no leak. */
#include "welkin.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define CHECK(call)                                                                         \
    do {                                                                                    \
        wk_status status_ = (call);                                                         \
        if (status_ < 0) {                                                                  \
            fprintf(stderr, "%s: %s\n", wk_status_name(status_), wk_last_error_message()); \
            exit(1);                                                                        \
        }                                                                                   \
    } while (0)

#define EXPECT(condition)                                                        \
    do {                                                                         \
        if (!(condition)) {                                                      \
            fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);      \
            exit(1);                                                             \
        }                                                                        \
    } while (0)

static int log_lines;

static void on_log(void *user, wk_log_level level, const char *message)
{
    (void)level;
    (void)message;
    ++*(int *)user;
}

static void versions(void)
{
    uint32_t major = 99, minor = 99, patch = 99;
    CHECK(wk_version(&major, &minor, &patch));
    EXPECT(major == WK_VERSION_MAJOR && minor == WK_VERSION_MINOR && patch == WK_VERSION_PATCH);
    EXPECT(strcmp(wk_status_name(WK_ERROR_BAD_HANDLE), "WK_ERROR_BAD_HANDLE") == 0);
}

static wk_texture *texture(wk_device *device, wk_format format)
{
    wk_texture_desc desc = WK_TEXTURE_DESC_INIT;
    wk_texture *made = NULL;
    desc.width = 16;
    desc.height = 8;
    desc.format = format;
    CHECK(wk_texture_create(device, &desc, &made));
    return made;
}

static void draw(wk_view *view, wk_texture *color, wk_texture *depth, uint64_t frame_id)
{
    wk_own_target target = WK_OWN_TARGET_INIT;
    wk_frame frame = WK_FRAME_INIT;
    wk_report report = WK_REPORT_INIT;
    target.color = color;
    target.depth = depth;
    frame.frame_id = frame_id;
    frame.target = &target;
    frame.flags = WK_FRAME_DEPTH_REVERSED;
    /* infinite reversed perspective, 90 degrees, near plane 0.1 m */
    frame.projection[0] = 0.5;
    frame.projection[10] = 0.0;
    frame.projection[11] = -1.0;
    frame.projection[14] = 0.1;
    frame.projection[15] = 0.0;
    CHECK(wk_view_record(view, &frame, WK_STAGE_ALL));
    EXPECT(wk_view_record(view, &frame, WK_STAGE_ALL) == WK_ERROR_WRONG_ORDER);
    EXPECT(strstr(wk_last_error_message(), "wk_view_record: ") != NULL);
    EXPECT(strcmp(wk_last_error_field(), "stages") == 0);
    CHECK(wk_view_get_report(view, &report));
    EXPECT(report.frame_id == frame_id && report.passes > 0);
}

/* A progress callback that aborts at a given call. */
static int32_t on_progress(void *user, double share)
{
    double *last = (double *)user;
    const int abort_now = *last < 0.0;
    EXPECT(share > *last && share <= 1.0);
    *last = share;
    return abort_now;
}

int main(void)
{
    wk_device_desc device_desc = WK_DEVICE_DESC_INIT;
    wk_context_desc context_desc = WK_CONTEXT_DESC_INIT;
    wk_given_direction sun = WK_GIVEN_DIRECTION_INIT;
    wk_caps caps = WK_CAPS_INIT;
    wk_device *device = NULL;
    wk_context *context = NULL;
    wk_view *views[2] = {NULL, NULL};
    wk_texture *color, *depth;
    unsigned char pixels[16 * 8 * 4];
    double progress;
    int i;

    versions();
    CHECK(wk_set_log_callback(on_log, &log_lines, WK_LOG_LEVEL_DEBUG));
    device_desc.backends = WK_BACKEND_NOOP;
    CHECK(wk_device_create(&device_desc, &device));
    CHECK(wk_device_get_caps(device, &caps));
    EXPECT(caps.backend == WK_BACKEND_NOOP && caps.adapter_name != NULL && caps.max_texture_size >= 2048);
    context_desc.world_kind = WK_WORLD_TANGENT;
    CHECK(wk_context_create(device, &context_desc, &context));
    CHECK(wk_context_set_sun(context, &sun));
    CHECK(wk_context_set_sun(context, NULL));
    progress = -1.0;
    EXPECT(wk_context_build_sky(context, on_progress, &progress) == WK_ERROR_ABORTED);
    progress = 0.0;
    CHECK(wk_context_build_sky(context, on_progress, &progress));
    EXPECT(progress == 1.0);
    CHECK(wk_context_build_sky(context, NULL, NULL));
    for (i = 0; i < 2; i++) CHECK(wk_view_create(context, NULL, &views[i]));
    color = texture(device, WK_FORMAT_RGBA8_UNORM);
    depth = texture(device, WK_FORMAT_R32_FLOAT);
    memset(pixels, 0, sizeof pixels);
    CHECK(wk_texture_write(color, pixels, sizeof pixels, 16 * 4));
    for (i = 0; i < 20; i++) draw(views[i % 2], color, depth, (uint64_t)i);
    CHECK(wk_texture_read(color, pixels, sizeof pixels, 16 * 4));
    EXPECT(wk_context_destroy(context) == WK_ERROR_IN_USE);
    CHECK(wk_texture_destroy(color));
    CHECK(wk_texture_destroy(depth));
    for (i = 0; i < 2; i++) CHECK(wk_view_destroy(views[i]));
    CHECK(wk_context_destroy(context));
    CHECK(wk_device_get_status(device));
    CHECK(wk_device_destroy(device));
    EXPECT(wk_device_get_status(device) == WK_ERROR_BAD_HANDLE);
    CHECK(wk_set_log_callback(NULL, NULL, WK_LOG_LEVEL_ERROR));
    printf("ok\n");
    return 0;
}
