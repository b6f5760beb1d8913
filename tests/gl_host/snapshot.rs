//! Everything that OpenGL reports of a context's state, as text, so that two moments can be compared.

use std::ffi::c_void;

use glow::HasContext;

use welkin_support::egl::function;

type Get<T> = unsafe extern "system" fn(u32, *mut T);
type GetAt<T> = unsafe extern "system" fn(u32, u32, *mut T);
type GetOf<T> = unsafe extern "system" fn(u32, u32, *mut T);

/// The functions that read state; the same for every context here, since all come from one dispatch library.
struct Readers {
    ints: Get<i32>,
    floats: Get<f32>,
    doubles: Get<f64>,
    ints_at: GetAt<i32>,
    longs_at: GetAt<i64>,
    floats_at: GetAt<f32>,
    doubles_at: GetAt<f64>,
    enabled: unsafe extern "system" fn(u32) -> u8,
    enabled_at: unsafe extern "system" fn(u32, u32) -> u8,
    texture: GetOf<i32>,
    texture_floats: GetOf<f32>,
    sampler: GetOf<i32>,
    attribute: GetOf<i32>,
    attribute_pointer: GetOf<*const c_void>,
    program: GetOf<i32>,
    query: GetOf<i32>,
    attachment: unsafe extern "system" fn(u32, u32, u32, *mut i32),
    uniform: unsafe extern "system" fn(u32, i32, *mut f32),
}

impl Readers {
    fn new() -> Self {
        // SAFETY: each is the named function's type.
        unsafe {
            Self {
                ints: function("glGetIntegerv"),
                floats: function("glGetFloatv"),
                doubles: function("glGetDoublev"),
                ints_at: function("glGetIntegeri_v"),
                longs_at: function("glGetInteger64i_v"),
                floats_at: function("glGetFloati_v"),
                doubles_at: function("glGetDoublei_v"),
                enabled: function("glIsEnabled"),
                enabled_at: function("glIsEnabledi"),
                texture: function("glGetTexParameteriv"),
                texture_floats: function("glGetTexParameterfv"),
                sampler: function("glGetSamplerParameteriv"),
                attribute: function("glGetVertexAttribiv"),
                attribute_pointer: function("glGetVertexAttribPointerv"),
                program: function("glGetProgramiv"),
                query: function("glGetQueryiv"),
                attachment: function("glGetFramebufferAttachmentParameteriv"),
                uniform: function("glGetUniformfv"),
            }
        }
    }
}

/// One line for each value that the context knows: its name, then the value.
pub struct Snapshot(Vec<(String, String)>);

struct Taker<'a> {
    gl: &'a glow::Context,
    readers: Readers,
    lines: Vec<(String, String)>,
}

impl Taker<'_> {
    /// Adds a line unless the context does not know the value.
    fn add<T: std::fmt::Debug + Copy, const N: usize>(
        &mut self,
        name: String,
        blank: T,
        read: impl Fn(&Readers, *mut T),
    ) {
        let mut values = [blank; N];
        read(&self.readers, values.as_mut_ptr());
        // SAFETY: the context is current.
        if unsafe { self.gl.get_error() } == 0 {
            self.lines.push((name, format!("{values:?}")));
        }
    }

    fn ints(&mut self, names: &[u32]) {
        for &n in names {
            // SAFETY: at most 4 values (checked against the specification's tables) in 16.
            self.add::<_, 16>(format!("{n:#06x}"), -77, |r, p| unsafe { (r.ints)(n, p) });
        }
    }

    fn floats(&mut self, names: &[u32]) {
        for &n in names {
            // SAFETY: as above.
            self.add::<_, 16>(format!("{n:#06x} f"), -77.0, |r, p| unsafe { (r.floats)(n, p) });
            // SAFETY: as above.
            self.add::<_, 16>(format!("{n:#06x} d"), -77.0, |r, p| unsafe { (r.doubles)(n, p) });
        }
    }

    fn switches(&mut self, names: impl IntoIterator<Item = u32>) {
        for n in names {
            // SAFETY: one value is written.
            self.add::<u8, 1>(format!("switch {n:#06x}"), 77, |r, p| unsafe { *p = (r.enabled)(n) });
        }
    }

    fn switches_at(&mut self, name: u32, count: u32) {
        for i in 0..count {
            // SAFETY: one value is written.
            self.add::<u8, 1>(format!("switch {name:#06x}[{i}]"), 77, |r, p| unsafe { *p = (r.enabled_at)(name, i) });
        }
    }

    fn ints_at(&mut self, names: &[u32], count: u32) {
        for &n in names {
            for i in 0..count {
                // SAFETY: at most 4 values in 8.
                self.add::<_, 8>(format!("{n:#06x}[{i}]"), -77, |r, p| unsafe { (r.ints_at)(n, i, p) });
            }
        }
    }

    fn longs_at(&mut self, names: &[u32], count: u32) {
        for &n in names {
            for i in 0..count {
                // SAFETY: one value in 2.
                self.add::<_, 2>(format!("{n:#06x}[{i}] l"), -77, |r, p| unsafe { (r.longs_at)(n, i, p) });
            }
        }
    }

    fn limit(&self, name: u32, most: i32) -> u32 {
        let mut value = 0;
        // SAFETY: limits are one value.
        unsafe {
            (self.readers.ints)(name, &mut value);
            self.gl.get_error();
        }
        value.clamp(0, most) as u32
    }
}

