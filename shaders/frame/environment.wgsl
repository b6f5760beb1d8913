// Draws one face of the cube map of the surroundings of the camera, for reflections in the host's own objects: the
// composition's sky, clouds, fog and planet's ground, without the discs of sun and moon and without stars.
//!include "common/guarded.wgsl"
//!include "frame/composite.wgsl"

// One face of the cube map.
struct EnvironmentFace {
    // The face's middle, and the vectors from there to its right and lower edges (`right`, `down`); axes are east,
    // north, up.
    forward: vec3f,
    // Value of a texel per cd/m^2 of light.
    scale: f32,
    right: vec3f,
    pad0: f32,
    down: vec3f,
    pad1: f32,
}

@group(3) @binding(0) var<uniform> face: EnvironmentFace;

// Colour for the host, and for the filter of the rougher levels.
struct EnvironmentTexel {
    @location(0) shown: vec4f,
    @location(1) source: vec4f,
}

@fragment
fn environment(in: FullscreenVarying) -> EnvironmentTexel {
    // Draws every part, even those that the plan leaves out of the picture. Drops near the eye are part of the fog
    // here.
    drawn = vec4f(1.0, 1.0, 1.0, 0.0);
    let at = in.uv * 2.0 - 1.0;
    let direction = normalize(face.forward + at.x * face.right + at.y * face.down);
    let light = weather_over(ViewRay(vec3f(0.0), direction, 1.0), RANGE_SKY, RANGE_SKY, sky_sample_toward(direction)).light;
    // The greatest half float is 65504.
    let texel = vec4f(capped(light * face.scale, 65504.0), 1.0);
    return EnvironmentTexel(texel, texel);
}
