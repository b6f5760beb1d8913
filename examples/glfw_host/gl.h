/* OpenGL 3.3 core through function pointers, loaded from the library that created the context (GLFW or EGL). */
#ifndef GL_H
#define GL_H

#include <stdbool.h>

#include <GL/glcorearb.h>

#include "platform.h"

/* Every OpenGL function that the host calls: name, type. */
#define GL_FUNCTIONS(X)                                                \
    X(glActiveTexture, PFNGLACTIVETEXTUREPROC)                         \
    X(glAttachShader, PFNGLATTACHSHADERPROC)                           \
    X(glBindBuffer, PFNGLBINDBUFFERPROC)                               \
    X(glBindFramebuffer, PFNGLBINDFRAMEBUFFERPROC)                     \
    X(glBindTexture, PFNGLBINDTEXTUREPROC)                             \
    X(glBindVertexArray, PFNGLBINDVERTEXARRAYPROC)                     \
    X(glBlitFramebuffer, PFNGLBLITFRAMEBUFFERPROC)                     \
    X(glBufferData, PFNGLBUFFERDATAPROC)                               \
    X(glBufferSubData, PFNGLBUFFERSUBDATAPROC)                         \
    X(glCheckFramebufferStatus, PFNGLCHECKFRAMEBUFFERSTATUSPROC)       \
    X(glClear, PFNGLCLEARPROC)                                         \
    X(glClearColor, PFNGLCLEARCOLORPROC)                               \
    X(glClearDepth, PFNGLCLEARDEPTHPROC)                               \
    X(glCompileShader, PFNGLCOMPILESHADERPROC)                         \
    X(glCreateProgram, PFNGLCREATEPROGRAMPROC)                         \
    X(glCreateShader, PFNGLCREATESHADERPROC)                           \
    X(glDeleteBuffers, PFNGLDELETEBUFFERSPROC)                         \
    X(glDeleteFramebuffers, PFNGLDELETEFRAMEBUFFERSPROC)               \
    X(glDeleteProgram, PFNGLDELETEPROGRAMPROC)                         \
    X(glDeleteShader, PFNGLDELETESHADERPROC)                           \
    X(glDeleteTextures, PFNGLDELETETEXTURESPROC)                       \
    X(glDeleteVertexArrays, PFNGLDELETEVERTEXARRAYSPROC)               \
    X(glDepthFunc, PFNGLDEPTHFUNCPROC)                                 \
    X(glDisable, PFNGLDISABLEPROC)                                     \
    X(glDrawBuffer, PFNGLDRAWBUFFERPROC)                               \
    X(glDrawArrays, PFNGLDRAWARRAYSPROC)                               \
    X(glDrawBuffers, PFNGLDRAWBUFFERSPROC)                             \
    X(glDrawElements, PFNGLDRAWELEMENTSPROC)                           \
    X(glEnable, PFNGLENABLEPROC)                                       \
    X(glEnableVertexAttribArray, PFNGLENABLEVERTEXATTRIBARRAYPROC)     \
    X(glFinish, PFNGLFINISHPROC)                                       \
    X(glFramebufferTexture2D, PFNGLFRAMEBUFFERTEXTURE2DPROC)           \
    X(glGenBuffers, PFNGLGENBUFFERSPROC)                               \
    X(glGenFramebuffers, PFNGLGENFRAMEBUFFERSPROC)                     \
    X(glGenTextures, PFNGLGENTEXTURESPROC)                             \
    X(glGenVertexArrays, PFNGLGENVERTEXARRAYSPROC)                     \
    X(glGetError, PFNGLGETERRORPROC)                                   \
    X(glGetProgramInfoLog, PFNGLGETPROGRAMINFOLOGPROC)                 \
    X(glGetProgramiv, PFNGLGETPROGRAMIVPROC)                           \
    X(glGetShaderInfoLog, PFNGLGETSHADERINFOLOGPROC)                   \
    X(glGetShaderiv, PFNGLGETSHADERIVPROC)                             \
    X(glGetString, PFNGLGETSTRINGPROC)                                 \
    X(glGetUniformLocation, PFNGLGETUNIFORMLOCATIONPROC)               \
    X(glLinkProgram, PFNGLLINKPROGRAMPROC)                             \
    X(glPixelStorei, PFNGLPIXELSTOREIPROC)                             \
    X(glPolygonOffset, PFNGLPOLYGONOFFSETPROC)                         \
    X(glReadBuffer, PFNGLREADBUFFERPROC)                               \
    X(glReadPixels, PFNGLREADPIXELSPROC)                               \
    X(glShaderSource, PFNGLSHADERSOURCEPROC)                           \
    X(glTexImage2D, PFNGLTEXIMAGE2DPROC)                               \
    X(glTexParameterfv, PFNGLTEXPARAMETERFVPROC)                       \
    X(glTexParameteri, PFNGLTEXPARAMETERIPROC)                         \
    X(glUniform1f, PFNGLUNIFORM1FPROC)                                 \
    X(glUniform1i, PFNGLUNIFORM1IPROC)                                 \
    X(glUniform2f, PFNGLUNIFORM2FPROC)                                 \
    X(glUniform3f, PFNGLUNIFORM3FPROC)                                 \
    X(glUniform3fv, PFNGLUNIFORM3FVPROC)                               \
    X(glUniformMatrix4fv, PFNGLUNIFORMMATRIX4FVPROC)                   \
    X(glUseProgram, PFNGLUSEPROGRAMPROC)                               \
    X(glVertexAttribPointer, PFNGLVERTEXATTRIBPOINTERPROC)             \
    X(glViewport, PFNGLVIEWPORTPROC)

#define GL_DECLARE(name, type) extern type name;
GL_FUNCTIONS(GL_DECLARE)
#undef GL_DECLARE

/* From OpenGL 4.5; NULL on older contexts. It allows reversed depth, which stays precise up to the horizon. */
extern PFNGLCLIPCONTROLPROC glClipControl;

/* Loads all functions. If a required one is missing, returns false and prints its name on stderr. */
bool gl_load(const platform *p);

/* Compiles and links a program. If its GLSL is wrong, prints the driver's message and exits. `fragment_end` continues a
 * long fragment shader, because C99 guarantees string literals of only 4095 characters; NULL for a short one. */
GLuint gl_program(const char *vertex, const char *fragment, const char *fragment_end);

#endif
