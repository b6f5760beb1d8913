// The host's own world: a mesh with vertex colours, lit by one sun and a sky of one colour. It uses nothing of Welkin.

struct Host {
    view_projection: mat4x4f, // camera-relative
    sun: vec3f,               // unit vector towards the sun
    pad0: f32,
    sun_light: vec3f,         // illuminance of the sun on a surface facing it, lux
    pad1: f32,
    sky_light: vec3f,         // illuminance of the sky on level ground, lux
    pad2: f32,
}

@group(0) @binding(0) var<uniform> host: Host;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) albedo: vec3f,
    @location(2) made_of: f32,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) albedo: vec3f, @location(3) made_of: f32) -> Varying {
    return Varying(host.view_projection * vec4f(position, 1.0), normal, albedo, made_of);
}

struct Drawn {
    @location(0) color: vec4f,
    // Surface class of each pixel, which Welkin reads: the number of the class, divided by 255.
    @location(1) made_of: vec4f,
}

@fragment
fn fragment(in: Varying) -> Drawn {
    let n = normalize(in.normal);
    // Surfaces that face down are lit by the ground.
    let up = 0.5 + 0.5 * n.z;
    let light = host.sun_light * max(dot(n, host.sun), 0.0) + host.sky_light * mix(0.12, 1.0, up);
    return Drawn(vec4f(in.albedo * light / 3.14159265, 1.0), vec4f(in.made_of / 255.0));
}
