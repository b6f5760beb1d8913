/* Each event of a Win32 window gives a status, and the device can draw into another window afterwards.
 *
 *     window vulkan|opengl */
#include "scene.h"

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

static HWND make(int width, int height)
{
    const HWND made = CreateWindowA("Window", "Window", WS_POPUP | WS_VISIBLE, 0, 0, width, height, NULL, NULL,
                                    GetModuleHandleA(NULL), NULL);
    EXPECT(made);
    return made;
}

static wk_window named(HWND window)
{
    wk_window w = WK_WINDOW_INIT;
    w.kind = WK_WINDOW_WIN32;
    w.display = GetModuleHandleA(NULL);
    w.handle = window;
    return w;
}

static void take_messages(void)
{
    MSG message;
    while (PeekMessageA(&message, NULL, 0, 0, PM_REMOVE)) DispatchMessageA(&message);
}

static wk_status configure(wk_surface *surface, uint32_t width, uint32_t height)
{
    wk_surface_config config = WK_SURFACE_CONFIG_INIT;
    config.width = width;
    config.height = height;
    config.pacing = WK_PACING_IMMEDIATE;
    return wk_surface_configure(surface, &config);
}

static uint64_t frame_id;

/* Draws one frame as a host does; returns the first status that is not WK_OK. */
static wk_status draw(wk_view *view, wk_surface *surface)
{
    wk_own_target target = WK_OWN_TARGET_INIT;
    wk_frame frame = WK_FRAME_INIT;
    wk_status status = wk_surface_acquire(surface);
    take_messages();
    if (status != WK_OK) return status;
    target.surface = surface;
    scene_frame(&frame, &target);
    frame.frame_id = ++frame_id;
    frame.color_space = WK_COLOR_DISPLAY_LINEAR;
    status = wk_view_record(view, &frame, WK_STAGE_ALL);
    return status == WK_OK ? wk_surface_present(surface) : status;
}

/* Draws until a frame is shown, which must be within a few: right after a change the first ones may be refused. */
static void shows(wk_view *view, wk_surface *surface, uint32_t width, uint32_t height)
{
    int i;
    for (i = 0; i < 5; i++) {
        const wk_status status = draw(view, surface);
        if (status == WK_OK) return;
        EXPECT(status == WK_ERROR_SURFACE_OUTDATED);
        CHECK(configure(surface, width, height));
    }
    EXPECT(!"the window shows nothing");
}

static void is_gone(wk_status status)
{
    if (status != WK_ERROR_SURFACE_OUTDATED) {
        fprintf(stderr, "%s: %s\n", wk_status_name(status), wk_last_error_message());
    }
    EXPECT(status == WK_ERROR_SURFACE_OUTDATED);
    EXPECT(strstr(wk_last_error_message(), "it does not exist, or no longer") != NULL);
}

int main(int argc, char **argv)
{
    WNDCLASSA kind = {0};
    wk_device_desc desc = WK_DEVICE_DESC_INIT;
    wk_device *device = NULL, *second = NULL;
    wk_context *context = NULL;
    wk_view *view = NULL;
    wk_surface *surface = NULL, *other = NULL;
    wk_window name;
    HWND window, another;
    EXPECT(argc == 2);
    desc.backends = strcmp(argv[1], "vulkan") == 0 ? WK_BACKEND_VULKAN : WK_BACKEND_GL;
    kind.style = CS_OWNDC;
    kind.lpfnWndProc = DefWindowProcA;
    kind.hInstance = GetModuleHandleA(NULL);
    kind.lpszClassName = "Window";
    RegisterClassA(&kind);
    window = make(120, 80);
    another = make(60, 50);
    name = named(window);
    CHECK(wk_device_create_for_window(&desc, &name, &device));
    CHECK(wk_context_create(device, NULL, &context));
    CHECK(wk_view_create(context, NULL, &view));
    CHECK(wk_surface_create(device, &name, &surface));
    CHECK(configure(surface, 120, 80));
    shows(view, surface, 120, 80);

    SetWindowPos(window, NULL, 0, 0, 200, 150, SWP_NOMOVE | SWP_NOZORDER);
    take_messages();
    CHECK(configure(surface, 200, 150));
    shows(view, surface, 200, 150);
    ShowWindow(window, SW_HIDE);
    draw(view, surface); /* whatever it answers, it answers */
    ShowWindow(window, SW_SHOW);
    CHECK(configure(surface, 200, 150));
    shows(view, surface, 200, 150);

    CHECK(wk_surface_acquire(surface)); /* with an image in hand */
    DestroyWindow(window);
    draw(view, surface);
    is_gone(configure(surface, 200, 150));
    CHECK(wk_surface_destroy(surface));
    is_gone(wk_surface_create(device, &name, &surface));
    is_gone(wk_device_create_for_window(&desc, &name, &second));
    CHECK(wk_device_get_status(device));

    name = named(another);
    CHECK(wk_surface_create(device, &name, &other));
    CHECK(configure(other, 60, 50));
    shows(view, other, 60, 50);
    CHECK(wk_surface_destroy(other));
    CHECK(wk_view_destroy(view));
    CHECK(wk_context_destroy(context));
    CHECK(wk_device_destroy(device));
    DestroyWindow(another);
    printf("ok\n");
    return 0;
}
