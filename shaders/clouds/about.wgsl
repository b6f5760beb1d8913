// What a ray finds of a cloud at a place, and how much cloud lies about it. In its place about_box.wgsl stands for a box of even cloud.
//!include "clouds/field.wgsl"
//!include "clouds/light.wgsl"

// Steps towards the sun.
override CLOUD_SUN_STEPS: u32 = 5u;

// A cloud at a place.
struct CloudHere {
    // How far the excess is from where there may be any cloud; below 0 there may be.
    gap: f32,
    // Excess over the threshold, frayed.
    excess: f32,
    // 1/m.
    extinction: f32,
}

fn cloud_here(layer: CloudLayer, at: CloudPlace) -> CloudHere {
    let over = cloud_strength(layer, at.level) - layer.shape.x;
    let excess = over - cloud_dome(layer, at.height);
    let gap = -MOST_FRAYED * layer.shape.z - excess;
    if gap > 0.0 {
        return CloudHere(gap, over, 0.0);
    }
    let frays = cloud_frays(layer, at);
    return CloudHere(gap, over + frays, cloud_extinction(layer, excess + frays));
}

// Distance to a gap that wide in excess, m: it changes along a ray no faster than the map and the dome do.
fn cloud_skip(layer: CloudLayer, gap: f32, direction: vec3f) -> f32 {
    let steepest = STEEPEST * layer.size.z * length(direction.xy) + 2.0 * layer.shape.y * layer.size.y * abs(direction.z);
    return gap / (steepest + 1e-6);
}

// Altitude at a distance along a ray.
fn cloud_altitude(direction: vec3f, t: f32) -> f32 {
    let r = clouds.radius + clouds.altitude;
    let rise = t * (2.0 * direction.z + t / r);
    return clouds.altitude + rise * r / (r + sqrt(max(r * (r + rise), 0.0)));
}

fn cloud_place(layer: CloudLayer, direction: vec3f, t: f32) -> CloudPlace {
    let altitude = cloud_altitude(direction, t);
    // Along the ground.
    let level = direction.xy * t * (clouds.radius / (clouds.radius + altitude));
    return CloudPlace(level, (altitude - layer.size.x) * layer.size.y);
}

// Scaled depth from a place towards the sun.
fn cloud_sun_depth(layer: CloudLayer, at: CloudPlace, scaled: f32) -> f32 {
    let sun = vec3f(clouds.to_sun.xy, max(clouds.to_sun.z, 0.02));
    var step = 0.06 / layer.size.z;
    var gone = 0.0;
    var depth = 0.0;
    for (var i = 0u; i < CLOUD_SUN_STEPS; i++) {
        let t = gone + 0.5 * step;
        let p = CloudPlace(at.level + sun.xy * t, at.height + sun.z * t * layer.size.y);
        let inside = p.height >= 0.0 && p.height <= 1.0;
        var excess = cloud_strength(layer, p.level) - layer.shape.x - cloud_dome(layer, p.height);
        excess += cloud_frays(layer, p);
        depth += select(0.0, cloud_extinction(layer, excess), inside) * step;
        gone += step;
        step *= 1.7;
    }
    return depth * scaled;
}

fn cloud_depths(layer: CloudLayer, at: CloudPlace, excess: f32) -> CloudDepths {
    let scaled = layer.size.w * layer.medium.y;
    let about = cloud_about(layer, excess, at.height) * scaled;
    let to_sun = cloud_sun_depth(layer, at, layer.medium.y);
    let sine = length(clouds.to_sun.xy);
    let edge = max(about.z, 0.02);
    let other = max(layer.below.w - edge, edge);
    // The sun's rays come in at a side where they have less cloud before them than straight up.
    let by_side = to_sun < about.x / max(clouds.to_sun.z, 0.02);
    let near = select(max(edge, to_sun * sine), max(to_sun * sine, 0.02), by_side);
    return CloudDepths(about.x, about.y, to_sun, near, other, edge, other);
}
