// A made-up scene for pictures of fog: ground with squares of 10 m, boards at known distances, a tower, a hill, a sky.
struct SceneUniform {
    fog: FogUniform,
    depth: DepthUniform,
    eye: vec3f,
    sun: vec3f,
    sky_zenith: vec3f,
    sky_horizon: vec3f,
    // Light on the ground.
    ground_light: vec3f,
    planet_radius: f32,
}

fn box_hit(o: vec3f, d: vec3f, lo: vec3f, hi: vec3f) -> f32 {
    let a = (lo - o) / d;
    let b = (hi - o) / d;
    let near = min(a, b);
    let far = max(a, b);
    let t = max(max(near.x, near.y), near.z);
    return select(1e12, t, t > 0.0 && t < min(min(far.x, far.y), far.z));
}

fn sky_colour(d: vec3f) -> vec3f {
    let base = mix(u.sky_horizon, u.sky_zenith, sqrt(clamp(d.z, 0.0, 1.0)));
    let c = dot(d, u.fog.to_sun);
    let aureole = u.sun * (0.02 * exp(-(1.0 - c) * 60.0) + 0.01 * exp(-(1.0 - c) * 8.0));
    let disc = select(vec3f(0.0), u.sun / 6.8e-5, c > 0.99999);
    return base + aureole + disc;
}

fn answer(i: vec4f) -> vec4f {
    let ray = view_ray(u.depth, i.xy);
    let d = ray.direction;
    var t = 1e12;
    var colour = vec3f(0.0);
    // The curved ground.
    let b = d.z + u.eye.z / u.planet_radius * d.z;
    let disc = b * b - 2.0 * u.eye.z / u.planet_radius;
    if d.z < 0.0 && disc > 0.0 {
        t = 2.0 * u.eye.z / (-b + sqrt(disc));
        let p = u.eye + d * t;
        let square = (i32(floor(p.x / 10.0)) + i32(floor(p.y / 10.0))) & 1;
        colour = u.ground_light / 3.14159 * select(vec3f(0.10, 0.14, 0.06), vec3f(0.16, 0.20, 0.10), square == 1);
    }
    let distances = array<f32, 10>(15.0, 30.0, 60.0, 100.0, 150.0, 250.0, 400.0, 700.0, 1200.0, 2500.0);
    for (var k = 0; k < 10; k++) {
        let y = distances[k];
        let w = 0.02 * y + 0.3;
        for (var side = 0; side < 2; side++) {
            let x = (f32(side) * 2.0 - 1.0) * (0.07 * y + 2.0 + f32(k) * 0.018 * y);
            let h = 2.0 + 0.025 * y;
            let s = box_hit(u.eye, d, vec3f(x - w, y, 0.0), vec3f(x + w, y + 0.5, h));
            if s < t {
                t = s;
                let p = u.eye + d * s;
                let white = p.z > 0.5 * h;
                colour = u.ground_light / 3.14159 * select(0.02, 0.8, white) * vec3f(1.0);
            }
        }
    }
    let tower = box_hit(u.eye, d, vec3f(-12.0, 120.0, 0.0), vec3f(-6.0, 126.0, 40.0));
    if tower < t {
        t = tower;
        colour = u.ground_light / 3.14159 * vec3f(0.4, 0.12, 0.08);
    }
    let centre = vec3f(900.0, 3500.0, -700.0);
    let oc = u.eye - centre;
    let hb = dot(oc, d);
    let hd = hb * hb - dot(oc, oc) + 900.0 * 900.0;
    if hd > 0.0 && -hb - sqrt(hd) > 0.0 && -hb - sqrt(hd) < t {
        t = -hb - sqrt(hd);
        let n = normalize(oc + d * t);
        colour = u.ground_light / 3.14159 * vec3f(0.08, 0.12, 0.05) * (0.5 + 0.5 * max(dot(n, u.fog.to_sun), 0.0));
    }
    if t >= 1e12 {
        colour = sky_colour(d);
    }
    let fog = fog_along(u.fog, vec3f(0.0), d, min(t, RANGE_SKY), t);
    return vec4f(fog_apply(fog, colour), t);
}
