//! The veil in a Vulkan host's own shader: the published WGSL, compiled to SPIR-V and run in the host's pipeline. Glass
//! in front of the sky shows the same as what Welkin draws in front of an opaque object at its place.

use ash::vk::{self, Handle};
use welkin::capi::{device::*, frame::*, veil::*, view::*, vulkan::*};
use welkin_support::c_scene::{Scene, init, ok, veil::*};
use wgpu::naga;

use crate::SIZE;
use crate::capi::{device, image};
use crate::host::{Host, Owned, Setup};

const FORMAT: vk::Format = vk::Format::R16G16B16A16_SFLOAT;
const GENERAL: vk::ImageLayout = vk::ImageLayout::GENERAL;
const SAMPLED: vk::ImageLayout = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;

/// The host's shader, with the numbers written into its text.
fn shader(far_m: f64, light_scale: f64) -> Vec<u32> {
    let ([x, y], [r, g, b]) = (slopes(SIZE), COLOR);
    let text = format!(
        "{}
@group(0) @binding(0) var veil_light: texture_2d<f32>;
@group(0) @binding(1) var veil_through: texture_2d<f32>;
@group(0) @binding(2) var linear: sampler;
@vertex fn corner(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {{
    return vec4f(f32(i & 1u) * 4.0 - 1.0, f32(i >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}}
@fragment fn glass(@builtin(position) at: vec4f) -> @location(0) vec4f {{
    let uv = at.xy / vec2f({}.0, {}.0);
    let ray = vec3f((2.0 * uv - 1.0) * vec2f({x:?}, {y:?}), 1.0);
    let veil = welkin_veil(veil_light, veil_through, linear, uv, {far_m:?} * length(ray));
    return vec4f(vec3f({r:?}, {g:?}, {b:?}) * veil.through + veil.light * {light_scale:?}, {ALPHA:?});
}}",
        snippet(WK_SHADING_WGSL),
        SIZE.0,
        SIZE.1
    );
    let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|e| panic!("{}", e.emit_to_string(&text)));
    let mut validator =
        naga::valid::Validator::new(naga::valid::ValidationFlags::all(), naga::valid::Capabilities::empty());
    let info = validator.validate(&module).expect("the snippet is valid");
    let options = naga::back::spv::Options { flags: naga::back::spv::WriterFlags::empty(), ..Default::default() };
    naga::back::spv::write_vec(&module, &info, &options, None).expect("SPIR-V")
}

/// An image with the same texel everywhere.
fn image_of<T: bytemuck::Pod>(host: &Host, format: vk::Format, usage: vk::ImageUsageFlags, texel: T) -> Owned {
    use vk::ImageUsageFlags as U;
    let owned = host.image(format, SIZE, 1, usage | U::TRANSFER_SRC | U::TRANSFER_DST);
    host.write_texels(&owned.image, &vec![texel; (SIZE.0 * SIZE.1) as usize], GENERAL);
    owned
}

/// Colour and depth images that the host has cleared to one value.
fn canvas(host: &Host, [r, g, b]: [f32; 3], depth: f32) -> [Owned; 2] {
    use vk::ImageUsageFlags as U;
    let texel = [r, g, b, 1.0].map(|v| half::f16::from_f32(v).to_bits());
    [
        image_of(host, FORMAT, U::COLOR_ATTACHMENT, texel),
        image_of(host, vk::Format::D32_SFLOAT, U::DEPTH_STENCIL_ATTACHMENT | U::SAMPLED, depth),
    ]
}

fn record(scene: &Scene, [color, depth]: &[Owned; 2], id: u64, space: wk_color_space) {
    let (color, depth) = (image(color, GENERAL, GENERAL), image(depth, GENERAL, GENERAL));
    let target = wk_vulkan_target { color: &color, depth: &depth, ..init("wk_vulkan_target") };
    let frame = wk_frame { target: (&raw const target).cast(), ..frame(id, SIZE, space) };
    // SAFETY: live handles, truly described.
    ok(unsafe { wk_view_record(scene.view, &frame, STAGES) });
}

fn read(host: &Host, colour: &Owned) -> Vec<[f32; 4]> {
    let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
    host.run(&[], &[], true, |c| host.transition(c, &colour.image, GENERAL, source));
    let halves: Vec<[u16; 4]> = host.read_texels(&colour.image, &[]);
    host.run(&[], &[], true, |c| host.transition(c, &colour.image, source, GENERAL));
    halves.iter().map(|t| t.map(|h| half::f16::from_bits(h).to_f32())).collect()
}

fn view(host: &Host, image: vk::Image) -> vk::ImageView {
    let range = vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        level_count: 1,
        layer_count: 1,
        ..Default::default()
    };
    let info = vk::ImageViewCreateInfo::default()
        .image(image)
        .view_type(vk::ImageViewType::TYPE_2D)
        .format(FORMAT)
        .subresource_range(range);
    // SAFETY: plain Vulkan by its rules.
    unsafe { host.device.create_image_view(&info, None).unwrap() }
}

/// Blends the glass over the picture, by plain Vulkan.
fn draw_glass(host: &Host, colour: &Owned, veil: &wk_frame_textures, far_m: f64) {
    let d = &host.device;
    let views = [colour.image.image, vk::Image::from_raw(veil.light), vk::Image::from_raw(veil.through)];
    let views = views.map(|image| view(host, image));
    // SAFETY: plain Vulkan by its rules, which the validation layer watches; all is waited for before it is destroyed.
    unsafe {
        let sampler = vk::SamplerCreateInfo::default()
            .min_filter(vk::Filter::LINEAR)
            .mag_filter(vk::Filter::LINEAR)
            .address_mode_u(vk::SamplerAddressMode::CLAMP_TO_EDGE)
            .address_mode_v(vk::SamplerAddressMode::CLAMP_TO_EDGE);
        let sampler = d.create_sampler(&sampler, None).unwrap();
        let kinds = [vk::DescriptorType::SAMPLED_IMAGE, vk::DescriptorType::SAMPLED_IMAGE, vk::DescriptorType::SAMPLER];
        let bindings: Vec<_> = (0..3)
            .map(|i| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(i)
                    .descriptor_count(1)
                    .descriptor_type(kinds[i as usize])
                    .stage_flags(vk::ShaderStageFlags::FRAGMENT)
            })
            .collect();
        let set_layout = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let set_layouts = [d.create_descriptor_set_layout(&set_layout, None).unwrap()];
        let sizes = kinds.map(|ty| vk::DescriptorPoolSize { ty, descriptor_count: 1 });
        let pool = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        let pool = d.create_descriptor_pool(&pool, None).unwrap();
        let set = vk::DescriptorSetAllocateInfo::default().descriptor_pool(pool).set_layouts(&set_layouts);
        let set = d.allocate_descriptor_sets(&set).unwrap()[0];
        for (i, kind) in kinds.into_iter().enumerate() {
            let image_view = views[(i + 1) % 3];
            let info = [vk::DescriptorImageInfo { sampler, image_view, image_layout: SAMPLED }];
            let write = vk::WriteDescriptorSet::default().dst_set(set).dst_binding(i as u32).descriptor_type(kind);
            d.update_descriptor_sets(&[write.image_info(&info)], &[]);
        }
        let attachments = [vk::AttachmentDescription::default()
            .format(FORMAT)
            .samples(vk::SampleCountFlags::TYPE_1)
            .load_op(vk::AttachmentLoadOp::LOAD)
            .store_op(vk::AttachmentStoreOp::STORE)
            .initial_layout(GENERAL)
            .final_layout(GENERAL)];
        let references = [vk::AttachmentReference { attachment: 0, layout: GENERAL }];
        let subpasses = [vk::SubpassDescription::default().color_attachments(&references)];
        let pass = vk::RenderPassCreateInfo::default().attachments(&attachments).subpasses(&subpasses);
        let pass = d.create_render_pass(&pass, None).unwrap();
        let framebuffer = vk::FramebufferCreateInfo::default()
            .render_pass(pass)
            .attachments(&views[..1])
            .width(SIZE.0)
            .height(SIZE.1)
            .layers(1);
        let framebuffer = d.create_framebuffer(&framebuffer, None).unwrap();
        let code = shader(far_m, veil.light_scale);
        let module = d.create_shader_module(&vk::ShaderModuleCreateInfo::default().code(&code), None).unwrap();
        let layout = vk::PipelineLayoutCreateInfo::default().set_layouts(&set_layouts);
        let layout = d.create_pipeline_layout(&layout, None).unwrap();
        let stages = [(vk::ShaderStageFlags::VERTEX, c"corner"), (vk::ShaderStageFlags::FRAGMENT, c"glass")]
            .map(|(stage, name)| vk::PipelineShaderStageCreateInfo::default().stage(stage).module(module).name(name));
        let area = vk::Rect2D { extent: vk::Extent2D { width: SIZE.0, height: SIZE.1 }, ..Default::default() };
        let (width, height) = (SIZE.0 as f32, SIZE.1 as f32);
        let (viewports, scissors) = ([vk::Viewport { width, height, max_depth: 1.0, ..Default::default() }], [area]);
        let blends = [vk::PipelineColorBlendAttachmentState::default()
            .blend_enable(true)
            .src_color_blend_factor(vk::BlendFactor::SRC_ALPHA)
            .dst_color_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
            .src_alpha_blend_factor(vk::BlendFactor::ONE)
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let pipeline = vk::GraphicsPipelineCreateInfo::default().stages(&stages).layout(layout).render_pass(pass);
        let (vertices, assembly, raster, samples, viewport, blend) = (
            vk::PipelineVertexInputStateCreateInfo::default(),
            vk::PipelineInputAssemblyStateCreateInfo::default().topology(vk::PrimitiveTopology::TRIANGLE_LIST),
            vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0),
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(vk::SampleCountFlags::TYPE_1),
            vk::PipelineViewportStateCreateInfo::default().viewports(&viewports).scissors(&scissors),
            vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends),
        );
        let pipeline = pipeline
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .viewport_state(&viewport)
            .color_blend_state(&blend);
        let pipeline = d.create_graphics_pipelines(vk::PipelineCache::null(), &[pipeline], None).unwrap()[0];
        host.run(&[], &[], true, |c| {
            host.transition(c, &colour.image, GENERAL, GENERAL);
            let begin = vk::RenderPassBeginInfo::default().render_pass(pass).framebuffer(framebuffer).render_area(area);
            d.cmd_begin_render_pass(c, &begin, vk::SubpassContents::INLINE);
            d.cmd_bind_pipeline(c, vk::PipelineBindPoint::GRAPHICS, pipeline);
            d.cmd_bind_descriptor_sets(c, vk::PipelineBindPoint::GRAPHICS, layout, 0, &[set], &[]);
            d.cmd_draw(c, 3, 1, 0, 0);
            d.cmd_end_render_pass(c);
            host.transition(c, &colour.image, GENERAL, GENERAL);
        });
        d.destroy_pipeline(pipeline, None);
        d.destroy_pipeline_layout(layout, None);
        d.destroy_shader_module(module, None);
        d.destroy_framebuffer(framebuffer, None);
        d.destroy_render_pass(pass, None);
        d.destroy_descriptor_pool(pool, None);
        d.destroy_descriptor_set_layout(set_layouts[0], None);
        d.destroy_sampler(sampler, None);
        views.iter().for_each(|v| d.destroy_image_view(*v, None));
    }
}

#[test]
fn glass_by_the_published_shader_is_what_welkin_draws_before_an_opaque_thing() {
    let host = Host::new(Setup::modern());
    let device = device(&host);
    for (rain, space) in CASES {
        let scene = scene(device, rain);
        let mut id = 0;
        for far_m in FAR_M {
            let thing = canvas(&host, COLOR, depth(far_m));
            record(&scene, &thing, id + 1, space);
            let opaque = read(&host, &thing[0]);
            let sky = canvas(&host, [0.0; 3], 0.0);
            record(&scene, &sky, id + 2, space);
            let behind = read(&host, &sky[0]);
            draw_glass(&host, &sky[0], &textures(&scene), far_m);
            let what = format!("rain {rain}, colour space {space}, {far_m} m");
            assert_mixed(&read(&host, &sky[0]), &behind, &opaque, &what);
            for owned in thing.into_iter().chain(sky) {
                // SAFETY: a live device.
                ok(unsafe { wk_device_forget_vulkan_image(device, owned.image.image.as_raw()) });
                host.destroy_image(owned);
            }
            id += 2;
        }
        scene.destroy();
    }
    // SAFETY: a live handle.
    ok(unsafe { wk_device_destroy(device) });
    host.assert_valid();
    host.finish();
}
