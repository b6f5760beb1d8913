// A wet surface seen by the camera: the host's colour x through + light, before air and fog.
//!include "between/sky.wgsl"
//!include "ground/binding.wgsl"
//!include "ground/optics.wgsl"
//!include "ground/hollows.wgsl"
//!include "ground/class.wgsl"
//!include "ground/snow.wgsl"
//!include "surroundings/lights_binding.wgsl"
//!include "surroundings/shelter.wgsl"

// What a mirror on the ground sees in direction `d`: the sky through the fog that lies on it; the ground round about if it
// faces down.
fn mirrored_light(d: vec3f) -> vec3f {
    let up = normalize(vec3f(d.xy, max(d.z, 1e-3)));
    let through = exp(-ground.fog_depth / max(up.z, 0.02));
    let sky = sky_toward(up) * through + ground.fog_light * (1.0 - through);
    return mix(ground.ground_light, sky, smoothstep(-0.1, 0.02, d.z));
}

// Share of the rain's water that a surface keeps: level ground all, walls less, undersides none.
fn caught(up_cosine: f32) -> f32 {
    return clamp(up_cosine + 0.3, 0.0, 1.0);
}

// The ground's own colour, from its luminance and the light that falls on it.
fn dry_albedo(luminance: vec3f, normal: vec3f, up: vec3f, lamps: vec3f) -> vec3f {
    let lamp = ground.lamp_lux * max(dot(normal, ground.to_lamp), 0.0);
    let light = lamp + ground.sky_lux * (0.5 + 0.5 * dot(normal, up)) + lamps;
    return luminance * SKY_PI / max(light, vec3f(1e-9));
}

// One kind of water on a surface: how it is turned, how rough it is, how much of it there is.
struct Film {
    normal: vec3f,
    slope: f32,
}

struct Mirror {
    share: f32,
    direction: vec3f,
    lamp: vec3f,
}

fn mirror(film: Film, to_eye: vec3f) -> Mirror {
    let cosine = clamp(dot(film.normal, to_eye), 1e-3, 1.0);
    let sine = sqrt(1.0 - cosine * cosine);
    let level = (to_eye - film.normal * cosine) / max(sine, 1e-4);
    let facet = normalize(film.normal + level * seen_slope(film.slope, sine / cosine));
    let share = fresnel_water(dot(facet, to_eye));
    let middle = normalize(to_eye + ground.to_lamp);
    let pixel = 0.25 * frame.pixel_angle;
    let lamp = glitter(film.slope, ground.disc2 + pixel * pixel, film.normal, middle, to_eye, ground.to_lamp) * fresnel_water(dot(middle, to_eye));
    return Mirror(share, reflect(-to_eye, facet), ground.lamp_lux * lamp);
}

// Illuminance by the host's lamps.
fn host_lamps(at: vec3f, normal: vec3f) -> vec3f {
    var lux = vec3f(0.0);
    if LAMPS {
        for (var i = 0u; i < lights.count; i++) {
            let to = at - lights.lamps[i].position;
            let cosine = max(-dot(normal, to) * inverseSqrt(max(dot(to, to), 1e-6)), 0.0);
            lux += light_at(lights.lamps[i], to) * cosine;
        }
    }
    return lux / frame.exposure;
}

// Slopes of thin and closed films (src/ground/uniform.rs).
const THIN_FILM_SLOPE: f32 = 0.3;
const CLOSED_FILM_SLOPE: f32 = 0.15;

// Slope of the clear ice that freezing rain leaves.
const GLAZE_SLOPE: f32 = 0.04;

// Slope up to which ground keeps the pattern's puddles for certain (`smoothstep` of its cosine).
const POOL_SLOPE: f32 = 0.08;

// Radius that a lamp of the host is taken to have, m.
const LAMP_RADIUS: f32 = 0.1;

// What a film mirrors of the host's lamps.
fn mirrored_lamps(film: Film, at: vec3f, to_eye: vec3f) -> vec3f {
    var light = vec3f(0.0);
    if LAMPS {
        for (var i = 0u; i < lights.count; i++) {
            let to = at - lights.lamps[i].position;
            let near = inverseSqrt(max(dot(to, to), 1e-4));
            let to_lamp = -to * near;
            let middle = normalize(to_eye + to_lamp);
            let disc = 0.25 * (LAMP_RADIUS * near + frame.pixel_angle);
            let share = glitter(film.slope, disc * disc, film.normal, middle, to_eye, to_lamp);
            light += light_at(lights.lamps[i], to) * (share * fresnel_water(dot(middle, to_eye)));
        }
    }
    return light / frame.exposure;
}

// Where something stands off a surface, as far as depth may be wrong.
fn off_surface(at: vec3f, normal: vec3f, range: f32) -> vec3f {
    return at + normal * (0.02 + 0.002 * range);
}

