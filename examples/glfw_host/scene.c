/* Uploads the world, updates its shadows and draws it. */
#include "scene.h"

#include <stdio.h>
#include <stdlib.h>

#include "objects.h"
#include "shaders.h"
#include "vessel.h"

#define NEAR_M 0.5
#define SHADOW_SIZE 2048
#define SHADOW_HALF_M 70.0 /* around the pad */

static void attribute(GLuint index, GLint count, size_t offset)
{
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, sizeof(vertex), (const void *)offset);
}

static void upload(scene *s)
{
    glGenVertexArrays(1, &s->array);
    glBindVertexArray(s->array);
    glGenBuffers(1, &s->vertices);
    glBindBuffer(GL_ARRAY_BUFFER, s->vertices);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(s->mesh.vertex_count * sizeof(vertex)), s->mesh.vertices, GL_STATIC_DRAW);
    attribute(0, 3, offsetof(vertex, position));
    attribute(1, 3, offsetof(vertex, normal));
    attribute(2, 3, offsetof(vertex, albedo));
    attribute(3, 1, offsetof(vertex, road));
    glGenBuffers(1, &s->sunlit);
    glBindBuffer(GL_ARRAY_BUFFER, s->sunlit);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(s->mesh.vertex_count * sizeof(float)), NULL, GL_DYNAMIC_DRAW);
    glEnableVertexAttribArray(4);
    glVertexAttribPointer(4, 1, GL_FLOAT, GL_FALSE, sizeof(float), NULL);
    glGenBuffers(1, &s->indices);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, s->indices);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(s->mesh.index_count * sizeof(uint32_t)), s->mesh.indices,
                 GL_STATIC_DRAW);
    glBindVertexArray(0);
}

