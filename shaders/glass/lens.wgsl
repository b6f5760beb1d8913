// Draws the glass over the finished picture. Each bead is a lens that shows the scene behind it small and upside down,
// with a dark rim where light is reflected inside. A film of water distorts the picture, and mist on the inside blurs
// and whitens it. Snow lets light through, but no picture. Axes: right and up along the glass, and outwards from it, m;
// the eye is behind the glass.
//!include "common/fullscreen.wgsl"
//!include "common/tone.wgsl"

// Block of the lens.
struct Lens {
    // Ray direction in the middle of the picture, and its change per unit of clip x and y.
    ray: vec3f,
    // Number of cells per metre.
    per_m: f32,
    ray_dx: vec3f,
    // 1 if row 0 of the target is the picture's top, -1 if it is the bottom.
    y_sign: f32,
    ray_dy: vec3f,
    // Ratio of a bead's contact radius, cells, to the cube root of its volume, units.
    radius: f32,
    // Position of the eye, m.
    eye: vec3f,
    // Size of a pixel on the glass, cells.
    pixel: f32,
    // Columns of the matrix from a direction to clip space.
    clip_x: vec3f,
    // Mist on the inside, and the part of it that is cleared (`demist`).
    fogging: f32,
    clip_y: vec3f,
    demist: f32,
    clip_z: vec3f,
    // Height of the glass, m.
    height: f32,
    // Edges of the pane (a, b, c, 0): a point (u, v), m, is inside if a u + b v + c >= 0 for all four.
    edges: array<vec4f, 4>,
    // For each wiper: pivot x and y, inner and outer radius, cells; all 0 without a wiper.
    arms: array<vec4f, 2>,
    // Direction in which large beads run, unit vector or 0.
    flow: vec2f,
    // Numbers of columns and rows of the lattice; hash of the seed (`key`).
    size: vec2i,
    key: u32,
    // 1 if there is water.
    wet: u32,
    // Optical depth of snow per unit of its water in a cell; 0 without snow.
    snow_depth: f32,
}

@group(0) @binding(0) var<uniform> lens: Lens;
@group(0) @binding(1) var cells: texture_2d<u32>;
@group(0) @binding(2) var picture: texture_2d<f32>;
// Means of the picture over 8 x 8 and 32 x 32 texels.
@group(0) @binding(3) var smaller: texture_2d<f32>;
@group(0) @binding(4) var smallest: texture_2d<f32>;
@group(0) @binding(5) var linear_sampler: sampler;
@group(0) @binding(6) var host_mask: texture_2d<f32>;
@group(0) @binding(7) var snow: texture_2d<u32>;

// Whether the picture's values are sRGB-encoded.
override ENCODED: bool = false;
// Whether the host has a mask; where it is 1, the glass is not drawn.
override HAS_MASK: bool = false;

// Refractive index of water relative to air.
const WATER_INDEX: f32 = 1.333;
// Sine of the contact angle of 50 degrees (src/glass/laws.rs).
const CONTACT_SINE: f32 = 0.7660444;
// Cotangent of the contact angle.
const CONTACT_COTANGENT: f32 = 0.8390996;

