//!include "common/fullscreen.wgsl"
//!include "sky/disc.wgsl"
// Answers queries with the look-ups that pictures use. Each query is one texel; results are the bits of f32.

// xyz: direction (unit, the observer's frame), w: distance, m.
@group(0) @binding(0) var questions: texture_2d<f32>;

struct Answer {
    @location(0) radiance: vec4u,
    @location(1) transmittance: vec4u,
}

fn answer(radiance: vec3f, transmittance: vec3f) -> Answer {
    return Answer(vec4u(bitcast<vec3u>(radiance), 0u), vec4u(bitcast<vec3u>(transmittance), 0u));
}

@fragment
fn probe_sky(in: FullscreenVarying) -> Answer {
    let dir = textureLoad(questions, vec2i(in.position.xy), 0).xyz;
    return answer(sky_radiance(dir), sky_transmittance(dir));
}

@fragment
fn probe_aerial(in: FullscreenVarying) -> Answer {
    let question = textureLoad(questions, vec2i(in.position.xy), 0);
    let seen = aerial(question.xyz, question.w);
    return answer(seen.radiance, seen.transmittance);
}

// Direct light of the lamps, and light of the sky, on a level surface at the observer's altitude.
@fragment
fn probe_irradiance(in: FullscreenVarying) -> Answer {
    var direct = vec3f(0.0);
    for (var i = 0u; i < (sky_view.lamp_count & 3u); i++) {
        direct += lamp_irradiance(i, sky_view.altitude) * max(sky_view.lamps[i].toward.z, 0.0);
    }
    return answer(direct, sky_irradiance(sky_view.altitude));
}

// Light of the ground, and light of the discs.
@fragment
fn probe_ground(in: FullscreenVarying) -> Answer {
    let dir = textureLoad(questions, vec2i(in.position.xy), 0).xyz;
    return answer(ground_radiance(dir), disc_radiance(dir, 1e-4));
}