static void create_shadow_map(scene *s)
{
    const float outside[4] = {1, 1, 1, 1};
    glGenTextures(1, &s->shadow_texture);
    glBindTexture(GL_TEXTURE_2D, s->shadow_texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, SHADOW_SIZE, SHADOW_SIZE, 0, GL_DEPTH_COMPONENT, GL_FLOAT, NULL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, outside);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glGenFramebuffers(1, &s->shadow_frame);
    glBindFramebuffer(GL_FRAMEBUFFER, s->shadow_frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, s->shadow_texture, 0);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

static void vessel_extra(const ground *g, mesh *m)
{
    (void)g;
    vessel_mesh(m);
}

bool scene_create(scene *s, const char *terrain_png)
{
    *s = (scene){0};
    if (!ground_load(&s->ground, terrain_png))
        return false;
    ground_mesh(&s->ground, &s->mesh);
    s->ground_indices = (GLsizei)s->mesh.index_count;
    objects_mesh(&s->ground, &s->mesh);
    s->object_indices = (GLsizei)s->mesh.index_count - s->ground_indices;
    void (*const extras[EXTRAS])(const ground *, mesh *) = {
        [BRIDGE] = objects_bridge_mesh, [BARN] = objects_barn_mesh, [VESSEL] = vessel_extra};
    for (int i = NO_EXTRA + 1; i < EXTRAS; i++) {
        s->extra_first[i] = (GLsizei)s->mesh.index_count;
        s->vessel_vertex = s->mesh.vertex_count;
        extras[i](&s->ground, &s->mesh);
        s->extra_indices[i] = (GLsizei)s->mesh.index_count - s->extra_first[i];
    }
    s->lit = malloc(s->mesh.vertex_count * sizeof *s->lit);
    if (!s->lit) {
        fprintf(stderr, "out of memory\n");
        return false;
    }
    upload(s);
    create_shadow_map(s);
    s->program = gl_program(SCENE_VERTEX, SCENE_FRAGMENT, SCENE_FRAGMENT_END);
    s->shadow_program = gl_program(SHADOW_VERTEX, SHADOW_FRAGMENT, NULL);
    return true;
}

void scene_destroy(scene *s)
{
    glDeleteProgram(s->program);
    glDeleteProgram(s->shadow_program);
    glDeleteFramebuffers(1, &s->shadow_frame);
    glDeleteTextures(1, &s->shadow_texture);
    GLuint buffers[3] = {s->vertices, s->indices, s->sunlit};
    glDeleteBuffers(3, buffers);
    glDeleteVertexArrays(1, &s->array);
    mesh_free(&s->mesh);
    ground_free(&s->ground);
    free(s->lit);
    *s = (scene){0};
}

void scene_place_vessel(scene *s, mat4 pose)
{
    size_t count = s->mesh.vertex_count - s->vessel_vertex;
    vertex *moved = malloc(count * sizeof *moved);
    if (!moved)
        return;
    for (size_t i = 0; i < count; i++) {
        moved[i] = s->mesh.vertices[s->vessel_vertex + i];
        float *p = moved[i].position, *n = moved[i].normal;
        vec3 at = transform_point(pose, vec(p[0], p[1], p[2])), out = transform_direction(pose, vec(n[0], n[1], n[2]));
        p[0] = (float)at.x, p[1] = (float)at.y, p[2] = (float)at.z;
        n[0] = (float)out.x, n[1] = (float)out.y, n[2] = (float)out.z;
    }
    glBindBuffer(GL_ARRAY_BUFFER, s->vertices);
    glBufferSubData(GL_ARRAY_BUFFER, (GLintptr)(s->vessel_vertex * sizeof *moved), (GLsizeiptr)(count * sizeof *moved), moved);
    free(moved);
    s->vessel_at = transform_point(pose, vec(0, 0, 0));
}

mat4 camera_view(const camera *c)
{
    return look_along(c->ahead, vec(0, 0, 1));
}

mat4 camera_projection(const camera *c, double aspect, bool reversed)
{
    double f = 1.0 / tan(0.5 * c->fov_y);
    mat4 p = {{f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, reversed ? 0.0 : -1.0, -1, 0, 0, reversed ? NEAR_M : -2.0 * NEAR_M, 0}};
    return p;
}

/* Shadows cast by the terrain, one value per vertex, computed again when the sun has moved by a quarter of a degree. */
static void shade_terrain(scene *s, vec3 sun)
{
    if (dot(sun, s->shaded_for) > cos(RAD(0.25)))
        return;
    s->shaded_for = sun;
    for (size_t i = 0; i < s->mesh.vertex_count; i++) {
        const float *p = s->mesh.vertices[i].position;
        s->lit[i] = i < s->vessel_vertex ? (float)ground_sunlit(&s->ground, vec(p[0], p[1], p[2] + 1.0), sun) : 1.0f;
    }
    glBindBuffer(GL_ARRAY_BUFFER, s->sunlit);
    glBufferSubData(GL_ARRAY_BUFFER, 0, (GLsizeiptr)(s->mesh.vertex_count * sizeof(float)), s->lit);
}

/* World to shadow clip space: a square around the pad or the vessel, seen along the sun's rays. */
static mat4 shadow_matrix(const scene *s, vec3 sun)
{
    double x, y;
    ground_pad(&x, &y);
    vec3 middle = s->extra == VESSEL ? s->vessel_at : vec(x, y, s->ground.pad_height);
    vec3 up = fabs(sun.z) > 0.99 ? vec(0, 1, 0) : vec(0, 0, 1);
    mat4 view = multiply(look_along(scale(sun, -1.0), up), translation(scale(middle, -1.0)));
    mat4 box = identity();
    box.m[0] = box.m[5] = 1.0 / SHADOW_HALF_M;
    box.m[10] = -1.0 / (2.5 * SHADOW_HALF_M);
    return multiply(box, view);
}

static void draw_from(GLsizei first, GLsizei count)
{
    glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_INT, (const void *)((size_t)first * sizeof(uint32_t)));
}

static void draw(const scene *s, bool with_ground, bool objects)
{
    if (s->empty)
        return;
    if (with_ground && !s->landless && !s->at_sea)
        draw_from(0, s->ground_indices);
    if (objects) {
        if (!s->at_sea)
            draw_from(s->ground_indices, s->object_indices);
        draw_from(s->extra_first[s->extra], s->extra_indices[s->extra]);
    }
}

static void draw_shadows(scene *s, const float to_shadow[16])
{
    glBindFramebuffer(GL_FRAMEBUFFER, s->shadow_frame);
    glViewport(0, 0, SHADOW_SIZE, SHADOW_SIZE);
    glClearDepth(1.0);
    glDepthFunc(GL_LEQUAL);
    glClear(GL_DEPTH_BUFFER_BIT);
    glUseProgram(s->shadow_program);
    glUniformMatrix4fv(glGetUniformLocation(s->shadow_program, "to_shadow"), 1, GL_FALSE, to_shadow);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.5f, 2.0f);
    draw(s, false, true);
    glDisable(GL_POLYGON_OFFSET_FILL);
}

