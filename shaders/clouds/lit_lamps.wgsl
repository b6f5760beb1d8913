// Light of the host's lamps and of lightning flashes that a place in a cloud scatters to the eye; replaces lit.wgsl.
// The f64 reference is src/clouds/light/lamp_light.rs, which describes the model.
//!include "clouds/about.wgsl"
//!include "clouds/lamps.wgsl"

// Extrapolation length of the diffusion approximation, in units of 1 / (1 - g').
const DARK_AT: f32 = 0.71;
// Depth from which light returns through the face that it fell on, in units of 1 / (1 - g').
const RETURNS_FROM: f32 = 0.5;
// Shares of the path to a lamp that lie in cloud: up to the first the lamp counts as outside, from the second on as
// inside, and between them the two are mixed.
const INSIDE: vec2f = vec2f(0.5, 1.0);
// Number of places along an interval at which a beam is sampled.
const BEAM_PLACES: u32 = 4u;

// A lamp as seen from a place. A distance is given as the scaled depth that it would have if all of it lay in cloud as
// dense as that around the place.
struct CloudShine {
    // Unit vector to the lamp.
    toward: vec3f,
    // Distance of the lamp.
    distance: f32,
    // Scaled depth of cloud on the path.
    between: f32,
}

// Creates the shine of a lamp at the offset `to` from a place, m. `scaled` is the scaled depth of cloud per metre.
fn cloud_shine(layer: CloudLayer, at: CloudPlace, lamp: CloudLamp, to: vec3f, scaled: f32) -> CloudShine {
    let way = sqrt(dot(to, to) + lamp.radius * lamp.radius);
    let d = max(way * scaled, 1e-3);
    if lamp.buried > 0.0 {
        return CloudShine(to / way, d, d);
    }
    return CloudShine(to / way, d, min(cloud_way(layer, at, to / way, way) * scaled, d));
}

// Ratio of a place's distance from a lamp to its distance from the lamp's image beyond a face, and the derivative of
// this ratio along `direction`. `place` and `source` are the depths of place and lamp behind the plane where the light
// is 0, `grows` is the derivative of `place` along the direction.
fn cloud_mirrored(shine: CloudShine, direction: vec3f, place: f32, grows: f32, source: f32) -> vec2f {
    let d = shine.distance;
    let square = d * d + 4.0 * place * source;
    let image = inverseSqrt(square);
    let toward = (d * d / square - 1.0) * dot(shine.toward, direction);
    return vec2f(d, toward - 2.0 * d * source * grows / square) * image;
}

// Light that comes from a lamp inside the cloud and is scattered more than once, per steradian and unit of scaled
// depth. The lamp has intensity 1 with distances in scaled depths: at a distance d its irradiance is 1 / d^2. `about`
// has the scaled depths of cloud around the place. `within` has the scaled depths of the layer's cloud above and below
// the lamp.
fn cloud_wandered(medium: CloudMedium, about: vec4f, within: vec2f, shine: CloudShine, direction: vec3f) -> f32 {
    let turning = medium.rest.z;
    let dark = DARK_AT / turning;
    let d = shine.distance;
    let level = length(shine.toward.xy) * d;
    // `about` does not say on which side eye and lamp are. Assumed: the eye looks at the nearer side, and the lamp lies
    // beyond the place, deeper in the same cloud.
    let out = length(direction.xy);
    let half = 0.5 * max(about.z + about.w, d);
    let place = array<f32, 6>(about.x, about.y, about.z, max(about.w, level + half), half, half);
    let lamp = array<f32, 6>(within.x, within.y, about.z + level, half, half, half);
    let grows = array<f32, 6>(-direction.z, direction.z, -out, out, 0.0, 0.0);
    let nearest = select(select(0u, 1u, about.y < about.x), 2u, about.z < min(about.x, about.y));
    var mean = 1.0 / d;
    var growing = dot(shine.toward, direction) / d;
    for (var i = 0u; i < 6u; i++) {
        let power = select(select(3.0, 2.0, i == (nearest ^ 1u)), 1.0, i == nearest);
        // A cloud is round: where one face is near, the others are farther away. So the place counts as at least as
        // deep behind the others as the lamp.
        let depth = select(max(place[i], lamp[i]), place[i], i == nearest);
        let r = cloud_mirrored(shine, direction, depth + dark, grows[i], max(lamp[i], 0.0) + dark);
        let others = pow(r.x, power - 1.0);
        let left = 1.0 - others * r.x;
        mean *= left;
        growing -= power * others * r.y / left;
    }
    return medium.rest.w * 3.0 / (4.0 * CLOUD_PI) * mean * max(turning - (1.0 - turning) * growing, 0.0);
}

