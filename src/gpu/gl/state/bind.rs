//! Bindings of the host's context: programs, vertex arrays, buffers, textures, samplers, images, framebuffers,
//! transform feedback.

use super::super::{api::Api, check::GlInfo, names::*};

/// Largest number of texture units, samplers and buffer slots that wgpu's backend uses. It uses them from the first on.
const SLOTS: u32 = 16;
/// Largest number of storage images that wgpu's backend binds.
const IMAGES: u32 = 8;

/// Range of a buffer that is bound to an indexed slot, bytes.
#[derive(Clone, Copy, Default)]
struct BufferRange {
    buffer: u32,
    start: i64,
    size: i64,
}

/// Texture level that is bound to an image unit.
#[derive(Clone, Copy, Default)]
struct Image {
    texture: u32,
    level: i32,
    layered: bool,
    layer: i32,
    access: u32,
    format: u32,
}

/// Indexed bindings of one kind of buffer.
struct IndexedBuffers {
    target: u32,
    binding: u32,
    start: u32,
    size: u32,
    /// Buffer bound to the target itself, beside its slots.
    generic: u32,
    slots: Vec<BufferRange>,
}

impl IndexedBuffers {
    fn new(target: u32, [binding, start, size]: [u32; 3], count: u32) -> Self {
        Self { target, binding, start, size, generic: 0, slots: vec![BufferRange::default(); count as usize] }
    }

    fn save(&mut self, api: &Api) {
        self.generic = api.uint(self.binding);
        for (i, slot) in self.slots.iter_mut().enumerate() {
            let i = i as u32;
            slot.buffer = api.int_at(self.binding, i) as u32;
            if slot.buffer != 0 {
                // SAFETY: start and size are one value each.
                unsafe {
                    api.GetInteger64i_v(self.start, i, &mut slot.start);
                    api.GetInteger64i_v(self.size, i, &mut slot.size);
                }
            }
        }
    }

    fn restore(&self, api: &Api) {
        for (i, slot) in self.slots.iter().enumerate() {
            let i = i as u32;
            if slot.buffer != 0 && slot.size != 0 {
                api.BindBufferRange(self.target, i, slot.buffer, slot.start as isize, slot.size as isize);
            } else {
                api.BindBufferBase(self.target, i, slot.buffer);
            }
        }
        api.BindBuffer(self.target, self.generic);
    }
}

/// Saved bindings of the host's context.
#[derive(Default)]
pub(super) struct Bindings {
    /// (target, binding query, saved name)
    buffers: Vec<(u32, u32, u32)>,
    indexed: Vec<IndexedBuffers>,
    /// (target, binding query)
    textures: Vec<(u32, u32)>,
    /// Saved texture names, `textures.len()` for each unit.
    bound: Vec<u32>,
    samplers: Vec<u32>,
    images: Vec<Image>,
    /// Whether transform feedback can be paused here; `feedback_running` says whether it ran unpaused.
    feedback: bool,
    feedback_running: bool,
    active_unit: u32,
    program: u32,
    vertex_array: u32,
    /// Framebuffers that the host draws to and reads from.
    draw: u32,
    read: u32,
    renderbuffer: u32,
}

impl Bindings {
    pub(super) fn new(api: &Api, info: &GlInfo) -> Self {
        let units = api.uint(MAX_COMBINED_TEXTURE_IMAGE_UNITS).min(SLOTS);
        let mut textures = vec![
            (TEXTURE_2D, TEXTURE_BINDING_2D),
            (TEXTURE_3D, TEXTURE_BINDING_3D),
            (TEXTURE_2D_ARRAY, TEXTURE_BINDING_2D_ARRAY),
            (TEXTURE_CUBE_MAP, TEXTURE_BINDING_CUBE_MAP),
        ];
        let cube_arrays =
            ["GL_ARB_texture_cube_map_array", "GL_EXT_texture_cube_map_array", "GL_OES_texture_cube_map_array"];
        if info.knows((4, 0), (3, 2), &cube_arrays) {
            textures.push((TEXTURE_CUBE_MAP_ARRAY, TEXTURE_BINDING_CUBE_MAP_ARRAY));
        }
        if info.at_least((3, 2), (3, 1)) {
            textures.push((TEXTURE_2D_MULTISAMPLE, TEXTURE_BINDING_2D_MULTISAMPLE));
        }
        let mut buffers = vec![
            (ARRAY_BUFFER, ARRAY_BUFFER_BINDING, 0),
            // For the copy targets, the target is also the binding query (OpenGL 3.1, ES 3.0).
            (COPY_READ_BUFFER, COPY_READ_BUFFER, 0),
            (COPY_WRITE_BUFFER, COPY_WRITE_BUFFER, 0),
            (PIXEL_PACK_BUFFER, PIXEL_PACK_BUFFER_BINDING, 0),
            (PIXEL_UNPACK_BUFFER, PIXEL_UNPACK_BUFFER_BINDING, 0),
        ];
        if info.knows((4, 0), (3, 1), &["GL_ARB_draw_indirect"]) {
            buffers.push((DRAW_INDIRECT_BUFFER, DRAW_INDIRECT_BUFFER_BINDING, 0));
        }
        if info.has_compute() {
            buffers.push((DISPATCH_INDIRECT_BUFFER, DISPATCH_INDIRECT_BUFFER_BINDING, 0));
        }
        if info.knows((4, 4), (0, 0), &["GL_ARB_query_buffer_object", "GL_AMD_query_buffer_object"]) {
            buffers.push((QUERY_BUFFER, QUERY_BUFFER_BINDING, 0));
        }
        let uniform = [UNIFORM_BUFFER_BINDING, UNIFORM_BUFFER_START, UNIFORM_BUFFER_SIZE];
        let mut indexed =
            vec![IndexedBuffers::new(UNIFORM_BUFFER, uniform, api.uint(MAX_UNIFORM_BUFFER_BINDINGS).min(SLOTS))];
        let mut images = 0;
        if info.knows((4, 3), (3, 1), &["GL_ARB_shader_storage_buffer_object"]) {
            let storage = [SHADER_STORAGE_BUFFER_BINDING, SHADER_STORAGE_BUFFER_START, SHADER_STORAGE_BUFFER_SIZE];
            let count = api.uint(MAX_SHADER_STORAGE_BUFFER_BINDINGS).min(SLOTS);
            indexed.push(IndexedBuffers::new(SHADER_STORAGE_BUFFER, storage, count));
        }
        if info.knows((4, 2), (3, 1), &["GL_ARB_shader_image_load_store"]) {
            images = api.uint(MAX_IMAGE_UNITS).min(IMAGES);
        }
        Self {
            buffers,
            indexed,
            bound: vec![0; textures.len() * units as usize],
            textures,
            samplers: vec![0; units as usize],
            images: vec![Image::default(); images as usize],
            feedback: info.knows((4, 0), (3, 0), &["GL_ARB_transform_feedback2"]),
            ..Self::default()
        }
    }