// Whether a map keeps a drop of this fall speed off `p`.
fn kept_off(p: vec3f, fall: f32, wanted: bool) -> f32 {
    return select(0.0, 1.0, mapped_ground(p, ground.wind - vec3f(0.0, 0.0, fall), wanted));
}

// Of each twelfth of the water whether maps keep it off `p`. They are asked for the slowest and the fastest drops and two between,
// and where two neighbours of these differ, by halves for the size from which on it is otherwise.
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

// Share of the rain's water that gets to `p` past what keeps it off; `boxes`: past boxes too. Time in a box times fall speed goes
// evenly with that speed, where a roof's underside and its edge bound it: asked for four drops, it says which of all twelfths
// of the water come by.
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

// How a surface lies, what it is made of, and its own colour.
struct Wetted {
    facing: Facing,
    look: SurfaceLook,
    albedo: vec3f,
}

// `host`, `albedo_known`: as of `wet_surface`.
fn wetted(host: vec3f, albedo_known: bool, at: vec3f, up: vec3f, surface: HostSurface, here: TerrainPoint) -> Wetted {
    let known = known_facing(surface, here);
    if albedo_known {
        let look = surface_look(surface, here, host);
        return Wetted(settled_facing(known, up, look.level), look, clamp(host, vec3f(0.0), vec3f(look.most_albedo)));
    }
    let lamps = host_lamps(at, known.normal);
    let look = surface_look(surface, here, dry_albedo(host, up, up, lamps));
    let facing = settled_facing(known, up, look.level);
    // The host lights natural ground by normals that go smoothly over its triangles: those of depth would show each of them.
    // Gentle slopes are taken for level there, which is off by a tenth of the darkening at most.
    let rough = smoothstep(0.0, 0.3, look.slope) * smoothstep(0.5, 0.8, dot(facing.normal, up));
    let by_depth = surface.normal.w == 0.0;
    let flat = select(0.0, max(rough, 1.0 - facing.sure) * (1.0 - here.share), by_depth);
    let albedo = dry_albedo(host, normalize(mix(facing.normal, up, flat)), up, lamps);
    return Wetted(facing, look, clamp(albedo, vec3f(0.0), vec3f(look.most_albedo)));
}

// Share of the surface under a film, standing water or clear ice, for the diagnostic picture of it.
var<private> water_cover: f32;

