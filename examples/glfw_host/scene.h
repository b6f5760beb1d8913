/* The host's world on the GPU, and its drawing: the part that a simulator has before it has weather. */
#ifndef SCENE_H
#define SCENE_H

#include "gl.h"
#include "ground.h"
#include "light.h"

typedef struct camera {
    vec3 position; /* m, world */
    vec3 ahead;    /* unit vector */
    double fov_y;  /* rad */
} camera;

/* Objects that stand in some pictures only. */
typedef enum extra { NO_EXTRA, BRIDGE, BARN, VESSEL, EXTRAS } extra;

typedef struct scene {
    ground ground;
    mesh mesh;
    GLsizei ground_indices, object_indices;
    GLsizei extra_first[EXTRAS], extra_indices[EXTRAS];
    extra extra;
    bool empty;    /* draw nothing: for views from space and over the sea */
    bool landless; /* draw objects without ground */
    bool at_sea;   /* draw the extra object alone */
    GLuint array, vertices, indices, sunlit;
    GLuint shadow_texture, shadow_frame;
    GLuint program, shadow_program;
    size_t vessel_vertex; /* index of the vessel's first vertex; the vessel's vertices are the last */
    vec3 vessel_at; /* position of the vessel, m */
    vec3 shaded_for; /* the sun's direction for which the terrain's shadows were computed */
    float *lit;
} scene;

bool scene_create(scene *s, const char *terrain_png);
void scene_destroy(scene *s);

/* Moves the vessel to a pose. */
void scene_place_vessel(scene *s, mat4 pose);

/* World to eye, rotation only. */
mat4 camera_view(const camera *c);

/*
 * Eye to clip, far plane at infinity. Where OpenGL supports it, depth is reversed (near 1, far 0) in zero-to-one clip
 * space; otherwise it is OpenGL's usual depth.
 */
mat4 camera_projection(const camera *c, double aspect, bool reversed);

/* Clears the bound framebuffer and draws the world into it. */
void scene_draw(scene *s, const camera *c, const light *l, int width, int height, bool reversed, GLuint framebuffer);

#endif
