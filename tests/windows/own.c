/* The scene on a device of Welkin's own, and values that need no GPU: parsed reports, conditions, the state's hash.
 *
 *     own vulkan|opengl|noop PICTURE.ppm VALUES.bin */
#include "scene.h"

#include <stddef.h>

static void write_values(wk_context *context, FILE *file)
{
    static const char *const REPORTS[] = {
        "METAR LBBG 041600Z 12012KT 9999 FEW030 20/12 Q1015",
        "METAR EGLL 041620Z AUTO 00000KT 0150 R27L/0350N FZFG VV001 M02/M02 Q1031",
        "SPECI KDEN 041653Z 27025G45KT 1/2SM +TSRA BKN008CB OVC020 12/11 A2970",
        "METAR UUEE 041600Z 33007MPS 2000 SN OVC007 M05/M07 Q1001",
        "METAR LBBG 041600Z 120X2KT",
        "",
    };
    const double at[3] = {100.0, -50.0, 1.0};
    wk_conditions conditions = WK_CONDITIONS_INIT;
    uint64_t hash = 0;
    size_t i;
    for (i = 0; i < sizeof REPORTS / sizeof *REPORTS; i++) {
        wk_weather weather = WK_WEATHER_INIT;
        wk_cloud_layer layers[8] = {WK_CLOUD_LAYER_INIT};
        const wk_status status = wk_weather_from_metar(REPORTS[i], layers, 8, sizeof layers[0], &weather, NULL);
        fprintf(file, "%d %s\n", (int)status, status < 0 ? wk_last_error_message() : "");
        EXPECT(fwrite(layers, sizeof layers, 1, file) == 1);
    }
    CHECK(wk_context_get_conditions(context, &at, 30.0, &conditions));
    EXPECT(fwrite(&conditions, sizeof conditions, 1, file) == 1);
    CHECK(wk_context_state_hash(context, &hash));
    EXPECT(fwrite(&hash, sizeof hash, 1, file) == 1);
}

int main(int argc, char **argv)
{
    static unsigned char pixels[WIDTH * HEIGHT * 4];
    wk_device_desc device_desc = WK_DEVICE_DESC_INIT;
    wk_texture_desc texture = WK_TEXTURE_DESC_INIT;
    wk_own_target target = WK_OWN_TARGET_INIT;
    wk_frame frame = WK_FRAME_INIT;
    wk_caps caps = WK_CAPS_INIT;
    wk_device *device = NULL;
    wk_context *context = NULL;
    wk_view *view = NULL;
    wk_texture *color = NULL;
    FILE *values;
    EXPECT(argc == 4);
    device_desc.backends = strcmp(argv[1], "vulkan") == 0   ? WK_BACKEND_VULKAN
                           : strcmp(argv[1], "opengl") == 0 ? WK_BACKEND_GL
                                                            : WK_BACKEND_NOOP;
    CHECK(wk_device_create(&device_desc, &device));
    CHECK(wk_device_get_caps(device, &caps));
    printf("%s (%s), tier %u\n", caps.adapter_name, caps.driver, (unsigned)caps.tier);
    CHECK(wk_context_create(device, NULL, &context));
    CHECK(wk_view_create(context, NULL, &view));
    scene_weather(context);
    texture.width = WIDTH;
    texture.height = HEIGHT;
    CHECK(wk_texture_create(device, &texture, &color));
    target.color = color;
    scene_frame(&frame, &target);
    CHECK(wk_view_record(view, &frame, WK_STAGE_ALL));
    CHECK(wk_texture_read(color, pixels, sizeof pixels, WIDTH * 4));
    if (device_desc.backends != WK_BACKEND_NOOP) scene_look(pixels);
    scene_write(argv[2], pixels, WIDTH, HEIGHT);
    values = fopen(argv[3], "wb");
    EXPECT(values);
    write_values(context, values);
    EXPECT(fclose(values) == 0);
    CHECK(wk_texture_destroy(color));
    CHECK(wk_view_destroy(view));
    CHECK(wk_context_destroy(context));
    CHECK(wk_device_destroy(device));
    printf("ok\n");
    return 0;
}
