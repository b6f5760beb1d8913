// Water and snow on a surface seen by the camera, as a veil: the new colour is the host's colour times transmittance,
// plus light. Air and fog are added later.
//!include "ground/snow.wgsl"
//!include "ground/water.wgsl"

// Whether there is water or clear ice on any surface.
override WATER: bool = true;

// Returns the veil of water and snow. `host` is the host's colour as luminance or, if `albedo_known`, as display-linear
// colour, from which only the albedo is known.
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
