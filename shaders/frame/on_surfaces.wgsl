// Water and snow on the surface in a pixel. A pipeline without surface effects uses on_surfaces_dry.wgsl instead.
//!include "frame/color_space.wgsl"
//!include "frame/host_picture.wgsl"
//!include "ground/surface.wgsl"

// Whether the stage SURFACE is drawn.
override SURFACE: bool = true;

// Host's data on the surface in a pixel, if the host gives any: the surface class in red, and the normal.
@group(0) @binding(9) var host_classes: texture_2d<f32>;
@group(0) @binding(10) var host_normals: texture_2d<f32>;

// Whether the host gives surface classes, and whether it gives normals.
override HAS_CLASSES: bool = false;
override HAS_NORMALS: bool = false;

// Host's data on the surface in a pixel, with the normal that follows from depth.
fn host_surface(seen: Seen) -> HostSurface {
    let facing = surface_facing(ground, frame.depth, seen.depth, depth_around(seen.pixel, seen.sample), seen.ndc);
    var surface = HostSurface(facing, 0u, vec4f(0.0));
    if HAS_CLASSES {
        surface.number = u32(textureLoad(host_classes, seen.pixel, 0).r * 255.0 + 0.5);
    }
    if HAS_NORMALS {
        surface.normal = given_normal(ground, textureLoad(host_normals, seen.pixel, 0).rgb);
    }
    return surface;
}

// Depths of the pixels to the left, right, above and below. Beyond the picture's edge, the pixel's own depth.
fn depth_around(pixel: vec2i, sample: i32) -> vec4f {
    let low = max(pixel - 1, vec2i(0));
    let high = min(pixel + 1, vec2i(textureDimensions(host_depth)) - 1);
    return vec4f(
        textureLoad(host_depth, vec2i(low.x, pixel.y), sample).r,
        textureLoad(host_depth, vec2i(high.x, pixel.y), sample).r,
        textureLoad(host_depth, vec2i(pixel.x, low.y), sample).r,
        textureLoad(host_depth, vec2i(pixel.x, high.y), sample).r,
    );
}

// Lays water and snow on the surface in a pixel behind the veil.
fn on_surface(veil: Veil, host: vec3f, ray: ViewRay, seen: Seen) -> Veil {
    if !SURFACE || !HAS_DEPTH || seen.range >= RANGE_SKY {
        return veil;
    }
    let wet = wet_surface(host, !is_space(SCENE_LINEAR), ray, seen.range, host_surface(seen));
    return Veil(veil.light + veil.transmittance * wet.light, veil.transmittance * wet.transmittance);
}
