// Columns of rain seen from afar: one quad over each, blended as a veil in front of the picture. The f64 reference of
// the optical depth along a ray is src/rain/shaft.rs. The fragment entry point, which reads the depth, is in
// shaft_view.wgsl.
//!include "between/veil.wgsl"
//!include "between/bow.wgsl"
//!include "rain/area.wgsl"
//!include "rain/phase.wgsl"

// Number of waves of the pattern of curtains.
const SHAFT_WAVES: u32 = 12u;
// Amplitude of each wave of the pattern: AMOUNT of src/falling/curtain.rs.
const PATTERN_AMOUNT: f32 = 0.2;
// Distance at which the pattern begins to fade in, m: PATTERN_M[0] of src/falling/curtain.rs.
const PATTERN_FIRST: f32 = 30.0;
// Distance from which the pattern shows in full, m: PATTERN_M[1].
const PATTERN_FULL: f32 = 300.0;
// Depth of the columns below the level of their plan, m: BELOW_M of src/rain/shaft.rs.
const BELOW: f32 = 1000.0;
// Distance into a dense column from which most of its light comes, m.
const FRONT: f32 = 500.0;
// Share of the light of a column that varies with the pattern of its front.
const FRONT_SHARE: f32 = 0.3;

// Block of the columns' light and of the weather's own rain.
struct ShaftUniform {
    // Mean radiance of the sky (`above`) and of the ground (`below`), cd/m^2 per channel.
    above: vec3f,
    // Extinction of the weather's own rain, which is drawn with the fog, 1/m.
    own: f32,
    below: vec3f,
    // Top of the weather's own rain, camera-relative, m, and the depth below it over which the rain sets in
    // (`own_soft`).
    own_top: f32,
    // Illuminance of sun or moon (`sun`), lux, and the unit vector towards it (`to_sun`).
    sun: vec3f,
    own_soft: f32,
    to_sun: vec3f,
    // Extinction of the weather's own drops that are drawn near the camera, 1/m.
    own_near: f32,
    // Indices of the drawn columns from far to near, four to a vector.
    order: array<vec4u, 4>,
    // Rectangles of the picture that contain these columns, in the same order: left, bottom, right, top, ndc.
    rects: array<vec4f, MAX_AREAS>,
    // Waves of the pattern. x, y, z: wave numbers to the right, ahead and up, 1/m. w: phase, rad.
    waves: array<vec4f, SHAFT_WAVES>,
}

@group(0) @binding(8) var<uniform> shaft: ShaftUniform;

// Corner of a column's quad.
struct ShaftVarying {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) column: u32,
    @location(1) ndc: vec2f,
}

// Segment of a ray inside a column.
struct Met {
    // Optical depth that the column adds.
    depth: f32,
    // Distances of the segment's ends along the ray, m.
    first: f32,
    last: f32,
    // Mean of the pattern over the column's front, relative to its mean over all places.
    front: f32,
}

