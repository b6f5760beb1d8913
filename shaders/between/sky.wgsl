// Sky in a direction, without fog: behind everything in the picture, in mirrors, and in the cube map.
//!include "between/sky_sample.wgsl"

fn night_light(sky: SkySample) -> vec3f {
    return mix(frame.night_floor, sky.behind, behind_share);
}

// Light of the air above the horizon, cd/m^2, without the discs of sun and moon.
fn clear_sky_above(d: vec3f) -> vec3f {
    if !CLEAR_SKY || deck_hides_all() || drawn.z == 0.0 {
        return vec3f(0.0);
    }
    return color_of(sky_radiance_above(d));
}

// Sky above the horizon without the clouds in front of it. `clear` is the light of the air, with the disc of sun or
// moon if it is visible.
fn open_sky(d: vec3f, clear: vec3f, sky: SkySample) -> vec3f {
    return mix(clear * drawn.z + night_light(sky), frame.deck * overcast_gradation(d.z), sky.deck);
}

// Lays the clouds in front of `behind`, with the light of flashes on them.
fn before_sky(behind: vec3f, d: vec3f, sky: SkySample) -> vec3f {
    var light = with_clouds(Veil(behind, vec3f(0.0)), sky, RANGE_SKY).light;
    if FLASH {
        let known = CLOUDS && sky.reach.y > 0.0;
        let way = select(flash_way(d), exp2(0.5 * (sky.reach.x + sky.reach.y)), known);
        // If the glow of the clouds is known, light is added only for the deck, which has no glow.
        let flat = select(cloud_cover(sky), sky.clouds.a * sky.deck, sky.has_glow);
        light += flash_on_clouds(d, way) * flat;
    }
    return light;
}

// Sky above the horizon, without fog and without the discs of sun and moon.
fn sky_toward(d: vec3f) -> vec3f {
    let sky = sky_sample_toward(d);
    return before_sky(open_sky(d, clear_sky_above(d), sky), d, sky);
}

// Light of flashes in the air in front of a surface at this range. Clouds hide the air behind them.
fn flash_before(ray: ViewRay, range: f32, sky: SkySample) -> vec3f {
    let all = flash_in_air(ray, range);
    if !CLOUDS || sky.reach.y == 0.0 {
        return all;
    }
    return mix(flash_in_air(ray, min(range, exp2(sky.reach.x))), all, sky.clouds.a);
}

// Share of the background that clouds hide.
fn cloud_cover(sky: SkySample) -> f32 {
    return select(frame.flash_cover, 1.0 - sky.clouds.a * (1.0 - sky.deck), CLOUDS);
}
