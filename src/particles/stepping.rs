//! Particles integrated through a wind that varies in space, such as that around a building.
//!
//! Drops and flakes keep the shells and numbers of their lattice, but each has its own position and velocity, in a
//! buffer of the view. Each starts at its place in the lattice. In a uniform wind it then stays at the place that the
//! lattice gives, until it leaves the cell around the camera.
//!
//! During a step the drag is linear and is solved exactly ([`crate::falling::drag::step`]), so steps of any length are
//! stable. The drag's rate is that of quadratic drag at the start of the step, so short steps converge to the true
//! motion. A longer step uses the rate of a particle at terminal velocity, so that it ends at the right fall speed.
//!
//! A particle that leaves its cell, or is left behind by the camera, enters again on the opposite side. Its new place
//! is random: a hash of its number and of the number of times that it has entered. Its velocity is the wind there minus
//! the fall speed. As many particles enter as leave, so neither dropped frames nor a camera at 300 m/s cause gaps or
//! bursts. After a jump in time, or of the camera if the host reports it, all particles start anew.

use std::sync::Arc;

use glam::DVec3;

use crate::{
    error::Result,
    falling::lattice::fraction,
    gpu::{
        Device,
        bind::{self, Slot},
        blocks::{Blocks, UniformBlock},
        pass::{self, ComputeDesc},
    },
    moment::SceneMoment,
    surroundings::{WindMap, WindView},
};

/// Number of shells of each lattice.
pub(crate) const SHELLS: usize = 4;
/// Size of a `State` of `shaders/falling/state.wgsl`, bytes.
pub(crate) const STATE_BYTES: u64 = 32;
/// Longest time between two frames that is stepped, s. After a longer time all particles start anew.
const MOST_S: f64 = 10.0;
/// Longest step, s, unless a frame would then need more than [`MOST_STEPS`].
const STEP_S: f64 = 1.0 / 60.0;
/// Largest number of steps in a frame.
const MOST_STEPS: f64 = 8.0;
/// Byte offset, in the step's block, of the camera's place in each shell. Passes that only read the states bind this
/// part alone.
const EYES: usize = 512;
/// Factor by which a buffer that has to grow exceeds the requested size.
const GROWTH: f64 = 1.5;

/// Uniform block `StepUniform` of `shaders/falling/step.wgsl`, which describes the fields.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct ParticleStepUniform {
    air: [f32; 3],
    dt: f32,
    wind: WindMap,
    moved: [f32; 3],
    steps: u32,
    counts: [u32; SHELLS],
    known: [u32; SHELLS],
    begins: [u32; SHELLS],
    sides: [f32; SHELLS],
    eye: [[u32; 4]; SHELLS],
    before: [[u32; 4]; SHELLS],
    seed: u32,
    pad: [u32; 3],
}

/// Inputs of one frame's step.
pub(crate) struct Stepped<'a> {
    /// Seed of the places where particles enter.
    pub seed: u32,
    /// Number of particles in each shell.
    pub counts: [u32; SHELLS],
    /// Side of each shell's cell, m.
    pub sides_m: [f64; SHELLS],
    /// Smallest capacity of each shell, for particles that may come soon.
    pub least_room: u32,
    /// Position of the camera, m, east, north and up from a point fixed to the world.
    pub position_m: DVec3,
    /// Time at the end of the step, s.
    pub time_s: f64,
    /// Present velocity of the air, (east, north, up), m/s.
    pub air_m_s: DVec3,
    /// Function that returns the displacement of the air, m (east, north, up), since an earlier time, s.
    pub carried: &'a dyn Fn(f64) -> DVec3,
    /// Whether all particles start anew, because the picture must not depend on earlier frames.
    pub anew: bool,
    /// Texture of the wind that varies in space, and the camera's position in it if there is such a wind.
    pub wind: (WindView, Option<WindMap>),
}

/// Returns whether the particles within `reach_m` of the camera are stepped: if the wind varies in space there and the
/// device has compute (tier 1). Particles that were stepped in the last frame (`was`) stay so, unless the picture must
/// not depend on earlier frames (`is_pure`): otherwise they would jump.
pub(crate) fn is_due(now: &SceneMoment<'_>, device: &Device, reach_m: f64, was: bool, is_pure: bool) -> bool {
    let varies = || now.wind_volume.is_some_and(|volume| volume.distance_m(now.eye) <= reach_m);
    device.caps().tier > 0 && ((was && !is_pure) || varies())
}

/// State at the end of the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LastStep {
    /// Time, s.
    time_s: f64,
    /// Position of the camera, (east, north, up), m.
    position_m: DVec3,
    /// Number of particles with a state in each shell.
    counts: [u32; SHELLS],
}

