//!include "sky/air.wgsl"
// Rays in a shell of air, in f32 from -100 m to 1e7 m. Altitudes are never computed as a difference of radii, and
// lengths that nearly cancel are computed from their conjugates. The f64 reference is src/sky/reference/ray.rs.

struct SkyRay {
    // Altitude of the ray's start, at most that of the top of the air; cosine of the ray's zenith angle and distance
    // from the planet's centre there.
    altitude: Length,
    mu: Cosine,
    radius: Length,
    // Radius and altitude of the point of the line that is closest to the planet's centre.
    perigee_radius: Length,
    perigee: Length,
    // Distance from the point that `sky_ray` was given to the ray's start, and from the start to the end of the ray or
    // of the air.
    before: Length,
    length: Length,
    // 1 if the ray ends on the ground.
    grounded: u32,
}

// Cosine of the zenith angle of the horizon: -sqrt(h (2R + h))/(R + h).
fn horizon_mu(air: SkyAir, altitude: Length) -> Cosine {
    let h = max(altitude, 0.0);
    return -sqrt(h * (2.0 * air.bottom_m + h)) / (air.bottom_m + h);
}

// Altitude of the point at `distance` along a ray.
fn altitude_along(radius: Length, altitude: Length, mu: Cosine, distance: Length) -> Length {
    let s = distance * (distance + 2.0 * radius * mu);
    return altitude + s / (radius + sqrt(max(radius * radius + s, 0.0)));
}

// Ray from `altitude` at zenith cosine `mu_start`, limited to the air. The caller decides `grounded`; the sign of a
// root would cause speckles on both sides of the horizon.
fn sky_ray(air: SkyAir, altitude: Length, mu_start: Cosine, grounded: bool) -> SkyRay {
    var h = max(altitude, 0.0);
    var mu = mu_start;
    var r = air.bottom_m + h;
    var before = 0.0;
    var inside = true;
    if (h > air.thickness_m) {
        let b = r * mu;
        let c = (h - air.thickness_m) * (2.0 * air.bottom_m + h + air.thickness_m);
        let root = sqrt(max(b * b - c, 0.0));
        inside = b < 0.0 && b * b > c;
        before = select(0.0, c / max(root - b, 1.0), inside);
        h = air.thickness_m;
        r = air.bottom_m + h;
        mu = select(0.0, max(-root / r, -1.0), inside);
    }
    let sine = sqrt(max((1.0 - mu) * (1.0 + mu), 0.0));
    let drop = r * mu * mu / (1.0 + sine);
    let b = r * mu;
    let up = (air.thickness_m - h) * (2.0 * air.bottom_m + air.thickness_m + h);
    let down = h * (2.0 * air.bottom_m + h);
    let up_root = sqrt(b * b + up);
    let to_top = select(up_root - b, up / max(up_root + b, 1e-3), b > 0.0);
    let to_ground = down / max(sqrt(max(b * b - down, 0.0)) - b, 1e-3);
    let len = select(0.0, select(to_top, to_ground, grounded), inside);
    return SkyRay(h, mu, r, r * sine, h - drop, before, len, u32(grounded));
}

// e^(z^2) erfc(z) for z >= 0 within 2e-6: t P(t), t = 1/(1 + 0.35 z), with P fitted at Chebyshev nodes.
fn erfcx(z: vec2f) -> vec2f {
    let t = 1.0 / (1.0 + 0.35 * z);
    let p = 0.19746665 + t * (0.19742708 + t * (0.18628623 + t * (0.15254212 + t * (0.16876432
        + t * (-0.02277911 + t * (0.20700841 - t * 0.08671662))))));
    return t * p;
}

// Columns of gas and haze from the point at radius r straight out along the ray, in metres at the density of that
// point, which is `rise` above the perigee p. With v^2 = r - p, ds = 2 (p + v^2)/sqrt(2p + v^2) dv is expanded to first
// order around the point. That leaves integrals of e^(-v^2/H) and v^2 e^(-v^2/H), where H is the scale height. The
// relative error is 5e-7 for the Earth, and 5e-3 where H is a sixth of the radius, at any angle. (The function is that
// of Chapman 1931; the expansion is our own.)
fn chapman(air: SkyAir, rise: Length, r: Length, p: Length) -> vec2f {
    let scale_height = vec2f(air.rayleigh_scale_height_m, air.mie_scale_height_m);
    let z = sqrt(max(rise, 0.0) / scale_height);
    let e = 0.88622693 * erfcx(z);
    let sum = r + p;
    let g0 = 2.0 * r * inverseSqrt(sum);
    let g1 = (r + 2.0 * p) * inverseSqrt(sum) / sum;
    return sqrt(scale_height) * (g0 * e + g1 * scale_height * (0.5 * z + e * (0.5 - z * z)));
}

// Column of the ozone tent from the perigee up to `altitude`, by Simpson's rule in each half of the tent.
fn ozone_from_perigee(air: SkyAir, perigee: Length, p: Length, altitude: Length) -> Length {
    let edges = vec3f(-air.ozone_half_width_m, 0.0, air.ozone_half_width_m) + air.ozone_center_m;
    let h = clamp(edges, vec3f(perigee), vec3f(altitude));
    let t = sqrt(max((h - perigee) * (h + (perigee + 2.0 * air.bottom_m)), vec3f(0.0)));
    let m = 0.5 * (t.xy + t.yz);
    let hm = perigee + m * m / (sqrt(p * p + m * m) + p);
    let d = max(1.0 - abs(h - air.ozone_center_m) / air.ozone_half_width_m, vec3f(0.0));
    let dm = max(1.0 - abs(hm - air.ozone_center_m) / air.ozone_half_width_m, vec2f(0.0));
    let parts = (t.yz - t.xy) * (d.xy + 4.0 * dm + d.yz);
    return (parts.x + parts.y) / 6.0;
}

