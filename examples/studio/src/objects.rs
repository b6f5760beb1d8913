//! Things of the host in the world: an excavator, a hall and posts of known heights, as boxes. They stand in the
//! valley, keep rain off, and are lit as Welkin tells hosts.

use glam::{DMat3, DVec3, Mat4, Vec3};
use welkin::{
    context::Scene,
    rain::{Planes, Shelter},
    scene::Camera,
};

/// A box: east, north and height of its middle above the site, m; half its sides; its turn clockwise, degrees; albedo.
#[derive(Clone, Copy)]
struct Block {
    middle: [f64; 3],
    half: [f64; 3],
    turn_deg: f64,
    albedo: [f32; 3],
}

/// Place of the site, m east and north in the world.
pub const SITE: [f64; 2] = [2606.0, 152.0];

const YELLOW: [f32; 3] = [0.62, 0.40, 0.05];
const DARK: [f32; 3] = [0.05, 0.05, 0.055];
const GLASS: [f32; 3] = [0.06, 0.08, 0.09];
const CONCRETE: [f32; 3] = [0.42, 0.41, 0.39];
const WOOD: [f32; 3] = [0.25, 0.17, 0.10];

/// Number of the excavator's boxes, which come first, and its turn clockwise, degrees.
const MACHINE: usize = 7;
const MACHINE_TURN_DEG: f64 = 215.0;

const fn one(middle: [f64; 3], half: [f64; 3], turn_deg: f64, albedo: [f32; 3]) -> Block {
    Block { middle, half, turn_deg, albedo }
}

/// The excavator's tracks, house, cab, boom and bucket, the hall with its roof, and posts at 20, 50, 100 and 200 m.
const BOXES: [Block; 13] = [
    one([-1.2, 0.0, 0.45], [0.35, 2.1, 0.45], 0.0, DARK),
    one([1.2, 0.0, 0.45], [0.35, 2.1, 0.45], 0.0, DARK),
    one([0.0, -0.3, 1.55], [1.4, 1.8, 0.6], 0.0, YELLOW),
    one([-0.9, 0.9, 2.2], [0.5, 0.8, 0.85], 0.0, GLASS),
    one([0.2, 3.0, 3.0], [0.2, 2.3, 0.25], 0.0, YELLOW),
    one([0.2, 5.2, 1.7], [0.18, 0.25, 1.5], 0.0, YELLOW),
    one([0.2, 5.2, 0.35], [0.6, 0.45, 0.35], 0.0, DARK),
    one([22.0, 34.0, 3.0], [9.0, 6.0, 3.0], 20.0, CONCRETE),
    one([22.0, 34.0, 6.2], [9.6, 6.6, 0.2], 20.0, DARK),
    one([-6.0, 8.0, 1.5], [0.1, 0.1, 1.5], 0.0, WOOD),
    one([-10.0, 38.0, 1.5], [0.1, 0.1, 1.5], 0.0, WOOD),
    one([-15.0, 88.0, 1.5], [0.15, 0.15, 1.5], 0.0, WOOD),
    one([-26.0, 188.0, 1.5], [0.25, 0.25, 1.5], 0.0, WOOD),
];

impl Block {
    fn axes(&self) -> DMat3 {
        DMat3::from_rotation_z(-self.turn_deg.to_radians())
    }

    fn middle(&self, ground_m: f64) -> DVec3 {
        DVec3::new(SITE[0], SITE[1], ground_m) + DVec3::from(self.middle)
    }
}

/// All boxes, with the excavator turned.
fn boxes() -> impl Iterator<Item = Block> {
    BOXES.iter().enumerate().map(|(i, one)| {
        if i >= MACHINE {
            return *one;
        }
        let turn = DMat3::from_rotation_z(-MACHINE_TURN_DEG.to_radians());
        let middle = turn * DVec3::from(one.middle);
        Block { middle: middle.to_array(), turn_deg: one.turn_deg + MACHINE_TURN_DEG, ..*one }
    })
}

