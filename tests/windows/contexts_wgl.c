/* Two contexts by WGL, as a Windows host makes them. */
#ifdef _WIN32

#include "contexts.h"
#include "scene.h"

#define WIN32_LEAN_AND_MEAN
#include <windows.h>

#include <GL/gl.h>
#include <GL/wglext.h>

static HWND window;
static HDC dc;
static HGLRC contexts[2];

/* wglGetProcAddress knows what came after OpenGL 1.1; the library itself exports the rest. For a function that is not
 * there some drivers answer 1, 2, 3 or -1: Welkin takes these for none, and so does this host. */
const void *contexts_get_proc(void *user, const char *name)
{
    PROC found = wglGetProcAddress(name);
    const void *address;
    (void)user;
    if ((intptr_t)found >= -1 && (intptr_t)found <= 3)
        found = (PROC)GetProcAddress(GetModuleHandleA("opengl32.dll"), name);
    memcpy(&address, &found, sizeof address);
    return address;
}

int32_t contexts_make_current(void *user, uint32_t which)
{
    (void)user;
    return wglMakeCurrent(dc, contexts[which]) ? 0 : 1;
}

static void open_window(int width, int height)
{
    WNDCLASSA kind = {0};
    PIXELFORMATDESCRIPTOR format = {0};
    kind.style = CS_OWNDC;
    kind.lpfnWndProc = DefWindowProcA;
    kind.hInstance = GetModuleHandleA(NULL);
    kind.lpszClassName = "WGL host";
    RegisterClassA(&kind);
    window = CreateWindowA(kind.lpszClassName, "WGL host", WS_POPUP | WS_VISIBLE, 0, 0, width, height, NULL, NULL,
                           kind.hInstance, NULL);
    EXPECT(window);
    dc = GetDC(window);
    format.nSize = sizeof format;
    format.nVersion = 1;
    format.dwFlags = PFD_DRAW_TO_WINDOW | PFD_SUPPORT_OPENGL | PFD_DOUBLEBUFFER;
    format.iPixelType = PFD_TYPE_RGBA;
    format.cColorBits = 32;
    format.cDepthBits = 24;
    format.cStencilBits = 8;
    EXPECT(SetPixelFormat(dc, ChoosePixelFormat(dc, &format), &format));
}

void contexts_open(int width, int height, int core)
{
    static const int CORE[] = {WGL_CONTEXT_MAJOR_VERSION_ARB, 3, WGL_CONTEXT_MINOR_VERSION_ARB, 3,
                               WGL_CONTEXT_PROFILE_MASK_ARB, WGL_CONTEXT_CORE_PROFILE_BIT_ARB, 0};
    PFNWGLCREATECONTEXTATTRIBSARBPROC create;
    PROC found;
    HGLRC first;
    open_window(width, height);
    /* The function that makes contexts of a profile can be found only while a context is current. */
    first = wglCreateContext(dc);
    EXPECT(first && wglMakeCurrent(dc, first));
    if (core) {
        found = wglGetProcAddress("wglCreateContextAttribsARB");
        memcpy(&create, &found, sizeof create);
        EXPECT(create);
        contexts[0] = create(dc, NULL, CORE);
        contexts[1] = contexts[0] ? create(dc, contexts[0], CORE) : NULL;
        wglMakeCurrent(NULL, NULL);
        wglDeleteContext(first);
    } else {
        contexts[0] = first;
        contexts[1] = wglCreateContext(dc);
        EXPECT(contexts[1] && wglShareLists(contexts[0], contexts[1]));
    }
    EXPECT(contexts[1] && contexts_make_current(NULL, 0) == 0);
}

void contexts_close(void)
{
    wglMakeCurrent(NULL, NULL);
    wglDeleteContext(contexts[1]);
    wglDeleteContext(contexts[0]);
    ReleaseDC(window, dc);
    DestroyWindow(window);
}

#else
typedef int not_on_this_system;
#endif
