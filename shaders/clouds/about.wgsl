// Cloud at a place on a ray, and the depths of cloud around the place. In the probe, about_box.wgsl replaces this file
// by a box of even cloud.
//!include "clouds/field.wgsl"
//!include "clouds/light.wgsl"

// Number of intervals of the path to the sun.
const SUN_STEPS: u32 = 5u;
// Number of first intervals in which solid noise frays the clouds' edges; farther on they are smooth.
const SUN_FRAYED: u32 = 3u;
// Ends of the intervals of the path to the sun, in distances from cloud to cloud.
const SUN_WAY = array<f32, 5>(0.05, 0.15, 0.3, 0.8, 2.0);
// Largest slope of the map that rays assume when they skip clear air, per distance from cloud to cloud. Steeper places
// are too small to matter.
const MAP_SKIP: f32 = 6.0;
// Largest slope of the solid noise that rays assume when they skip clear air, per side of its cube.
const SOLID_SKIP: f32 = 12.0;

// A cloud at a place.
struct CloudHere {
    // Amount by which the map's number falls short of cloud at the place, without the rounded base and fraying.
    gap: f32,
    // Excess over the threshold, with fraying.
    excess: f32,
    // Extinction, 1/m.
    extinction: f32,
    // Excess over threshold and dome, with fraying: above 0 in cloud.
    inside: f32,
    // `gap` with fraying.
    frayed_gap: f32,
    // Excess needed for cloud at the layer's top over the place.
    dome: f32,
    // Distance within which the place's threshold stays the same, m.
    steady: f32,
    // Largest change of the threshold per metre beyond the distance `steady`.
    slope: f32,
    // Distance within which there is no cloud, whatever the map's number, m.
    clear: f32,
    // Share of the place that is cloud: 1 unless clouds are blurred. Excess and extinction are those of the cloudy
    // share.
    share: f32,
}

// A place where clouds are blurred counts as clear if its mean excess lies this many standard deviations below the
// threshold.
const CLOUD_RARE: f32 = 2.5;

// Horizontal distance after which a ray meets other clouds, in distances from cloud to cloud.
const CLOUD_CELL: f32 = 0.3;

// Share of a normal distribution about `mean` with the standard deviation `spread` that lies above 0 (x), and the mean
// of the values in that share (y). Both use the logistic distribution closest to the normal one.
fn cloud_share(mean: f32, spread: f32) -> vec2f {
    let a = 1.702 * mean / spread;
    let share = 1.0 / (1.0 + exp(-a));
    let over = select(log(1.0 + exp(a)), a, a > 20.0) * spread / 1.702;
    // Far below the threshold both are 0.
    return vec2f(share, over / max(share, 1e-30));
}

// Cloud of a layer at a place.
fn cloud_here(whole: CloudLayer, at: CloudPlace) -> CloudHere {
    let local = cloud_local(whole, cloud_unleaned(whole, at));
    let layer = local.layer;
    let over = cloud_over(layer, at);
    let frays = cloud_frays(layer, at);
    let excess = over - cloud_dome(layer, over, at.height);
    let dome = cloud_dome_over(layer, over);
    // The rounded base is left out because it only removes cloud. An anvil may lie above the place.
    let gap = min(dome * at.height * at.height, layer.lean.z) - over;
    let inside = excess + frays;
    let clear = select(0.0, local.steady, CLOUD_PLACED && layer.shape.x > CLOUD_CLEAR_FROM);
    var here = CloudHere(gap, over + frays, cloud_extinction(layer, inside), inside, gap - frays, dome, local.steady, local.slope, clear, 1.0);
    let spread = cloud_blur.spread;
    if CLOUD_COARSE && spread > 0.0 {
        let wanting = CLOUD_RARE * spread;
        let part = cloud_share(inside, spread);
        let is_cloud = inside > -wanting;
        here.gap -= wanting;
        here.frayed_gap -= wanting;
        here.excess += part.y - inside;
        here.inside = select(inside + wanting, part.y, is_cloud);
        here.extinction = select(0.0, cloud_extinction(layer, part.y), is_cloud);
        here.share = part.x;
    }
    return here;
}

// Excess by which a place is inside cloud; below 0 outside.
fn cloud_inside(here: CloudHere) -> f32 {
    return here.inside;
}

// Distance along a ray from a place outside clouds within which there is no cloud, m. The map's number, the noise and
// the dome change no faster than their largest slopes, and the noise adds no more than its largest value.
fn cloud_skip(layer: CloudLayer, here: CloudHere, height: f32, direction: vec3f) -> f32 {
    let leaning = 2.0 * layer.lean.w * layer.size.y * abs(direction.z);
    let level = length(direction.xy) + leaning;
    let dome = 2.0 * here.dome * height * layer.size.y * max(-direction.z, 0.0);
    let steep = MAP_SKIP * layer.size.z * level + dome;
    let skip = cloud_skip_by(layer, here, steep);
    if !CLOUD_PLACED {
        return skip;
    }
    // The threshold stays the same within `steady` and may change beyond.
    let near = max(min(skip, here.steady / max(level, 1e-3)), here.clear / max(level, 1e-3));
    return max(near, cloud_skip_by(layer, here, steep + here.slope * level));
}

// Distance along a ray from a place outside clouds within which there is no cloud, m, if the gap falls by at most
// `steep` per metre, apart from the change by the noise.
fn cloud_skip_by(layer: CloudLayer, here: CloudHere, steep: f32) -> f32 {
    let by_map = (here.gap - MOST_FRAYED * layer.shape.z) / (steep + 1e-6);
    let by_noise = here.frayed_gap / (steep + SOLID_SKIP * layer.shape.z * layer.medium.w);
    return max(by_map, by_noise);
}