// `host` is the host's colour as luminance, or as display-linear colour where `albedo_known` says that it is all that is
// known of the albedo.
fn wet_surface(host: vec3f, albedo_known: bool, ray: ViewRay, range: f32, surface: HostSurface) -> Veil {
    let at = ray.origin + ray.direction * range;
    let up = normalize(vec3f(at.xy * ground.curvature, 1.0));
    var here = no_terrain();
    if TERRAIN {
        here = terrain_at(at);
    }
    let ground_here = wetted(host, albedo_known, at, up, surface, here);
    let facing = ground_here.facing;
    let look = ground_here.look;
    // What depth does not tell is taken for level.
    let level = dot(facing.normal, up);
    let kept = caught(mix(1.0, level, facing.sure));
    let to_eye = -ray.direction;
    let below = wet_share(ground_here.albedo, ground.entering);

    // The pixel's sides on the ground.
    let side = range * frame.pixel_angle;
    let cosine = max(dot(facing.normal, to_eye), 0.02);
    let view = vec2f(dot(ground.axis_u, ray.direction), dot(ground.axis_v, ray.direction));
    let along = view * inverseSqrt(max(dot(view, view), 1e-8));
    let across = vec2f(-along.y, along.x) * side;
    let place = vec2f(dot(ground.axis_u, at), dot(ground.axis_v, at));

    var gets = 1.0;
    if SHELTER {
        // What falls past boxes the terrain's cells know.
        gets = rained_on(off_surface(at, facing.normal, range), here.share < 0.5 || ground.glaze > 0.0);
    }
    // Hollows are those of paved ground; elsewhere a film lies as it does in the mean.
    let wanted = look.hollows > 0.0 && (TERRAIN || min(ground.level, ground.film_level) < 100.0);
    let pattern = hollow_depth(place, across, along * (side / cosine), wanted || SNOW);
    let hollow = vec2f(pattern.x * look.hollows, mix(1.0, pattern.y, look.hollows));
    var pool = covered_share(hollow, ground.level, PUDDLE_EDGE) * smoothstep(0.98, 0.997, level) * look.hollows;
    pool *= mirror_left(facing.error, POOL_SLOPE);
    var soaked_share = ground.soaked;
    var film_level = ground.film_level;
    var film_slope = ground.film_slope;
    if TERRAIN {
        // Standing water is level, and shows where it covers the relief of the ground.
        let over = smoothstep(0.2 * look.relief_mm, 2.0 * look.relief_mm, here.water.standing);
        let stands = select(0.0, over, look.relief_mm > 0.0) * smoothstep(0.5, 0.8, mix(1.0, level, facing.sure));
        pool = mix(pool, stands, here.share);
        soaked_share = mix(soaked_share, here.water.soaked, here.share);
        film_level = mix(min(film_level, FARTHEST_LEVEL), level_of(here.water.film), here.share);
        film_slope = mix(film_slope, mix(THIN_FILM_SLOPE, CLOSED_FILM_SLOPE, here.water.film), here.share);
    }
    pool *= gets;
    // A pixel too long to see rings sees a rougher surface.
    let seen = 1.0 - smoothstep(0.3, 1.2, side / cosine / RING_WAVE);
    let rings = pool > 1e-3 && ground.ring_chance > 0.0 && seen > 0.0;
    let slopes = ring_slopes(place, select(0u, RING_LAYERS, rings)) * seen;
    let rough = sqrt(ground.water_slope * ground.water_slope + ground.ring_slope2 * (1.0 - seen * seen));
    let water = Film(normalize(up - ground.axis_u * slopes.x - ground.axis_v * slopes.y), rough);
    // In the hollows the film is deeper and smoother; ice lies evenly over all of it, nearly as clear as water and as bright.
    let ice = ground.glaze * gets;
    let own = mix(film_slope * (1.2 - 0.4 * normal_share(hollow.x)), GLAZE_SLOPE, ice);
    let film = Film(facing.normal, sqrt(own * own + look.slope * look.slope));
    let holds = mix(look.film, smoothstep(0.0, 0.1, look.film), ice) * mirror_left(facing.error, film.slope);
    let filmed = kept * clamp(1.25 * level - 0.25, 0.0, 1.0) * holds * gets;

    // Where a film lies on rough ground its facets look every way; through standing water the eye looks one way.
    let soaked = max(soaked_share, ground.glaze) * kept * look.soaks * gets;
    let wet = mix(vec3f(1.0), below, soaked);
    let cover = max(covered_share(hollow, film_level, FILM_EDGE), ground.glaze) * filmed;
    water_cover = mix(cover, 1.0, pool);
    let thin = mirror(film, to_eye);
    let deep = mirror(water, to_eye);
    let thin_share = thin.share * cover * (1.0 - pool);
    let deep_share = deep.share * pool;
    let both = max(thin_share + deep_share, 1e-6);
    let mirrored = normalize(thin.direction * (thin_share / both) + deep.direction * (deep_share / both));
    var sky = mirrored_light(mirrored);
    if SHELTER {
        // What keeps rain off hides the sky too: its underside is as bright as the ground that it sees.
        let shines = thin_share + deep_share > 1e-3;
        let p = off_surface(at, facing.normal, range);
        let hidden = time_in_standing(p, -mirrored, shines) >= 0.0 || mapped_ground(p, -mirrored, shines);
        sky = select(sky, min(sky, ground.ground_light), hidden);
    }
    let lamps = (thin.lamp + mirrored_lamps(film, at, to_eye)) * (cover * (1.0 - pool))
        + (deep.lamp + mirrored_lamps(water, at, to_eye)) * pool;
    let through = mix(wet, below * ((1.0 - deep.share) / (1.0 - WATER_OUTSIDE)), pool);
    let veil = Veil(min(sky * (thin_share + deep_share) + lamps, vec3f(ground.most)), through);
    if !SNOW {
        return veil;
    }
    // Snow hides the water below it.
    var snow = ground.snow.xyz;
    if TERRAIN && ground.snow.w > 0.0 {
        let depth = mix(snow.x, here.snow.x, here.share);
        // Where only one has snow, its properties count.
        let known = select(select(here.share, 1.0, snow.x <= 0.0), 0.0, here.snow.x <= 0.0);
        snow = vec3f(depth, mix(snow.yz, here.snow.zw, known));
    }
    // Far off a pixel's side along the ground is known too badly for patches: there they mix.
    let patches = mix(pattern, vec2f(0.0, 1.0), smoothstep(150.0, 800.0, range));
    let lies = snow_share(snow.x, patches, mix(1.0, level, facing.sure)) * look.snow * gets;
    let soft = normalize(mix(facing.normal, up, select(0.35, 0.0, here.share > 0.5 || surface.normal.w > 0.0)));
    // Drifts and tracks lie over the ground that the host drew: what they rise by leans their light.
    let heaped = normalize(soft - here.drift * (here.share * lies));
    let glints = snow_glints(place, side, to_eye) * (1.0 - snow.y);
    let white = snow_light(snow, heaped, up, ground_here.albedo, host_lamps(at, heaped), glints);
    return Veil(mix(veil.light, min(white, vec3f(ground.most)), lies), veil.transmittance * (1.0 - lies));
}
