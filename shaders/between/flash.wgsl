// Glow of the clouds and of the air in the light of lightning flashes. The clouds' face is the level plane in which the
// camera sees the clouds: their base from below, or their tops from above. The f64 reference is src/lightning/glow.rs.
//!include "common/frame.wgsl"

// Whether any flash shines.
override FLASH: bool = false;

// Asymmetry of the scattering in air: haze, fog and rain have 0.7 to 0.9.
const FLASH_ASYMMETRY: f32 = 0.75;
// Share of the scattering that counts as loss, because most scattered light goes on nearly straight.
const FLASH_TAKES: f32 = 0.2;
// Farthest distance at which the clouds' face is lit, m.
const FLASH_FARTHEST: f32 = 60000.0;

// Distance along a ray to the clouds' face, m; 0 or less if the ray does not meet the face.
fn flash_way(d: vec3f) -> f32 {
    return frame.flash_plane / select(d.z, 1e-6, abs(d.z) < 1e-6);
}

// Luminance of clouds where a ray meets their face, cd/m^2. A source at distance h from the face, m, gives k h / R^3 at
// a place of the face that lies R from the source, m. k, cd, is `FlashSource.clouds`. For light that diffuses through
// the cloud, k = F s / (2 pi^2), with the flux F, lm, and the share s that leaves by this face. For light that falls on
// the cloud, k = I rho / pi, with the intensity I, cd, and the reflectance rho.
fn flash_on_clouds(d: vec3f, way: f32) -> vec3f {
    if way <= 0.0 || way > FLASH_FARTHEST {
        return vec3f(0.0);
    }
    var sum = 0.0;
    for (var i = 0u; i < (frame.flash_count & 15u); i++) {
        let source = frame.flashes[i];
        let to = d * way - source.position;
        let h = source.height;
        sum += source.clouds * h * pow(max(dot(to, to), h * h), -1.5);
    }
    // Fade out before the farthest distance.
    let left = exp(-frame.flash_haze * way) * (1.0 - smoothstep(0.5, 1.0, way / FLASH_FARTHEST));
    return frame.flash_color * (sum * left);
}

// Phase function of Henyey and Greenstein (1941), 1/sr.
fn flash_phase(cosine: f32) -> f32 {
    let g = FLASH_ASYMMETRY;
    let d = 1.0 + g * g - 2.0 * g * cosine;
    return 0.07957747 * (1.0 - g * g) / (d * sqrt(d));
}

// Luminance of the light that the air up to `range`, m, scatters once towards the eye, cd/m^2. The integral along the
// ray is taken over the angle u at the source (equiangular sampling, Kulla and Fajardo 2012). `along` is the distance
// along the ray to its point nearest to the source, and h the distance of that point from the source, m. The distance
// along the ray is s = along + h tan u, and the distance from the source is D = h / cos u; hence ds / D^2 = du / h.
fn flash_in_air(ray: ViewRay, range: f32) -> vec3f {
    let taken = FLASH_TAKES * frame.flash_scattering;
    var sum = 0.0;
    for (var i = 0u; i < (frame.flash_count & 15u); i++) {
        let source = frame.flashes[i];
        let to = source.position - ray.origin;
        let along = dot(to, ray.direction);
        let h = sqrt(max(dot(to, to) - along * along, 0.0) + source.radius * source.radius);
        let first = atan(-along / h);
        let whole = atan((min(range, FLASH_FARTHEST) - along) / h) - first;
        var part = 0.0;
        for (var k = 0u; k < 4u; k++) {
            // Samples with u = first + whole t^2 are denser near the eye, where the scattering angle is smallest. The
            // weight of each is du = 2 whole t dt, with dt = 1/4.
            let t = 0.25 * (f32(k) + 0.5);
            let u = first + whole * t * t;
            let s = along + h * tan(u);
            part += t * flash_phase(-sin(u)) * exp(-taken * (s + h / cos(u)));
        }
        sum += source.air * part * 0.5 * whole / h;
    }
    return frame.flash_color * (sum * frame.flash_scattering);
}
