/* OpenGL 3.3 core by function pointers, got from whoever made the context (GLFW or EGL). */
#ifndef GL_H
#define GL_H

#include <stdbool.h>

#include <GL/glcorearb.h>

#include "platform.h"

/* Every function that the host calls: name, type. */
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

/* OpenGL 4.5; NULL on older contexts. With it depth can be reversed, which keeps distance exact to the horizon. */
extern PFNGLCLIPCONTROLPROC glClipControl;

/* Gets all of them; false, with the name on stderr, if one that is needed is missing. */
bool gl_load(const platform *p);

/* Compiles and links; exits with the driver's message if the program's own GLSL is wrong. */
/* A long fragment shader goes on in fragment_end: C99 promises no string of more than 4095 characters. Else NULL. */
GLuint gl_program(const char *vertex, const char *fragment, const char *fragment_end);

#endif