/// The host's objects whose own state is compared as well.
#[derive(Default)]
pub struct Objects {
    pub textures: Vec<(u32, glow::Texture)>,
    pub samplers: Vec<glow::Sampler>,
    pub framebuffers: Vec<Option<glow::Framebuffer>>,
    pub programs: Vec<(glow::Program, i32)>,
    pub arrays: Vec<Option<glow::VertexArray>>,
}

/// Single values of the whole context: OpenGL 4.5's and ES 3.2's state tables, the compatibility profile's that shaders
/// or pixel copies can see.
const INTS: &[u32] = &[
    0x0B40, 0x0B45, 0x0B46, 0x0B72, 0x0B74, 0x0B91, 0x0B92, 0x0B93, 0x0B94, 0x0B95, 0x0B96, 0x0B97,
    0x0B98, // raster
    0x8800, 0x8801, 0x8802, 0x8803, 0x8CA3, 0x8CA4, 0x8CA5, // stencil back
    0x0BA2, 0x0C10, 0x0C01, 0x0C02, 0x0BF0, 0x8E4F, 0x935C, 0x935D, 0x8F9E, 0x8E52,
    0x8E72, // views, buffers, modes
    0x8825, 0x8826, 0x8827, 0x8828, 0x8829, 0x882A, 0x882B, 0x882C, // draw buffers
    0x80C8, 0x80C9, 0x80CA, 0x80CB, 0x8009, 0x883D, 0x0C23, 0x891A, 0x891B, 0x891C, // blending, clamps
    0x0CF0, 0x0CF1, 0x0CF2, 0x0CF3, 0x0CF4, 0x0CF5, 0x806D, 0x806E, 0x0D00, 0x0D01, 0x0D02, 0x0D03, 0x0D04, 0x0D05,
    0x806B, 0x806C, 0x9127, 0x9128, 0x9129, 0x912A, 0x912B, 0x912C, 0x912D, 0x912E, // pixel store
    0x8B8D, 0x825A, 0x85B5, 0x8894, 0x8895, 0x8F36, 0x8F37, 0x88ED, 0x88EF, 0x8F43, 0x90EF, 0x9193, 0x8A28, 0x90D3,
    0x92C1, 0x8C8F, 0x8C2A, 0x8E22, 0x8E23, 0x8E24, 0x8E25, // programs and buffers
    0x84E0, 0x8CA6, 0x8CAA, 0x8CA7, 0x0BA0, 0x0D33, 0x0C40, 0x0B33, 0x84EF, 0x0B54, 0x0D10, 0x0D11, // the rest
    0x0C52, 0x0C53, 0x84EF, 0x8B8B, 0x826D, 0x8244, // hints, debug group depth, debug callback
];
const FLOATS: &[u32] = &[
    0x0B70, 0x0B73, 0x0C22, 0x8005, 0x8038, 0x2A00, 0x8E1B, 0x0B21, 0x0B11, 0x8128, 0x80AA, 0x8C37,
    0x0B80, // ranges
    0x0D14, 0x0D15, 0x0D18, 0x0D19, 0x0D1A, 0x0D1B, 0x0D1C, 0x0D1D, 0x0D1E, 0x0D1F, 0x0B00,
    0x0BC2, // pixel transfer
];
const SWITCHES: &[u32] = &[
    0x0B44, 0x0B71, 0x0B90, 0x0BD0, 0x0BE2, 0x0C11, 0x0BF2, 0x0BF1, 0x0B20, 0x0B41, 0x2A01, 0x2A02, 0x8037, 0x809D,
    0x809E, 0x809F, 0x80A0, 0x8C36, 0x8E51, 0x8C89, 0x864F, 0x8F9D, 0x8D69, 0x8DB9, 0x8642, 0x92E0, 0x8242, 0x884F,
    0x0BC0, 0x0B42, 0x0B24, 0x0B50, 0x0B60, 0x0B57, 0x0BA1, 0x8861, 0x0DE0, 0x0DE1, 0x8620, 0x8804, 0x80AB,
];
const TEXTURE_TARGETS: &[(u32, u32)] = &[
    (0x0DE0, 0x8068), // 1D
    (0x0DE1, 0x8069), // 2D
    (0x806F, 0x806A), // 3D
    (0x8C18, 0x8C1C), // 1D array
    (0x8C1A, 0x8C1D), // 2D array
    (0x84F5, 0x84F6), // rectangle
    (0x8513, 0x8514), // cube
    (0x9009, 0x900A), // cube array
    (0x8C2A, 0x8C2C), // buffer
    (0x9100, 0x9104), // multisampled
    (0x9102, 0x9105), // multisampled array
];
const TEXTURE_PARAMETERS: &[u32] = &[
    0x2800, 0x2801, 0x2802, 0x2803, 0x8072, 0x813C, 0x813D, 0x8501, 0x884C, 0x884D, 0x884B, 0x8E42, 0x8E43, 0x8E44,
    0x8E45, 0x90EA, 0x8A48, 0x84FE, 0x912F, 0x813A, 0x813B,
];