// Light of a lamp outside the cloud, with all orders of scattering, in the units of `cloud_wandered`.
fn cloud_shone_on(medium_index: f32, medium: CloudMedium, about: vec4f, shine: CloudShine, direction: vec3f) -> f32 {
    let turning = medium.rest.z;
    let to = shine.toward;
    let upright = select(about.x, about.y, to.z > 0.0) / max(abs(to.z), 1e-6);
    let behind = min(upright, about.w / max(length(to.xy), 1e-6));
    let widths = vec3f(vec2f(about.z + about.w), about.x + about.y);
    let b = CLOUD_PI / (widths + 2.0 * DARK_AT / turning);
    let leak = dot(b * b, 1.0 - to * to) / (3.0 * turning);
    let x = -dot(direction, to);
    let often = max(cloud_legendre(cloud_table(2.0, medium_index, shine.between, behind, leak), x), 0.0) / CLOUD_PI;
    let momentum = exp(-turning * shine.between) - exp(-shine.between);
    let kept = medium.rest.w * 3.0 * (1.0 - turning) / (4.0 * CLOUD_PI) * momentum * x;
    // Light that returns through the face has first gone some depth into the cloud.
    let d = shine.distance - shine.between + max(shine.between, RETURNS_FROM / turning);
    return (often + clamp(kept, -often, often)) / (d * d);
}

// Distances, m, between which a ray's interval from `first` to `last` is inside a lamp's beam. The interval misses the
// beam if the second distance is not larger than the first. `to` is the offset from the ray's start to the lamp.
fn cloud_in_beam(lamp: CloudLamp, to: vec3f, direction: vec3f, first: f32, last: f32) -> vec2f {
    if lamp.light.end <= 0.0 {
        return vec2f(first, last);
    }
    // The beam's edge is the cone (axis . p)^2 = end^2 p^2, where p leads from the lamp to a point of the ray.
    let on = dot(direction, lamp.light.direction);
    let from_lamp = -dot(to, lamp.light.direction);
    let square = lamp.light.end * lamp.light.end;
    let a = on * on - square;
    let b = from_lamp * on + square * dot(to, direction);
    let c = from_lamp * from_lamp - square * dot(to, to);
    let root = b * b - a * c;
    if root <= 0.0 || abs(a) < 1e-9 {
        return vec2f(first, select(first, last, c > 0.0 && from_lamp > 0.0));
    }
    let ends = (vec2f(-b) + vec2f(-1.0, 1.0) * sqrt(root) * sign(a)) / a;
    if a > 0.0 {
        // A ray at a smaller angle to the axis than the edge enters the beam and stays in it, or leaves it for good.
        return select(vec2f(first, min(last, ends.x)), vec2f(max(first, ends.y), last), on > 0.0);
    }
    let in_front = from_lamp + 0.5 * (ends.x + ends.y) * on > 0.0;
    return select(vec2f(first), vec2f(max(first, min(ends.x, ends.y)), min(last, max(ends.x, ends.y))), in_front);
}

