// Clouds of a frame: CloudsUniform of src/clouds/drawn/uniforms.rs.

// Largest number of layers, the size of the arrays.
const CLOUD_LAYERS: u32 = 16u;

// One layer of cloud.
struct CloudLayer {
    // Altitude of the base, m; 1/thickness, 1/m; 1/distance from cloud to cloud, 1/m; extinction inside, 1/m.
    size: vec4f,
    // Threshold of the map, dome, amplitude of the fraying, 1/softness.
    shape: vec4f,
    // Position of the camera on the map's first and second sheet, in their periods.
    sheets: vec4f,
    // Position of the camera in the solid noise, east and north, in periods; 0, because the noise begins at the layer's
    // base; share of the cellular pattern.
    solid: vec4f,
    // Illuminance by the sun or moon on a surface that faces it, lux times exposure.
    sun: vec4f,
    // Radiance of sky and higher clouds above the layer, cd/m^2 times exposure.
    above: vec4f,
    // Radiance of ground and lower clouds below the layer, cd/m^2 times exposure; scaled optical depth of a cloud from
    // side to side.
    below: vec4f,
    // Index of the medium; ratio of scaled extinction to extinction; share of the layer that is drawn as a volume;
    // 1/side of the solid noise, 1/m.
    medium: vec4f,
    // Matrix to the pattern before its stretch along the wind: xx, xy and yy; growth of the domes of cumulus with the
    // excess.
    stretch: vec4f,
    // Distance that the top lies downwind of the base, m (east, north); least excess that has an anvil above it; length
    // of the vector (east, north), m.
    lean: vec4f,
    // Host's map of the layer (placed.wgsl): position of the camera (east, north), in cells from the middle of the
    // first cell; 1/side of a cell, 1/m; row of the map's first texels.
    mapped: vec4f,
    // Number of the map's cells east and north, 0 without a map; growth of the domes times the dome squared; largest
    // change of the threshold per metre.
    cells: vec4f,
    // Threshold, dome and extinction, 1/m, where the layer is filled over rain areas; number of areas, 0 for other
    // layers.
    filled: vec4f,
}

// A cell of cloud over a rain area: an ellipse.
struct CloudArea {
    // Middle, m east and north of the camera; unit vector to the right.
    place: vec4f,
    // Half extents to the right and ahead, width of the edge, smaller half extent, m.
    extent: vec4f,
}

// Scattering of one medium: droplets (0) or ice (1).
struct CloudMedium {
    // Phase function: asymmetry of the Henyey-Greenstein lobe and of Draine's, Draine's alpha, weight of Draine's.
    lobes: vec4f,
    // Share of scattering that counts as straight on; value at which the phase function is cut off, 1/sr; 1 - asymmetry
    // of the rest; single-scattering albedo of the rest.
    rest: vec4f,
}

// Clouds of a frame: their light, media, layers, and cells over rain areas.
struct CloudsUniform {
    // Unit vector towards the sun or moon that lights the clouds, (east, north, up) at the camera.
    to_sun: vec3f,
    // Number of layers.
    layer_count: u32,
    // Altitude of the camera, m.
    altitude: f32,
    // Radius of the planet's ground, m.
    radius: f32,
    // Offset of a ray's samples within their steps, 0 to 1.
    jitter: f32,
    // Padding.
    unused: f32,
    // Scattering of droplets (0) and ice (1).
    media: array<CloudMedium, 2>,
    // Layers, of which the first `layer_count` are in use.
    layers: array<CloudLayer, 16>,
    // Cells of cloud over rain areas.
    areas: array<CloudArea, 16>,
}

// Whether pixels at some places are wider than the structure of the clouds, which are then blurred (field.wgsl).
override CLOUD_COARSE: bool = false;

// Clouds of the frame.
@group(0) @binding(1) var<uniform> clouds: CloudsUniform;

// Number of layers, limited to 31 by a mask, so that a loop over them ends whatever the block holds.
fn cloud_layers() -> u32 {
    return clouds.layer_count & 31u;
}

// Origin of a ray relative to the camera (east, north, up), m: the camera, except for rays of parallel views.
var<private> cloud_origin: vec3f;

// Height of the ray's origin above the planet's ground, m.
fn cloud_eye() -> f32 {
    return clouds.altitude + cloud_origin.z;
}
