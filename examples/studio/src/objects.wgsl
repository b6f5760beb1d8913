// Boxes in the world: a machine, a hall, posts. Lit by sun, moon and sky as Welkin tells hosts.

struct Light {
    // From places relative to the eye to the picture.
    clip: mat4x4f,
    // Directions to sun and moon, and their lux on a surface that faces them.
    sun: vec4f,
    sun_lux: vec4f,
    moon: vec4f,
    moon_lux: vec4f,
    // Lux of the sky on level ground.
    sky_lux: vec4f,
}

@group(0) @binding(0) var<uniform> light: Light;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) albedo: vec3f,
}

// A corner of a box: six faces of two triangles. The box has its middle, relative to the eye, and half its sides.
@vertex
fn corner(
    @builtin(vertex_index) index: u32,
    @location(0) middle: vec3f,
    @location(1) east: vec3f,
    @location(2) north: vec3f,
    @location(3) up: vec3f,
    @location(4) albedo: vec3f,
) -> Varying {
    let square = array(vec2f(-1.0, -1.0), vec2f(1.0, -1.0), vec2f(1.0, 1.0), vec2f(-1.0, -1.0), vec2f(1.0, 1.0), vec2f(-1.0, 1.0));
    let at = square[index % 6u];
    let side = f32((index / 6u) % 2u) * 2.0 - 1.0;
    let axes = mat3x3f(east, north, up);
    let axis = index / 12u;
    let normal = side * axes[axis];
    let place = middle + normal + at.x * axes[(axis + 1u) % 3u] + at.y * axes[(axis + 2u) % 3u];
    return Varying(light.clip * vec4f(place, 1.0), normalize(normal), albedo);
}

@fragment
fn lit(in: Varying) -> @location(0) vec4f {
    let normal = normalize(in.normal);
    let open = 0.5 + 0.5 * normal.z;
    let direct = light.sun_lux.rgb * max(dot(normal, light.sun.xyz), 0.0) + light.moon_lux.rgb * max(dot(normal, light.moon.xyz), 0.0);
    return vec4f(in.albedo * (direct + light.sky_lux.rgb * mix(0.12, 1.0, open)) / 3.14159265, 1.0);
}
