/* A host that draws with OpenGL: it clears its picture, Welkin draws the weather, and the host reads the pixels.
 *
 *     opengl_host shared|host|window core|compatibility PICTURE.ppm
 *
 * `shared` and `host` are Welkin's two modes, into a texture; `window` is the host's context and framebuffer 0. */
#include "contexts.h"
#include "scene.h"

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#endif
#include <GL/gl.h>
#include <GL/glext.h>

/* Functions that OpenGL 1.1 does not have. */
static PFNGLGENFRAMEBUFFERSPROC gen_framebuffers;
static PFNGLBINDFRAMEBUFFERPROC bind_framebuffer;
static PFNGLFRAMEBUFFERTEXTURE2DPROC framebuffer_texture;

static void load(void *function, const char *name)
{
    const void *address = contexts_get_proc(NULL, name);
    EXPECT(address);
    memcpy(function, &address, sizeof address);
}

static GLuint make_picture(void)
{
    GLuint texture = 0, framebuffer = 0;
    load(&gen_framebuffers, "glGenFramebuffers");
    load(&bind_framebuffer, "glBindFramebuffer");
    load(&framebuffer_texture, "glFramebufferTexture2D");
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, WIDTH, HEIGHT, 0, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    gen_framebuffers(1, &framebuffer);
    bind_framebuffer(GL_FRAMEBUFFER, framebuffer);
    framebuffer_texture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    return texture;
}

int main(int argc, char **argv)
{
    static unsigned char pixels[WIDTH * HEIGHT * 4];
    wk_opengl_host_desc desc = WK_OPENGL_HOST_DESC_INIT;
    wk_opengl_target target = WK_OPENGL_TARGET_INIT;
    wk_frame frame = WK_FRAME_INIT;
    wk_device *device = NULL;
    wk_context *context = NULL;
    wk_view *view = NULL;
    int y;
    EXPECT(argc == 4);
    contexts_open(WIDTH, HEIGHT, strcmp(argv[2], "core") == 0);
    printf("%s, %s\n", (const char *)glGetString(GL_RENDERER), (const char *)glGetString(GL_VERSION));
    desc.get_proc = contexts_get_proc;
    desc.make_current = contexts_make_current;
    desc.mode = strcmp(argv[1], "shared") == 0 ? WK_OPENGL_SHARED : WK_OPENGL_HOST_CONTEXT;
    CHECK(wk_device_create_opengl(&desc, &device));
    CHECK(wk_context_create(device, NULL, &context));
    CHECK(wk_view_create(context, NULL, &view));
    scene_weather(context);
    if (strcmp(argv[1], "window") == 0) {
        target.color.kind = WK_OPENGL_FRAMEBUFFER;
    } else {
        target.color.kind = WK_OPENGL_TEXTURE;
        target.color.name = make_picture();
    }
    target.width = WIDTH;
    target.height = HEIGHT;
    glClearColor(0.0f, 0.0f, 0.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    scene_frame(&frame, &target);
    CHECK(wk_view_record(view, &frame, WK_STAGE_ALL));
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    for (y = 0; y < HEIGHT; y++) /* OpenGL's first row is the lowest */
        glReadPixels(0, HEIGHT - 1 - y, WIDTH, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixels + 4 * WIDTH * y);
    EXPECT(glGetError() == GL_NO_ERROR);
    scene_look(pixels);
    scene_write(argv[3], pixels, WIDTH, HEIGHT);
    CHECK(wk_view_destroy(view));
    CHECK(wk_context_destroy(context));
    CHECK(wk_device_destroy(device));
    contexts_close();
    printf("ok\n");
    return 0;
}
