//! The scene of the matrix, painted and read through a third context that shares the host's objects: the host's own may
//! be in any state meanwhile.

use glow::HasContext;

use crate::{host::Host, images::*};
use welkin_support::egl::{Api, Context};

/// Distance of the depth value 1, m: the near plane of `c_scene::frame`.
const NEAR_M: f64 = 0.1;
/// Height of the eye over the ground, m.
const EYE_M: f64 = 2.0;
/// Red, green and blue of the ground that the host painted, as stored.
pub const GROUND: [u8; 3] = [102, 77, 51];

/// Reversed depth of the level ground in row `y` from the bottom, 0 above the horizon.
pub fn depth_of_row(y: u32) -> f32 {
    let below = -(2.0 * (f64::from(y) + 0.5) / f64::from(HEIGHT) - 1.0) * f64::tan(0.5);
    if below > 0.0 { (NEAR_M * below / EYE_M) as f32 } else { 0.0 }
}

/// A triangle over the whole picture.
pub const CORNERS: &str = "
void main() {
    gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}";

/// Level ground below the horizon; with an edge, a wall 5 m away left of a slanted line.
const FRAGMENT: &str = "
uniform vec3 ground;
uniform float height;
out vec4 color;
void main() {
    float below = -(2.0 * floor(gl_FragCoord.y) + 1.0 - height) / height * 0.5463024898437905;
    gl_FragDepth = max(0.1 * below / 2.0, 0.0);
    color = vec4(below > 0.0 ? ground : vec3(0.0), 1.0);
}";

const WALL: &str = "
void main() {
    vec2 at = vec2[3](vec2(-1.0, -3.0), vec2(-1.0, 3.0), vec2(0.37, -1.0))[gl_VertexID];
    gl_Position = vec4(at, 0.02, 1.0);
}";

const PLAIN: &str = "
uniform vec3 ground;
out vec4 color;
void main() { gl_FragDepth = 0.02; color = vec4(ground, 1.0); }";

/// The third context.
pub struct Painter {
    context: Context,
    gl: glow::Context,
    es: bool,
    ground: glow::Program,
    wall: glow::Program,
    vertices: glow::VertexArray,
}