impl ParticleStepUniform {
    /// Creates the block for the step from `left` to now; `None` if there is nothing to step.
    fn new(stepped: &Stepped<'_>, left: Option<LastStep>, rooms: &ShellCapacities) -> Option<Self> {
        let v = |d: DVec3| d.as_vec3().to_array();
        let left = left.filter(|l| (0.0..=MOST_S).contains(&(stepped.time_s - l.time_s)));
        let dt = left.map_or(0.0, |l| stepped.time_s - l.time_s);
        let moved = left.map_or(DVec3::ZERO, |l| stepped.position_m - l.position_m);
        let known = left.map_or([0; SHELLS], |l| l.counts);
        let counts = rooms.within(stepped.counts);
        let all_known = counts.iter().zip(known).all(|(count, known)| known >= *count);
        if left.is_some() && dt == 0.0 && moved == DVec3::ZERO && all_known {
            return None;
        }
        let steps = (dt / STEP_S).ceil().clamp(1.0, MOST_STEPS);
        let blows = match left {
            Some(l) if dt > 0.0 => (stepped.carried)(l.time_s) / dt,
            _ => stepped.air_m_s,
        };
        let begins = rooms.begins();
        let places = |p: DVec3| {
            std::array::from_fn(|s| {
                let [x, y, z] = p.to_array().map(|x| fraction(x, stepped.sides_m[s]));
                [x, y, z, begins[s]]
            })
        };
        Some(Self {
            air: v(blows),
            dt: (dt / steps) as f32,
            wind: stepped.wind.1.unwrap_or_default(),
            moved: v(moved),
            steps: if dt > 0.0 { steps as u32 } else { 0 },
            counts,
            known,
            begins,
            sides: stepped.sides_m.map(|side| side as f32),
            eye: places(stepped.position_m),
            before: places(stepped.position_m - moved),
            seed: stepped.seed,
            pad: [0; 3],
        })
    }
}

/// Capacity of each shell, in states.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct ShellCapacities([u32; SHELLS]);

impl ShellCapacities {
    /// Returns the index of each shell's first state.
    fn begins(&self) -> [u32; SHELLS] {
        std::array::from_fn(|s| self.0[..s].iter().sum())
    }

    /// Returns the capacity of all shells together.
    fn all(&self) -> u64 {
        self.0.iter().map(|n| u64::from(*n)).sum()
    }

    /// Returns the counts, limited to the capacities.
    fn within(&self, counts: [u32; SHELLS]) -> [u32; SHELLS] {
        std::array::from_fn(|s| counts[s].min(self.0[s]))
    }

    /// Returns these capacities if they hold `counts`, each taken as at least `least`. Otherwise returns new ones,
    /// whose sum over all shells is at most `most`: larger ones or, if these exceed `most`, as few as are needed or
    /// allowed.
    fn for_counts(&self, counts: [u32; SHELLS], least: u32, most: u64) -> Self {
        if self.0.iter().zip(counts).all(|(room, count)| *room >= count.max(least)) {
            return *self;
        }
        let is_first = self.all() == 0;
        let grown = |s: usize| match counts[s].max(least) {
            wanted if is_first || wanted <= self.0[s] => wanted.max(self.0[s]),
            wanted => (f64::from(wanted) * GROWTH) as u32,
        };
        let rooms = Self(std::array::from_fn(grown));
        if rooms.all() <= most {
            return rooms;
        }
        // If growth does not fit, use the counts alone, and at last an equal share for each shell.
        let bare = Self(std::array::from_fn(|s| counts[s].max(least)));
        if bare.all() <= most { bare } else { Self([(most / SHELLS as u64) as u32; SHELLS]) }
    }
}

/// States on the GPU, and the pass that steps them.
pub(crate) struct StepPass {
    /// Shader file and entry point; `group` is the number of threads in a workgroup.
    shader: (&'static str, &'static str),
    group: u32,
    block: UniformBlock,
    /// Capacities of the shells, and the buffer of the states.
    states: Option<(ShellCapacities, wgpu::Buffer)>,
    /// State at the end of the last step; `None` before the first.
    left: Option<LastStep>,
    /// Bound texture of the wind; one texel if there is no wind that varies in space.
    wind: Option<WindView>,
    sampler: wgpu::Sampler,
    /// Layouts of the effect's own block, of the step, and of the states for passes that read them.
    layouts: [wgpu::BindGroupLayout; 3],
    /// Pipelines without and with a wind that varies in space.
    steps: [Option<wgpu::ComputePipeline>; 2],
    /// Bind groups for the three layouts.
    groups: Option<[wgpu::BindGroup; 3]>,
}

