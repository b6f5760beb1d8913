/* The host's own GLSL. It knows nothing of weather: it draws a clear world in the light that it is given. */
#ifndef SHADERS_H
#define SHADERS_H

extern const char *const SCENE_VERTEX, *const SCENE_FRAGMENT, *const SCENE_FRAGMENT_END;
extern const char *const SHADOW_VERTEX, *const SHADOW_FRAGMENT;
extern const char *const PRESENT_VERTEX, *const PRESENT_FRAGMENT;

#endif