impl Snapshot {
    pub fn take(gl: &glow::Context, objects: &Objects) -> Self {
        // SAFETY: the context is current. Errors of earlier calls are cleared, so that they do not hide values.
        while unsafe { gl.get_error() } != 0 {}
        let mut taker = Taker { gl, readers: Readers::new(), lines: Vec::new() };
        taker.ints(INTS);
        taker.floats(FLOATS);
        taker.switches(SWITCHES.iter().copied().chain(0x3000..0x3008));
        let views = taker.limit(0x825B, 16);
        let targets = taker.limit(0x8824, 8);
        for i in 0..views {
            // SAFETY: four and two values in 8.
            taker.add::<_, 8>(format!("viewport[{i}]"), -77.0, |r, p| unsafe { (r.floats_at)(0x0BA2, i, p) });
            // SAFETY: as above.
            taker.add::<_, 8>(format!("depth range[{i}]"), -77.0, |r, p| unsafe { (r.doubles_at)(0x0B70, i, p) });
        }
        taker.ints_at(&[0x0C10], views);
        taker.switches_at(0x0C11, views);
        taker.switches_at(0x0BE2, targets);
        taker.ints_at(&[0x80C8, 0x80C9, 0x80CA, 0x80CB, 0x8009, 0x883D, 0x0C23], targets);
        taker.ints_at(&[0x8E52], 1);
        for (binding, most, start) in [(0x8A28, 0x8A2F, 0x8A29), (0x90D3, 0x90DD, 0x90D4), (0x8C8F, 0x8E70, 0x8C84)] {
            let count = taker.limit(most, 96);
            taker.ints_at(&[binding], count);
            taker.longs_at(&[start, start + 1], count);
        }
        let images = taker.limit(0x8F38, 32);
        taker.ints_at(&[0x8F3A, 0x8F3B, 0x8F3C, 0x8F3D, 0x8F3E, 0x906E], images);
        let bindings = taker.limit(0x82DA, 32);
        taker.ints_at(&[0x82D6, 0x82D8, 0x8F4F], bindings);
        taker.longs_at(&[0x82D7], bindings);
        taker.units();
        taker.objects(objects);
        for target in [0x8914, 0x8C2F, 0x8D6A, 0x8C87, 0x8C88, 0x88BF] {
            // SAFETY: one value in 2.
            taker.add::<_, 2>(format!("query {target:#06x}"), -77, |r, p| unsafe { (r.query)(target, 0x8865, p) });
        }
        Self(taker.lines)
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Lines that differ from `other`'s.
    pub fn differences(&self, other: &Self) -> Vec<String> {
        assert_eq!(self.0.len(), other.0.len(), "as many values are known");
        let pairs = self.0.iter().zip(&other.0);
        pairs.filter(|(a, b)| a != b).map(|(a, b)| format!("{}: {} became {} {}", a.0, a.1, b.0, b.1)).collect()
    }
}

impl Taker<'_> {
    /// Adds the bindings of every texture unit.
    fn units(&mut self) {
        let units = self.limit(0x8B4D, 96);
        let (mut active, mut set_active) = (0, None);
        // SAFETY: one value; the function's own type.
        unsafe { (self.readers.ints)(0x84E0, &mut active) };
        let activate: unsafe extern "system" fn(u32) =
            // SAFETY: the function's own type.
            *set_active.get_or_insert_with(|| unsafe { function("glActiveTexture") });
        for unit in 0..units {
            // SAFETY: the unit exists.
            unsafe { activate(0x84C0 + unit) };
            for &(_, binding) in TEXTURE_TARGETS.iter().chain(&[(0, 0x8919)]) {
                // SAFETY: one value in 2.
                self.add::<_, 2>(format!("unit {unit} {binding:#06x}"), -77, |r, p| unsafe { (r.ints)(binding, p) });
            }
        }
        // SAFETY: back to what it was.
        unsafe { activate(active as u32) };
    }

