// A wet or snowy surface seen by the camera: the host's colour x through + light, before air and fog.
//!include "ground/snow.wgsl"
//!include "ground/water.wgsl"

// Whether there is water or clear ice on any surface.
override WATER: bool = true;

// `host` is the host's colour as luminance, or as display-linear colour where `albedo_known` says that it is all that
// is known of the albedo.
fn wet_surface(host: vec3f, albedo_known: bool, ray: ViewRay, range: f32, surface: HostSurface) -> Veil {
    let spot = spot_at(host, albedo_known, ray, range, surface);
    var veil = Veil(vec3f(0.0), vec3f(1.0));
    if WATER {
        veil = water_on(spot);
    }
    if SNOW {
        // Snow hides the water below it.
        let snow = snow_on(spot, surface.normal.w > 0.0);
        veil = Veil(mix(veil.light, snow.light, snow.share), veil.transmittance * (1.0 - snow.share));
    }
    return veil;
}
