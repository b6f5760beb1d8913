//! The terrain's water as a texture for a Rust host's own shaders: the cells, and what is drawn from it.

use std::sync::Arc;

use welkin::{
    Status,
    context::{Context, ContextDesc},
    frame::{Shared, Stages, View},
    gpu::{Device, DeviceOptions, readback},
    ground::{GroundCell, GroundModel},
    ground::{GroundTexture, SNIPPET_WGSL},
    weather::{Surface, SurfaceState, Weather, Wind},
};

use crate::{
    host::{Host, ground, look},
    terrain::{NODES, grid, rain, roof, simulated},
};

fn cells(context: &Context) -> Vec<[f32; 4]> {
    let of = |c: GroundCell| [c.film_mm, c.soaked, c.standing_mm, c.ice];
    context.ground_cells().unwrap().map(of).collect()
}

#[track_caller]
fn assert_cells(texels: &[[f32; 4]], cells: &[[f32; 4]]) {
    assert_eq!(texels.len(), cells.len());
    for (i, (texel, cell)) in texels.iter().zip(cells).enumerate() {
        let shown = [texel[0], texel[1], texel[2].max(0.0), texel[3]];
        let close = shown.iter().zip(cell).all(|(t, c)| (t - c).abs() <= c / 2048.0 + 1e-7);
        assert!(close, "texel {i}: {texel:?}, wanted {cell:?}");
    }
}

#[track_caller]
fn assert_shown(context: &mut Context) -> GroundTexture {
    let texture = context.ground_texture().unwrap();
    assert_eq!(texture.revision, context.ground_revision());
    assert_cells(&readback::rgba(context.device(), &texture.texture).unwrap(), &cells(context));
    texture
}

/// A simulated ground under a roof, on both drivers and without compute shaders.
fn contexts() -> [Context; 3] {
    let gl = DeviceOptions { backends: wgpu::Backends::GL, ..DeviceOptions::default() };
    let options = [DeviceOptions::default(), gl.clone(), DeviceOptions { force_tier0: true, ..gl }];
    options.map(|options| {
        let device = Device::headless(&options).unwrap();
        let shared = Arc::new(Shared::new(&device).unwrap());
        let desc = ContextDesc { ground: GroundModel::Simulated, ..ContextDesc::default() };
        let mut context = Context::new(device, shared, desc).unwrap();
        context.set_shelters(&[roof([-12.0, 8.0, 4.0], [5.0, 4.0, 0.2])]).unwrap();
        context
    })
}

#[test]
fn the_texture_has_the_cells_and_stays_until_another_grid_comes() {
    for mut context in contexts() {
        let e = context.ground_texture().unwrap_err();
        assert!(e.status == Status::WrongOrder && e.to_string().contains("ground_grid"), "{e}");
        context.set_ground_grid(Some(grid())).unwrap();
        let dry = assert_shown(&mut context);
        context.set_weather(&rain(12.0, 4.0), 0.0, 0.0).unwrap();
        context.update(1800.0).unwrap();
        let wet = assert_shown(&mut context);
        assert!(wet.texture == dry.texture && wet.generation == dry.generation && wet.revision != dry.revision);
        assert!(cells(&context).iter().any(|c| c[2] > 50.0) && cells(&context).iter().any(|c| c[1] == 0.0));
        // Loading a state on the same grid keeps the texture and changes its water.
        let saved = context.save().unwrap();
        context.update(3600.0).unwrap();
        assert_shown(&mut context);
        context.load(&saved).unwrap();
        let back = assert_shown(&mut context);
        assert!(back.texture == wet.texture && back.generation == wet.generation);
        // The same nodes on other heights are another grid.
        let mut other = grid();
        other.heights_m.reverse();
        context.set_ground_grid(Some(other)).unwrap();
        let next = assert_shown(&mut context);
        assert!(next.texture != wet.texture && next.generation != wet.generation);
        let bad = welkin::ground::GroundGrid { cell_m: -1.0, ..grid() };
        context.set_ground_grid(Some(bad)).unwrap_err();
        assert_eq!(assert_shown(&mut context).generation, next.generation, "an error changes nothing");
    }
}

#[test]
fn water_in_the_texture_freezes_as_the_weather_says() {
    let host = Host::new();
    let mut context = simulated(&host);
    context.set_ground_grid(Some(grid())).unwrap();
    context.set_weather(&Weather::default(), 0.0, 0.0).unwrap();
    let before = assert_shown(&mut context);
    let surface = Surface { state: Some(SurfaceState::Ice), ..Surface::default() };
    let icy = Weather { surface, temperature_c: -5.0, wind: Wind::of(0.0, 0.0), ..Weather::default() };
    context.set_weather(&icy, 100.0, 60.0).unwrap();
    let mut ice = Vec::new();
    for time_s in [95.0, 125.0, 129.0, 151.0, 200.0, 300.0] {
        context.update(time_s).unwrap();
        ice.push((assert_shown(&mut context).revision, cells(&context)[0][3]));
    }
    assert_eq!(ice[0], (before.revision, 0.0));
    assert!(
        ice.windows(2).all(|p| (p[0].0 == p[1].0) == (p[0].1 == p[1].1)),
        "another revision for other ice: {ice:?}"
    );
    assert!(ice[1] == ice[2] && ice[3].1 > ice[2].1 && ice[4].1 == 1.0 && ice[4] == ice[5], "{ice:?}");
}

