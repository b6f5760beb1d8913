//!include "sky/view.wgsl"
//!include "sky/march.wgsl"
// Look-ups of the sky for other shaders. Bind group 1 is `SkyVolume::bind_group()`.
//
// `dir` is a unit vector from the observer in its local level frame: z up, x and y any level axes, in which the host
// also gave the lamps' directions (`Lamp::toward`). Radiances follow the unit of the lamps' irradiance: they are in W
// m^-2 sr^-1 nm^-1 with `Planet::solar_irradiance`. Distances are metres from the observer.

struct SkyLamp {
    // Unit vector towards the lamp, geometric (without refraction).
    toward: vec3f,
    angular_radius: f32,
    irradiance: vec3f,
    // 0: a sun; 1: a moon, lit from `lit_from`.
    kind: u32,
    // Exponents of a sun's limb darkening per wavelength (Hestroffer and Magnan 1998: I = mu^a); not read for a moon.
    limb: vec3f,
    // Reciprocal of the angular radius.
    inverse_radius: f32,
    lit_from: vec3f,
    // Least sine of elevation at which `depth` is valid. `depth_scale` is the reciprocal of the length of the interval
    // of valid sines.
    depth_from: f32,
    // Unit level vector towards the point of the horizon below the lamp.
    level: vec2f,
    // First layer of this lamp's tables.
    layer: u32,
    unused_b: u32,
    // Radiance of the disc where the law of its surface is 1.
    disc: vec3f,
    depth_scale: f32,
    // Logarithm of the optical depth of the air in front of the disc, per wavelength, as a cubic polynomial.
    depth: array<vec4f, 4>,
}

struct SkyView {
    air: SkyAir,
    dims: SkyDims,
    edges: SkyEdges,
    // Texture coordinates of the sky above the horizon: the centre of its first texel, and the offset from there to the
    // centre of its last texel.
    sky_above: vec4f,
    altitude: Length,
    lamp_count: u32,
    // Strength of refraction: 0 is none, 1 that of the Earth's standard air.
    refraction: f32,
    // Number of panels in a pixel's march.
    march_panels: u32,
    lamps: array<SkyLamp, 2>,
}

@group(1) @binding(0) var<uniform> sky_view: SkyView;
// Observer's sky, and the air in front of objects.
@group(1) @binding(1) var sky_tables: texture_2d_array<f32>;
// Light of the planet. If pixels march, the sources lie below the light in the texture.
@group(1) @binding(2) var sky_lights: texture_2d<f32>;
@group(1) @binding(3) var sky_sampler: sampler;

// Whether every pixel marches, as in the model `BruteForce`; set by `SkyTables::pipeline_constants`.
override SKY_MARCH: bool = false;
// Number of lamps that a pipeline draws; 2 means `lamp_count`. A constant of 0 or 1 needs no loop; on a software driver
// a loop costs one more iteration than it has.
override SKY_LAMPS: u32 = 2u;

fn sky_lamps() -> u32 {
    if SKY_LAMPS < 2u {
        return SKY_LAMPS;
    }
    return sky_view.lamp_count & 3u;
}

struct Aerial {
    // Radiance scattered into the ray between observer and distance.
    radiance: Radiance,
    // Transmittance from that distance to the observer.
    transmittance: vec3f,
}

// Ray in a direction, limited to the air. Below the horizon it ends on the ground.
fn sky_view_ray(dir: vec3f) -> SkyRay {
    return sky_ray(sky_view.air, sky_view.altitude, dir.z, view_place(sky_view.edges, dir.z) < 0.0);
}

// Optical depth from the observer to `distance`.
fn sky_depth(ray: SkyRay, distance: Length) -> vec3f {
    let inside = clamp(distance - ray.before, 0.0, ray.length);
    return air_optical_depth(sky_view.air, columns_along(sky_view.air, ray, inside));
}

fn lamp_azimuth(lamp: SkyLamp, dir: vec3f) -> f32 {
    let level = dot(dir.xy, dir.xy);
    return sky_acos(clamp(dot(dir.xy, lamp.level) * inverseSqrt(max(level, 1e-12)), -1.0, 1.0)) / SKY_PI;
}

fn lamp_light(lamp: SkyLamp, dir: vec3f, smooth_light: vec4f, haze_light: vec4f) -> Radiance {
    let nu = dot(dir, lamp.toward);
    let phase = mie_phase(nu, sky_view.air.asymmetry_g);
    return lamp.irradiance * (sky_decode_signed(smooth_light) + phase * sky_decode_signed(haze_light));
}