    fn objects(&mut self, objects: &Objects) {
        let gl = self.gl;
        // SAFETY: the context is current, names are the host's own, and every binding is put back.
        unsafe {
            for &(target, name) in &objects.textures {
                let binding = TEXTURE_TARGETS.iter().find(|t| t.0 == target).unwrap().1;
                let was = gl.get_parameter_texture(binding);
                gl.bind_texture(target, Some(name));
                for &p in TEXTURE_PARAMETERS {
                    self.add::<_, 4>(format!("texture {name:?} {p:#06x}"), -77, |r, o| (r.texture)(target, p, o));
                }
                let border = format!("texture {name:?} border");
                self.add::<_, 4>(border, -77.0, |r, o| (r.texture_floats)(target, 0x1004, o));
                gl.bind_texture(target, was);
            }
            for &sampler in &objects.samplers {
                let raw = sampler.0.get();
                for &p in TEXTURE_PARAMETERS {
                    self.add::<_, 4>(format!("sampler {raw} {p:#06x}"), -77, |r, o| (r.sampler)(raw, p, o));
                }
            }
            for &(program, location) in &objects.programs {
                let raw = program.0.get();
                for p in [0x8B80, 0x8B82, 0x8B83] {
                    self.add::<_, 2>(format!("program {raw} {p:#06x}"), -77, |r, o| (r.program)(raw, p, o));
                }
                self.add::<_, 4>(format!("program {raw} uniform"), -77.0, |r, o| (r.uniform)(raw, location, o));
            }
            let array_was = gl.get_parameter_vertex_array(glow::VERTEX_ARRAY_BINDING);
            for &array in &objects.arrays {
                gl.bind_vertex_array(array);
                self.add::<_, 2>(format!("array {array:?} elements"), -77, |r, o| (r.ints)(0x8895, o));
                for i in 0..16 {
                    for p in [0x8622, 0x8623, 0x8624, 0x8625, 0x886A, 0x889F, 0x88FD, 0x88FE, 0x82D4, 0x82D5] {
                        let name = format!("array {array:?} attribute {i} {p:#06x}");
                        self.add::<_, 4>(name, -77, |r, o| (r.attribute)(i, p, o));
                    }
                    let name = format!("array {array:?} attribute {i} pointer");
                    self.add::<_, 1>(name, std::ptr::null(), |r, o| (r.attribute_pointer)(i, 0x8645, o));
                }
            }
            gl.bind_vertex_array(array_was);
            let draw = gl.get_parameter_framebuffer(glow::DRAW_FRAMEBUFFER_BINDING);
            let read = gl.get_parameter_framebuffer(glow::READ_FRAMEBUFFER_BINDING);
            for &framebuffer in &objects.framebuffers {
                gl.bind_framebuffer(glow::FRAMEBUFFER, framebuffer);
                for p in (0x8825..0x882D).chain([0x0C02]) {
                    self.add::<_, 2>(format!("framebuffer {framebuffer:?} {p:#06x}"), -77, |r, o| (r.ints)(p, o));
                }
                for attachment in (0x8CE0..0x8CE8).chain([0x8D00, 0x8D20, 0x1801, 0x1802, 0x0402, 0x0405]) {
                    for p in [0x8CD0, 0x8CD1, 0x8CD2, 0x8CD3, 0x8CD4] {
                        let name = format!("framebuffer {framebuffer:?} {attachment:#06x} {p:#06x}");
                        self.add::<_, 2>(name, -77, |r, o| (r.attachment)(glow::DRAW_FRAMEBUFFER, attachment, p, o));
                    }
                }
            }
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, draw);
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, read);
        }
    }
}