// Returns the 32-bit PCG hash of a number (Jarzynski and Olano 2020).
fn pcg(v: u32) -> u32 {
    let state = v * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Returns a random word for a place and a key.
fn hash(p: vec2i, key: u32) -> u32 {
    return pcg(u32(p.x) + pcg(u32(p.y) + key));
}

// Water at a point of the glass.
struct Water {
    // Slope of its surface, right and up.
    slope: vec2f,
    // Share of the pixel that it covers.
    cover: f32,
    // Contact radius, cells.
    radius: f32,
    // Height of the water's surface above the glass, cells.
    height: f32,
}

// Returns the water of a spherical cap at `rho` contact radii from its middle, in the direction `to`.
fn cap(to: vec2f, rho: f32, radius: f32, pixel: f32) -> Water {
    let r = min(rho, 0.995);
    let root = sqrt(1.0 - r * r * CONTACT_SINE * CONTACT_SINE);
    let slope = r * CONTACT_SINE / root;
    let height = radius * (root / CONTACT_SINE - CONTACT_COTANGENT);
    let cover = clamp((1.0 - rho) * radius / pixel + 0.5, 0.0, 1.0);
    return Water(to * slope, cover, radius, height);
}

// Returns the water of a cell's bead at the offset `q`, cells, from the bead's middle. The bead's outline is uneven,
// hangs down, and is drawn out while the bead runs.
fn bead(cell: vec4u, q: vec2f) -> Water {
    let radius = lens.radius * pow(f32(cell.x), 0.33333333);
    // Reach of the longest tail of the most uneven bead, plus half a pixel.
    let reach = 2.6 * radius + lens.pixel;
    if dot(q, q) > reach * reach {
        return Water(vec2f(0.0), 0.0, 0.0, 0.0);
    }
    let shape = f32(cell.z >> 16u) * (6.2831853 / 65536.0);
    let runs = min(f32(cell.z & 0xffffu) / 8192.0, 1.0);
    let along = dot(q, lens.flow);
    let tail = select(1.0, 1.0 + 0.12 * min(radius * 3.0, 1.0) + 1.1 * runs, along < 0.0);
    let p = q + lens.flow * along * (1.0 / tail - 1.0);
    let far = max(length(p), 1e-6);
    let d = p / far;
    let two = vec2f(d.x * d.x - d.y * d.y, 2.0 * d.x * d.y);
    let three = vec2f(d.x * two.x - d.y * two.y, d.x * two.y + d.y * two.x);
    let turn = vec2f(cos(shape), sin(shape));
    // No two beads are alike: the unevenness of an outline depends on the bead's own shape.
    let stray = 0.6 + 0.8 * fract(shape * 2.7);
    let uneven = 1.0 + (1.0 - runs) * stray * (0.17 * dot(two, turn) + 0.09 * dot(three, turn.yx));
    return cap(d, far / (radius * uneven), radius, lens.pixel);
}

// Returns the water of small beads, one in each square; there are `per_cell` squares along a cell's edge. The more
// drops have hit, the more beads there are: all of them after `patience` hits.
fn fine(straight: vec2f, per_cell: f32, key: u32, hits: f32, patience: f32) -> Water {
    // The squares are turned and bent, so that no rows are visible.
    let s = straight * per_cell;
    let bent = 0.9 * vec2f(sin(0.83 * s.y + 0.29 * s.x), sin(0.71 * s.x - 0.37 * s.y));
    let c = (vec2f(0.8 * s.x - 0.6 * s.y, 0.6 * s.x + 0.8 * s.y) + 0.35 * bent) / per_cell;
    let square = floor(c * per_cell);
    let h = hash(vec2i(square), key);
    let due = f32(h & 255u) * (patience / 255.0);
    let grown = clamp((hits - due) * 0.5, 0.0, 1.0);
    let chance = f32((h >> 8u) & 255u) / 255.0;
    let radius = (0.10 + 0.34 * chance * chance) * sqrt(grown);
    if radius <= 0.02 {
        return Water(vec2f(0.0), 0.0, 0.0, 0.0);
    }
    let at = vec2f(f32((h >> 16u) & 255u), f32(h >> 24u)) / 255.0;
    let q = c * per_cell - square - mix(vec2f(radius), vec2f(1.0 - radius), at);
    let far = max(length(q), 1e-6);
    let in_cells = radius / per_cell;
    var w = cap(q / far, far / radius, in_cells, lens.pixel);
    // Turn the slope back out of the turned squares.
    w.slope = vec2f(0.8 * w.slope.x + 0.6 * w.slope.y, 0.8 * w.slope.y - 0.6 * w.slope.x);
    // A bead smaller than a pixel covers its share of the pixel.
    w.cover *= min(in_cells / lens.pixel * 2.0, 1.0);
    return w;
}

// Returns the film (0 to 1) and the hits, interpolated between the four cells around a point.
fn blended(c: vec2f) -> vec2f {
    let p = c - 0.5;
    let base = vec2i(floor(p));
    let f = p - floor(p);
    var sum = vec2f(0.0);
    for (var i = 0; i < 4; i++) {
        let o = vec2i(i & 1, i >> 1u);
        let at = clamp(base + o, vec2i(0), lens.size - 1);
        let state = textureLoad(cells, at, 0).w;
        let w = select(1.0 - f, f, o == vec2i(1));
        sum += w.x * w.y * vec2f(f32(state >> 16u) / 65535.0, f32(state & 4095u));
    }
    return sum;
}

// Returns a texel of the picture in linear light.
fn texel(at: vec2i) -> vec3f {
    let c = textureLoad(picture, clamp(at, vec2i(0), vec2i(textureDimensions(picture)) - 1), 0).rgb;
    return select(c, srgb_decode(c), ENCODED);
}

// Returns the scene averaged over squares of about 2^detail pixels a side, at least 32. For squares larger than a texel
// of the smallest copy, four texels are averaged, so that a lamp does not flash in one pixel of a drop and miss the
// next.
fn wide_scene(place: vec2f, detail: f32) -> vec3f {
    let apart = 0.25 * exp2(detail) / vec2f(textureDimensions(picture));
    if detail <= 5.0 {
        return textureSampleLevel(smallest, linear_sampler, place, 0.0).rgb;
    }
    var sum = vec3f(0.0);
    for (var i = 0; i < 4; i++) {
        let corner = vec2f(f32(i & 1), f32(i >> 1u)) * 2.0 - 1.0;
        sum += 0.25 * textureSampleLevel(smallest, linear_sampler, place + corner * apart, 0.0).rgb;
    }
    return sum;
}

// Returns the scene at a position in the picture, averaged over squares of about 2^detail pixels a side.
fn scene(uv: vec2f, detail: f32) -> vec3f {
    let place = clamp(uv, vec2f(0.0), vec2f(1.0));
    if detail >= 5.0 {
        return wide_scene(place, detail);
    }
    let middle = textureSampleLevel(smaller, linear_sampler, place, 0.0).rgb;
    if detail >= 3.0 {
        return mix(middle, wide_scene(place, 5.0), (detail - 3.0) * 0.5);
    }
    let p = place * vec2f(textureDimensions(picture)) - 0.5;
    let base = vec2i(floor(p));
    let f = p - floor(p);
    let sharp = mix(mix(texel(base), texel(base + vec2i(1, 0)), f.x),
        mix(texel(base + vec2i(0, 1)), texel(base + vec2i(1, 1)), f.x), f.y);
    return mix(sharp, middle, clamp(detail / 3.0, 0.0, 1.0));
}

// Returns the texture coordinates of a direction in the picture; (0, 0) is in the picture's first row.
fn picture_at(d: vec3f) -> vec2f {
    let clip = lens.clip_x * d.x + lens.clip_y * d.y + lens.clip_z * d.z;
    let ndc = clip.xy / max(clip.z, 1e-3 * length(clip) + 1e-20);
    return vec2f(0.5 + 0.5 * ndc.x, 0.5 - 0.5 * ndc.y * lens.y_sign);
}

// Returns the light through water towards the eye along -d: it enters through the water's outer surface and leaves
// through the glass.
fn through(d: vec3f, w: Water, uv: vec2f) -> vec3f {
    let normal = normalize(vec3f(w.slope, 1.0));
    let inner = refract(d, vec3f(0.0, 0.0, -1.0), 1.0 / WATER_INDEX);
    let outer = refract(inner, -normal, WATER_INDEX);
    // Light reflected inside comes from the dim cab and from the glass beside the bead.
    let dark = scene(uv, 5.0) * 0.08;
    let cosine_in = dot(inner, normal);
    let cosine_out = dot(outer, normal);
    if cosine_in <= 0.0 || cosine_out <= 1e-4 {
        return dark;
    }
    // Fresnel's equations for unpolarised light.
    let s = (WATER_INDEX * cosine_in - cosine_out) / (WATER_INDEX * cosine_in + cosine_out);
    let p = (cosine_in - WATER_INDEX * cosine_out) / (cosine_in + WATER_INDEX * cosine_out);
    let thrown_back = 0.5 * (s * s + p * p);
    // Estimates the number of the picture's pixels in one pixel of the bead (`spread`): a bead shows some 50 degrees of
    // the scene.
    let spread = 0.4 * abs(lens.eye.z) * lens.per_m / max(w.radius, 0.02);
    return mix(scene(picture_at(outer), log2(max(spread, 1.0))), dark, thrown_back);
}

// Returns the highest water over a point of the glass. `c` is the point's position, cells.
fn water_over(c: vec2f, hits: f32) -> Water {
    var best = Water(vec2f(0.0), 0.0, 0.0, -1.0);
    let base = vec2i(floor(c));
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let at = base + vec2i(x, y);
            if any(at < vec2i(0)) || any(at >= lens.size) {
                continue;
            }
            let cell = textureLoad(cells, at, 0);
            if cell.x == 0u {
                continue;
            }
            let middle = vec2f(at) + vec2f(f32(cell.y & 0xffffu), f32(cell.y >> 16u)) / 65536.0;
            let w = bead(cell, c - middle);
            if w.cover > 0.0 && w.height > best.height {
                best = w;
            }
        }
    }
    if best.cover <= 0.0 && hits > 0.0 {
        let key = lens.key + ((textureLoad(cells, clamp(base, vec2i(0), lens.size - 1), 0).w >> 12u) & 15u);
        best = fine(c, 2.0, key + 32u, hits, 24.0);
        if best.cover <= 0.0 {
            best = fine(c, 4.0, key + 64u, hits, 12.0);
        }
    }
    return best;
}

