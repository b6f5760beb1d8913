/* Draws the sky of a weather report into memory and writes it as a PPM picture. It calls no graphics API.
 * cc examples/minimal.c $(pkg-config --cflags --libs welkin) -o minimal && ./minimal > sky.ppm */
#include <stdio.h>
#include <stdlib.h>
#include <welkin.h>
#ifdef _WIN32 /* where standard output is in text mode by default */
#include <fcntl.h>
#include <io.h>
#endif

enum { WIDTH = 320, HEIGHT = 180 };

static void check(wk_status status)
{
    if (status < 0) {
        fprintf(stderr, "%s: %s\n", wk_status_name(status), wk_last_error_message());
        exit(1);
    }
}

int main(void)
{
    static unsigned char pixels[HEIGHT][WIDTH][4];
    const char *report = "METAR LBBG 041600Z 12012KT 9999 FEW030 20/12 Q1015";
    wk_device *device = NULL;
    wk_context *context = NULL;
    wk_view *view = NULL;
    wk_texture *color = NULL;
    wk_weather weather = WK_WEATHER_INIT;
    wk_cloud_layer layers[16] = {WK_CLOUD_LAYER_INIT};
    wk_texture_desc texture = WK_TEXTURE_DESC_INIT;
    wk_own_target target = WK_OWN_TARGET_INIT;
    wk_frame frame = WK_FRAME_INIT;
    /* Looks north: in the picture east is right and up is up. One radian wide, infinite reversed depth. */
    const double view_matrix[16] = {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    const double projection[16] = {1.83, 0, 0, 0, 0, 3.25, 0, 0, 0, 0, 0, -1, 0, 0, 0.1, 0};
    int i;

    check(wk_device_create(NULL, &device));
    check(wk_context_create(device, NULL, &context));
    check(wk_view_create(context, NULL, &view));
    check(wk_weather_from_metar(report, layers, 16, sizeof layers[0], &weather, NULL));
    check(wk_context_set_weather(context, &weather, 0.0, 0.0));
    texture.width = WIDTH;
    texture.height = HEIGHT;
    check(wk_texture_create(device, &texture, &color));
    for (i = 0; i < 16; i++) {
        frame.view[i] = view_matrix[i];
        frame.projection[i] = projection[i];
    }
    frame.position_m[2] = 2.0;
    target.color = color;
    frame.target = &target;
    /* WK_FRAME_NO_HISTORY completes a single picture in one frame. Leave it out where frames follow each other. */
    frame.flags = WK_FRAME_DEPTH_REVERSED | WK_FRAME_NO_HISTORY;
    check(wk_view_record(view, &frame, WK_STAGE_ALL));
    check(wk_texture_read(color, pixels, sizeof pixels, WIDTH * 4));
#ifdef _WIN32
    _setmode(_fileno(stdout), _O_BINARY);
#endif
    printf("P6 %d %d 255\n", WIDTH, HEIGHT);
    for (i = 0; i < WIDTH * HEIGHT; i++) fwrite(pixels[i / WIDTH][i % WIDTH], 3, 1, stdout);
    check(wk_texture_destroy(color));
    check(wk_view_destroy(view));
    check(wk_context_destroy(context));
    check(wk_device_destroy(device));
    return 0;
}