// Values that the columns from a ray's start to any of its points share.
struct SkyColumns {
    // Columns outwards from the start: of gas and haze, negative if the ray descends; and of ozone, from the perigee.
    gas_haze: vec2f,
    ozone: f32,
    // Columns added once the perigee is passed.
    turn: vec2f,
    // Side of the perigee on which the ray starts: -1 before it, 1 after it.
    side: f32,
}

fn sky_columns(air: SkyAir, ray: SkyRay) -> SkyColumns {
    let side = select(-1.0, 1.0, ray.mu >= 0.0);
    let h = ray.altitude;
    let p = ray.perigee_radius;
    let start = side * air_density(air, h).xy * chapman(air, h - ray.perigee, air.bottom_m + h, p);
    let turn = 2.0 * air_density(air, ray.perigee).xy * chapman(air, 0.0, p, p);
    return SkyColumns(start, side * ozone_from_perigee(air, ray.perigee, p, h), turn, side);
}

// Columns of gas, haze and ozone from the ray's start to the point at `altitude` on the given side of the perigee, in
// metres at density 1. Closed form, with an error of about 0.1 m at any distance.
fn columns_to(air: SkyAir, ray: SkyRay, start: SkyColumns, altitude: Length, side: f32) -> vec3f {
    let p = ray.perigee_radius;
    let here = side * air_density(air, altitude).xy * chapman(air, altitude - ray.perigee, air.bottom_m + altitude, p);
    let turn = select(vec2f(0.0), start.turn, side != start.side);
    let ozone = side * ozone_from_perigee(air, ray.perigee, p, altitude) - start.ozone;
    return max(vec3f(start.gas_haze - here + turn, ozone), vec3f(0.0));
}

// Columns from the ray's start to `distance`, in metres at density 1, with a relative error of 1e-4. Short columns are
// computed by Simpson's rule, long ones in closed form.
fn columns_along(air: SkyAir, ray: SkyRay, distance: Length) -> vec3f {
    let h0 = ray.altitude;
    let h1 = clamp(altitude_along(ray.radius, h0, ray.mu, distance), 0.0, air.thickness_m);
    let hm = altitude_along(ray.radius, h0, ray.mu, 0.5 * distance);
    let start = sky_columns(air, ray);
    let side = select(-1.0, 1.0, ray.radius * ray.mu + distance >= 0.0);
    let long = columns_to(air, ray, start, h1, side);
    let short = distance / 6.0 * (air_density(air, h0) + 4.0 * air_density(air, hm) + air_density(air, h1));
    let spread = select(abs(h1 - h0), max(h0, h1) - ray.perigee, side != start.side);
    let is_short = vec2f(spread) < 0.15 * vec2f(air.rayleigh_scale_height_m, air.mie_scale_height_m);
    return vec3f(select(long.xy, short.xy, is_short), long.z);
}

// Share of the light's disc above the horizon of a point, and the zenith cosine of the middle of that share. x is the
// height of the disc's centre above the horizon in disc radii.
fn disc_above_horizon(air: SkyAir, altitude: Length, mu_s: Cosine) -> vec2f {
    let h = max(altitude, 0.0);
    let r = air.bottom_m + h;
    let horizon = -sqrt(h * (2.0 * air.bottom_m + h)) / r;
    let radius = max(air.sun_angular_radius, 1e-5) * air.bottom_m / r;
    let x = clamp((mu_s - horizon) / radius, -1.0, 1.0);
    let y = 0.5 + 0.5 * x;
    // Area of a disc cut by a chord, 1/2 + (x sqrt(1 - x^2) + asin x)/pi, as a series whose last term makes it exact at
    // the ends.
    let xx = x * x;
    let share = 0.5 + x * (0.63662 - xx * (0.10610 + xx * (0.01592 + xx * 0.01460)));
    let middle = horizon + radius * y * (0.7 + 0.3 * y);
    return vec2f(share, max(mu_s, middle));
}

// Transmittance from a point to the light, over the share of its disc that the planet does not hide.
fn sun_transmittance(air: SkyAir, altitude: Length, mu_s: Cosine) -> vec3f {
    let disc = disc_above_horizon(air, altitude, mu_s);
    let ray = sky_ray(air, altitude, disc.y, false);
    let columns = columns_to(air, ray, sky_columns(air, ray), air.thickness_m, 1.0);
    return disc.x * exp(-air_optical_depth(air, columns));
}

// Interval of a ray in the planet's shadow, from `x` to `y` metres along it; empty if y <= x. The shadow is a cylinder
// behind the planet.
fn shadow_stretch(air: SkyAir, ray: SkyRay, mu_s: Cosine, nu: Cosine) -> vec2f {
    let r = ray.radius;
    let a = max(1.0 - nu * nu, 1e-9);
    let b = r * (ray.mu - mu_s * nu);
    let c = ray.altitude * (2.0 * air.bottom_m + ray.altitude) - r * r * mu_s * mu_s;
    let root = sqrt(max(b * b - a * c, 0.0));
    // Part of the cylinder's interval behind the plane through the planet's centre that is perpendicular to the light.
    let plane = -r * mu_s / select(nu, 1e-9, abs(nu) < 1e-9);
    let enter = select((-b - root) / a, max((-b - root) / a, plane), nu < 0.0);
    let leave = select((-b + root) / a, min((-b + root) / a, plane), nu > 0.0);
    return select(vec2f(1.0, 0.0), vec2f(enter, leave), b * b > a * c);
}