// Light of a lamp along a ray by a march, for the model `BruteForce`, whose tables hold only light scattered more than
// once.
fn lamp_march(lamp: SkyLamp, dir: vec3f, ray: SkyRay, end: Length) -> Radiance {
    let nu = dot(dir, lamp.toward);
    let r = sky_view.air.bottom_m + max(sky_view.altitude, 0.0);
    let mu_s = clamp((r * lamp.toward.z + ray.before * nu) / ray.radius, -1.0, 1.0);
    let place = marched_sources();
    let light =
        sky_march(sky_view.air, sky_view.dims, sky_lights, place, sky_sampler, ray, 0.0, end, min(sky_view.march_panels, MOST_MARCH_PANELS), mu_s, nu);
    let once = light.gas * rayleigh_phase(nu) + light.haze * mie_phase(nu, sky_view.air.asymmetry_g);
    return lamp.irradiance * (once + light.more);
}

// Ray in a direction, and the optical depth from the observer to the end of the path. Several look-ups in one direction
// share this path.
struct SkyPath {
    ray: SkyRay,
    // Distance from the observer to the end of the path, m.
    distance: Length,
    depth: vec3f,
}

// Path to `distance`, or to the end of the ray if that is nearer.
fn sky_path(dir: vec3f, distance: Length) -> SkyPath {
    let ray = sky_view_ray(dir);
    let end = min(distance, ray.before + ray.length);
    return SkyPath(ray, end, sky_depth(ray, end));
}

fn whole_path(dir: vec3f) -> SkyPath {
    return sky_path(dir, 1e30);
}

// Radiance that the air scatters into a whole ray: to space, or below the horizon to the ground. Discs and the ground's
// own light are left out.
fn sky_radiance(dir: vec3f) -> Radiance {
    return sky_radiance_on(whole_path(dir), dir);
}

fn sky_radiance_on(path: SkyPath, dir: vec3f) -> Radiance {
    if (SKY_MARCH) {
        return marched_light(path.ray, dir);
    }
    let v = view_place(sky_view.edges, dir.z);
    let dims = sky_view.dims;
    let below = (f32(dims.sky_x) + view_row(v, dims.sky_above, dims.sky_below)) / f32(dims.tables_width);
    let at = select(below, place_above(v), v >= 0.0);
    return sky_table_light(dir, at) * select(air_opacity(path.depth), vec3f(1.0), v >= 0.0);
}

// Radiance as `sky_radiance` gives it, for directions above the horizon only.
fn sky_radiance_above(dir: vec3f) -> Radiance {
    if (SKY_MARCH) {
        return sky_radiance(dir);
    }
    return sky_table_light(dir, place_above(max(view_place(sky_view.edges, dir.z), 0.0)));
}

fn marched_light(ray: SkyRay, dir: vec3f) -> vec3f {
    var out = vec3f(0.0);
    for (var i = 0u; i < sky_lamps(); i++) {
        out += lamp_march(sky_view.lamps[i], dir, ray, ray.length);
    }
    return out;
}

// Texture coordinate x for coordinate `v` above the horizon.
fn place_above(v: f32) -> f32 {
    return sky_view.sky_above.x + v * sky_view.sky_above.z;
}

// Light from the table at texture coordinate `x`. Below the horizon the light is stored divided by the opacity of the
// air.
fn sky_table_light(dir: vec3f, x: f32) -> vec3f {
    var out = vec3f(0.0);
    for (var i = 0u; i < sky_lamps(); i++) {
        let lamp = sky_view.lamps[i];
        let uv = vec2f(x, sky_view.sky_above.y + lamp_azimuth(lamp, dir) * sky_view.sky_above.w);
        let a = textureSampleLevel(sky_tables, sky_sampler, uv, lamp.layer, 0.0);
        let b = textureSampleLevel(sky_tables, sky_sampler, uv, lamp.layer + 1u, 0.0);
        out += lamp_light(lamp, dir, a, b);
    }
    return out;
}

// Radiance and transmittance of the air between the observer and a point `distance` metres away in direction `dir`.
fn aerial(dir: vec3f, distance: Length) -> Aerial {
    return aerial_on(sky_path(dir, distance), dir);
}

