// The host's own world: a mesh with vertex colours under one sun, a sky of one colour and two lamps. Nothing of Welkin.

struct Lamp {
    position: vec3f,  // camera-relative
    full: f32,        // cosine of where its beam is full
    direction: vec3f,
    end: f32,         // cosine of where it has ended
    intensity: vec3f, // cd
    pad: f32,
}

struct Host {
    view_projection: mat4x4f, // camera-relative
    sun: vec3f,               // towards it
    pad0: f32,
    sun_light: vec3f,         // illuminance that arrives, lux
    pad1: f32,
    sky_light: vec3f,         // illuminance of the sky on level ground, lux
    pad2: f32,
    lamps: array<Lamp, 2>,
}

@group(0) @binding(0) var<uniform> host: Host;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) albedo: vec3f,
    @location(2) place: vec3f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) albedo: vec3f) -> Varying {
    return Varying(host.view_projection * vec4f(position, 1.0), normal, albedo, position);
}

@fragment
fn fragment(in: Varying) -> @location(0) vec4f {
    let n = normalize(in.normal);
    var light = host.sun_light * max(dot(n, host.sun), 0.0) + host.sky_light * (0.5 + 0.5 * n.z);
    for (var i = 0; i < 2; i++) {
        let lamp = host.lamps[i];
        let to = in.place - lamp.position;
        let d = normalize(to);
        let beam = smoothstep(lamp.end, lamp.full, dot(d, lamp.direction));
        light += lamp.intensity * (beam * max(-dot(n, d), 0.0) / dot(to, to));
    }
    return vec4f(in.albedo * light / 3.14159265, 1.0);
}
