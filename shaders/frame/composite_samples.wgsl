// Composition over a host's picture with several samples per pixel, each with its own depth: variant `:multi`.
//!include "frame/composite_view.wgsl"

@fragment
fn composite_samples(in: FullscreenVarying, @builtin(sample_index) sample: u32) -> @location(0) vec4f {
    return composed(in, i32(sample));
}