// Returns a corner of the rectangle that contains a column in the picture.
@vertex
fn shaft_vertex(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> ShaftVarying {
    let r = shaft.rects[instance];
    let at = vec2f(select(r.x, r.z, (corner & 1u) != 0u), select(r.y, r.w, (corner & 2u) != 0u));
    let column = shaft.order[instance / 4u][instance % 4u];
    return ShaftVarying(vec4f(at.x, at.y * frame.y_sign, 0.0, 1.0), column, at);
}

// Returns the interval of distances t, (first, last), over which a ray lies at least `inset` m inside the outline. The
// ray's position in the plan is q + u t. last < first if there is no such interval.
fn column_chord(i: u32, q: vec2f, u: vec2f, inset: f32) -> vec2f {
    let inner = columns.list[i].semi - inset;
    let e = q / max(inner, vec2f(1.0));
    let v = u / max(inner, vec2f(1.0));
    let a = max(dot(v, v), 1e-16);
    let middle = -dot(e, v) / a;
    let at = e + v * middle;
    let left = 1.0 - dot(at, at);
    let half = sqrt(max(left, 0.0) / a);
    var chord = select(vec2f(1.0, -1.0), vec2f(middle - half, middle + half), left > 0.0 && min(inner.x, inner.y) >= 1.0);
    if POLYGONS && columns.list[i].corners > 0u {
        chord = vec2f(-1e9, 1e9);
        for (var k = 0u; k < (columns.list[i].corners & 15u); k++) {
            let edge = columns.list[i].edges[k];
            let f = dot(edge.xy, q) + edge.z - inset;
            let g = dot(edge.xy, u);
            let t = -f / select(g, select(-1e-9, 1e-9, g >= 0.0), abs(g) < 1e-9);
            chord.x = select(chord.x, max(chord.x, t), g >= 0.0);
            chord.y = select(min(chord.y, t), chord.y, g >= 0.0);
        }
    }
    return chord;
}

// Returns the integral from the height `z` upwards of a ramp that is 0 above `top` and 1 below `top - soft`, m.
fn ramp_below(top: f32, soft: f32, z: f32) -> f32 {
    let y = (top - z) / soft;
    let x = clamp(y, 0.0, 1.0);
    return (max(y - x, 0.0) + 0.5 * x * x) * soft;
}

// Returns the mean, between the heights `a` and `b`, of a ramp that is 0 above `top` and 1 below `top - soft`.
fn ramp_mean(top: f32, soft: f32, a: f32, b: f32) -> f32 {
    let level = clamp((top - 0.5 * (a + b)) / soft, 0.0, 1.0);
    let flat = abs(b - a) < 0.01 * soft;
    return select((ramp_below(top, soft, a) - ramp_below(top, soft, b)) / select(b - a, 1.0, flat), level, flat);
}

// Returns the mean of the pattern between the distances `a` and `b` along a ray whose position in the plan is q + u t
// and whose height is z + dz t.
fn column_pattern(i: u32, q: vec2f, u: vec2f, z: f32, dz: f32, a: f32, b: f32) -> f32 {
    let middle = 0.5 * (a + b);
    let half = 0.5 * (b - a);
    let fine = columns.list[i].fine;
    let at = vec3f((q + u * middle) * fine, z + dz * middle - columns.list[i].ground + columns.list[i].fallen);
    let along = vec3f(u * fine, dz);
    var sum = 0.0;
    for (var w = 0u; w < SHAFT_WAVES; w++) {
        let wave = shaft.waves[w];
        let x = dot(wave.xyz, along) * half;
        let sinc = select(sin(x) / select(x, 1.0, abs(x) < 1e-2), 1.0 - x * x * 0.16666667, abs(x) < 1e-2);
        sum += cos(dot(wave.xyz, at) + wave.w + columns.list[i].turn * f32(w + 1u)) * sinc;
    }
    return max(1.0 + PATTERN_AMOUNT * smoothstep(PATTERN_FIRST, PATTERN_FULL, middle) * sum, 0.0);
}

// Returns two means over the piece of the ray from `a` to `b`, by four Gauss points: of the column's share of the rain,
// and of this share times the share of the column's rain that has left the cloud.
fn piece_mean(i: u32, origin: vec3f, d: vec3f, a: f32, b: f32) -> vec2f {
    let x = vec4f(0.06943184, 0.33000948, 0.66999052, 0.93056816) * (b - a) + a;
    let weights = vec4f(0.17392742, 0.32607258, 0.32607258, 0.17392742);
    let share = weights * vec4f(
        column_left(i, origin + d * x.x),
        column_left(i, origin + d * x.y),
        column_left(i, origin + d * x.z),
        column_left(i, origin + d * x.w),
    );
    let begun = clamp((columns.list[i].top - origin.z - d.z * x) / columns.list[i].soft, vec4f(0.0), vec4f(1.0));
    return vec2f(dot(share, vec4f(1.0)), dot(share, begun));
}

// Returns the segment of a ray inside a column, up to `range`; last <= first if there is none.
fn column_met(i: u32, origin: vec3f, d: vec3f, range: f32) -> Met {
    let lean = columns.list[i].lean;
    let ground = columns.list[i].ground;
    let top = columns.list[i].top;
    let q = column_plan(i, origin);
    let u = column_turned(i, d.xy - lean * d.z);
    let chord = column_chord(i, q, u, 0.0);
    let up = select(d.z, select(-1e-6, 1e-6, d.z >= 0.0), abs(d.z) < 1e-6);
    let a = (ground - BELOW - origin.z) / up;
    // Takes the higher of the two clouds: above its own cloud the column still replaces the weather's rain.
    let b = (max(top, shaft.own_top) - origin.z) / up;
    var end = min(min(range, max(a, b)), chord.y);
    if range >= RANGE_SKY && d.z < 0.0 && origin.z > ground {
        end = min(end, (ground - origin.z) / up);
    }
    let begin = max(max(chord.x, min(a, b)), 0.0);
    if end <= begin {
        return Met(0.0, 1.0, 0.0, 1.0);
    }
    var inner = column_chord(i, q, u, columns.list[i].rim);
    inner = select(inner, vec2f(0.5 * (chord.x + chord.y)), inner.y < inner.x);
    inner = clamp(inner, vec2f(begin), vec2f(end));
    let soft = clamp((top - columns.list[i].soft - origin.z) / up, begin, end);
    let cuts = vec3f(min(inner.x, soft), max(inner.x, min(soft, inner.y)), max(inner.y, soft));
    var shared_own = 0.0;
    var fell = 0.0;
    var s = begin;
    for (var k = 0u; k < 4u; k++) {
        var e = end;
        if k < 3u {
            e = cuts[k];
        }
        let z0 = origin.z + d.z * s;
        let z1 = origin.z + d.z * e;
        let mean = piece_mean(i, origin, d, s, e);
        shared_own += (e - s) * mean.x * ramp_mean(shaft.own_top, shaft.own_soft, z0, z1);
        fell += (e - s) * mean.y;
        s = e;
    }
    // Applies the pattern of the column's front, which is most visible, and of the rest.
    let cut = min(begin + FRONT, end);
    let front = column_pattern(i, q, u, origin.z, d.z, begin, cut);
    let rest = column_pattern(i, q, u, origin.z, d.z, cut, end);
    fell *= mix(rest, front, (cut - begin) / (end - begin));
    var own = shaft.own;
    if FOG && FOG_FALLING && FOG_CURTAINS && own > 0.0 && low_air.fog.curtain_amount > 0.0 {
        own += low_air.fog.falling.x * curtain_mean(origin, d, begin, end).x;
    }
    var depth = columns.list[i].extinction * fell - own * shared_own;
    // Subtracts the part of the extinction that is drawn as drops near the eye.
    let near = min(range, frame.drops.y);
    depth -= (columns.list[i].near - shaft.own_near) * near * column_left(i, origin + d * (0.5 * near));
    return Met(depth, begin, end, front);
}

// Returns the radiance that a column's rain sends along `d` from a place, cd/m^2. Drops show the image of most of the
// half space behind them; their own cloud hides part of the sky. They also scatter the light of sun or moon that comes
// in below the cloud.
fn column_light(i: u32, p: vec3f, d: vec3f) -> vec3f {
    let top = columns.list[i].top;
    let radius = columns.list[i].radius;
    let under = max(top - p.z, 0.0);
    // A rain cloud extends twice as far as its rain, and its base has a fifth of the radiance of the sky beside it.
    let hidden = 0.8 * (1.0 - under / sqrt(under * under + 4.0 * radius * radius));
    let around = mix(shaft.below, shaft.above * (1.0 - hidden), 0.5 + 0.5 * d.z);
    let out = column_chord(i, column_plan(i, p), column_turned(i, shaft.to_sun.xy - columns.list[i].lean * shaft.to_sun.z), 0.0).y;
    let way = max(out, 0.0);
    let height = p.z + shaft.to_sun.z * way;
    let open = smoothstep(0.0, 0.3 * max(top - columns.list[i].ground, 100.0), top - height);
    let beam = shaft.sun * (open * exp(-0.5 * columns.list[i].extinction * way));
    let phase = vec3f(drop_phase(dot(d, shaft.to_sun)) * 0.07957747) + bow_phase(BOW_COLUMNS, d, shaft.to_sun);
    return around + beam * max(phase, vec3f(0.0));
}

// Returns the veil of a column in front of the pixel at `ndc`: premultiplied light, display units, and opacity.
fn shaft_veil(i: u32, pixel: vec2i, ndc: vec2f, range: f32) -> vec4f {
    drawn = frame.drawn;
    let ray = view_ray(frame.depth, ndc);
    let met = column_met(i, ray.origin, ray.direction, range);
    let through = exp(-met.depth);
    let far = met.first + (met.last - met.first) * mean_place(met.depth);
    let at = max(far, 1.0);
    let before = veil_between(ray, at, at / ray.slant * frame.depth.plane_scale, sky_sample_in(pixel, at));
    let own = column_light(i, ray.origin + ray.direction * at, ray.direction) * mix(1.0, met.front, FRONT_SHARE);
    let taken = select(0.0, 1.0 - through, met.last > met.first);
    return vec4f((before.light + before.transmittance * own) * (taken * frame.exposure), taken);
}
