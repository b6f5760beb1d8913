/* The window on Win32. */
#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#define VK_USE_PLATFORM_WIN32_KHR
#endif
#include "host.h"
#include "native.h"

#ifdef _WIN32

#include <windows.h>

static HWND window;

const char *native_extension(void) { return VK_KHR_WIN32_SURFACE_EXTENSION_NAME; }

static LRESULT CALLBACK on_message(HWND hwnd, UINT message, WPARAM w_param, LPARAM l_param)
{
    native *n = (native *)GetWindowLongPtrW(hwnd, GWLP_USERDATA);
    if (n && message == WM_SIZE && w_param != SIZE_MINIMIZED) {
        n->resized |= n->width != LOWORD(l_param) || n->height != HIWORD(l_param);
        n->width = LOWORD(l_param);
        n->height = HIWORD(l_param);
        return 0;
    }
    if (n && message == WM_CLOSE) {
        n->open = false;
        return 0;
    }
    return message == WM_ERASEBKGND ? 1 : DefWindowProcW(hwnd, message, w_param, l_param);
}

/* A window is larger than its drawing area by its frame. */
static RECT with_frame(uint32_t width, uint32_t height)
{
    RECT r = {0, 0, (LONG)width, (LONG)height};
    AdjustWindowRect(&r, WS_OVERLAPPEDWINDOW, FALSE);
    return r;
}

void native_open(native *n, uint32_t width, uint32_t height)
{
    const HINSTANCE module = GetModuleHandleW(NULL);
    const WNDCLASSW kind = {.lpfnWndProc = on_message, .hInstance = module, .lpszClassName = L"Welkin Vulkan host"};
    const RECT r = with_frame(width, height);
    SetProcessDPIAware();
    RegisterClassW(&kind);
    window = CreateWindowW(kind.lpszClassName, L"Welkin on a host's Vulkan", WS_OVERLAPPEDWINDOW, 0, 0,
                           r.right - r.left, r.bottom - r.top, NULL, NULL, module, NULL);
    EXPECT(window, "no window: error %lu", GetLastError());
    *n = (native){.width = width, .height = height, .open = true};
    SetWindowLongPtrW(window, GWLP_USERDATA, (LONG_PTR)n);
    ShowWindow(window, SW_SHOW);
}

void native_take_events(native *n)
{
    (void)n;
    MSG message;
    while (PeekMessageW(&message, NULL, 0, 0, PM_REMOVE)) {
        TranslateMessage(&message);
        DispatchMessageW(&message);
    }
}

void native_resize(uint32_t width, uint32_t height)
{
    const RECT r = with_frame(width, height);
    SetWindowPos(window, NULL, 0, 0, r.right - r.left, r.bottom - r.top, SWP_NOMOVE | SWP_NOZORDER);
}

VkSurfaceKHR native_surface(VkInstance instance)
{
    const VkWin32SurfaceCreateInfoKHR info = {.sType = VK_STRUCTURE_TYPE_WIN32_SURFACE_CREATE_INFO_KHR,
                                              .hinstance = GetModuleHandleW(NULL),
                                              .hwnd = window};
    VkSurfaceKHR surface;
    VK_CHECK(vkCreateWin32SurfaceKHR(instance, &info, NULL, &surface));
    return surface;
}

void native_close(native *n)
{
    n->open = false;
    DestroyWindow(window);
}

#endif