// Returns the vector to a point from the pivot of the wiper that reaches the point, or from the nearer pivot if both
// wipers do; 0 if neither does.
fn from_pivot(c: vec2f) -> vec2f {
    var best = vec2f(0.0);
    var nearest = 1e9;
    for (var i = 0; i < 2; i++) {
        let arm = lens.arms[i];
        let d = c - arm.xy;
        let far = length(d);
        if far >= arm.z && far <= arm.w && far < nearest {
            best = d;
            nearest = far;
        }
    }
    return best;
}

// Returns the height of a film's streaks, -1 to 1: fine ridges along the blade's path, or along the flow. `arm` is the
// vector from the wiper's pivot, or 0.
fn streaks(c: vec2f, arm: vec2f) -> f32 {
    let across = dot(c, vec2f(lens.flow.y, -lens.flow.x));
    let at = 2.7 * select(across, length(arm), any(arm != vec2f(0.0)));
    let f = fract(at);
    let i = i32(floor(at));
    let a = f32(hash(vec2i(i, 11), lens.key) & 255u) / 127.5 - 1.0;
    let b = f32(hash(vec2i(i + 1, 11), lens.key) & 255u) / 127.5 - 1.0;
    return mix(a, b, f * f * (3.0 - 2.0 * f));
}

// Returns the mist, 0 to 1, at the height `v`, m, on the glass.
fn mist_at(v: f32) -> f32 {
    let height = v / lens.height;
    let cleared = 1.3 * lens.demist;
    return lens.fogging * smoothstep(cleared - 0.3, cleared, height);
}

