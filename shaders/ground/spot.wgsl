// Surface that a pixel shows: its normal, its class, and the share of the rain and snow in the open that reaches it.
//!include "common/guarded.wgsl"
//!include "between/sky.wgsl"
//!include "ground/binding.wgsl"
//!include "ground/optics.wgsl"
//!include "ground/hollows.wgsl"
//!include "ground/class.wgsl"
//!include "surroundings/lights_binding.wgsl"
//!include "surroundings/shelter.wgsl"

// Returns the illuminance from the host's lamps on a surface at `at`, lux.
fn host_lamps(at: vec3f, normal: vec3f) -> vec3f {
    var lux = vec3f(0.0);
    if LAMPS {
        for (var i = 0u; i < light_count(); i++) {
            let to = at - lights.lamps[i].position;
            let cosine = max(-dot(normal, to) * inverseSqrt(max(dot(to, to), 1e-6)), 0.0);
            lux += light_at(lights.lamps[i], to) * cosine;
        }
    }
    return lux / frame.exposure;
}

// Returns the albedo of the ground from its luminance, cd/m^2, and the light that falls on it. `lamps` is the
// illuminance from the host's lamps, lux.
fn dry_albedo(luminance: vec3f, normal: vec3f, up: vec3f, lamps: vec3f) -> vec3f {
    let lamp = ground.lamp_lux * max(dot(normal, ground.to_lamp), 0.0);
    let light = lamp + ground.sky_lux * (0.5 + 0.5 * dot(normal, up)) + lamps;
    return luminance * SKY_PI / max(light, vec3f(1e-9));
}

// Returns a point above the surface, raised by the possible error of the depth of `at`.
fn off_surface(at: vec3f, normal: vec3f, range: f32) -> vec3f {
    return at + normal * (0.02 + 0.002 * range);
}

// Returns 1 if an occluder map keeps a drop of this fall speed off `p`, else 0.
fn kept_off(p: vec3f, fall: f32, wanted: bool) -> f32 {
    return select(0.0, 1.0, mapped_ground(p, ground.wind - vec3f(0.0, 0.0, fall), wanted));
}

// Returns for each twelfth of the rain's water, from the slowest drops to the fastest, 1 if occluder maps keep it off
// `p`, else 0. The maps are tested for the slowest and the fastest drops and for two speeds between. Where the answers
// for two neighbouring speeds differ, bisection finds the twelfth at which the answer changes.
fn kept_off_twelfths(p: vec3f) -> array<vec4f, 3> {
    let falls = ground.falls;
    let ends = vec4f(
        kept_off(p, falls[0].x, true),
        kept_off(p, falls[1].x, true),
        kept_off(p, falls[2].x, true),
        kept_off(p, falls[2].w, true),
    );
    let differ = ends.xyz != ends.yzw;
    let between = vec3f(
        kept_off(p, falls[0].z, differ.x),
        kept_off(p, falls[1].z, differ.y),
        kept_off(p, falls[2].z, differ.z),
    );
    let middles = select(ends.xyz, between, differ);
    let below = ends.xyz != middles;
    let asked = select(vec3f(falls[0].w, falls[1].w, 0.0), vec3f(falls[0].y, falls[1].y, falls[2].y), below);
    let last = vec3f(
        kept_off(p, asked.x, differ.x),
        kept_off(p, asked.y, differ.y),
        kept_off(p, asked.z, below.z),
    );
    let low = select(middles, last, below);
    let high = select(middles, last, middles != ends.yzw);
    return array<vec4f, 3>(
        vec4f(ends.x, low.x, middles.x, high.x),
        vec4f(ends.y, low.y, middles.y, high.y),
        vec4f(ends.z, low.z, middles.z, ends.w),
    );
}

// Returns the share of the rain's water that reaches `p` past occluder maps and, if `boxes`, past boxes. Under a roof,
// where its underside and its edge bound a drop's path, (time in the box) x (fall speed) is linear in the fall speed.
// The values at four fall speeds therefore suffice: between them the product is interpolated, and a twelfth of the
// water reaches `p` where the product is negative.
fn rained_on(p: vec3f, boxes: bool) -> f32 {
    let falls = ground.falls;
    let asked = vec4f(falls[0].x, 0.5 * (falls[0].w + falls[1].x), 0.5 * (falls[1].w + falls[2].x), falls[2].w);
    let mapped = kept_off_twelfths(p);
    var slow = asked.x * time_in_standing(p, ground.wind - vec3f(0.0, 0.0, asked.x), boxes);
    var share = 0.0;
    for (var i = 0u; i < 3u; i++) {
        let fall = asked[i + 1u];
        let fast = fall * time_in_standing(p, ground.wind - vec3f(0.0, 0.0, fall), boxes);
        let within = mix(vec4f(slow), vec4f(fast), (falls[i] - asked[i]) / (fall - asked[i]));
        let free = clamp(0.5 - within / max(0.25 * abs(fast - slow), 1e-6), vec4f(0.0), vec4f(1.0));
        share += dot(free, vec4f(1.0) - mapped[i]) / 12.0;
        slow = fast;
    }
    return share;
}

