//!include "sky/lookup.wgsl"
// The discs of sun and moon. The light in the air uses the geometric place of a lamp; the disc is seen where refraction
// puts it, lifted and flattened at the horizon.

// Degrees by which standard air lifts what is seen at an apparent elevation in degrees (Bennett 1982, arc minutes).
fn refraction_deg(apparent_deg: f32) -> f32 {
    let a = clamp(apparent_deg, -2.0, 89.9);
    let x = (a + 7.31 / (a + 4.4)) * (SKY_PI / 180.0);
    return max(cos(x) / max(sin(x), 1e-3), 0.0) / 60.0;
}

// The geometric direction of what is seen in `dir`. Fades with the air's density over the observer.
fn unrefracted(dir: vec3f) -> vec3f {
    let density = exp(-max(sky_view.altitude, 0.0) / sky_view.air.rayleigh_scale_height_m);
    let elevation = SKY_PI * 0.5 - sky_acos(dir.z);
    let lift = sky_view.refraction * density * refraction_deg(elevation * (180.0 / SKY_PI)) * (SKY_PI / 180.0);
    let level = max(length(dir.xy), 1e-6);
    let z = dir.z * cos(lift) - level * sin(lift);
    return vec3f(dir.xy * (sqrt(max(1.0 - z * z, 0.0)) / level), z);
}

// Lamps whose discs a pipeline draws: those of `SKY_LAMPS`, and behind them those that do not light the air. A lamp
// that is not there has no radiance.
override SKY_DISCS: u32 = 2u;
// The first lamp is a sun and the second one a moon: the law of neither is computed for the other.
override SUN_THEN_MOON: bool = false;

// Share of a disc's radius at which its middle is, and how much of the pixel it covers.
fn disc_place(lamp: SkyLamp, dir: vec3f, pixel_angle: f32) -> vec2f {
    // The angle by its sine's series, within 1e-5 of itself for the largest discs.
    let chord = 0.5 * length(dir - lamp.toward);
    let apart = chord * (2.0 + chord * chord * 0.33333333);
    let cover = clamp((lamp.angular_radius - apart) / max(pixel_angle, 1e-6) + 0.5, 0.0, 1.0);
    return vec2f(min(apart * lamp.inverse_radius, 1.0), cover);
}

// Radiance of the lamps' discs in a direction, reddened by the air; `pixel_angle` is the angle of a pixel, rad, over
// which the edge is smoothed. 0 below the horizon.
fn disc_radiance(dir: vec3f, pixel_angle: f32) -> Radiance {
    return disc_radiance_on(whole_path(dir), dir, pixel_angle);
}

fn disc_radiance_on(path: SkyPath, dir: vec3f, pixel_angle: f32) -> Radiance {
    return disc_faces(dir, pixel_angle, path.depth, false) * f32(path.ray.grounded == 0u);
}

// The same above the level of the eye, where the air before a disc follows from its height alone.
fn disc_radiance_above(dir: vec3f, pixel_angle: f32) -> Radiance {
    return disc_faces(dir, pixel_angle, vec3f(0.0), true);
}

// Optical depth of the air before what of a disc is seen at this sine of elevation: src/sky/disc.rs.
fn depth_before_disc(lamp: SkyLamp, sine: f32) -> vec3f {
    let x = sqrt(clamp((sine - lamp.depth_from) * lamp.depth_scale, 0.0, 1.0));
    return exp(lamp.depth[0].xyz + x * (lamp.depth[1].xyz + x * (lamp.depth[2].xyz + x * lamp.depth[3].xyz)));
}

// Radiances of the discs behind air of an optical depth, or of that of their own height.
fn disc_faces(dir: vec3f, pixel_angle: f32, depth: vec3f, by_height: bool) -> Radiance {
    let real = unrefracted(dir);
    var out = vec3f(0.0);
    if (SUN_THEN_MOON) {
        out = sun_disc(sky_view.lamps[0], real, pixel_angle, air_before_disc(sky_view.lamps[0], dir, depth, by_height));
        if (SKY_DISCS > 1u) {
            out += moon_disc(sky_view.lamps[1], real, pixel_angle, air_before_disc(sky_view.lamps[1], dir, depth, by_height));
        }
    } else {
        for (var i = 0u; i < SKY_DISCS; i++) {
            let lamp = sky_view.lamps[i];
            let air = air_before_disc(lamp, dir, depth, by_height);
            out += select(sun_disc(lamp, real, pixel_angle, air), moon_disc(lamp, real, pixel_angle, air), lamp.kind == 1u);
        }
    }
    return out;
}

fn air_before_disc(lamp: SkyLamp, dir: vec3f, depth: vec3f, by_height: bool) -> vec3f {
    if by_height {
        return depth_before_disc(lamp, dir.z);
    }
    return depth;
}

// Zenith cosine of the eye on a disc's face, at a share of its radius.
fn face_cosine(share: f32) -> f32 {
    return sqrt(max(1.0 - share * share, 1e-4));
}

// Darker towards the limb: mu^a. `air`: optical depth between eye and disc.
fn sun_disc(lamp: SkyLamp, real: vec3f, pixel_angle: f32, air: vec3f) -> Radiance {
    let place = disc_place(lamp, real, pixel_angle);
    return lamp.disc * exp2(log2(face_cosine(place.x)) * lamp.limb - air * 1.44269504) * place.y;
}

// Lommel and Seeliger: mu0/(mu0 + mu), on the side of the moon that faces us.
fn moon_disc(lamp: SkyLamp, real: vec3f, pixel_angle: f32, air: vec3f) -> Radiance {
    let place = disc_place(lamp, real, pixel_angle);
    let mu = face_cosine(place.x);
    let offset = (real - lamp.toward * dot(real, lamp.toward)) * lamp.inverse_radius;
    let mu0 = max(dot(offset - lamp.toward * mu, lamp.lit_from), 0.0);
    return lamp.disc * exp(-air) * (mu0 / max(mu0 + mu, 1e-4) * place.y);
}
