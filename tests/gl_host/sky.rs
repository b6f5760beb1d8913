//! The sky's tables built ahead of time in a host's contexts: at every call of the progress callback the host's own
//! context and state are restored.

use std::sync::Arc;

use glow::HasContext;
use welkin::{
    Status,
    context::{Context, ContextDesc},
    frame::Shared,
    gpu::gl::GlMode,
    sky::{SkyModel, SkySettings},
};
use welkin_support::egl::{Api, Window};

use crate::host::{Host, close};

fn builds_ahead(mode: GlMode) {
    let host = Host::new(Api::Core(3, 3), Window::None, mode);
    let adopted = host.adopt();
    let device = adopted.device.clone();
    let sky = SkySettings { suns: 16, altitudes: 8, ..SkySettings::with_model(SkyModel::IsotropicTables) };
    let entered = device.enter().unwrap();
    let shared = Arc::new(Shared::new(&device).unwrap());
    drop(entered);
    let context = Context::new(device.clone(), shared, ContextDesc { sky, ..ContextDesc::default() }).unwrap();
    for most in [2, u32::MAX] {
        let mut calls = 0;
        let built = context.build_sky(&mut |_| {
            calls += 1;
            assert!(host.contexts.host.is_current());
            // The callback's own drawing, with state that must be as the host left it at the last call. SAFETY: the
            // host's context is current.
            unsafe {
                let [red, ..] = {
                    let mut color = [0.0; 4];
                    host.gl.get_parameter_f32_slice(glow::COLOR_CLEAR_VALUE, &mut color);
                    color
                };
                assert_eq!(red, (calls - 1) as f32 / 64.0);
                host.gl.clear_color(calls as f32 / 64.0, 0.0, 0.0, 1.0);
            }
            calls < most
        });
        assert_eq!(built.err().map(|e| e.status), (most == 2).then_some(Status::Aborted));
        assert!(calls == most || calls >= 14, "{calls}");
        // SAFETY: as above.
        unsafe { host.gl.clear_color(0.0, 0.0, 0.0, 0.0) };
    }
    assert!(host.contexts.host.is_current());
    let entered = device.enter().unwrap();
    drop(context);
    drop(entered);
    drop(device);
    close(adopted);
}

#[test]
fn a_sky_is_built_ahead_beside_the_hosts_context() {
    builds_ahead(GlMode::Shared);
}

#[test]
fn a_sky_is_built_ahead_in_the_hosts_context() {
    builds_ahead(GlMode::HostContext);
}