static void set_light(const scene *s, const light *l, const float to_shadow[16])
{
    GLuint p = s->program;
    double x, y;
    ground_pad(&x, &y);
    glUniform3f(glGetUniformLocation(p, "sun_direction"), (float)l->sun_direction.x, (float)l->sun_direction.y,
                (float)l->sun_direction.z);
    glUniform3fv(glGetUniformLocation(p, "sun_illuminance"), 1, l->illuminance);
    glUniform3fv(glGetUniformLocation(p, "ambient"), 9, l->ambient[0]);
    glUniform1f(glGetUniformLocation(p, "per_unit"), (float)(1.0 / l->cd_m2_per_unit));
    glUniform2f(glGetUniformLocation(p, "pad"), (float)x, (float)y);
    glUniformMatrix4fv(glGetUniformLocation(p, "to_shadow"), 1, GL_FALSE, to_shadow);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, s->shadow_texture);
    glUniform1i(glGetUniformLocation(p, "shadow_map"), 0);
}

static void set_vector(GLuint program, const char *name, vec3 v)
{
    glUniform3f(glGetUniformLocation(program, name), (float)v.x, (float)v.y, (float)v.z);
}

static void set_lamps(GLuint p, const lamp_pair *l)
{
    set_vector(p, "lamp_position[0]", l->position[0]);
    set_vector(p, "lamp_position[1]", l->position[1]);
    set_vector(p, "lamp_direction[0]", l->direction[0]);
    set_vector(p, "lamp_direction[1]", l->direction[1]);
    glUniform3fv(glGetUniformLocation(p, "lamp_intensity"), 1, l->intensity_cd);
    glUniform2f(glGetUniformLocation(p, "lamp_cosines"), (float)cos(RAD(l->outer_deg)), (float)cos(RAD(l->inner_deg)));
}

/* Sets the bridge's deck, which blocks the sky's light for what is below it. */
static void set_deck(const scene *s)
{
    solid boxes[BRIDGE_BOXES];
    objects_bridge(&s->ground, boxes);
    vec3 half = scale(boxes[0].size, s->extra == BRIDGE ? 0.5 : 0.0);
    set_vector(s->program, "deck_foot", transform_point(boxes[0].place, vec(0, 0, -0.5 * boxes[0].size.z)));
    set_vector(s->program, "deck_right", transform_direction(boxes[0].place, vec(1, 0, 0)));
    glUniform2f(glGetUniformLocation(s->program, "deck_half"), (float)half.x, (float)half.y);
}

void scene_draw(scene *s, const camera *c, const light *l, int width, int height, bool reversed, GLuint framebuffer)
{
    float to_shadow[16], to_clip[16];
    to_floats(to_shadow, shadow_matrix(s, l->sun_direction));
    to_floats(to_clip, multiply(camera_projection(c, (double)width / height, reversed), camera_view(c)));
    shade_terrain(s, l->sun_direction);
    glBindVertexArray(s->array);
    glEnable(GL_DEPTH_TEST);
    draw_shadows(s, to_shadow);

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    if (reversed)
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glClearColor(0, 0, 0, 1);
    glClearDepth(reversed ? 0.0 : 1.0);
    glDepthFunc(reversed ? GL_GREATER : GL_LESS);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glUseProgram(s->program);
    set_light(s, l, to_shadow);
    set_lamps(s->program, &l->lamps);
    set_deck(s);
    glUniform3f(glGetUniformLocation(s->program, "eye"), (float)c->position.x, (float)c->position.y, (float)c->position.z);
    glUniformMatrix4fv(glGetUniformLocation(s->program, "to_clip"), 1, GL_FALSE, to_clip);
    glUniform1i(glGetUniformLocation(s->program, "ground"), 1);
    draw(s, true, false);
    glUniform1i(glGetUniformLocation(s->program, "ground"), 0);
    draw(s, false, true);
    glDisable(GL_DEPTH_TEST);
    if (reversed)
        glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glBindVertexArray(0);
}
