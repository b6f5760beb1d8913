#include "gl_target.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl31.h>
#include <dlfcn.h>

#ifndef EGL_PLATFORM_SURFACELESS_MESA
#define EGL_PLATFORM_SURFACELESS_MESA 0x31DD
#endif
/* EGL_ANGLE_platform_angle: SwiftShader by Vulkan. */
#define ANGLE_PLATFORM 0x3202
#define ANGLE_TYPE 0x3203
#define ANGLE_TYPE_VULKAN 0x3450
#define ANGLE_DEVICE_TYPE 0x3209
#define ANGLE_DEVICE_SWIFTSHADER 0x3487

/* Found by name, so that DRIVERS_EGL can name another implementation than the system's: ANGLE's libEGL.so. */
#define EGL_FUNCTIONS(X)                                                                                               \
    X(PFNEGLGETPROCADDRESSPROC, eglGetProcAddress)                                                                     \
    X(PFNEGLQUERYSTRINGPROC, eglQueryString)                                                                           \
    X(PFNEGLINITIALIZEPROC, eglInitialize)                                                                             \
    X(PFNEGLTERMINATEPROC, eglTerminate)                                                                               \
    X(PFNEGLBINDAPIPROC, eglBindAPI)                                                                                   \
    X(PFNEGLCHOOSECONFIGPROC, eglChooseConfig)                                                                         \
    X(PFNEGLCREATECONTEXTPROC, eglCreateContext)                                                                       \
    X(PFNEGLDESTROYCONTEXTPROC, eglDestroyContext)                                                                     \
    X(PFNEGLCREATEPBUFFERSURFACEPROC, eglCreatePbufferSurface)                                                         \
    X(PFNEGLMAKECURRENTPROC, eglMakeCurrent)                                                                           \
    X(PFNEGLGETERRORPROC, eglGetError)

#define GL_FUNCTIONS(X)                                                                                                \
    X(PFNGLGENTEXTURESPROC, glGenTextures)                                                                             \
    X(PFNGLBINDTEXTUREPROC, glBindTexture)                                                                             \
    X(PFNGLTEXPARAMETERIPROC, glTexParameteri)                                                                         \
    X(PFNGLTEXSTORAGE2DPROC, glTexStorage2D)                                                                           \
    X(PFNGLTEXIMAGE2DPROC, glTexImage2D)                                                                               \
    X(PFNGLTEXSUBIMAGE2DPROC, glTexSubImage2D)                                                                         \
    X(PFNGLPIXELSTOREIPROC, glPixelStorei)                                                                             \
    X(PFNGLGENFRAMEBUFFERSPROC, glGenFramebuffers)                                                                     \
    X(PFNGLBINDFRAMEBUFFERPROC, glBindFramebuffer)                                                                     \
    X(PFNGLFRAMEBUFFERTEXTURE2DPROC, glFramebufferTexture2D)                                                           \
    X(PFNGLREADPIXELSPROC, glReadPixels)                                                                               \
    X(PFNGLGETSTRINGPROC, glGetString)                                                                                 \
    X(PFNGLGETERRORPROC, glGetError)

struct gl_target {
#define MEMBER(type, name) type name;
    EGL_FUNCTIONS(MEMBER)
    GL_FUNCTIONS(MEMBER)
#undef MEMBER
    EGLDisplay display;
    EGLSurface surface;
    EGLContext context;
    int width, height;
    GLuint color, depth, classes, framebuffer;
};

/* Function pointers as data pointers, without a cast that ISO C forbids. */
#define ASSIGN(function, address)                                                                                      \
    do {                                                                                                               \
        void *at = (void *)(address);                                                                                  \
        memcpy(&(function), &at, sizeof at);                                                                           \
    } while (0)

const void *gl_target_proc(void *user, const char *name)
{
    const gl_target *t = user;
    void (*function)(void) = t->eglGetProcAddress(name);
    const void *address;
    memcpy(&address, &function, sizeof address);
    return address;
}

static bool load_egl(gl_target *t)
{
    const char *name = getenv("DRIVERS_EGL");
    void *library = dlopen(name ? name : "libEGL.so.1", RTLD_NOW);
    if (!library) {
        fprintf(stderr, "%s\n", dlerror());
        return false;
    }
#define LOAD(type, function) ASSIGN(t->function, dlsym(library, #function));
    EGL_FUNCTIONS(LOAD)
#undef LOAD
    return t->eglGetProcAddress && t->eglInitialize && t->eglMakeCurrent;
}

static bool has(const char *extensions, const char *name)
{
    return extensions && strstr(extensions, name);
}

static bool open_display(gl_target *t)
{
    const char *client = t->eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    PFNEGLGETPLATFORMDISPLAYEXTPROC of_platform;
    ASSIGN(of_platform, gl_target_proc(t, "eglGetPlatformDisplayEXT"));
    if (has(client, "EGL_ANGLE_platform_angle")) {
        static const EGLint swiftshader[] = {ANGLE_TYPE, ANGLE_TYPE_VULKAN, ANGLE_DEVICE_TYPE, ANGLE_DEVICE_SWIFTSHADER, EGL_NONE};
        t->display = of_platform(ANGLE_PLATFORM, (void *)EGL_DEFAULT_DISPLAY, swiftshader);
    } else if (has(client, "EGL_MESA_platform_surfaceless")) {
        t->display = of_platform(EGL_PLATFORM_SURFACELESS_MESA, (void *)EGL_DEFAULT_DISPLAY, NULL);
    }
    if (t->display && t->eglInitialize(t->display, NULL, NULL))
        return true;
    fprintf(stderr, "EGL opens no display (0x%x)\n", (unsigned)t->eglGetError());
    t->display = EGL_NO_DISPLAY;
    return false;
}

