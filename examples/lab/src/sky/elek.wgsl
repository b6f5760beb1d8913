// Sky by Elek 2008: equations 3.3 (optical depth), 3.4 (light scattered once), 3.2 and 3.5 (phase functions of gas and
// haze), and 3.9.
struct Uniform {
    beta: vec3f,
    bottom_m: f32,
    irradiance: vec3f,
    top_m: f32,
    to_sun: vec3f,
    altitude_m: f32,
    haze: f32,
    asymmetry_g: f32,
    scale_m: vec2f,
    side: u32,
    samples: u32,
    slice: u32,
    unused: u32,
}
const PI: f32 = 3.14159265;

// The passes that build the tables have their uniforms in group 0. Pictures have their camera or rays in group 0, and
// the uniforms and tables in group 1.
@group(0) @binding(0) var<uniform> made: Uniform;
@group(1) @binding(0) var<uniform> shown: Uniform;
@group(1) @binding(1) var table: texture_3d<f32>;
@group(1) @binding(2) var depths: texture_2d<f32>;
@group(1) @binding(3) var smp: sampler;

struct Camera {
    forward: vec3f,
    aspect: f32,
}
@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(0) var rays: texture_2d<f32>;

struct Varying {
    @builtin(position) position: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn vertex(@builtin(vertex_index) i: u32) -> Varying {
    let corner = vec2f(f32(i & 1u), f32(i >> 1u)) * 2.0;
    return Varying(vec4f(corner * 2.0 - 1.0, 0.0, 1.0), vec2f(corner.x, 1.0 - corner.y));
}

// Length of a ray to the ground or to the top of the air (x), and 1 if it meets the ground (y). Computed from
// altitudes, because differences of squared radii have too few digits in f32.
fn reach(u: Uniform, h: f32, mu: f32) -> vec2f {
    let b = (u.bottom_m + h) * mu;
    let down = h * (2.0 * u.bottom_m + h);
    if (mu < 0.0 && b * b > down) {
        return vec2f(down / (sqrt(b * b - down) - b), 1.0);
    }
    let up = max((u.top_m - h) * (2.0 * u.bottom_m + u.top_m + h), 0.0);
    let root = sqrt(b * b + up);
    return vec2f(select(root - b, up / max(root + b, 1e-3), b > 0.0), 0.0);
}

fn altitude_at(u: Uniform, h: f32, mu: f32, s: f32) -> f32 {
    let r = u.bottom_m + h;
    let q = s * (s + 2.0 * r * mu);
    return max(h + q / (r + sqrt(max(r * r + q, 0.0))), 0.0);
}

fn density(u: Uniform, h: f32) -> vec2f {
    return exp(-vec2f(h) / u.scale_m);
}

// Columns of gas and haze to the end of the air, trapezoid rule with equal steps.
fn columns(u: Uniform, h: f32, mu: f32, end: f32) -> vec2f {
    let ds = end / f32(u.samples);
    var sum = 0.5 * (density(u, h) + density(u, altitude_at(u, h, mu, end)));
    for (var i = 1u; i < u.samples; i++) {
        sum += density(u, altitude_at(u, h, mu, f32(i) * ds));
    }
    return sum * ds;
}

// One texel: light scattered once without phase functions, gas in rgb and haze in a. x: view zenith angle, y: sun
// zenith angle, z: altitude.
@fragment
fn build(@builtin(position) p: vec4f) -> @location(0) vec4f {
    let u = made;
    let at = floor(p.xy) / f32(u.side - 1u) * PI;
    let h0 = u.top_m * f32(u.slice) / f32(u.side - 1u);
    let mu = cos(at.x);
    let nu = cos(at.x - at.y);
    let mu_s0 = cos(at.y);
    let r0 = u.bottom_m + h0;
    let length = reach(u, h0, mu).x;
    let ds = length / f32(u.samples);
    var passed = vec2f(0.0);
    var before = density(u, h0);
    var gas = vec3f(0.0);
    var haze = 0.0;
    for (var i = 0u; i <= u.samples; i++) {
        let s = f32(i) * ds;
        let h = altitude_at(u, h0, mu, s);
        let here = density(u, h);
        passed += select(0.5 * (before + here) * ds, vec2f(0.0), i == 0u);
        before = here;
        let mu_s = clamp((r0 * mu_s0 + s * nu) / (u.bottom_m + h), -1.0, 1.0);
        let to_sun = reach(u, h, mu_s);
        if (to_sun.y == 0.0) {
            let whole = passed + columns(u, h, mu_s, to_sun.x);
            let weight = ds * select(1.0, 0.5, i == 0u || i == u.samples);
            gas += weight * here.x * exp(-u.beta * whole.x);
            haze += weight * here.y * exp(-u.haze * whole.y);
        }
    }
    return vec4f(gas * u.beta, haze * u.haze) / (4.0 * PI);
}

// Columns of gas and haze by zenith angle and altitude, in kilometres that half floats can hold.
@fragment
fn build_depth(@builtin(position) p: vec4f) -> @location(0) vec4f {
    let u = made;
    let at = floor(p.xy) / f32(u.side - 1u);
    let h = u.top_m * at.y;
    let mu = cos(at.x * PI);
    return vec4f(columns(u, h, mu, reach(u, h, mu).x) * 1e-3, 0.0, 1.0);
}

struct Veil {
    @location(0) light: vec4f,
    @location(1) through: vec4f,
}

fn depth_at(angle: f32, h: f32) -> vec3f {
    let n = f32(shown.side);
    let uv = (0.5 + vec2f(angle / PI, h / shown.top_m) * (n - 1.0)) / n;
    let c = textureSampleLevel(depths, smp, uv, 0.0).xy * 1e3;
    return shown.beta * c.x + shown.haze * c.y;
}

// Light and transmittance of the air along a ray from the observer. `ground` is the distance to the ground, m; below 0
// if the ray misses it.
fn veil(dir: vec3f, ground: f32) -> Veil {
    let u = shown;
    var h = max(u.altitude_m, 0.0);
    var r = u.bottom_m + h;
    var mu = dir.z;
    var mu_s = u.to_sun.z;
    let nu = dot(dir, u.to_sun);
    var start = 0.0;
    if (h > u.top_m) {
        // From space the ray begins where it enters the air.
        let b = r * mu;
        let c = (h - u.top_m) * (2.0 * u.bottom_m + h + u.top_m);
        if (b >= 0.0 || b * b <= c) {
            return Veil(vec4f(0.0), vec4f(1.0));
        }
        let s = c / (sqrt(b * b - c) - b);
        start = s;
        let top = u.bottom_m + u.top_m;
        mu = clamp((r * mu + s) / top, -1.0, 1.0);
        mu_s = clamp((r * mu_s + s * nu) / top, -1.0, 1.0);
        h = u.top_m;
        r = top;
    }
    let n = f32(u.side);
    let angles = vec3f(acos(clamp(mu, -1.0, 1.0)) / PI, acos(clamp(mu_s, -1.0, 1.0)) / PI, h / u.top_m);
    let s = textureSampleLevel(table, smp, (0.5 + angles * (n - 1.0)) / n, 0.0);
    let g = u.asymmetry_g;
    let gas = 0.7 * (1.4 + 0.5 * nu);
    let haze = 1.5 * (1.0 - g * g) / (2.0 + g * g) * (1.0 + nu * nu) / pow(1.0 + g * g - 2.0 * g * nu, 1.5);
    let light = u.irradiance * (gas * s.rgb + haze * s.a);
    var through = exp(-depth_at(angles.x * PI, h));
    if (ground >= 0.0) {
        // The transmittance is the ratio of two paths to space: upwards from the ground point, and upwards from the
        // observer.
        let mu_ground = clamp((r * mu + ground - start) / u.bottom_m, -1.0, 1.0);
        let up = acos(clamp(-mu_ground, -1.0, 1.0));
        let here = acos(clamp(-mu, -1.0, 1.0));
        through = exp(-max(depth_at(up, 0.0) - depth_at(here, h), vec3f(0.0)));
    }
    return Veil(vec4f(light, 1.0), vec4f(through, 1.0));
}

@fragment
fn probe(@builtin(position) p: vec4f) -> Veil {
    let ray = textureLoad(rays, vec2i(p.xy), 0);
    return veil(ray.xyz, ray.w);
}

// The timed picture: the library's `sky/picture.wgsl` with this method.
@fragment
fn picture(in: Varying) -> @location(0) vec4f {
    let right = normalize(cross(camera.forward, vec3f(0.0, 0.0, 1.0)));
    let up = cross(right, camera.forward);
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * camera.aspect);
    let dir = normalize(camera.forward + ndc.x * right + ndc.y * up);
    let end = reach(shown, shown.altitude_m, dir.z);
    let v = veil(dir, select(-1.0, end.x, end.y == 1.0));
    return vec4f(v.light.rgb + v.through.rgb * 0.05, 1.0);
}