// Longest path that a ray is followed through a layer, from its entry, m.
const CLOUD_FARTHEST: f32 = 60.0e3;
// Length, m, over which clouds fade out at the end of the path CLOUD_FARTHEST. Without this fade a cloud would end in a
// flat face.
const CLOUD_FADES: f32 = 15.0e3;

// Share of clouds left at a distance from a ray's entry into a layer, m; 0 to 1.
fn cloud_fades(within: f32) -> f32 {
    return clamp((CLOUD_FARTHEST - within) / CLOUD_FADES, 0.0, 1.0);
}

// Altitude at a distance along a ray, m.
fn cloud_altitude(direction: vec3f, t: f32) -> f32 {
    let r = clouds.radius + cloud_eye();
    let rise = t * (2.0 * direction.z + t / r);
    return cloud_eye() + rise * r / (r + sqrt(max(r * (r + rise), 0.0)));
}

// Place in a layer at a distance along a ray, m.
fn cloud_place(layer: CloudLayer, direction: vec3f, t: f32) -> CloudPlace {
    let altitude = cloud_altitude(direction, t);
    // Horizontal distance is measured along the ground.
    let level = cloud_origin.xy + direction.xy * t * (clouds.radius / (clouds.radius + altitude));
    return CloudPlace(level, (altitude - layer.size.x) * layer.size.y);
}

// Length of cloud at full extinction along an interval of a ray, m. All places of the interval have this excess. The
// interval begins at `height` and rises by `rise` thicknesses of the layer per metre.
fn cloud_stretch(layer: CloudLayer, excess: f32, height: f32, rise: f32, length: f32) -> f32 {
    let to = height + rise * length;
    let low = clamp(min(height, to), 0.0, 1.0);
    let high = clamp(max(height, to), 0.0, 1.0);
    // A level interval has hardly any height, so a thin slab around it is taken.
    let top = max(high, min(low + 0.02, 1.0));
    let bottom = min(low, top - 0.02);
    let filled = cloud_filled(layer, excess, top) - cloud_filled(layer, excess, bottom);
    return length * filled / (top - bottom);
}

// Length of cloud at full extinction along a direction up to a distance, m. In each of the first SUN_FRAYED intervals,
// the cloud in the middle is looked up with fraying. In each interval beyond, all places have the excess of the
// interval's middle, without fraying.
fn cloud_way(layer: CloudLayer, at: CloudPlace, toward: vec3f, most: f32) -> f32 {
    let rise = select(min(toward.z, -1e-3), max(toward.z, 1e-3), toward.z >= 0.0) * layer.size.y;
    let way = min(select(at.height, 1.0 - at.height, rise > 0.0) / abs(rise), most);
    var gone = 0.0;
    var depth = 0.0;
    for (var i = 0u; i < SUN_FRAYED && gone < way; i++) {
        let end = min(SUN_WAY[i] / layer.size.z, way);
        let t = 0.5 * (gone + end);
        let p = CloudPlace(at.level + toward.xy * t, at.height + rise * t);
        let there = cloud_local(layer, cloud_unleaned(layer, p)).layer;
        let over = cloud_over(there, p);
        let excess = over - cloud_dome(there, over, p.height) + cloud_frays(there, p);
        depth += clamp(excess * layer.shape.w, 0.0, 1.0) * (end - gone);
        gone = end;
    }
    for (var i = SUN_FRAYED; i < SUN_STEPS && gone < way; i++) {
        let end = min(SUN_WAY[i] / layer.size.z, way);
        let t = 0.5 * (gone + end);
        let p = CloudPlace(at.level + toward.xy * t, at.height + rise * t);
        let there = cloud_local(layer, cloud_unleaned(layer, p)).layer;
        depth += cloud_stretch(there, cloud_over(there, p), at.height + rise * gone, rise, end - gone);
        gone = end;
    }
    return depth;
}

// Scaled depths of cloud around a place: above, below, horizontally to the nearer side and to the farther side. `here`
// is the layer with the local cover of the place.
fn cloud_box(here: CloudLayer, at: CloudPlace, excess: f32) -> vec4f {
    let about = cloud_about(here, excess, at.height) * (here.size.w * here.medium.y);
    let edge = max(about.z, 0.02);
    return vec4f(about.xy, edge, max(here.below.w - edge, edge));
}

// Scaled depths of cloud around a place. `excess` is the excess over the threshold, with fraying.
fn cloud_depths(layer: CloudLayer, at: CloudPlace, excess: f32) -> CloudDepths {
    let here = cloud_local(layer, cloud_unleaned(layer, at)).layer;
    let about = cloud_box(here, at, excess);
    let to_sun = cloud_way(layer, at, clouds.to_sun, 1e9) * (here.size.w * here.medium.y);
    let near = max(about.z, to_sun * length(clouds.to_sun.xy));
    return CloudDepths(about.x, about.y, to_sun, near, about.w, about.z, about.w);
}

// Share of sunlight that other clouds let through to a place where clouds are blurred. Elsewhere the path to the sun
// already contains these clouds.
fn cloud_sunlit(layer: CloudLayer, at: CloudPlace, here: CloudHere) -> f32 {
    if !CLOUD_COARSE {
        return 1.0;
    }
    let up = select(at.height, 1.0 - at.height, clouds.to_sun.z >= 0.0) / layer.size.y;
    let cells = up * length(clouds.to_sun.xy) / max(abs(clouds.to_sun.z), 0.05) * layer.size.z;
    // The factor 0.5 allows for the share of cloud, which falls with height.
    let blocked = 1.0 - exp(-0.5 * here.share * cells / CLOUD_CELL);
    return 1.0 - min(cloud_blur.spread, 1.0) * blocked;
}
