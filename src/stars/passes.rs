//! Drawing of stars on the GPU: their buffer, their uniform block and the one draw in a render pass of the caller's.

use std::sync::Arc;

use glam::Vec3;

use super::{
    catalogue::Star,
    planets::BODIES,
    settings::StarSettings,
    uniforms::{StarInstance, StarUniform, StarView},
};
use crate::{
    error::Result,
    gpu::{
        Device,
        bind::{self, Slot},
        pass::{self, QuadsDesc},
    },
};

/// The host's depth in the form that the stars' shader reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StarDepth<'a> {
    /// View of the depth aspect alone.
    pub view: &'a wgpu::TextureView,
    /// Whether the depth has several samples a pixel.
    pub multisampled: bool,
}

/// Key of a pipeline: the target's format, whether the depth is multisampled, and whether there is a depth.
type PointsKind = (wgpu::TextureFormat, bool, bool);

/// Stars loaded for drawing.
struct LoadedStars {
    /// The host's own stars; `None` for the catalogue's.
    stars: Option<Arc<[Star]>>,
    /// Whole years since J2000.0 up to which proper motion is applied.
    year: f64,
    /// All stars, the brightest first, and the illuminance of each above the air, lux.
    all: Vec<StarInstance>,
    lux: Vec<f32>,
    /// Planets, then the stars that the next draw shows.
    shown: Vec<StarInstance>,
    /// Content of the buffer.
    written: Vec<StarInstance>,
    buffer: wgpu::Buffer,
}

/// GPU resources that a view holds for stars: the buffer of stars, a uniform block, and pipelines by target.
pub struct StarPass {
    block: wgpu::Buffer,
    /// Layouts for depths of one sample and of several.
    layouts: [wgpu::BindGroupLayout; 2],
    /// Placeholder texture, bound where the host gives no depth.
    none: wgpu::TextureView,
    loaded: Option<LoadedStars>,
    /// Bind group of the next draw, and the view of the depth that it was made for; `None` for the placeholder.
    bound: Option<(Option<wgpu::TextureView>, wgpu::BindGroup)>,
    pipelines: Vec<(PointsKind, wgpu::RenderPipeline)>,
    /// Pipeline key and number of instances of the next draw.
    prepared: Option<(PointsKind, u32)>,
    /// Content of the uniform block.
    written: Option<StarUniform>,
    has_changed: bool,
}

impl StarPass {
    /// Creates the resources that do not depend on the stars; the first [`StarPass::prepare`] creates the buffer of
    /// stars.
    pub fn new(device: &Device) -> Self {
        let device = &device.device;
        let block = crate::gpu::bind::block(device, "stars", size_of::<StarUniform>());
        let layouts = [false, true].map(|multi| {
            let slots = [(0, Slot::Uniform(size_of::<StarUniform>())), (1, Slot::texels(multi))];
            bind::layout(device, "stars", wgpu::ShaderStages::VERTEX_FRAGMENT, &slots)
        });
        let none = bind::nothing(device, wgpu::TextureFormat::Rgba8Unorm);
        Self {
            block,
            layouts,
            none,
            loaded: None,
            bound: None,
            pipelines: Vec::new(),
            prepared: None,
            written: None,
            has_changed: false,
        }
    }

    /// Prepares a draw into a target of `format` (one sample a pixel, blendable), where `depth`, if given, hides stars.
    /// Returns the number of points that it will draw. Proper motion is applied again once a simulated year.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] for a setting or view out of range. Also fails if a shader file is missing.
    /// GPU faults come through [`Device::check`].
    pub fn prepare(
        &mut self,
        device: &Device,
        settings: &StarSettings,
        view: &StarView<'_>,
        format: wgpu::TextureFormat,
        depth: Option<StarDepth<'_>>,
    ) -> Result<u32> {
        view.validate()?;
        self.load(device, settings, view.heavens.years.round())?;
        let Some(loaded) = &mut self.loaded else { return Ok(0) };
        loaded.shown.clear();
        if settings.planets {
            loaded.shown.extend(view.heavens.planets.iter().map(StarInstance::of_planet));
        }
        let bright = loaded.lux.partition_point(|lux| f64::from(*lux) > view.faintest_lux);
        let frustum = Frustum::of(view);
        loaded.shown.extend(loaded.all[..bright].iter().filter(|star| frustum.may_show(star)));
        let block = view.uniform();
        self.has_changed = self.written != Some(block) || loaded.shown != loaded.written;
        if self.has_changed {
            device.write_buffer(&loaded.buffer, 0, bytemuck::cast_slice(&loaded.shown));
            device.write_buffer(&self.block, 0, bytemuck::bytes_of(&block));
            loaded.written.clone_from(&loaded.shown);
            self.written = Some(block);
        }
        let count = loaded.shown.len() as u32;
        let kind = (format, depth.is_some_and(|d| d.multisampled), depth.is_some());
        if !self.pipelines.iter().any(|(k, _)| *k == kind) {
            let made = pipeline(device, &self.layouts[usize::from(kind.1)], kind)?;
            self.pipelines.push((kind, made));
        }
        self.bind(&device.device, depth);
        self.prepared = Some((kind, count));
        Ok(count)
    }

