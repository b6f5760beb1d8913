// Local cloud cover that overrides a layer's own. The f64 reference is src/clouds/field/placed.rs, which describes the
// model.
//!include "clouds/block.wgsl"

// Host's maps of layers, one below the other: threshold, dome, extinction, 1/m, distance within which the threshold
// stays the same, m.
@group(0) @binding(8) var cloud_maps: texture_2d<f32>;
// Linear sampler that repeats.
@group(0) @binding(5) var cloud_sampler: sampler;

// Whether there is a map or a rain area.
override CLOUD_PLACED: bool = false;

// Threshold above which there is no cloud: just below CLEAR of src/clouds/field/thresholds.rs.
const CLOUD_CLEAR_FROM: f32 = 6.95;

// A layer with the local cover of a place.
struct CloudLocal {
    // The layer with its local threshold, dome and extinction.
    layer: CloudLayer,
    // Distance within which the layer's threshold stays the same, m.
    steady: f32,
    // Largest change of the threshold per metre beyond the distance `steady`.
    slope: f32,
}

// Share by which a place is filled over a rain area, 0 to 1, and the place's distance from the area's cell, m.
fn cloud_filled_over(area: CloudArea, level: vec2f) -> vec2f {
    let away = level - area.place.xy;
    let p = vec2f(dot(away, area.place.zw), dot(away, vec2f(-area.place.w, area.place.z)));
    let k = p / area.extent.xy;
    let k1 = length(k);
    let depth = (1.0 - k1) * select(k1 / max(length(k / area.extent.xy), 1e-12), area.extent.w, k1 < 1e-4);
    return vec2f(clamp(depth / max(area.extent.z, 1e-6), 0.0, 1.0), max(k1 - 1.0, 0.0) * area.extent.w);
}

// Returns the layer with its local cover at `level`, m east and north of the camera, without the lean.
fn cloud_local(layer: CloudLayer, level: vec2f) -> CloudLocal {
    var here = CloudLocal(layer, 1e9, layer.cells.w);
    if !CLOUD_PLACED {
        return here;
    }
    var cut = vec3f(layer.shape.xy, layer.size.w);
    if layer.cells.x > 0.0 {
        let cell = clamp(layer.mapped.xy + level * layer.mapped.z, vec2f(0.0), layer.cells.xy - 1.0);
        let uv = (cell + vec2f(0.5, 0.5 + layer.mapped.w)) / vec2f(textureDimensions(cloud_maps));
        let found = textureSampleLevel(cloud_maps, cloud_sampler, uv, 0.0);
        cut = found.xyz;
        here.steady = found.w;
    }
    var most = 0.0;
    for (var i = 0u; i < (u32(layer.filled.w) & 31u); i++) {
        let over = cloud_filled_over(clouds.areas[i], level);
        most = max(most, over.x);
        here.steady = min(here.steady, over.y);
    }
    cut = mix(cut, layer.filled.xyz, most);
    here.layer.shape.x = cut.x;
    here.layer.shape.y = cut.y;
    here.layer.size.w = cut.z;
    here.layer.stretch.w = layer.cells.z / (cut.y * cut.y);
    return here;
}
