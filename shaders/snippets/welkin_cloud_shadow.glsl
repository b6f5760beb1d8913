// For a host's own materials (GLSL 3.30, GLSL ES 3.00): share of the direct light of sun or moon that clouds let
// through to a position, from the shadow map that Welkin hands over.
//   float share = welkin_cloud_shadow(shadow_map, uv, camera_uv, height, even);
//   direct_light *= share / even.x; // if direct_light is the mean over positions, as Welkin's queries return it
// `uv` and `height`: position in the host's world times the rows of uv_from_world and height_from_world. `even`:
// mean_share, told and top_m. The sampler must filter linearly and repeat.

float welkin_cloud_shadow(sampler2D map, vec2 uv, vec2 camera_uv, float height, vec3 even) {
    vec2 away = abs(uv - camera_uv);
    // Weight of the map against the mean share. It falls to 0 between 0.4 and 0.46 periods of the map from the camera,
    // and over the highest 100 m below top_m.
    float far = max(away.x, away.y);
    float told = even.y * clamp((0.46 - far) / 0.06, 0.0, 1.0) * clamp((even.z - height) / 100.0, 0.0, 1.0);
    return mix(even.x, textureLod(map, uv, 0.0).r, told);
}