    /// Returns the host's framebuffer for reading.
    pub(super) fn read_framebuffer(&self) -> u32 {
        self.read
    }

    pub(super) fn save(&mut self, api: &Api) {
        self.program = api.uint(CURRENT_PROGRAM);
        self.vertex_array = api.uint(VERTEX_ARRAY_BINDING);
        self.draw = api.uint(DRAW_FRAMEBUFFER_BINDING);
        self.read = api.uint(READ_FRAMEBUFFER_BINDING);
        self.renderbuffer = api.uint(RENDERBUFFER_BINDING);
        if self.feedback {
            self.feedback_running = api.int(TRANSFORM_FEEDBACK_ACTIVE) != 0 && api.int(TRANSFORM_FEEDBACK_PAUSED) == 0;
        }
        for (_, binding, name) in &mut self.buffers {
            *name = api.uint(*binding);
        }
        for indexed in &mut self.indexed {
            indexed.save(api);
        }
        self.save_units(api);
        for (i, image) in self.images.iter_mut().enumerate() {
            let get = |name| api.int_at(name, i as u32);
            image.texture = get(IMAGE_BINDING_NAME) as u32;
            image.level = get(IMAGE_BINDING_LEVEL);
            image.layered = get(IMAGE_BINDING_LAYERED) != 0;
            image.layer = get(IMAGE_BINDING_LAYER);
            image.access = get(IMAGE_BINDING_ACCESS) as u32;
            image.format = get(IMAGE_BINDING_FORMAT) as u32;
        }
    }

    fn save_units(&mut self, api: &Api) {
        self.active_unit = api.uint(ACTIVE_TEXTURE);
        let kinds = self.textures.len();
        for (unit, sampler) in self.samplers.iter_mut().enumerate() {
            api.ActiveTexture(TEXTURE0 + unit as u32);
            *sampler = api.uint(SAMPLER_BINDING);
            for (k, (_, binding)) in self.textures.iter().enumerate() {
                self.bound[unit * kinds + k] = api.uint(*binding);
            }
        }
    }

    pub(super) fn normalise(&self, api: &Api, vao: u32) {
        if self.feedback_running {
            api.PauseTransformFeedback();
        }
        api.BindVertexArray(vao);
        api.BindBuffer(PIXEL_PACK_BUFFER, 0);
        api.BindBuffer(PIXEL_UNPACK_BUFFER, 0);
        api.ActiveTexture(TEXTURE0);
    }

    pub(super) fn restore(&self, api: &Api) {
        let kinds = self.textures.len();
        for (unit, sampler) in self.samplers.iter().enumerate() {
            api.ActiveTexture(TEXTURE0 + unit as u32);
            api.BindSampler(unit as u32, *sampler);
            for (k, (target, _)) in self.textures.iter().enumerate() {
                api.BindTexture(*target, self.bound[unit * kinds + k]);
            }
        }
        api.ActiveTexture(self.active_unit);
        for (i, image) in self.images.iter().enumerate() {
            let Image { texture, level, layered, layer, access, format } = *image;
            api.BindImageTexture(i as u32, texture, level, u8::from(layered), layer, access, format);
        }
        for indexed in &self.indexed {
            indexed.restore(api);
        }
        // The element buffer belongs to the vertex array and comes back with it, so `buffers` does not list it.
        api.BindVertexArray(self.vertex_array);
        for (target, _, name) in &self.buffers {
            api.BindBuffer(*target, *name);
        }
        api.BindRenderbuffer(RENDERBUFFER, self.renderbuffer);
        api.BindFramebuffer(DRAW_FRAMEBUFFER, self.draw);
        api.BindFramebuffer(READ_FRAMEBUFFER, self.read);
        api.UseProgram(self.program);
        if self.feedback_running {
            api.ResumeTransformFeedback();
        }
    }
}