fn aerial_on(path: SkyPath, dir: vec3f) -> Aerial {
    let dims = sky_view.dims;
    let ray = path.ray;
    let end = clamp(path.distance - ray.before, 0.0, ray.length);
    let depth = path.depth;
    var out = vec3f(0.0);
    if (SKY_MARCH) {
        for (var i = 0u; i < sky_lamps(); i++) {
            out += lamp_march(sky_view.lamps[i], dir, ray, end);
        }
        return Aerial(out, exp(-depth));
    }
    let size = vec2f(f32(dims.tables_width), f32(dims.tables_height));
    let tile = f32(dims.air_azimuths);
    let row = view_row(view_place(sky_view.edges, dir.z), dims.air_above, dims.air_below);
    let slice = slice_of(end, ray.length) * f32(dims.air_slices - 1u);
    let near = min(floor(slice), f32(dims.air_slices - 2u));
    for (var i = 0u; i < sky_lamps(); i++) {
        let lamp = sky_view.lamps[i];
        let x = 0.5 + lamp_azimuth(lamp, dir) * (tile - 1.0) + near * tile;
        let uv = vec2f(x, row) / size;
        let next = uv + vec2f(tile / size.x, 0.0);
        let f = slice - near;
        let a = mix(textureSampleLevel(sky_tables, sky_sampler, uv, lamp.layer, 0.0),
            textureSampleLevel(sky_tables, sky_sampler, next, lamp.layer, 0.0), f);
        let b = mix(textureSampleLevel(sky_tables, sky_sampler, uv, lamp.layer + 1u, 0.0),
            textureSampleLevel(sky_tables, sky_sampler, next, lamp.layer + 1u, 0.0), f);
        out += lamp_light(lamp, dir, a, b);
    }
    return Aerial(out * air_opacity(depth), exp(-depth));
}

// Transmittance of a whole ray to space; 0 below the horizon.
fn sky_transmittance(dir: vec3f) -> vec3f {
    return sky_transmittance_on(whole_path(dir));
}

fn sky_transmittance_on(path: SkyPath) -> vec3f {
    return select(exp(-path.depth), vec3f(0.0), path.ray.grounded == 1u);
}

// Irradiance of all lamps' skies on a level surface facing up. The sun angles are those at the observer.
fn sky_irradiance(altitude: Length) -> vec3f {
    var out = vec3f(0.0);
    for (var i = 0u; i < sky_lamps(); i++) {
        let lamp = sky_view.lamps[i];
        out += lamp.irradiance * diffuse_irradiance(altitude, lamp.toward.z);
    }
    return out;
}

const SKY_LIGHT_TILES: f32 = 7.0;
const SKY_LIGHT_SCALE: f32 = 4096.0;

fn light_table_size() -> vec2f {
    return vec2f(SKY_LIGHT_TILES * f32(sky_view.dims.suns), f32(sky_view.dims.altitudes));
}

fn sources_table_size() -> vec2f {
    let dims = sky_view.dims;
    return vec2f(f32(dims.azimuths * dims.suns), f32(dims.zeniths * dims.altitudes));
}

// Size of `sky_lights`, texels.
fn planet_table_size() -> vec2f {
    let light = light_table_size();
    if (!SKY_MARCH) {
        return light;
    }
    let sources = sources_table_size();
    return vec2f(max(light.x, sources.x), light.y + sources.y);
}

fn marched_sources() -> vec4f {
    let all = planet_table_size();
    return vec4f(vec2f(0.0, light_table_size().y) / all, sources_table_size() / all);
}

fn diffuse_irradiance(altitude: Length, mu_s: Cosine) -> vec3f {
    let dims = sky_view.dims;
    let at = planet_texel(sky_view.air, dims, altitude, mu_s) / planet_table_size();
    return max(textureSampleLevel(sky_lights, sky_sampler, at, 0.0).rgb, vec3f(0.0)) / SKY_LIGHT_SCALE;
}

// Irradiance of a lamp on a surface facing it, at `altitude`, with the observer's sun angle.
fn lamp_irradiance(index: u32, altitude: Length) -> vec3f {
    let lamp = sky_view.lamps[index];
    let h = clamp(altitude, 0.0, sky_view.air.thickness_m);
    return lamp.irradiance * sun_transmittance(sky_view.air, h, lamp.toward.z);
}

// Radiance of the planet's ground (a Lambert surface lit by lamps and sky), seen through the air; 0 above the horizon.
fn ground_radiance(dir: vec3f) -> Radiance {
    return ground_radiance_on(whole_path(dir), dir);
}

fn ground_radiance_on(path: SkyPath, dir: vec3f) -> Radiance {
    if (path.ray.grounded == 0u) {
        return vec3f(0.0);
    }
    let distance = path.distance;
    let r = sky_view.air.bottom_m + max(sky_view.altitude, 0.0);
    var lit = vec3f(0.0);
    for (var i = 0u; i < sky_lamps(); i++) {
        let lamp = sky_view.lamps[i];
        let mu_s = clamp((r * lamp.toward.z + distance * dot(dir, lamp.toward)) / sky_view.air.bottom_m, -1.0, 1.0);
        let direct = max(mu_s, 0.0) * sun_transmittance(sky_view.air, 0.0, mu_s);
        lit += lamp.irradiance * (direct + diffuse_irradiance(0.0, mu_s));
    }
    return sky_view.air.ground_albedo / SKY_PI * lit * exp(-path.depth);
}