// Surface of a spot: its normal, look and albedo.
struct Wetted {
    facing: Facing,
    look: SurfaceLook,
    // Albedo of the dry ground.
    albedo: vec3f,
}

// Returns the surface of a spot; `host` and `albedo_known` are those of `wet_surface`.
fn wetted(host: vec3f, albedo_known: bool, at: vec3f, up: vec3f, surface: HostSurface, here: TerrainPoint) -> Wetted {
    let known = known_facing(surface, here);
    if albedo_known {
        let look = surface_look(surface, here, host);
        return Wetted(settled_facing(known, up, look.level), look, clamp(host, vec3f(0.0), vec3f(look.most_albedo)));
    }
    let lamps = host_lamps(at, known.normal);
    let look = surface_look(surface, here, dry_albedo(host, up, up, lamps));
    let facing = settled_facing(known, up, look.level);
    // The host lights natural ground with normals that are smooth across its triangles; normals from depth would show
    // each triangle. So gentle slopes of natural ground count as level, which changes the darkening by a tenth at most.
    let rough = smoothstep(0.0, 0.3, look.slope) * smoothstep(0.5, 0.8, dot(facing.normal, up));
    let by_depth = surface.normal.w == 0.0;
    let flat = select(0.0, max(rough, 1.0 - facing.sure) * (1.0 - here.share), by_depth);
    let albedo = dry_albedo(host, unit_or(mix(facing.normal, up, flat), up), up, lamps);
    return Wetted(facing, look, clamp(albedo, vec3f(0.0), vec3f(look.most_albedo)));
}

// Place of a pixel on a surface.
struct Spot {
    // Position relative to the camera, m.
    at: vec3f,
    // Unit vector upwards at the place.
    up: vec3f,
    // Unit vector towards the camera.
    to_eye: vec3f,
    // Distance from the camera, m.
    range: f32,
    // Host's terrain at the place.
    terrain: TerrainPoint,
    // Surface at the place.
    ground: Wetted,
    // Cosine of the slope; 1 where the depth gives no slope.
    level: f32,
    // Width of the pixel across the ray, m.
    side: f32,
    // Cosine between the ray and the surface's normal.
    cosine: f32,
    // Position on the axes of the pattern of hollows, m.
    place: vec2f,
    // Share of the rain and snow in the open that reaches the place.
    gets: f32,
    // Depth of the pattern of hollows, and the share of its variance in waves too small for the pixel (`hollow_depth`).
    pattern: vec2f,
}

// Returns the spot that a pixel shows; `host` and `albedo_known` are those of `wet_surface`.
fn spot_at(host: vec3f, albedo_known: bool, ray: ViewRay, range: f32, surface: HostSurface) -> Spot {
    let at = ray.origin + ray.direction * range;
    let up = normalize(vec3f(at.xy * ground.curvature, 1.0));
    var here = no_terrain();
    if TERRAIN {
        here = terrain_at(at);
    }
    let lies = wetted(host, albedo_known, at, up, surface, here);
    let normal = lies.facing.normal;
    // Where the depth gives no slope, the surface counts as level.
    let level = mix(1.0, dot(normal, up), lies.facing.sure);

    // Sides of the pixel on the ground.
    let side = range * frame.pixel_angle;
    let cosine = max(-dot(normal, ray.direction), 0.02);
    let view = vec2f(dot(ground.axis_u, ray.direction), dot(ground.axis_v, ray.direction));
    let along = view * inverseSqrt(max(dot(view, view), 1e-8));
    let across = vec2f(-along.y, along.x) * side;
    let place = vec2f(dot(ground.axis_u, at), dot(ground.axis_v, at));

    var gets = 1.0;
    if SHELTER {
        // The terrain's cells already account for boxes; elsewhere, and for ice, boxes are tested here.
        gets = rained_on(off_surface(at, normal, range), here.share < 0.5 || ground.glaze > 0.0);
    }
    // Neither puddles nor snow lie on the sea.
    let over_sea = at.z + 0.5 * ground.curvature * dot(at.xy, at.xy) - ground.sea.x;
    gets *= select(0.0, 1.0, over_sea > 0.0);
    // Only paved ground has hollows; elsewhere the film is that of mean ground.
    let wanted = lies.look.hollows > 0.0 && (TERRAIN || min(ground.level, ground.film_level) < 100.0);
    let pattern = hollow_depth(place, across, along * (side / cosine), wanted || SNOW);
    return Spot(at, up, -ray.direction, range, here, lies, level, side, cosine, place, gets, pattern);
}
