// Factor on the light of the air where the share of direct light differs from its mean over places.
//!include "common/frame.wgsl"
//!include "sky/lookup.wgsl"

// Ratio of the radiance that a unit of air scatters from sky light to the irradiance of that light on level ground,
// 1/sr. Sky light comes evenly from half of all directions (1 / 2 pi), and the ground reflects 0.15 of it.
const SHAFT_DIFFUSE: f32 = 0.18;

// Returns the ratio of the radiance of the air in a direction to its mean, for each channel, where the share of direct
// light exceeds its mean by `differs`. Direct light is scattered by the phase function, sky light evenly in all
// directions.
fn shaft_light(direction: vec3f, differs: f32) -> vec3f {
    let air = sky_view.air;
    let toward = select(sky_view.lamps[0].toward, sky_view.lamps[1].toward, sky_view.lamps[0].toward.z < 0.0);
    let nu = dot(direction, toward);
    let density = air_density(air, sky_view.altitude);
    let scattering = vec2f(air.rayleigh_scattering.y * density.x, air.mie_scattering.y * density.y);
    let phases = vec2f(rayleigh_phase(nu), mie_phase(nu, air.asymmetry_g));
    let phase = dot(scattering, phases) / max(scattering.x + scattering.y, 1e-12);
    // Ratio of the sky's light on level ground to the direct light on a surface that faces the sun between clouds.
    let mean = frame.cloud_shadow.w;
    let diffuse = toward.z * (1.0 / max(frame.cloud_shadow.rgb, vec3f(1e-4)) - mean);
    return max(1.0 + phase / (mean * phase + SHAFT_DIFFUSE * max(diffuse, vec3f(1e-3))) * differs, vec3f(0.0));
}