/// A program of the host's, in the context that is current.
pub fn program(gl: &glow::Context, es: bool, vertex: &str, fragment: &str) -> glow::Program {
    let head = if es {
        "#version 300 es\nprecision highp float; precision highp int; precision highp sampler2D;\n"
    } else {
        "#version 330\n"
    };
    // SAFETY: the host's context is current.
    unsafe {
        let program = gl.create_program().unwrap();
        for (kind, text) in [(glow::VERTEX_SHADER, vertex), (glow::FRAGMENT_SHADER, fragment)] {
            let shader = gl.create_shader(kind).unwrap();
            gl.shader_source(shader, &format!("{head}{text}"));
            gl.compile_shader(shader);
            assert!(gl.get_shader_compile_status(shader), "{}", gl.get_shader_info_log(shader));
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        assert!(gl.get_program_link_status(program), "{}", gl.get_program_info_log(program));
        program
    }
}

impl Painter {
    /// Creates the painter's context, programs and vertex array. The host's context is current again afterwards.
    pub fn new(host: &Host, api: Api) -> Self {
        let context = host.contexts.host.sharing();
        let gl = context.functions();
        let es = matches!(api, Api::Es(..));
        let (ground, wall) = (program(&gl, es, CORNERS, FRAGMENT), program(&gl, es, WALL, PLAIN));
        // SAFETY: the painter's context is current.
        let vertices = unsafe { gl.create_vertex_array().unwrap() };
        assert!(host.contexts.host.make_current());
        Self { context, gl, es, ground, wall, vertices }
    }

    /// Calls `work` with the painter's context current, then makes the host's context current again. Each context sees
    /// the other's changes.
    fn with<T>(&self, host: &Host, work: impl FnOnce(&glow::Context) -> T) -> T {
        // SAFETY: the contexts are current in turn.
        unsafe {
            host.gl.finish();
            assert!(self.context.make_current());
            let answer = work(&self.gl);
            self.gl.finish();
            assert_eq!(self.gl.get_error(), 0);
            assert!(host.contexts.host.make_current());
            answer
        }
    }

    /// Makes images with the painter's own state.
    pub fn make<T>(&self, host: &Host, work: impl FnOnce(&glow::Context) -> T) -> T {
        self.with(host, work)
    }

    /// Paints ground and empty sky into these images, and the wall if asked.
    pub fn paint(
        &self,
        host: &Host,
        color: (welkin::gpu::gl::GlImage, u32),
        depth: welkin::gpu::gl::GlImage,
        wall: bool,
    ) {
        self.with(host, |gl| {
            let fbo = framebuffer(gl, color.0, Some(depth));
            // SAFETY: the painter's context is current, names are live.
            unsafe {
                gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo));
                self.draw(gl, color.1, wall);
                gl.bind_framebuffer(glow::FRAMEBUFFER, None);
                gl.delete_framebuffer(fbo);
            }
        });
    }

    /// Draws the scene into the bound framebuffer, whose colours are of format `internal`.
    unsafe fn draw(&self, gl: &glow::Context, internal: u32, wall: bool) {
        // OpenGL ES encodes what is drawn into sRGB images; elsewhere this context leaves it as it is.
        let encodes = self.es && internal == glow::SRGB8_ALPHA8;
        let ground = GROUND.map(|c| {
            let stored = f64::from(c) / 255.0;
            (if encodes { welkin::frame::tone::srgb_decode(stored) } else { stored }) as f32
        });
        // SAFETY: the caller's context is current.
        unsafe {
            gl.viewport(0, 0, WIDTH as i32, HEIGHT as i32);
            gl.enable(glow::DEPTH_TEST);
            gl.depth_func(glow::ALWAYS);
            gl.bind_vertex_array(Some(self.vertices));
            for (program, _) in [(self.ground, ()), (self.wall, ())].into_iter().take(if wall { 2 } else { 1 }) {
                gl.use_program(Some(program));
                let [r, g, b] = ground;
                gl.uniform_3_f32(gl.get_uniform_location(program, "ground").as_ref(), r, g, b);
                gl.uniform_1_f32(gl.get_uniform_location(program, "height").as_ref(), HEIGHT as f32);
                gl.draw_arrays(glow::TRIANGLES, 0, 3);
            }
            gl.use_program(None);
        }
    }

    /// Returns the texels of an image of format `internal`, 1 being white, samples averaged as stored; row 0 at the
    /// bottom.
    pub fn read(&self, host: &Host, color: welkin::gpu::gl::GlImage, internal: u32) -> Vec<[f32; 4]> {
        self.with(host, |gl| {
            let from = framebuffer(gl, color, None);
            let plain = texture(gl, internal);
            let to = framebuffer(gl, image_of(plain), None);
            let float = is_float(internal);
            let mut texels = vec![[0.0_f32; 4]; (WIDTH * HEIGHT) as usize];
            let mut bytes = vec![[0_u8; 4]; texels.len()];
            let (w, h) = (WIDTH as i32, HEIGHT as i32);
            // SAFETY: the painter's context is current, there is room for every texel.
            unsafe {
                gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(from));
                gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(to));
                gl.blit_framebuffer(0, 0, w, h, 0, 0, w, h, glow::COLOR_BUFFER_BIT, glow::NEAREST);
                gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(to));
                if float {
                    let room = glow::PixelPackData::Slice(Some(bytemuck::cast_slice_mut(&mut texels)));
                    gl.read_pixels(0, 0, w, h, glow::RGBA, glow::FLOAT, room);
                } else {
                    let room = glow::PixelPackData::Slice(Some(bytes.as_flattened_mut()));
                    gl.read_pixels(0, 0, w, h, glow::RGBA, glow::UNSIGNED_BYTE, room);
                }
                assert_eq!(gl.get_error(), 0, "{internal:#x}");
                gl.bind_framebuffer(glow::FRAMEBUFFER, None);
                gl.delete_framebuffer(from);
                gl.delete_framebuffer(to);
                gl.delete_texture(plain);
            }
            if !float {
                texels = bytes.iter().map(|t| t.map(|v| f32::from(v) / 255.0)).collect();
            }
            texels
        })
    }
}

/// Whether an internal format holds floats.
pub fn is_float(internal: u32) -> bool {
    matches!(internal, glow::RGBA16F | glow::RGB16F | glow::RGBA32F | glow::R11F_G11F_B10F)
}
