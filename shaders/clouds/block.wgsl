// What a frame knows of its clouds: CloudsUniform of src/clouds/drawn/uniforms.rs.

const CLOUD_LAYERS: u32 = 16u;

struct CloudLayer {
    // Altitude of the base, m; 1/thickness, 1/m; 1/distance from cloud to cloud, 1/m; extinction inside, 1/m.
    size: vec4f,
    // Threshold of the map, dome, how far edges fray, 1/softness.
    shape: vec4f,
    // Where the camera stands on the map's first and second sheet, in their periods.
    sheets: vec4f,
    // Where it stands in the solid noise, in its period (up: of the layer's base); share of the cellular pattern.
    solid: vec4f,
    // Light of the lamp on what faces it, lux times exposure.
    sun: vec4f,
    // Radiance of sky and higher clouds above it, cd/m^2 times exposure.
    above: vec4f,
    // Radiance of ground and lower clouds below it; scaled width of a cloud from side to side.
    below: vec4f,
    // Index of the medium that it is made of; scaled extinction over extinction; how much of the layer is drawn as a
    // volume; 1/side of the solid noise, 1/m.
    medium: vec4f,
    // To a pattern that is not drawn out along the wind: xx, xy and yy; how domes of heaps grow with their place's
    // excess.
    stretch: vec4f,
    // How far the top lies downwind of the base (east, north), m; least excess with an anvil over it; length of the
    // first two.
    lean: vec4f,
    // Of a host's map of it (placed.wgsl): where the camera stands, in cells from the middle of the first, 1/cell, 1/m,
    // row of its first texels.
    mapped: vec4f,
    // Cells of the map east and north, 0 without; held domes times dome squared; most change of threshold a metre.
    cells: vec4f,
    // Where it is filled over rain areas: threshold, dome, extinction, 1/m; how many areas there are, 0 for other
    // layers.
    filled: vec4f,
}

// A cell of cloud over a rain area: an ellipse.
struct CloudArea {
    // Its middle, m east and north of the camera; the way to the right.
    place: vec4f,
    // Half its extent to the right and ahead, width over which it sets in, smaller half extent, m.
    extent: vec4f,
}

struct CloudMedium {
    // Phase function: asymmetry of the Henyey-Greenstein lobe and of Draine's, Draine's alpha, weight of Draine's.
    lobes: vec4f,
    // Share of scattering counted as straight on; 1/sr above which the phase function is cut off; 1 - asymmetry of the
    // rest; albedo of the rest.
    rest: vec4f,
}

struct CloudsUniform {
    // Unit, towards the lamp that lights them, (east, north, up) at the camera; number of layers.
    to_sun: vec3f,
    layer_count: u32,
    // Altitude of the camera, m; radius of the planet's ground, m; jitter of the first step.
    altitude: f32,
    radius: f32,
    jitter: f32,
    unused: f32,
    media: array<CloudMedium, 2>,
    layers: array<CloudLayer, 16>,
    areas: array<CloudArea, 16>,
}

// Some places are looked at over widths in which clouds differ (field.wgsl).
override CLOUD_COARSE: bool = false;

@group(0) @binding(1) var<uniform> clouds: CloudsUniform;

// How many layers there are, as lights_binding.wgsl cuts a count.
fn cloud_layers() -> u32 {
    return clouds.layer_count & 31u;
}

// Where a ray begins, relative to the camera (east, north, up), m: at the camera, but for rays of parallel views.
var<private> cloud_origin: vec3f;

// Height of that place above the planet's ground, m.
fn cloud_eye() -> f32 {
    return clouds.altitude + cloud_origin.z;
}
