/* Draws as many frames as it is asked for with one build of the library. scripts/compare-speed runs two of these
 * programs in turn, each with its own header and library. Each line on stdin asks for some frames of a turning camera;
 * the answer is their processor time in ms per frame. A fourth argument, gl, asks for OpenGL. */
#include <stdio.h>
#include <stdlib.h>
#include <math.h>
#include <string.h>
#include <time.h>
#include <welkin.h>

enum { FRAMES = 8, LAYERS = 16 };

static void check(wk_status status)
{
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", wk_status_name(status), wk_last_error_message());
        exit(1);
    }
}

/* Processor time of the whole process, because a software driver draws on threads of its own. */
static double processor_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * (double)t.tv_sec + 1e-6 * (double)t.tv_nsec;
}

/* Places the camera 2 m above the ground, tilted slightly up and turned right by `degrees`. Vertical field of view 55
 * degrees, infinite reversed depth. */
static void look(wk_frame *frame, double degrees, double aspect)
{
    const double turn = degrees * 0.017453292519943295, rise = 0.1;
    const double forward[3] = {sin(turn) * cos(rise), cos(turn) * cos(rise), sin(rise)};
    const double right[3] = {cos(turn), -sin(turn), 0.0};
    const double up[3] = {-sin(turn) * sin(rise), -cos(turn) * sin(rise), cos(rise)};
    memset(frame->view, 0, sizeof frame->view);
    memset(frame->projection, 0, sizeof frame->projection);
    for (int i = 0; i < 3; i++) {
        frame->view[4 * i] = right[i];
        frame->view[4 * i + 1] = up[i];
        frame->view[4 * i + 2] = -forward[i];
    }
    frame->view[15] = 1.0;
    frame->projection[0] = 1.92 / aspect;
    frame->projection[5] = 1.92;
    frame->projection[11] = -1.0;
    frame->projection[14] = 0.1;
    frame->position_m[2] = 2.0;
}

int main(int argc, char **argv)
{
    wk_device_desc desc = WK_DEVICE_DESC_INIT;
    wk_device *device = NULL;
    wk_context *context = NULL;
    wk_view *view = NULL;
    wk_texture *color = NULL;
    wk_weather weather = WK_WEATHER_INIT;
    wk_cloud_layer layers[LAYERS] = {WK_CLOUD_LAYER_INIT};
    wk_texture_desc texture = WK_TEXTURE_DESC_INIT;
    wk_own_target target = WK_OWN_TARGET_INIT;
    wk_frame frame = WK_FRAME_INIT;
    char line[16];
    if (argc != 4 && (argc != 5 || strcmp(argv[4], "gl") != 0)) {
        fprintf(stderr, "usage: compare WIDTH HEIGHT REPORT [gl]\n");
        return 1;
    }
    texture.width = (uint32_t)atoi(argv[1]);
    texture.height = (uint32_t)atoi(argv[2]);
    const size_t bytes = (size_t)texture.width * texture.height * 4;
    unsigned char *pixels = malloc(bytes);
    if (pixels == NULL) return 1;
    if (argc == 5) desc.backends = WK_BACKEND_GL;
    check(wk_device_create(&desc, &device));
    check(wk_context_create(device, NULL, &context));
    check(wk_view_create(context, NULL, &view));
    check(wk_weather_from_metar(argv[3], layers, LAYERS, sizeof layers[0], &weather, NULL));
    check(wk_context_set_weather(context, &weather, 0.0, 0.0));
    check(wk_texture_create(device, &texture, &color));
    target.color = color;
    frame.target = &target;
    frame.flags = WK_FRAME_DEPTH_REVERSED;
    while (fgets(line, sizeof line, stdin) != NULL) {
        const double begun = processor_ms();
        for (int i = 0; i < FRAMES; i++) {
            frame.frame_id++;
            look(&frame, 0.25 * (double)frame.frame_id, (double)texture.width / texture.height);
            check(wk_view_record(view, &frame, WK_STAGE_ALL));
        }
        /* Waits until the frames are finished. */
        check(wk_texture_read(color, pixels, bytes, texture.width * 4));
        printf("%.3f\n", (processor_ms() - begun) / FRAMES);
        fflush(stdout);
    }
    check(wk_texture_destroy(color));
    check(wk_view_destroy(view));
    check(wk_context_destroy(context));
    check(wk_device_destroy(device));
    free(pixels);
    return 0;
}