// Returns the optical depth of the snow over a point of the glass. Flakes are some cells wide, with ragged edges.
fn snow_over(c: vec2f) -> f32 {
    if lens.snow_depth <= 0.0 {
        return 0.0;
    }
    var sum = 0.0;
    var weights = 0.0;
    let base = vec2i(floor(c));
    for (var y = -1; y <= 1; y++) {
        for (var x = -1; x <= 1; x++) {
            let at = clamp(base + vec2i(x, y), vec2i(0), lens.size - 1);
            let h = hash(at, lens.key + 21u);
            // Flakes lie off the middle of their cells.
            let middle = vec2f(at) + vec2f(f32(h & 255u), f32((h >> 8u) & 255u)) / 255.0;
            let off = c - middle;
            let weight = exp2(-2.5 * dot(off, off));
            sum += weight * f32(textureLoad(snow, at, 0).x);
            weights += weight;
        }
    }
    let grain = f32(hash(vec2i(floor(c * 6.0)), lens.key + 22u) & 255u) / 255.0;
    return lens.snow_depth * sum / max(weights, 1e-3) * (0.5 + grain);
}

// Returns the light through snow: the light L of the whole picture, less the part that the snow reflects, L / (1 + 0.75
// (1 - g) depth) (two-stream approximation, with the asymmetry g = 0.89 of ice spheres).
fn through_snow(depth: f32) -> vec3f {
    let around = 0.25 * (scene(vec2f(0.25, 0.3), 5.0) + scene(vec2f(0.75, 0.3), 5.0) + 2.0 * scene(vec2f(0.5, 0.5), 5.0));
    return around / (1.0 + 0.75 * 0.11 * depth);
}