static bool open_context(gl_target *t, const char *way)
{
    bool es = strncmp(way, "es", 2) == 0;
    const char *digits = way + (es ? 2 : 4);
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                             es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
    const EGLint tiny[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    EGLint attributes[7] = {EGL_CONTEXT_MAJOR_VERSION, digits[0] - '0', EGL_CONTEXT_MINOR_VERSION, digits[1] - '0',
                            es ? EGL_NONE : EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLConfig config;
    EGLint count = 0;
    if (!t->eglBindAPI(es ? EGL_OPENGL_ES_API : EGL_OPENGL_API) ||
        !t->eglChooseConfig(t->display, wanted, &config, 1, &count) || count < 1)
        return false;
    t->context = t->eglCreateContext(t->display, config, EGL_NO_CONTEXT, attributes);
    t->surface = t->eglCreatePbufferSurface(t->display, config, tiny);
    return t->context && t->eglMakeCurrent(t->display, t->surface, t->surface, t->context);
}

static GLuint texture(gl_target *t, GLenum format)
{
    GLuint name;
    t->glGenTextures(1, &name);
    t->glBindTexture(GL_TEXTURE_2D, name);
    t->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    t->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    t->glTexStorage2D(GL_TEXTURE_2D, 1, format, t->width, t->height);
    return name;
}

/* Creates an image; where a version lacks immutable storage (OpenGL before 4.2), an image of one level. */
static GLuint image(gl_target *t, GLenum internal, GLenum format, GLenum type)
{
    GLuint name;
    if (t->glTexStorage2D)
        return texture(t, internal);
    t->glGenTextures(1, &name);
    t->glBindTexture(GL_TEXTURE_2D, name);
    t->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    t->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    t->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    t->glTexImage2D(GL_TEXTURE_2D, 0, (GLint)internal, t->width, t->height, 0, format, type, NULL);
    return name;
}

static bool make_images(gl_target *t)
{
    GLenum fault;
#define LOAD(type, function) ASSIGN(t->function, gl_target_proc(t, #function));
    GL_FUNCTIONS(LOAD)
#undef LOAD
    t->color = image(t, GL_RGBA16F, GL_RGBA, GL_FLOAT);
    t->depth = image(t, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT);
    t->classes = image(t, GL_R8, GL_RED, GL_UNSIGNED_BYTE);
    t->glGenFramebuffers(1, &t->framebuffer);
    t->glBindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    t->glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, t->color, 0);
    fault = t->glGetError();
    if (fault)
        fprintf(stderr, "OpenGL error 0x%x while images were made\n", fault);
    return fault == 0;
}

gl_target *gl_target_open(const char *way, int width, int height)
{
    gl_target *t = calloc(1, sizeof *t);
    if (!t)
        return NULL;
    t->width = width, t->height = height;
    if (load_egl(t) && open_display(t)) {
        if (open_context(t, way) && make_images(t)) {
            printf("context\t%s\n", (const char *)t->glGetString(GL_VERSION));
            return t;
        }
        fprintf(stderr, "EGL makes no context %s (0x%x)\n", way, (unsigned)t->eglGetError());
    }
    gl_target_close(t);
    return NULL;
}

void gl_target_close(gl_target *t)
{
    if (!t)
        return;
    if (t->display) {
        t->eglMakeCurrent(t->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (t->context)
            t->eglDestroyContext(t->display, t->context);
        t->eglTerminate(t->display);
    }
    free(t);
}

unsigned gl_target_color(const gl_target *t) { return t->color; }
unsigned gl_target_depth(const gl_target *t) { return t->depth; }
unsigned gl_target_classes(const gl_target *t) { return t->classes; }

bool gl_target_write(gl_target *t, const float *color, const float *depth, const unsigned char *classes)
{
    t->glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    t->glBindTexture(GL_TEXTURE_2D, t->color);
    t->glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, t->width, t->height, GL_RGBA, GL_FLOAT, color);
    t->glBindTexture(GL_TEXTURE_2D, t->depth);
    t->glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, t->width, t->height, GL_DEPTH_COMPONENT, GL_FLOAT, depth);
    t->glBindTexture(GL_TEXTURE_2D, t->classes);
    t->glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, t->width, t->height, GL_RED, GL_UNSIGNED_BYTE, classes);
    return t->glGetError() == 0;
}

bool gl_target_read(gl_target *t, float *color)
{
    t->glBindFramebuffer(GL_FRAMEBUFFER, t->framebuffer);
    t->glReadPixels(0, 0, t->width, t->height, GL_RGBA, GL_FLOAT, color);
    return t->glGetError() == 0;
}
