//! An opaque card in front of the left half of a picture, at depth 0.5. It stands for opaque objects that write the
//! host's depth. Ordinary depth: less is nearer.

use crate::opaque::{Opaque, draw_opaque};

const SHADER: &str = "
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    return vec4f(f32(i & 1u) - 1.0, f32(i >> 1u) * 2.0 - 1.0, 0.5, 1.0);
}
@fragment fn card() -> @location(0) vec4f { return vec4f(1.0, 0.0, 0.0, 1.0); }
";

pub fn draw_card(device: &wgpu::Device, color: &wgpu::Texture, depth: &wgpu::Texture) -> wgpu::CommandEncoder {
    let card = Opaque { shader: SHADER, vertices: 4, passes: wgpu::CompareFunction::Less };
    draw_opaque(device, &card, color, depth)
}
