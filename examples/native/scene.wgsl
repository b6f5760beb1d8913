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
    deck: array<vec4f, 2>,    // lowest and highest corner of a deck, camera-relative; 1 in the last: there is one
}

@group(0) @binding(0) var<uniform> host: Host;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) normal: vec3f,
    @location(1) albedo: vec3f,
    @location(2) place: vec3f,
    @location(3) made_of: f32,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) albedo: vec3f, @location(3) made_of: f32) -> Varying {
    return Varying(host.view_projection * vec4f(position, 1.0), normal, albedo, position, made_of);
}

// Part of the sky's light on level ground that a level rectangle hides, whose corner is `a` away over its height; as odd in
// both, sums of corners are rectangles (Howell, Catalog of Radiation Heat Transfer Configuration Factors, B-4).
fn hidden_by(a: vec2f) -> f32 {
    let r = inverseSqrt(1.0 + a * a);
    return (a.x * r.x * atan(a.y * r.x) + a.y * r.y * atan(a.x * r.y)) / 6.2831853;
}

// Share of the sky's light that a surface gets.
fn sky_share(p: vec3f, n: vec3f) -> f32 {
    let up = 0.5 + 0.5 * n.z;
    let height = host.deck[0].z - p.z;
    if host.deck[0].w == 0.0 {
        return up;
    }
    var hidden = 0.0;
    // A pier is in the deck's shade up to where it meets it.
    if height > 1e-4 {
        let a = (host.deck[0].xy - p.xy) / max(height, 1e-2);
        let b = (host.deck[1].xy - p.xy) / max(height, 1e-2);
        hidden = hidden_by(b) - hidden_by(vec2f(a.x, b.y)) - hidden_by(vec2f(b.x, a.y)) + hidden_by(a);
    }
    // What looks down is lit by the ground.
    return up * (1.0 - hidden) + 0.12 * (1.0 - up);
}

struct Drawn {
    @location(0) color: vec4f,
    // What Welkin reads of each pixel: the number of what it is made of over 255.
    @location(1) made_of: vec4f,
}

@fragment
fn fragment(in: Varying) -> Drawn {
    let n = normalize(in.normal);
    var light = host.sun_light * max(dot(n, host.sun), 0.0) + host.sky_light * sky_share(in.place, n);
    for (var i = 0; i < 2; i++) {
        let lamp = host.lamps[i];
        let to = in.place - lamp.position;
        let d = normalize(to);
        let beam = smoothstep(lamp.end, lamp.full, dot(d, lamp.direction));
        light += lamp.intensity * (beam * max(-dot(n, d), 0.0) / dot(to, to));
    }
    return Drawn(vec4f(in.albedo * light / 3.14159265, 1.0), vec4f(in.made_of / 255.0));
}
