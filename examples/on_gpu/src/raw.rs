//! Draws one texel with loops in handwritten GLSL, without wgpu. The loop's form may decide whether the driver's
//! compiled code ends.

use glow::HasContext;

use welkin_support::egl;

use crate::{Fallible, Found};

const VERTEX: &str = "#version 330
void main() { gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }";

const HEAD: &str = "#version 330
layout(std140) uniform Dims { uvec4 a; uvec4 b; uvec4 c; uvec4 d; uvec4 e; };
layout(std140) uniform Rule { vec4 rule[24]; };
out vec4 color;
vec2 row(uint m) { return rule[m < b.x ? m : m - b.x].xy; }
";

const PLAIN: &str = "void main() {
    float sum = 0.0;
    for (uint m = 0u; m < 2u * b.x; m++) {
        vec2 d = row(m);
        for (uint p = 0u; p < b.y; p++) { sum += d.y * rule[p].z; }
    }
    color = vec4(sum / 255.0, 0.0, 0.0, 1.0);
}";

/// A `for` loop as naga writes it: an endless loop with the step at its start, and a break.
const WRITTEN: &str = "void main() {
    float sum = 0.0;
    uint m = 0u;
    bool first_m = true;
    while (true) {
        if (!first_m) { m = (m + 1u); }
        first_m = false;
        uint _e1 = b.x;
        if ((m < (2u * _e1))) {
        } else {
            break;
        }
        {
            vec2 d = row(m);
            uint p = 0u;
            bool first_p = true;
            while (true) {
                if (!first_p) { p = (p + 1u); }
                first_p = false;
                uint _e2 = b.y;
                if ((p < _e2)) {
                } else {
                    break;
                }
                {
                    float _e3 = sum;
                    sum = (_e3 + (d.y * rule[p].z));
                }
            }
        }
    }
    color = vec4(sum / 255.0, 0.0, 0.0, 1.0);
}";

/// Bounds of the loops, and the expected sum: 2 x 4 rows of weight 2, 5 columns of 1.
const BOUNDS: (u32, u32) = (4, 5);
const SUM: u8 = 80;

pub fn plain_loops() -> Fallible<Found> {
    texel(PLAIN)
}

pub fn written_loops() -> Fallible<Found> {
    texel(WRITTEN)
}

fn texel(body: &str) -> Fallible<Found> {
    let context = egl::Context::new(egl::Api::Compatibility(4, 5), egl::Window::None);
    let gl = context.functions();
    // SAFETY: the context is current, and only its own names are used.
    unsafe {
        let program = gl.create_program()?;
        for (kind, text) in [(glow::VERTEX_SHADER, VERTEX.to_owned()), (glow::FRAGMENT_SHADER, format!("{HEAD}{body}"))]
        {
            let shader = gl.create_shader(kind)?;
            gl.shader_source(shader, &text);
            gl.compile_shader(shader);
            if !gl.get_shader_compile_status(shader) {
                return Err(gl.get_shader_info_log(shader).into());
            }
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        if !gl.get_program_link_status(program) {
            return Err(gl.get_program_info_log(program).into());
        }
        let mut dims = [0_u32; 20];
        (dims[4], dims[5]) = BOUNDS;
        let rule = [[0.5_f32, 2.0, 1.0, 0.0]; 24];
        for (slot, name, bytes) in
            [(0, "Dims", bytemuck::bytes_of(&dims)), (1, "Rule", bytemuck::cast_slice::<_, u8>(&rule))]
        {
            let buffer = gl.create_buffer()?;
            gl.bind_buffer(glow::UNIFORM_BUFFER, Some(buffer));
            gl.buffer_data_u8_slice(glow::UNIFORM_BUFFER, bytes, glow::STATIC_DRAW);
            gl.bind_buffer_base(glow::UNIFORM_BUFFER, slot, Some(buffer));
            let index = gl.get_uniform_block_index(program, name).ok_or("the block is there")?;
            gl.uniform_block_binding(program, index, slot);
        }
        let texture = gl.create_texture()?;
        gl.bind_texture(glow::TEXTURE_2D, Some(texture));
        gl.tex_storage_2d(glow::TEXTURE_2D, 1, glow::RGBA8, 1, 1);
        let framebuffer = gl.create_framebuffer()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        gl.framebuffer_texture_2d(glow::FRAMEBUFFER, glow::COLOR_ATTACHMENT0, glow::TEXTURE_2D, Some(texture), 0);
        let array = gl.create_vertex_array()?;
        gl.bind_vertex_array(Some(array));
        gl.viewport(0, 0, 1, 1);
        gl.use_program(Some(program));
        gl.draw_arrays(glow::TRIANGLES, 0, 3);
        let mut color = [0; 4];
        gl.read_pixels(0, 0, 1, 1, glow::RGBA, glow::UNSIGNED_BYTE, glow::PixelPackData::Slice(Some(&mut color)));
        let error = gl.get_error();
        std::mem::forget(context);
        Ok(match (color[0], error) {
            (SUM, glow::NO_ERROR) => Found::Right(format!("the sum is {SUM}")),
            (other, error) => Found::Wrong(format!("the sum is {other} and must be {SUM}; OpenGL's error 0x{error:x}")),
        })
    }
}