// Returns a pixel of the picture as seen through the pane.
@fragment
fn look_through(in: FullscreenVarying) -> @location(0) vec4f {
    let pixel = vec2i(in.position.xy);
    let ndc = vec2f(in.uv.x * 2.0 - 1.0, (1.0 - in.uv.y * 2.0) * lens.y_sign);
    let ray = lens.ray + ndc.x * lens.ray_dx + ndc.y * lens.ray_dy;
    let p = lens.eye.xy + ray.xy * (-lens.eye.z / max(ray.z, 1e-9));
    var outside = ray.z <= 1e-6;
    for (var i = 0; i < 4; i++) {
        outside = outside || dot(lens.edges[i].xyz, vec3f(p, 1.0)) < 0.0;
    }
    if outside {
        discard;
    }
    var keep = 0.0;
    if HAS_MASK {
        keep = textureLoad(host_mask, pixel, 0).r;
    }
    let mist = mist_at(p.y);
    let c = p * lens.per_m;
    var film = 0.0;
    var water = Water(vec2f(0.0), 0.0, 0.0, 0.0);
    if lens.wet != 0u {
        let state = blended(c);
        film = state.x * state.x;
        water = water_over(c, state.y);
    }
    let snow_depth = snow_over(c);
    if keep >= 1.0 || (mist <= 0.0 && film < 1e-3 && water.cover <= 0.0 && snow_depth <= 0.0) {
        discard;
    }
    let host = textureLoad(picture, pixel, 0);
    let uv = in.uv;
    var seen = select(host.rgb, srgb_decode(host.rgb), ENCODED);
    let d = normalize(ray);
    if film >= 1e-3 {
        let arm = from_pivot(c);
        let ridge = streaks(c, arm) * film;
        let across = normalize(select(vec2f(lens.flow.y, -lens.flow.x), arm, any(arm != vec2f(0.0))) + 1e-6);
        let bent = picture_at(normalize(d + vec3f(across * ridge * 0.03, 0.0)));
        seen = mix(seen, scene(bent, 2.0 * film * abs(ridge) + film), min(film * 1.5, 1.0));
    }
    if water.cover > 0.0 {
        seen = mix(seen, through(d, water, uv), water.cover);
    }
    if snow_depth > 0.0 {
        seen = mix(through_snow(snow_depth), seen, exp(-snow_depth));
    }
    if mist > 0.0 {
        seen = mix(seen, scene(uv, 3.0 + 2.0 * mist), mist);
        let glow = scene(vec2f(0.5), 5.0) + scene(vec2f(0.2, 0.3), 5.0) + scene(vec2f(0.8, 0.3), 5.0);
        seen = mix(seen, vec3f(dot(glow, vec3f(0.2126, 0.7152, 0.0722) / 3.0)), 0.4 * mist);
    }
    let written = select(seen, srgb_encode(seen), ENCODED);
    return vec4f(mix(written, host.rgb, keep), host.a);
}