    /// Whether the last [`StarPass::prepare`] prepared a different draw than the one before it.
    pub(super) fn has_changed(&self) -> bool {
        self.has_changed
    }

    /// Draws the prepared stars and adds them to the target. Sets group 0 and vertex buffer 0.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let (Some((kind, count)), Some(loaded), Some((_, group))) = (self.prepared, &self.loaded, &self.bound) else {
            return;
        };
        let Some((_, pipeline)) = self.pipelines.iter().find(|(k, _)| *k == kind) else { return };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.set_vertex_buffer(0, loaded.buffer.slice(..));
        pass.draw(0..4, 0..count);
    }

    /// Size on the GPU, bytes.
    pub fn bytes(&self) -> u64 {
        self.block.size() + self.loaded.as_ref().map_or(0, |l| l.buffer.size())
    }

    /// Creates the sorted list and the buffer for these stars, unless they are loaded already.
    fn load(&mut self, device: &Device, settings: &StarSettings, year: f64) -> Result<()> {
        let same = |a: &Option<Arc<[Star]>>, b: &Option<Arc<[Star]>>| match (a, b) {
            (None, None) => true,
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            _ => false,
        };
        if self.loaded.as_ref().is_some_and(|l| l.year == year && same(&l.stars, &settings.stars)) {
            return Ok(());
        }
        settings.validate()?;
        let brightness = |i: &StarInstance| crate::light::luminance(&i.lux.map(f64::from)) as f32;
        let mut stars: Vec<_> = settings.stars().iter().map(|s| StarInstance::of_star(s, year)).collect();
        stars.sort_by(|a, b| brightness(b).total_cmp(&brightness(a)));
        let most = BODIES.len() + stars.len();
        let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("stars"),
            size: (size_of::<StarInstance>() * most) as u64,
            usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        device.check_made()?;
        let lux = stars.iter().map(brightness).collect();
        let (shown, written) = (Vec::with_capacity(most), Vec::with_capacity(most));
        self.written = None;
        self.loaded =
            Some(LoadedStars { stars: settings.stars.clone(), year, all: stars, lux, shown, written, buffer });
        Ok(())
    }

    fn bind(&mut self, device: &wgpu::Device, depth: Option<StarDepth<'_>>) {
        if self.bound.as_ref().is_some_and(|(view, _)| view.as_ref() == depth.map(|d| d.view)) {
            return;
        }
        let multi = depth.is_some_and(|d| d.multisampled);
        let texture = depth.map_or(&self.none, |d| d.view);
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("stars"),
            layout: &self.layouts[usize::from(multi)],
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: self.block.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(texture) },
            ],
        });
        self.bound = Some((depth.map(|d| d.view.clone()), group));
    }
}

/// Sides of the picture in J2000.0, widened for aberration, refraction and the footprint of a star.
struct Frustum {
    /// Rows x, y and w of the matrix from J2000.0 to clip space.
    rows: [Vec3; 3],
    /// Amounts by which x and y may exceed w.
    margins: [f32; 2],
    /// Further amounts by which x and y may exceed w, as a share of w.
    footprint: [f32; 2],
}

/// Largest angle between a star's catalogued and apparent direction, rad, in air of density 1 or less
/// ([`StarView::air_density`]). Refraction lifts by 0.6 degrees. In denser air the density multiplies the angle.
const MOST_MOVED: f64 = 0.012;

impl Frustum {
    fn of(view: &StarView<'_>) -> Self {
        let rows = [0, 1, 3].map(|i| view.heavens.to_world.transpose() * view.clip.row(i).truncate());
        let moved = MOST_MOVED * view.air_density.max(1.0);
        let margin = |i: usize| (moved * (rows[i].length() + rows[2].length())) as f32;
        Self {
            rows: rows.map(|row| row.as_vec3()),
            margins: [margin(0), margin(1)],
            footprint: view.size.map(|n| 4.0 / n as f32),
        }
    }

    fn may_show(&self, star: &StarInstance) -> bool {
        let [x, y, w] = self.rows.map(|row| row.dot(Vec3::from_array(star.direction)));
        let inside = |v: f32, i: usize| v.abs() - w <= self.margins[i] + self.footprint[i] * w.abs();
        inside(x, 0) && inside(y, 1)
    }
}

fn pipeline(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    (format, multi, has_depth): PointsKind,
) -> Result<wgpu::RenderPipeline> {
    let module = device.shader(if multi { "stars/points.wgsl:multi" } else { "stars/points.wgsl" })?;
    let constants = [("HAS_DEPTH", f64::from(u8::from(has_depth)))];
    let attributes = wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3];
    let instances = wgpu::VertexBufferLayout {
        array_stride: size_of::<StarInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &attributes,
    };
    pass::quads(
        device,
        &QuadsDesc {
            label: "stars",
            vertex: (&module, "star_vertex", &[]),
            fragment: (&module, "star_fragment", &constants),
            layouts: &[Some(layout)],
            buffers: &[Some(instances)],
            format,
            counts: false,
        },
    )
}

#[cfg(test)]
mod tests;
