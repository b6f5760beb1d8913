/* Textures and framebuffers of the host's picture. */
#include "picture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "shaders.h"

static GLuint texture(GLint format, int width, int height, GLenum layout, GLenum type)
{
    GLuint name;
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, type, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    return name;
}

static GLuint framebuffer(GLuint color, GLuint depth)
{
    GLuint name;
    glGenFramebuffers(1, &name);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
    if (depth)
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
    return name;
}

bool picture_create(picture *p, int shown_width, int shown_height, int finer)
{
    int width = shown_width * finer, height = shown_height * finer;
    *p = (picture){.width = width, .height = height, .shown_width = shown_width, .shown_height = shown_height,
                   .reversed = glClipControl != NULL};
    p->color = texture(GL_RGBA16F, width, height, GL_RGBA, GL_HALF_FLOAT);
    p->depth = texture(GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    p->shown = texture(GL_RGBA8, shown_width, shown_height, GL_RGBA, GL_UNSIGNED_BYTE);
    p->classes = texture(GL_R8, width, height, GL_RED, GL_UNSIGNED_BYTE);
    p->frame = framebuffer(p->color, p->depth);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, p->classes, 0);
    const GLenum outputs[2] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, outputs);
    bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    p->shown_frame = framebuffer(p->shown, 0);
    complete = complete && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glGenVertexArrays(1, &p->array);
    p->program = gl_program(PRESENT_VERTEX, PRESENT_FRAGMENT, NULL);
    if (!complete)
        fprintf(stderr, "this OpenGL cannot draw to %d x %d half floats\n", width, height);
    return complete;
}

void picture_destroy(picture *p)
{
    GLuint textures[4] = {p->color, p->depth, p->classes, p->shown}, frames[2] = {p->frame, p->shown_frame};
    glDeleteFramebuffers(2, frames);
    glDeleteTextures(4, textures);
    glDeleteVertexArrays(1, &p->array);
    glDeleteProgram(p->program);
    *p = (picture){0};
}

void picture_present(const picture *p, float exposure)
{
    glBindFramebuffer(GL_FRAMEBUFFER, p->shown_frame);
    glViewport(0, 0, p->shown_width, p->shown_height);
    glUseProgram(p->program);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, p->color);
    glUniform1i(glGetUniformLocation(p->program, "picture"), 0);
    glUniform1i(glGetUniformLocation(p->program, "finer"), p->width / p->shown_width);
    glUniform1f(glGetUniformLocation(p->program, "exposure"), exposure);
    glUniform1f(glGetUniformLocation(p->program, "grain"), p->plain ? 0.0f : 1.0f);
    glBindVertexArray(p->array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

void picture_read(const picture *p, uint8_t *rgb)
{
    size_t row = (size_t)p->shown_width * 3;
    uint8_t *spare = malloc(row);
    glBindFramebuffer(GL_FRAMEBUFFER, p->shown_frame);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, p->shown_width, p->shown_height, GL_RGB, GL_UNSIGNED_BYTE, rgb);
    /* OpenGL's first row is the bottom one. */
    for (int y = 0; spare && y < p->shown_height / 2; y++) {
        uint8_t *top = rgb + (size_t)y * row, *bottom = rgb + (size_t)(p->shown_height - 1 - y) * row;
        memcpy(spare, top, row);
        memcpy(top, bottom, row);
        memcpy(bottom, spare, row);
    }
    free(spare);
}
