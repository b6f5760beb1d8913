//! Values that are not numbers: in builds with debug assertions limits let them pass, and reading a picture that holds
//! one fails.

use welkin::gpu::{Device, DeviceOptions, readback, shader};
use welkin_support::{fullscreen, textures::texture};

/// Infinity, a value that is not a number, and -0, through the limit of each.
const FRAGMENT: &str = "
@fragment fn limited(in: FullscreenVarying) -> @location(0) vec4f {
    let v = vec3f(bitcast<f32>(0x7f800000u + u32(in.position.x) * 0x400000u));
    let pixel = u32(in.position.y);
    let light = select(capped(v, 100.0), not_negative(v), pixel == 1u);
    return vec4f(select(light, marked(vec3f(0.5), v, true), pixel == 2u), 1.0);
}
";

fn drawn(device: &Device) -> wgpu::Texture {
    let format = wgpu::TextureFormat::Rgba32Float;
    let target = texture(device, (3, 3), format, 1);
    let text = ["common/fullscreen.wgsl", "common/guarded.wgsl"].map(|name| shader::assemble_checked(name).unwrap());
    let source = wgpu::ShaderSource::Wgsl((text.concat() + FRAGMENT).into());
    let gpu = &device.device;
    let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
    let entry = (fullscreen::VERTEX, "limited", &[][..]);
    let pipeline = fullscreen::pipeline(gpu, &module, entry, &[], &[format.into()]);
    let mut encoder = gpu.create_command_encoder(&Default::default());
    let view = target.create_view(&Default::default());
    let attachment = wgpu::RenderPassColorAttachment {
        view: &view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store },
    };
    let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        color_attachments: &[Some(attachment)],
        ..Default::default()
    });
    pass.set_pipeline(&pipeline);
    pass.draw(0..3, 0..1);
    drop(pass);
    device.submit_and_wait(encoder).unwrap();
    target
}

#[test]
fn values_that_are_not_numbers_pass_limits_and_fail_the_reading() {
    let device = Device::headless(&DeviceOptions::default()).expect("a software driver is installed");
    let target = drawn(&device);
    let bytes = readback::bytes(&device, &target, 0).unwrap();
    let texels: &[[f32; 4]] = bytemuck::cast_slice(&bytes);
    for row in texels.chunks(3) {
        assert!(row[0][0].is_nan() && row[1][0].is_nan() && row[2][0].is_finite(), "{row:?}");
    }
    // The tests are built with debug assertions; a release build returns the values as they are.
    if cfg!(debug_assertions) {
        let error = readback::rgba(&device, &target).unwrap_err().to_string();
        assert!(error.contains("texel (0, 0)") && error.contains("not finite"), "{error}");
    }
}
