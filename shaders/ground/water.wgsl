// Water and clear ice on the surface that a pixel shows, as a veil: the host's colour times transmittance, plus light.
//!include "common/guarded.wgsl"
//!include "between/sky.wgsl"
//!include "ground/spot.wgsl"

// Whether drops make rings in standing water.
override RINGS: bool = true;

// Returns the light that reaches the ground from direction `d` to be reflected: the sky, seen through the fog above the
// ground, or the surrounding ground if `d` points down.
fn mirrored_light(d: vec3f) -> vec3f {
    let up = normalize(vec3f(d.xy, max(d.z, 1e-3)));
    let through = exp(-ground.fog_depth / max(up.z, 0.02));
    let sky = sky_toward(up) * through + ground.sky_lux * ((1.0 - through) / SKY_PI);
    return mix(ground.ground_light, sky, smoothstep(-0.1, 0.02, d.z));
}

// Returns the share of the rain's water that a surface catches: 1 on slopes up to 45 degrees, 0.3 on walls, 0 on
// undersides.
fn caught(up_cosine: f32) -> f32 {
    return clamp(up_cosine + 0.3, 0.0, 1.0);
}

// Water surface as a mirror: its normal, and its root mean square slope along one axis.
struct Film {
    normal: vec3f,
    slope: f32,
}

// Reflection of a film.
struct Mirror {
    // Share of the light from `direction` that is reflected.
    share: f32,
    // Unit vector from the surface towards where the reflected light comes from, for the mean facet that the eye sees.
    direction: vec3f,
    // Reflected light of the sun or moon, cd/m^2.
    lamp: vec3f,
}

// Returns the reflection of a film towards the eye.
fn mirror(film: Film, to_eye: vec3f) -> Mirror {
    let cosine = clamp(dot(film.normal, to_eye), 1e-3, 1.0);
    let sine = sqrt(1.0 - cosine * cosine);
    let level = (to_eye - film.normal * cosine) / max(sine, 1e-4);
    let facet = normalize(film.normal + level * seen_slope(film.slope, sine / cosine));
    let share = fresnel_water(dot(facet, to_eye));
    // If eye and lamp lie in opposite directions there is no half-way vector, and no facet reflects the lamp.
    let middle = unit_or(to_eye + ground.to_lamp, film.normal);
    let pixel = 0.25 * frame.pixel_angle;
    let lamp = glitter(film.slope, ground.disc2 + pixel * pixel, film.normal, middle, to_eye, ground.to_lamp) * fresnel_water(dot(middle, to_eye));
    return Mirror(share, reflect(-to_eye, facet), ground.lamp_lux * lamp);
}

// Root mean square slope, along one axis, of a film so thin that it covers none of the ground; the same as in
// src/ground/uniform.rs.
const THIN_FILM_SLOPE: f32 = 0.3;
// Root mean square slope, along one axis, of a closed film, which covers all of the ground; the same as in
// src/ground/uniform.rs.
const CLOSED_FILM_SLOPE: f32 = 0.15;

// Root mean square slope, along one axis, of the clear ice that freezing rain leaves.
const GLAZE_SLOPE: f32 = 0.04;

// Slope up to which ground holds the pattern's puddles in full: the slope of the cosine 0.997, the upper end of the
// `smoothstep` in `water_at`.
const POOL_SLOPE: f32 = 0.08;

// Radius that is assumed for a lamp of the host, m.
const LAMP_RADIUS: f32 = 0.1;

// Returns the light of the host's lamps that a film reflects.
fn mirrored_lamps(film: Film, at: vec3f, to_eye: vec3f) -> vec3f {
    var light = vec3f(0.0);
    if LAMPS {
        for (var i = 0u; i < light_count(); i++) {
            let to = at - lights.lamps[i].position;
            let near = inverseSqrt(max(dot(to, to), 1e-4));
            let to_lamp = -to * near;
            let middle = unit_or(to_eye + to_lamp, film.normal);
            let disc = 0.25 * (LAMP_RADIUS * near + frame.pixel_angle);
            let share = glitter(film.slope, disc * disc, film.normal, middle, to_eye, to_lamp);
            light += light_at(lights.lamps[i], to) * (share * fresnel_water(dot(middle, to_eye)));
        }
    }
    return light / frame.exposure;
}

// Share of the surface under a film, standing water or clear ice, for the diagnostic picture.
var<private> water_cover: f32;

// Water on a surface: a film, and standing water in hollows and on the host's terrain.
struct Water {
    // Surface of the film.
    film: Film,
    // Surface of the standing water.
    pool: Film,
    // Share of the surface under standing water.
    pooled: f32,
    // Share of the ground outside standing water that is under the film.
    filmed: f32,
    // Share of the darkening of wet ground that the surface shows.
    soaked: f32,
}