/// Creates the layout by which listing passes read stepped particles: the camera's place in each shell's cell with the
/// index of the shell's first state, and the states.
pub(crate) fn source_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let slots = [(0, Slot::Uniform(16 * SHELLS)), (1, Slot::StorageRead(STATE_BYTES))];
    bind::layout(device, "stepped", wgpu::ShaderStages::COMPUTE, &slots)
}

impl StepPass {
    /// Returns the largest number of states on a device.
    pub fn most(device: &Device) -> u64 {
        device.device.limits().max_storage_buffer_binding_size / STATE_BYTES
    }

    /// Creates the pass for an entry point of a shader with workgroups of `group` threads, which reads the effect's own
    /// block of `own_bytes` bytes.
    pub fn new(
        device: &Device,
        blocks: &Blocks,
        shader: (&'static str, &'static str),
        group: u32,
        own_bytes: usize,
    ) -> Self {
        let own = &device.device;
        let make = |label, slots: &[(u32, Slot)]| bind::layout(own, label, wgpu::ShaderStages::COMPUTE, slots);
        let step = [
            (0, Slot::Uniform(size_of::<ParticleStepUniform>())),
            (1, Slot::Storage(STATE_BYTES)),
            (2, Slot::FilteredVolume),
            (3, Slot::Sampler),
        ];
        Self {
            shader,
            group,
            block: blocks.block(device, EYES + 16 * SHELLS),
            states: None,
            left: None,
            wind: None,
            sampler: own.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("wind"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
            layouts: [make("step frame", &[(0, Slot::Uniform(own_bytes))]), make("step", &step), source_layout(own)],
            steps: [None, None],
            groups: None,
        }
    }

    /// Returns the bytes of GPU memory held.
    pub fn bytes(&self) -> u64 {
        self.states.as_ref().map_or(0, |(_, b)| b.size())
    }

    /// Makes room for the states, binds the wind, and records the step. The effect's own block is already uploaded.
    ///
    /// # Errors
    /// [`crate::Status::Internal`] if a shader file is missing.
    pub fn step(
        &mut self,
        device: &Arc<Device>,
        encoder: &mut wgpu::CommandEncoder,
        own: wgpu::BufferBinding<'_>,
        stepped: &Stepped<'_>,
    ) -> Result<()> {
        self.make_room(device, encoder, stepped);
        let (view, map) = &stepped.wind;
        if self.wind.as_ref().is_none_or(|bound| bound.generation != view.generation) {
            (self.wind, self.groups) = (Some(view.clone()), None);
        }
        self.bind(device, own);
        let Some((rooms, _)) = &self.states else { return Ok(()) };
        let left = self.left.filter(|_| !stepped.anew);
        let counts = rooms.within(stepped.counts);
        self.left = Some(LastStep { time_s: stepped.time_s, position_m: stepped.position_m, counts });
        let Some(block) = ParticleStepUniform::new(stepped, left, rooms) else { return Ok(()) };
        let mut bytes = [0; EYES + 16 * SHELLS];
        bytes[..size_of::<ParticleStepUniform>()].copy_from_slice(bytemuck::bytes_of(&block));
        bytes[EYES..].copy_from_slice(bytemuck::bytes_of(&block.eye));
        self.block.write(&bytes);
        let slot = &mut self.steps[usize::from(map.is_some())];
        if slot.is_none() {
            let desc = ComputeDesc {
                shader: self.shader.0,
                entry: self.shader.1,
                layouts: &[Some(&self.layouts[0]), Some(&self.layouts[1])],
                constants: &[("WIND", f64::from(u8::from(map.is_some())))],
            };
            *slot = Some(pass::compute(device, &desc)?);
        }
        let longest = counts.into_iter().max().unwrap_or(0);
        if let (Some(pipeline), Some(groups)) = (slot, &self.groups) {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(pipeline);
            pass.set_bind_group(0, &groups[0], &[]);
            pass.set_bind_group(1, &groups[1], &[]);
            pass.dispatch_workgroups(longest.div_ceil(self.group).max(1), SHELLS as u32, 1);
        }
        Ok(())
    }

    /// Makes room for more states, and copies the existing ones.
    fn make_room(&mut self, device: &Device, encoder: &mut wgpu::CommandEncoder, stepped: &Stepped<'_>) {
        let before = self.states.as_ref().map_or(ShellCapacities::default(), |(rooms, _)| *rooms);
        let rooms = before.for_counts(stepped.counts, stepped.least_room, Self::most(device));
        if self.states.is_some() && rooms == before {
            return;
        }
        let buffer = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("stepped"),
            size: STATE_BYTES * rooms.all().max(1),
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::VERTEX
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        if let (Some((_, old)), Some(left)) = (&self.states, &mut self.left) {
            left.counts = rooms.within(left.counts);
            for (s, (source, target)) in before.begins().into_iter().zip(rooms.begins()).enumerate() {
                let [source, target, kept] = [source, target, left.counts[s]].map(|n| STATE_BYTES * u64::from(n));
                if kept > 0 {
                    encoder.copy_buffer_to_buffer(old, source, &buffer, target, kept);
                }
            }
        }
        (self.states, self.groups) = (Some((rooms, buffer)), None);
    }

    /// Returns the bind group of the states ([`source_layout`]), once there are any.
    pub fn states(&self) -> Option<&wgpu::BindGroup> {
        self.groups.as_ref().map(|[.., states]| states)
    }

    /// Returns the states of each shell as a vertex buffer, and their number after the last step.
    pub fn shells(&self) -> impl DoubleEndedIterator<Item = (wgpu::BufferSlice<'_>, u32)> {
        let counts = self.left.map_or([0; SHELLS], |left| left.counts);
        self.states.iter().flat_map(move |(rooms, buffer)| {
            let begins = rooms.begins();
            (0..SHELLS).filter(move |s| counts[*s] > 0).map(move |s| {
                let begin = STATE_BYTES * u64::from(begins[s]);
                (buffer.slice(begin..begin + STATE_BYTES * u64::from(counts[s])), counts[s])
            })
        })
    }

    /// Returns the states of each shell, as words.
    #[cfg(test)]
    pub fn read(&self, device: &Device) -> [Vec<[u32; 8]>; SHELLS] {
        let (rooms, states) = self.states.as_ref().expect("there are states");
        let copy = device.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: states.size(),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = device.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(states, 0, &copy, 0, states.size());
        device.submit(encoder);
        copy.slice(..).map_async(wgpu::MapMode::Read, |r| r.expect("mapped"));
        device.wait().expect("the device answers");
        let bytes = copy.slice(..).get_mapped_range().expect("mapped").to_vec();
        let words: &[[u32; 8]] = bytemuck::cast_slice(&bytes);
        let counts = self.left.map_or([0; SHELLS], |left| left.counts);
        std::array::from_fn(|s| words[rooms.begins()[s] as usize..][..counts[s] as usize].to_vec())
    }

    fn bind(&mut self, device: &Device, own: wgpu::BufferBinding<'_>) {
        let (None, Some((_, states)), Some(wind)) = (&self.groups, &self.states, &self.wind) else { return };
        let group = |layout, entries: &[wgpu::BindGroupEntry<'_>]| {
            device.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("step"), layout, entries })
        };
        let entry = |binding, resource| wgpu::BindGroupEntry { binding, resource };
        self.groups = Some([
            group(&self.layouts[0], &[entry(0, wgpu::BindingResource::Buffer(own))]),
            group(
                &self.layouts[1],
                &[
                    self.block.part(0, 0, size_of::<ParticleStepUniform>()),
                    entry(1, states.as_entire_binding()),
                    entry(2, wgpu::BindingResource::TextureView(&wind.view)),
                    entry(3, wgpu::BindingResource::Sampler(&self.sampler)),
                ],
            ),
            group(&self.layouts[2], &[self.block.part(0, EYES, 16 * SHELLS), entry(1, states.as_entire_binding())]),
        ]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::shader;

    #[test]
    fn offsets_are_those_of_the_shader() {
        for file in ["rain/step.wgsl", "snow/step.wgsl"] {
            shader::assert_layout!(
                file,
                "StepUniform",
                ParticleStepUniform,
                [air, dt, wind, moved, steps, counts, known, begins, sides, eye, before, seed]
            );
        }
    }

    #[test]
    fn the_capacity_of_a_shell_stays_and_grows_with_its_count() {
        let first = ShellCapacities::default().for_counts([10, 0, 30, 7], 0, 1000);
        assert_eq!(first, ShellCapacities([10, 0, 30, 7]));
        assert_eq!(first.begins(), [0, 10, 10, 40]);
        assert_eq!(first.for_counts([10, 0, 20, 0], 0, 1000), first, "what is there is kept");
        assert_eq!(first.for_counts([12, 0, 20, 0], 0, 1000), ShellCapacities([18, 0, 30, 7]));
        assert_eq!(ShellCapacities::default().for_counts([1, 1, 1, 1], 50, 1000), ShellCapacities([50; 4]));
        // Without growth if that is too much, and at last an equal share for each shell.
        assert_eq!(first.for_counts([40, 0, 5, 0], 0, 50), ShellCapacities([40, 0, 5, 0]));
        assert_eq!(first.for_counts([400, 0, 5, 0], 0, 48), ShellCapacities([12; 4]));
        assert_eq!(ShellCapacities([12; 4]).within([400, 0, 5, 0]), [12, 0, 5, 0]);
    }
}
