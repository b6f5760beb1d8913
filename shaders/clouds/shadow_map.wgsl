// Mapping of a place to the clouds' shadow map. The block is ShadowUniform of src/clouds/drawn/uniforms.rs.

// Placement of the shadow map, and the light that casts the shadows.
struct CloudShadows {
    // Unit vector towards the light (east, north, up), never level.
    to_light: vec3f,
    // Height of the plane above the sea, m.
    plane: f32,
    // Position of the camera in the map, in periods.
    camera: vec2f,
    // Side of the map, m; the map repeats with this period.
    period: f32,
    // Height of the camera above the plane, m.
    eye: f32,
    // Mean share of the direct light over all places.
    mean: f32,
    // Weight of the map against `mean`, 0 to 1.
    map_weight: f32,
    // Height above the plane, m, at and above which the mean share holds.
    top: f32,
    // Extinction of the air at the camera's height, 1/m.
    haze: f32,
    // Scale height of the extinction `haze`, m.
    haze_height: f32,
}

// Share of the direct light at a place relative to the camera (east, north, up), m.
fn cloud_shadow(shadows: CloudShadows, map: texture_2d<f32>, between: sampler, at: vec3f) -> f32 {
    let height = shadows.eye + at.z;
    let away = (at.xy - shadows.to_light.xy / shadows.to_light.z * height) / shadows.period;
    let here = textureSampleLevel(map, between, shadows.camera + away, 0.0).r;
    // The map gives way to the mean from 0.4 to 0.46 of a period from the camera, and over the last 100 m below `top`.
    let far = max(abs(away.x), abs(away.y));
    let weight = shadows.map_weight * clamp((0.46 - far) / 0.06, 0.0, 1.0) * clamp((shadows.top - height) / 100.0, 0.0, 1.0);
    return mix(shadows.mean, here, weight);
}