/// Boxes that keep rain off. `ground_m` is the height of the site.
pub fn shelters(ground_m: f64) -> Vec<Shelter> {
    let shelter = |one: Block| Shelter {
        center_m: one.middle(ground_m),
        axes: one.axes(),
        half_size_m: DVec3::from(one.half),
        velocity_m_s: DVec3::ZERO,
        planes: Planes::default(),
    };
    boxes().map(shelter).collect()
}

/// Constants of `objects.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct LightUniform {
    clip: Mat4,
    lights: [[f32; 4]; 5],
}

/// A box as the shader takes it: middle, axes, albedo.
type Instance = [[f32; 3]; 5];

/// Pipeline and buffers that draw the boxes.
pub struct Objects {
    pipeline: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
    instances: wgpu::Buffer,
}

impl Objects {
    /// Creates it.
    pub fn new(device: &wgpu::Device) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("objects.wgsl"));
        let attributes =
            wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32x3, 4 => Float32x3];
        let bound = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("studio: objects"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some("studio: objects"),
            bind_group_layouts: &[Some(&bound)],
            immediate_size: 0,
        });
        let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some("studio: objects"),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("corner"),
                compilation_options: Default::default(),
                buffers: &[Some(wgpu::VertexBufferLayout {
                    array_stride: size_of::<Instance>() as u64,
                    step_mode: wgpu::VertexStepMode::Instance,
                    attributes: &attributes,
                })],
            },
            primitive: Default::default(),
            depth_stencil: Some(wgpu::DepthStencilState {
                format: wgpu::TextureFormat::Depth32Float,
                depth_write_enabled: Some(true),
                depth_compare: Some(wgpu::CompareFunction::Greater),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("lit"),
                compilation_options: Default::default(),
                targets: &[Some(wgpu::TextureFormat::Rgba16Float.into())],
            }),
            multiview_mask: None,
            cache: None,
        });
        let buffer = |size: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("studio: objects"),
                size: size as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let uniform = buffer(size_of::<LightUniform>(), wgpu::BufferUsages::UNIFORM);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("studio: objects"),
            layout: &bound,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        let instances = buffer(BOXES.len() * size_of::<Instance>(), wgpu::BufferUsages::VERTEX);
        Self { pipeline, uniform, group, instances }
    }

    /// Draws the boxes as a camera sees them. `ground_m` is the height of the site.
    pub fn draw(
        &self,
        queue: &wgpu::Queue,
        pass: &mut wgpu::RenderPass<'_>,
        (camera, scene): (&Camera, &Scene),
        ground_m: f64,
    ) {
        let four = |v: [f64; 3]| [v[0] as f32, v[1] as f32, v[2] as f32, 0.0];
        let sight = DMat3::from_mat4(camera.view);
        let block = LightUniform {
            clip: (camera.projection * glam::DMat4::from_mat3(sight)).as_mat4(),
            lights: [
                four(scene.sun.direction.to_array()),
                four(scene.ground.sun_lux),
                four(scene.moon.direction.to_array()),
                four(scene.ground.moon_lux),
                four(scene.ground.sky_lux),
            ],
        };
        queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(&block));
        let instances: Vec<Instance> = boxes().map(|one| instance(&one, camera.position, ground_m)).collect();
        queue.write_buffer(&self.instances, 0, bytemuck::cast_slice(&instances));
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.set_vertex_buffer(0, self.instances.slice(..));
        pass.draw(0..36, 0..BOXES.len() as u32);
    }
}

fn instance(one: &Block, eye: DVec3, ground_m: f64) -> Instance {
    let middle = (one.middle(ground_m) - eye).as_vec3();
    let axes = one.axes();
    let [east, north, up]: [Vec3; 3] = [0, 1, 2].map(|i| (axes.col(i) * one.half[i]).as_vec3());
    [middle, east, north, up, Vec3::from(one.albedo)].map(|v: Vec3| v.to_array())
}