#[test]
fn one_upload_serves_all_views_and_the_host() {
    let mut host = Host::new();
    let mut context = simulated(&host);
    context.set_ground_grid(Some(grid())).unwrap();
    context.set_weather(&rain(12.0, 0.0), 0.0, 0.0).unwrap();
    context.update(600.0).unwrap();
    let asked = context.ground_texture().unwrap();
    context.update(1200.0).unwrap();
    let held = host.view.report().bytes;
    host.context = context;
    let mut other = View::new(&host.context).unwrap();
    let eye = glam::DVec3::new(6.0, 12.0, 20.0);
    let camera = look(eye, 0.0, -90.0, 1.0);
    let first = host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [2000.0; 3]));
    // The drawn water is that of the texture that the host got, up to date.
    assert_cells(&readback::rgba(&host.device, &asked.texture).unwrap(), &cells(&host.context));
    std::mem::swap(&mut host.view, &mut other);
    let second = host.shoot(camera, Stages::SURFACE, |d| ground(eye, d, [2000.0; 3]));
    assert!(first == second && first.iter().any(|p| p[1] < 1900.0));
    let bytes = host.view.report().bytes.max(other.report().bytes) - held;
    assert!(bytes < 1 << 20, "views keep no terrain of their own: {bytes}");
}

/// Draws the published functions over the texture, four pixels a node along either side.
fn looks(device: &Arc<Device>, from: &GroundTexture) -> Vec<[f32; 4]> {
    let text = format!(
        "{SNIPPET_WGSL}
        @group(0) @binding(0) var cells: texture_2d<f32>;
        @group(0) @binding(1) var linear: sampler;
        @vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
            return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
        }}
        @fragment fn look(@builtin(position) at: vec4f) -> @location(0) vec4f {{
            let uv = at.xy / (4.0 * vec2f(textureDimensions(cells)));
            let water = welkin_ground(cells, uv);
            let film = textureSampleLevel(cells, linear, uv, 0.0).x;
            return vec4f(water.soaked, welkin_film(water).x, water.pool, film);
        }}"
    );
    let gpu = &device.device;
    let shader = gpu.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let pipeline = gpu.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: None,
        vertex: wgpu::VertexState {
            module: &shader,
            entry_point: None,
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &shader,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &[Some(wgpu::TextureFormat::Rgba16Float.into())],
        }),
        multiview_mask: None,
        cache: None,
    });
    let size = wgpu::Extent3d { width: 4 * NODES[0], height: 4 * NODES[1], depth_or_array_layers: 1 };
    let out = gpu.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let filter = wgpu::FilterMode::Linear;
    let sampler =
        gpu.create_sampler(&wgpu::SamplerDescriptor { mag_filter: filter, min_filter: filter, ..Default::default() });
    let group = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[
            wgpu::BindGroupEntry {
                binding: 0,
                resource: wgpu::BindingResource::TextureView(&from.texture.create_view(&Default::default())),
            },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(&sampler) },
        ],
    });
    let mut encoder = gpu.create_command_encoder(&Default::default());
    let view = out.create_view(&Default::default());
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &view,
            depth_slice: None,
            resolve_target: None,
            ops: Default::default(),
        })],
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    device.submit(encoder);
    readback::rgba(device, &out).unwrap()
}

#[test]
fn the_published_functions_find_water_where_the_queries_do() {
    for mut context in contexts() {
        context.set_ground_grid(Some(grid())).unwrap();
        context.set_weather(&rain(12.0, 0.0), 0.0, 0.0).unwrap();
        context.update(1800.0).unwrap();
        let from = context.ground_texture().unwrap();
        let pixels = looks(context.device(), &from);
        let mut seen = [0; 3];
        for (i, pixel) in pixels.iter().enumerate() {
            let (x, y) = (i as u32 % (4 * NODES[0]), i as u32 / (4 * NODES[0]));
            let uv = [f64::from(x) + 0.5, f64::from(y) + 0.5];
            let uv = [uv[0] / f64::from(4 * NODES[0]), uv[1] / f64::from(4 * NODES[1])];
            // The grid is level and aligned to north, so the matrix is a scale and an offset.
            let place = [0, 1].map(|k| (uv[k] - from.uv_from_world[k].w) / from.uv_from_world[k][k]);
            let at = context.ground_at(glam::DVec3::new(place[0], place[1], 0.0)).unwrap();
            let inside = (-20.0..=19.0).contains(&place[0]) && (0.0..=29.0).contains(&place[1]);
            if !inside {
                continue;
            }
            assert!((f64::from(pixel[3]) - at.film_mm).abs() < 0.02, "{place:?}: {pixel:?} {at:?}");
            assert!(at.in_puddle || pixel[2] == 0.0, "{place:?}: {pixel:?} {at:?}");
            assert!(
                at.water_mm - at.film_mm < 2.5 || (pixel[1] > 0.999 && pixel[2] == 1.0),
                "{place:?}: {pixel:?} {at:?}"
            );
            assert!(at.wetness > 0.0 || pixel[0] == 0.0, "{place:?}: {pixel:?} {at:?}");
            for (count, found) in seen.iter_mut().zip([pixel[0] == 0.0, pixel[1] > 0.5, pixel[2] > 0.5]) {
                *count += u32::from(found);
            }
        }
        assert!(seen.iter().all(|n| *n > 100), "dry places, films and puddles: {seen:?}");
    }
}