// Returns the surface of standing water. It is level except for the rings of drops. Where a pixel is too long to show
// the rings, they make the surface rougher instead.
fn pool_at(spot: Spot, pooled: f32) -> Film {
    var normal = spot.up;
    var slope2 = ground.water_slope * ground.water_slope;
    if RINGS {
        let seen = 1.0 - smoothstep(0.3, 1.2, spot.side / spot.cosine / RING_WAVE);
        let slopes = ring_slopes(spot.place, select(0u, RING_LAYERS, pooled > 1e-3 && seen > 0.0)) * seen;
        normal = normalize(spot.up - ground.axis_u * slopes.x - ground.axis_v * slopes.y);
        slope2 += ground.ring_slope2 * (1.0 - seen * seen);
    }
    return Film(normal, sqrt(slope2));
}

// Returns the water on a spot.
fn water_at(spot: Spot) -> Water {
    let here = spot.terrain;
    let facing = spot.ground.facing;
    let look = spot.ground.look;
    let level = dot(facing.normal, spot.up);
    let kept = caught(spot.level);
    let hollow = vec2f(spot.pattern.x * look.hollows, mix(1.0, spot.pattern.y, look.hollows));
    var pool = covered_share(hollow, ground.level, PUDDLE_EDGE) * smoothstep(0.98, 0.997, level) * look.hollows;
    pool *= mirror_left(facing.error, POOL_SLOPE);
    var soaked_share = ground.soaked;
    var film_level = ground.film_level;
    var film_slope = ground.film_slope;
    if TERRAIN {
        // Standing water is level, and visible where it covers the relief of the ground.
        let over = smoothstep(0.2 * look.relief_mm, 2.0 * look.relief_mm, here.water.standing);
        let stands = select(0.0, over, look.relief_mm > 0.0) * smoothstep(0.5, 0.8, spot.level);
        pool = mix(pool, stands, here.share);
        soaked_share = mix(soaked_share, here.water.soaked, here.share);
        film_level = mix(min(film_level, FARTHEST_LEVEL), level_of(here.water.film), here.share);
        film_slope = mix(film_slope, mix(THIN_FILM_SLOPE, CLOSED_FILM_SLOPE, here.water.film), here.share);
    }
    pool *= spot.gets;
    // In the hollows the film is deeper and smoother. Ice lies evenly on all of the ground. It is nearly as clear as
    // water and reflects nearly as much.
    let ice = ground.glaze * spot.gets;
    let own = mix(film_slope * (1.2 - 0.4 * normal_share(hollow.x)), GLAZE_SLOPE, ice);
    let film = Film(facing.normal, sqrt(own * own + look.slope * look.slope));
    let holds = mix(look.film, smoothstep(0.0, 0.1, look.film), ice) * mirror_left(facing.error, film.slope);
    let filmed = kept * clamp(1.25 * level - 0.25, 0.0, 1.0) * holds * spot.gets;
    let soaked = max(soaked_share, ground.glaze) * kept * look.soaks * spot.gets;
    let cover = max(covered_share(hollow, film_level, FILM_EDGE), ground.glaze) * filmed;
    return Water(film, pool_at(spot, pool), pool, cover, soaked);
}

// Returns light and transmittance of the water. Light from the ground leaves a film on rough ground through facets of
// all directions; through standing water the eye looks in one direction, whose Fresnel share applies.
fn water_on(spot: Spot) -> Veil {
    let water = water_at(spot);
    let pool = water.pooled;
    water_cover = mix(water.filmed, 1.0, pool);
    let thin = mirror(water.film, spot.to_eye);
    let deep = mirror(water.pool, spot.to_eye);
    let thin_share = thin.share * water.filmed * (1.0 - pool);
    let deep_share = deep.share * pool;
    let both = max(thin_share + deep_share, 1e-6);
    // Without water nothing is reflected and the mirror's direction is undefined; `up` is used, with a share of 0.
    let mirrored = unit_or(thin.direction * (thin_share / both) + deep.direction * (deep_share / both), spot.up);
    var sky = mirrored_light(mirrored);
    if SHELTER {
        // Objects that keep rain off also hide the sky. Their undersides are taken to be as bright as the ground that
        // they face, and no brighter than the sky that they hide.
        let shines = thin_share + deep_share > 1e-3;
        let p = off_surface(spot.at, spot.ground.facing.normal, spot.range);
        let hidden = time_in_standing(p, -mirrored, shines) >= 0.0 || mapped_ground(p, -mirrored, shines);
        sky = select(sky, min(sky, ground.ground_light), hidden);
    }
    let lamps = (thin.lamp + mirrored_lamps(water.film, spot.at, spot.to_eye)) * (water.filmed * (1.0 - pool))
        + (deep.lamp + mirrored_lamps(water.pool, spot.at, spot.to_eye)) * pool;
    let below = wet_share(spot.ground.albedo, ground.entering);
    let wet = mix(vec3f(1.0), below, water.soaked);
    let through = mix(wet, below * ((1.0 - deep.share) / (1.0 - WATER_OUTSIDE)), pool);
    return Veil(capped(sky * (thin_share + deep_share) + lamps, ground.most), through);
}
