// Look of water on the ground: the class of a surface, and how water shows on that class. src/ground/class.rs has a
// table of the classes.
//!include "ground/normal.wgsl"

// Look of water on vegetation. Its values are those in src/ground/class.rs.
const PLANTS: SurfaceLook = SurfaceLook(0.15, 0.0, 0.6, 50.0, 0.4, 0.0, 0.0, 1.0);

// Returns the linear mix of two looks.
fn mix_looks(a: SurfaceLook, b: SurfaceLook, share: f32) -> SurfaceLook {
    return SurfaceLook(
        mix(a.soaks, b.soaks, share),
        mix(a.film, b.film, share),
        mix(a.slope, b.slope, share),
        mix(a.relief_mm, b.relief_mm, share),
        mix(a.most_albedo, b.most_albedo, share),
        mix(a.hollows, b.hollows, share),
        mix(a.level, b.level, share),
        mix(a.snow, b.snow, share),
    );
}

// Returns the share of plants in a colour, from its excess green, (2 g - r - b) / (r + g + b) (Woebbecke et al. 1995),
// which is 0 for grey and below 0 for soil.
fn plants(albedo: vec3f) -> f32 {
    let excess = (2.0 * albedo.g - albedo.r - albedo.b) / max(albedo.r + albedo.g + albedo.b, 1e-6);
    return smoothstep(0.08, 0.3, excess);
}

// Returns the look of the class with this number; `unspecified` if there is none.
fn look_of(number: u32, unspecified: SurfaceLook) -> SurfaceLook {
    if number == 0u || number >= SURFACE_CLASSES {
        return unspecified;
    }
    return ground.looks[number];
}

// Returns the look of a surface. Its class comes from the host's image of classes, else from the host's terrain, else
// from the context's default. Under this default, green parts of the picture count as plants.
fn surface_look(surface: HostSurface, here: TerrainPoint, albedo: vec3f) -> SurfaceLook {
    var look = mix_looks(ground.looks[0], PLANTS, plants(albedo));
    if TERRAIN {
        let n = vec4u(here.classes + 0.5);
        let south = mix_looks(look_of(n.x, look), look_of(n.y, look), here.part.x);
        let north = mix_looks(look_of(n.z, look), look_of(n.w, look), here.part.x);
        look = mix_looks(look, mix_looks(south, north, here.part.y), here.share);
    }
    return look_of(surface.number, look);
}
