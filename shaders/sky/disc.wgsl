//!include "sky/lookup.wgsl"
// Discs of sun and moon. The light in the air uses a lamp's geometric direction. The disc is drawn where refraction
// shows it, lifted, and flattened at the horizon.

// Lift by standard air, degrees, at an apparent elevation in degrees (Bennett 1982, whose formula gives arc minutes).
fn refraction_deg(apparent_deg: f32) -> f32 {
    let a = clamp(apparent_deg, -2.0, 89.9);
    let x = (a + 7.31 / (a + 4.4)) * (SKY_PI / 180.0);
    return max(cos(x) / max(sin(x), 1e-3), 0.0) / 60.0;
}

// Geometric direction of the point that is seen in `dir`. Refraction decreases with the density of the air at the
// observer.
fn unrefracted(dir: vec3f) -> vec3f {
    let density = exp(-max(sky_view.altitude, 0.0) / sky_view.air.rayleigh_scale_height_m);
    let elevation = SKY_PI * 0.5 - sky_acos(dir.z);
    let lift = sky_view.refraction * density * refraction_deg(elevation * (180.0 / SKY_PI)) * (SKY_PI / 180.0);
    let level = max(length(dir.xy), 1e-6);
    let z = dir.z * cos(lift) - level * sin(lift);
    return vec3f(dir.xy * (sqrt(max(1.0 - z * z, 0.0)) / level), z);
}

// Number of lamps whose discs a pipeline draws: those of `SKY_LAMPS`, then those that do not light the air. A missing
// lamp has no radiance.
override SKY_DISCS: u32 = 2u;
// Whether the first lamp is a sun and the second one a moon, so that each needs only its own reflectance law.
override SUN_THEN_MOON: bool = false;

// Distance of `dir` from the centre of a disc, as a share of its radius, and the share of the pixel that the disc
// covers.
fn disc_place(lamp: SkyLamp, dir: vec3f, pixel_angle: f32) -> vec2f {
    // Angle from the series of its sine, within 1e-5 of its value for the largest discs.
    let chord = 0.5 * length(dir - lamp.toward);
    let apart = chord * (2.0 + chord * chord * 0.33333333);
    let cover = clamp((lamp.angular_radius - apart) / max(pixel_angle, 1e-6) + 0.5, 0.0, 1.0);
    return vec2f(min(apart * lamp.inverse_radius, 1.0), cover);
}

// Radiance of the lamps' discs in a direction, reddened by the air; 0 below the horizon. The edge is smoothed over
// `pixel_angle`, the angle of a pixel, rad.
fn disc_radiance(dir: vec3f, pixel_angle: f32) -> Radiance {
    return disc_radiance_on(whole_path(dir), dir, pixel_angle);
}

fn disc_radiance_on(path: SkyPath, dir: vec3f, pixel_angle: f32) -> Radiance {
    return disc_faces(dir, pixel_angle, path.depth, false) * f32(path.ray.grounded == 0u);
}

// Radiance of the discs above the eye's level, where the air in front of a disc depends only on the elevation.
fn disc_radiance_above(dir: vec3f, pixel_angle: f32) -> Radiance {
    return disc_faces(dir, pixel_angle, vec3f(0.0), true);
}

// Optical depth of the air in front of a disc at this sine of elevation; see src/sky/disc.rs.
fn depth_before_disc(lamp: SkyLamp, sine: f32) -> vec3f {
    let x = sqrt(clamp((sine - lamp.depth_from) * lamp.depth_scale, 0.0, 1.0));
    return exp(lamp.depth[0].xyz + x * (lamp.depth[1].xyz + x * (lamp.depth[2].xyz + x * lamp.depth[3].xyz)));
}

// Radiance of the discs behind air of the optical depth `depth`. With `by_height`, the depth is that in front of each
// disc at the elevation of `dir`.
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

// Cosine of the angle between the line of sight and the normal of a disc's sphere, at a share of the disc's radius.
fn face_cosine(share: f32) -> f32 {
    return sqrt(max(1.0 - share * share, 1e-4));
}

// Sun with limb darkening mu^a. `air` is the optical depth between eye and disc.
fn sun_disc(lamp: SkyLamp, real: vec3f, pixel_angle: f32, air: vec3f) -> Radiance {
    let place = disc_place(lamp, real, pixel_angle);
    return lamp.disc * exp2(log2(face_cosine(place.x)) * lamp.limb - air * 1.44269504) * place.y;
}

// Moon with the law of Lommel and Seeliger, mu0/(mu0 + mu), on the side that faces the eye.
fn moon_disc(lamp: SkyLamp, real: vec3f, pixel_angle: f32, air: vec3f) -> Radiance {
    let place = disc_place(lamp, real, pixel_angle);
    let mu = face_cosine(place.x);
    let offset = (real - lamp.toward * dot(real, lamp.toward)) * lamp.inverse_radius;
    let mu0 = max(dot(offset - lamp.toward * mu, lamp.lit_from), 0.0);
    return lamp.disc * exp(-air) * (mu0 / max(mu0 + mu, 1e-4) * place.y);
}
