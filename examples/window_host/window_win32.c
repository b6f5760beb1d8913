/* The window on Win32. */
#include "window.h"

#ifdef _WIN32

#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#include <windowsx.h>

static HWND window;

static LRESULT CALLBACK on_message(HWND hwnd, UINT message, WPARAM w_param, LPARAM l_param)
{
    host_window *w = (host_window *)GetWindowLongPtrW(hwnd, GWLP_USERDATA);
    if (!w) return DefWindowProcW(hwnd, message, w_param, l_param);
    switch (message) {
    case WM_SIZE: /* size of the client area; 0 x 0 when minimised */
        w->resized |= w->width != LOWORD(l_param) || w->height != HIWORD(l_param);
        w->width = LOWORD(l_param);
        w->height = HIWORD(l_param);
        return 0;
    case WM_MOUSEMOVE:
        if (w_param & MK_LBUTTON && w->width > 0 && w->height > 0) {
            w->dragged = true;
            w->drag_x = (double)GET_X_LPARAM(l_param) / w->width;
            w->drag_y = (double)GET_Y_LPARAM(l_param) / w->height;
        }
        return 0;
    case WM_ERASEBKGND: return 1; /* Welkin fills the window */
    case WM_CLOSE: w->open = false; return 0;
    default: return DefWindowProcW(hwnd, message, w_param, l_param);
    }
}

/* Welkin's sizes are those of the client area, in pixels; a window is larger by its frame. */
static RECT with_frame(uint32_t width, uint32_t height)
{
    RECT r = {0, 0, (LONG)width, (LONG)height};
    AdjustWindowRect(&r, WS_OVERLAPPEDWINDOW, FALSE);
    return r;
}

void window_open(host_window *w, uint32_t width, uint32_t height)
{
    const wk_window named = WK_WINDOW_INIT;
    const HINSTANCE module = GetModuleHandleW(NULL);
    const WNDCLASSW kind = {.style = CS_OWNDC,
                            .lpfnWndProc = on_message,
                            .hInstance = module,
                            .hCursor = LoadCursor(NULL, IDC_ARROW),
                            .lpszClassName = L"Welkin host"};
    const RECT r = with_frame(width, height);
    SetProcessDPIAware(); /* use the screen's pixels, not scaled ones */
    RegisterClassW(&kind);
    window = CreateWindowW(kind.lpszClassName, L"Welkin", WS_OVERLAPPEDWINDOW, 0, 0, r.right - r.left, r.bottom - r.top,
                           NULL, NULL, module, NULL);
    EXPECT(window, "no window: error %lu", GetLastError());
    *w = (host_window){.named = named, .width = width, .height = height, .open = true};
    w->named.kind = WK_WINDOW_WIN32;
    w->named.display = module;
    w->named.handle = window;
    SetWindowLongPtrW(window, GWLP_USERDATA, (LONG_PTR)w);
    ShowWindow(window, SW_SHOW);
}

void window_take_events(host_window *w)
{
    (void)w;
    MSG message;
    while (PeekMessageW(&message, NULL, 0, 0, PM_REMOVE)) {
        TranslateMessage(&message);
        DispatchMessageW(&message);
    }
}

void window_resize(host_window *w, uint32_t width, uint32_t height)
{
    const RECT r = with_frame(width, height);
    (void)w;
    SetWindowPos(window, NULL, 0, 0, r.right - r.left, r.bottom - r.top, SWP_NOMOVE | SWP_NOZORDER);
}

void window_show(host_window *w, bool shown)
{
    (void)w;
    ShowWindow(window, shown ? SW_SHOW : SW_HIDE);
}

void window_close(host_window *w)
{
    w->open = false;
    DestroyWindow(window);
}

/* Reads the screen: the picture of a window that Vulkan presents to is nowhere else. */
unsigned char *window_pixels(host_window *w)
{
    const int width = (int)w->width, height = (int)w->height;
    POINT corner = {0, 0};
    BITMAPINFO info = {.bmiHeader = {.biSize = sizeof info.bmiHeader,
                                     .biWidth = width,
                                     .biHeight = -height, /* top row first */
                                     .biPlanes = 1,
                                     .biBitCount = 32,
                                     .biCompression = BI_RGB}};
    void *bits = NULL;
    ClientToScreen(window, &corner);
    HDC screen = GetDC(NULL), copy = CreateCompatibleDC(screen);
    HBITMAP bitmap = CreateDIBSection(screen, &info, DIB_RGB_COLORS, &bits, NULL, 0);
    HGDIOBJ before = SelectObject(copy, bitmap);
    const BOOL copied = BitBlt(copy, 0, 0, width, height, screen, corner.x, corner.y, SRCCOPY);
    GdiFlush();
    unsigned char *rgb = malloc((size_t)width * height * 3);
    EXPECT(copied && bits && rgb, "the screen cannot be read: error %lu", GetLastError());
    for (int i = 0; i < width * height; i++) {
        const unsigned char *bgrx = (const unsigned char *)bits + 4 * i;
        rgb[3 * i] = bgrx[2];
        rgb[3 * i + 1] = bgrx[1];
        rgb[3 * i + 2] = bgrx[0];
    }
    SelectObject(copy, before);
    DeleteObject(bitmap);
    DeleteDC(copy);
    ReleaseDC(NULL, screen);
    return rgb;
}

void window_sleep_ms(unsigned ms)
{
    Sleep(ms);
}

#endif
