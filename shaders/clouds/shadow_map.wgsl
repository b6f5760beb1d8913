// Where a place lies in the map of the clouds' shadows: CloudShadows of src/clouds/drawn/uniforms.rs.

struct CloudShadows {
    // Unit, towards the light (east, north, up), never level.
    to_light: vec3f,
    // Height of the plane above the sea, m.
    plane: f32,
    // Where the camera stands in the map, in its period.
    camera: vec2f,
    // Metres from side to side of the map.
    period: f32,
    // Height of the camera above the plane, m.
    eye: f32,
    // Share of the direct light on the mean over places; how far shadows are told apart; height above the plane from
    // which on they are not.
    mean: f32,
    told: f32,
    top: f32,
    // What the air takes at the camera's height, 1/m, and the height over which it thins, m.
    haze: f32,
    haze_height: f32,
}

// Share of the direct light at a place relative to the camera (east, north, up), m.
fn cloud_shadow(shadows: CloudShadows, map: texture_2d<f32>, between: sampler, at: vec3f) -> f32 {
    let height = shadows.eye + at.z;
    let away = (at.xy - shadows.to_light.xy / shadows.to_light.z * height) / shadows.period;
    let here = textureSampleLevel(map, between, shadows.camera + away, 0.0).r;
    // Far off, and within clouds, the mean counts.
    let far = max(abs(away.x), abs(away.y));
    let told = shadows.told * clamp((0.46 - far) / 0.06, 0.0, 1.0) * clamp((shadows.top - height) / 100.0, 0.0, 1.0);
    return mix(shadows.mean, here, told);
}