// Light from a lamp inside the cloud that droplets along an interval scatter once (x), and the mean of the lamp's beam
// over the interval (y). `dense` is the scaled depth per metre on the path to the lamp. Sample places are evenly spaced
// in the angle seen from the lamp (Kulla and Fajardo 2012, "equiangular").
fn cloud_once(medium: CloudMedium, lamp: CloudLamp, to: vec3f, stretch: CloudStretch, dense: f32) -> vec2f {
    let within = cloud_in_beam(lamp, to, stretch.direction, stretch.begun, stretch.begun + stretch.length);
    if within.y <= within.x {
        return vec2f(0.0);
    }
    let along = dot(to, stretch.direction);
    let h = sqrt(max(dot(to, to) - along * along, 0.0) + lamp.radius * lamp.radius);
    let first = atan((within.x - along) / h);
    let whole = atan((within.y - along) / h) - first;
    var sum = vec2f(0.0);
    for (var k = 0u; k < BEAM_PLACES; k++) {
        let u = first + whole * (f32(k) + 0.5) / f32(BEAM_PLACES);
        let s = along + h * tan(u);
        let d = h / cos(u);
        let way = (stretch.direction * s - to) / d;
        let beam = light_beam(lamp.light, dot(way, lamp.light.direction));
        let gone = d * dense;
        let phase = cloud_first_phase(medium, 1.0 + dot(stretch.direction, way), gone + stretch.to_eye);
        // Since ds = d^2 du / h, the square of the distance d cancels in the first sum and remains in the second.
        sum += beam * vec2f(phase * exp(-gone), d * d);
    }
    return sum * vec2f(medium.rest.w, 1.0) * (whole / (h * f32(BEAM_PLACES) * stretch.length));
}

// Light of all lamps that a place scatters to the eye, cd/m^2 times exposure, per unit of scaled depth.
fn cloud_lit(layer: CloudLayer, at: CloudPlace, here: CloudHere, stretch: CloudStretch, halo: vec3f) -> vec3f {
    let local = cloud_local(layer, cloud_unleaned(layer, at)).layer;
    let about = cloud_box(local, at, here.excess);
    let medium = clouds.media[u32(layer.medium.x)];
    let scaled = local.size.w * local.medium.y;
    var sum = vec3f(0.0);
    for (var i = 0u; i < (lamps.count & 31u); i++) {
        let lamp = lamps.lamps[i];
        let from_origin = lamp.light.position - cloud_origin;
        let place = stretch.direction * stretch.at;
        let shine = cloud_shine(layer, at, lamp, from_origin - place, scaled);
        let inside = select(smoothstep(INSIDE.x, INSIDE.y, shine.between / shine.distance), 1.0, lamp.buried > 0.0);
        let once = cloud_once(medium, lamp, from_origin, stretch, scaled * shine.between / shine.distance);
        var light = inside * once.x;
        if inside > 0.0 {
            // In cloud the light of a beam spreads as if from a point ahead of the lamp, where the light has lost its
            // direction.
            let ahead = lamp.light.direction * ((1.0 - lamp.even) / (medium.rest.z * scaled));
            let to = from_origin + ahead - place;
            let way = sqrt(dot(to, to) + lamp.radius * lamp.radius);
            let turned = CloudShine(to / way, max(way * scaled, 1e-3), shine.between);
            let below = (clouds.altitude + lamp.light.position.z + ahead.z - layer.size.x) * scaled;
            let within = vec2f(scaled / layer.size.y - below, below);
            let wandered = cloud_wandered(medium, about, within, turned, -stretch.direction);
            light += inside * scaled * scaled * lamp.even * wandered;
        }
        if inside < 1.0 {
            let shone = cloud_shone_on(layer.medium.x, medium, about, shine, -stretch.direction);
            light += (1.0 - inside) * scaled * scaled * once.y * shone;
        }
        sum += lamp.light.intensity * light;
    }
    return sum;
}
