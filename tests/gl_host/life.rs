//! Creation and destruction of devices: contexts that give none, two devices, every order of destruction, and objects
//! left behind.

use std::{
    ffi::{CStr, c_char, c_void},
    ptr::{null, null_mut},
    sync::atomic::Ordering,
};

use glow::HasContext;
use welkin::{
    Status,
    gpu::gl::{GlDevice, GlHostDesc, GlImage, GlMode, GlTargetDesc, Handover, adopt},
};
use welkin_support::egl::{self, Api, Context, Window};

use crate::{
    host::{Depth, Host, Picture, close, get_proc},
    images::*,
};

/// Returns the error of creating a device of `desc`.
fn refusal(desc: &GlHostDesc) -> welkin::Error {
    // SAFETY: the callbacks are those of these tests.
    match unsafe { adopt(desc) } {
        Ok(_) => panic!("a device was made"),
        Err(e) => e,
    }
}

fn bare(mode: GlMode) -> GlHostDesc {
    GlHostDesc {
        get_proc: Some(get_proc),
        make_current: None,
        user: null_mut(),
        mode,
        handover: Handover::Fence,
        force_tier0: false,
    }
}

unsafe extern "C" fn finds_nothing(_: *mut c_void, _: *const c_char) -> *const c_void {
    null()
}

unsafe extern "C" fn misses_clear(user: *mut c_void, name: *const c_char) -> *const c_void {
    // SAFETY: the name is NUL-terminated.
    if unsafe { CStr::from_ptr(name) } == c"glClear" { null() } else { unsafe { get_proc(user, name) } }
}

extern "system" fn old_version(name: u32) -> *const u8 {
    let text: &CStr = if name == 0x1F02 { c"2.1 Ancient" } else { c"2.1" };
    text.as_ptr().cast()
}

extern "system" fn strange_version(_: u32) -> *const u8 {
    c"unknown".as_ptr().cast()
}

extern "system" fn old_es(_: u32) -> *const u8 {
    c"OpenGL ES 2.0 Ancient".as_ptr().cast()
}

/// Results of some Windows drivers for a function that does not exist.
const NO_FUNCTIONS: [isize; 4] = [1, 2, 3, -1];

/// A loader like wglGetProcAddress on these drivers: it returns `user` for missing functions and for the functions of
/// OpenGL 1.1.
unsafe extern "C" fn answers_numbers(user: *mut c_void, name: *const c_char) -> *const c_void {
    // SAFETY: the name is NUL-terminated.
    let (name, found) = unsafe { (CStr::from_ptr(name), get_proc(null_mut(), name)) };
    if found.is_null() || name == c"glClear" { user } else { found }
}

/// A loader as above, but with the functions of OpenGL 1.1 and without all functions that a driver may leave out.
unsafe extern "C" fn has_the_least(user: *mut c_void, name: *const c_char) -> *const c_void {
    const LEFT_OUT: [&str; 2] = ["ClipControl", "PolygonOffsetClamp"];
    // SAFETY: the name is NUL-terminated.
    let (name, found) = unsafe { (CStr::from_ptr(name), get_proc(null_mut(), name)) };
    let is_left_out = LEFT_OUT.iter().any(|part| name.to_string_lossy().contains(part));
    if found.is_null() || is_left_out { user } else { found }
}

#[test]
fn a_number_that_is_no_address_counts_as_a_missing_function() {
    let context = Context::new(Api::Core(3, 3), Window::None);
    assert!(context.make_current());
    for number in NO_FUNCTIONS {
        let user = number as *mut c_void;
        let error = refusal(&GlHostDesc { get_proc: Some(answers_numbers), user, ..bare(GlMode::HostContext) });
        assert_eq!(error.status, Status::InvalidArgument, "{number}: {error}");
        assert!(error.to_string().contains("got NULL for glClear"), "{number}: {error}");
        // With all optional functions missing, the device draws.
        let desc = GlHostDesc { get_proc: Some(has_the_least), user, ..bare(GlMode::HostContext) };
        // SAFETY: the callbacks are those of this file, the context is live.
        let adopted = unsafe { adopt(&desc) }.unwrap_or_else(|e| panic!("{number}: {e}"));
        close(adopted);
    }
}

/// A loader whose `glGetString` is `user`.
unsafe extern "C" fn with_other_version(user: *mut c_void, name: *const c_char) -> *const c_void {
    // SAFETY: the name is NUL-terminated.
    if unsafe { CStr::from_ptr(name) } == c"glGetString" { user } else { unsafe { get_proc(null_mut(), name) } }
}

#[test]
fn a_host_without_usable_functions_or_context_is_refused_by_name() {
    egl::make_none_current();
    let missing = refusal(&GlHostDesc { get_proc: None, ..bare(GlMode::HostContext) });
    assert_eq!(
        (missing.status, missing.to_string().contains("get_proc")),
        (Status::InvalidArgument, true),
        "{missing}"
    );
    for mode in [GlMode::HostContext, GlMode::Shared] {
        let none = refusal(&bare(mode));
        assert_eq!(none.status, Status::WrongOrder, "{none}");
        assert!(none.to_string().contains("no OpenGL context is current"), "{none}");
    }
    let context = Context::new(Api::Core(3, 3), Window::None);
    assert!(context.make_current());
    for (loader, name) in [(finds_nothing as _, "glGetString"), (misses_clear as _, "glClear")] {
        let error = refusal(&GlHostDesc { get_proc: Some(loader), ..bare(GlMode::HostContext) });
        assert_eq!(error.status, Status::InvalidArgument, "{error}");
        assert!(error.to_string().contains("get_proc") && error.to_string().contains(name), "{error}");
    }
    type GetString = extern "system" fn(u32) -> *const u8;
    for (version, status, part) in [
        (
            old_version as GetString,
            Status::Unsupported,
            "OpenGL 3.3 or later or OpenGL ES 3.0 or later, got OpenGL 2.1",
        ),
        (old_es as GetString, Status::Unsupported, "got OpenGL ES 2.0"),
        (strange_version as GetString, Status::NoAdapter, "\"unknown\""),
    ] {
        let user = version as *mut c_void;
        let error = refusal(&GlHostDesc { get_proc: Some(with_other_version), user, ..bare(GlMode::HostContext) });
        assert_eq!(error.status, status, "{error}");
        assert!(error.to_string().contains(part), "{error}");
    }
    let shared = refusal(&bare(GlMode::Shared));
    assert_eq!(shared.status, Status::InvalidArgument, "{shared}");
    assert!(shared.to_string().contains("make_current"), "{shared}");
    assert!(context.is_current());
}

#[test]
fn a_wrong_second_context_is_refused_and_a_right_one_accepted() {
    let mut host = Host::new(Api::Core(3, 3), Window::None, GlMode::Shared);
    host.contexts.refusal.store(7, Ordering::Relaxed);
    let refused = refusal(&host.desc());
    assert_eq!(refused.status, Status::WrongOrder, "{refused}");
    assert!(
        refused.to_string().contains("asked for WK_OPENGL_CONTEXT_WELKIN") && refused.to_string().contains("got 7")
    );
    assert_eq!(refused.field(), Some("make_current"));
    host.contexts.refusal.store(0, Ordering::Relaxed);
    let stranger = host.contexts.host.separate();
    let right = host.contexts.welkin.replace(stranger);
    let stranger = refusal(&host.desc());
    assert!(stranger.to_string().contains("shares objects"), "{stranger}");
    assert_eq!((stranger.status, stranger.field()), (Status::WrongOrder, Some("make_current")));
    host.contexts.welkin = None;
    unsafe extern "C" fn stays(_: *mut c_void, _: u32) -> i32 {
        0
    }
    let same = refusal(&GlHostDesc { make_current: Some(stays), ..host.desc() });
    assert!(same.to_string().contains("left the host's current"), "{same}");
    assert_eq!((same.status, same.field()), (Status::WrongOrder, Some("make_current")));
    host.contexts.welkin = right;
    assert!(host.contexts.host.is_current());
    let adopted = host.adopt();
    let other = host.contexts.host.sharing();
    let right = host.contexts.welkin.replace(other);
    let later = adopted.host.enter().err().expect("another context than the device was made in");
    assert_eq!((later.status, later.field()), (Status::WrongOrder, Some("make_current")));
    assert!(later.to_string().contains("when the device was created"), "{later}");
    host.contexts.welkin = right;
    close(adopted);
}

#[test]
fn modes_in_which_nothing_is_drawn_are_refused() {
    let host = Host::new(Api::Compatibility(3, 3), Window::None, GlMode::HostContext);
    // SAFETY: the host's context is current; each is the named function's type.
    unsafe {
        let new_list: unsafe extern "system" fn(u32, u32) = egl::function("glNewList");
        let end_list: unsafe extern "system" fn() = egl::function("glEndList");
        new_list(1, 0x1300);
        let error = refusal(&host.desc());
        assert!(error.status == Status::WrongOrder && error.to_string().contains("glEndList"), "{error}");
        end_list();
        let adopted = host.adopt();
        let render_mode: unsafe extern "system" fn(u32) -> i32 = egl::function("glRenderMode");
        let feedback: unsafe extern "system" fn(i32, u32, *mut f32) = egl::function("glFeedbackBuffer");
        let mut room = [0.0; 16];
        feedback(16, 0x0600, room.as_mut_ptr());
        render_mode(0x1C01);
        let error = adopted.host.enter().err().unwrap();
        assert!(error.status == Status::WrongOrder && error.to_string().contains("GL_RENDER"), "{error}");
        render_mode(0x1C00);
        close(adopted);
    }
}

fn draws(host: &Host, adopted: &GlDevice) {
    let gl = &host.gl;
    let color = image_of(texture(gl, glow::RGBA8));
    let fbo = framebuffer(gl, color, None);
    {
        let _current = adopted.host.enter().unwrap_or_else(|e| panic!("{e}"));
        let target = adopted.host.target(&adopted.device.device, &desc(color, None)).unwrap();
        Picture::new(&adopted.device.device, &target, Depth::None).draw(adopted, &target);
    }
    // SAFETY: the host's context is current.
    unsafe { gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
    assert_picture(&read(gl), Blue::Plain, 1);
}

#[test]
fn one_context_has_one_device() {
    for mode in [GlMode::HostContext, GlMode::Shared] {
        let host = Host::new(Api::Core(4, 5), Window::None, mode);
        let adopted = host.adopt();
        let again = refusal(&host.desc());
        assert_eq!(again.status, Status::AlreadyWrapped, "{again}");
        draws(&host, &adopted);
        close(adopted);
        let adopted = host.adopt();
        draws(&host, &adopted);
        close(adopted);
    }
}

#[test]
fn two_hosts_on_one_thread() {
    for modes in [[GlMode::HostContext; 2], [GlMode::Shared; 2], [GlMode::Shared, GlMode::HostContext]] {
        let hosts = modes.map(|mode| Host::new(Api::Core(3, 3), Window::None, mode));
        let adopted = [0, 1].map(|i| {
            assert!(hosts[i].contexts.host.make_current());
            hosts[i].adopt()
        });
        for i in [0, 1, 0] {
            assert!(hosts[i].contexts.host.make_current());
            draws(&hosts[i], &adopted[i]);
        }
        // A device in its host's own context must not be entered while another host's context is current, even if the
        // names of objects in both are the same.
        if modes[1] == GlMode::HostContext {
            assert!(hosts[0].contexts.host.make_current());
            let error = adopted[1].host.enter().err().unwrap();
            assert_eq!(error.status, Status::WrongOrder, "{error}");
            assert!(hosts[0].contexts.host.is_current());
        }
        let [first, second] = adopted;
        assert!(hosts[0].contexts.host.make_current());
        close(first);
        assert!(hosts[1].contexts.host.make_current());
        draws(&hosts[1], &second);
        close(second);
    }
}

#[test]
fn any_thread_may_draw_if_the_context_is_current_there() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::Shared);
    let adopted = host.adopt();
    let color = image_of(texture(&host.gl, glow::RGBA8));
    // SAFETY: the host's context is current; its commands are to be seen from another thread.
    unsafe { host.gl.finish() };
    egl::make_none_current();
    let contexts = &host.contexts;
    let adopted = std::thread::scope(|scope| {
        let thread = scope.spawn(|| {
            assert!(contexts.host.make_current());
            {
                let _current = adopted.host.enter().unwrap();
                let target = adopted.host.target(&adopted.device.device, &desc(color, None)).unwrap();
                Picture::new(&adopted.device.device, &target, Depth::None).draw(&adopted, &target);
            }
            egl::make_none_current();
            adopted
        });
        thread.join().unwrap()
    });
    assert!(host.contexts.host.make_current());
    let fbo = framebuffer(&host.gl, color, None);
    // SAFETY: the host's context is current.
    unsafe { host.gl.bind_framebuffer(glow::FRAMEBUFFER, Some(fbo)) };
    assert_picture(&read(&host.gl), Blue::Plain, 1);
    close(adopted);
}

/// Returns the live names of each kind in the current context.
fn census(gl: &glow::Context) -> [Vec<u32>; 5] {
    let alive = |is: &str| {
        // SAFETY: the context is current and the type is that of every `glIs..`.
        let is: unsafe extern "system" fn(u32) -> u8 = unsafe { egl::function(is) };
        // SAFETY: any name may be queried.
        (1..200).filter(|n| unsafe { is(*n) } != 0).collect()
    };
    // SAFETY: the context is current.
    assert_eq!(unsafe { gl.get_error() }, 0);
    ["glIsTexture", "glIsBuffer", "glIsRenderbuffer", "glIsProgram", "glIsSampler"].map(alive)
}

#[test]
fn closing_destroys_all_objects_of_welkin_and_none_of_the_host() {
    for mode in [GlMode::HostContext, GlMode::Shared] {
        let window = Window::Pbuffer(WIDTH as i32, HEIGHT as i32, 0);
        let host = Host::new(Api::Core(4, 5), window, mode);
        let gl = &host.gl;
        let color = image_of(texture(gl, glow::RGBA8));
        let depth = image_of_buffer(renderbuffer(gl, glow::DEPTH24_STENCIL8, 1));
        let before = census(gl);
        let adopted = host.adopt();
        let mut descs = vec![desc(color, Some(depth))];
        if mode == GlMode::HostContext {
            let window = GlImage::Framebuffer { name: 0 };
            descs.push(desc(window, Some(window)));
        }
        for desc in &descs {
            let _current = adopted.host.enter().unwrap();
            let target = adopted.host.target(&adopted.device.device, desc).unwrap();
            Picture::new(&adopted.device.device, &target, Depth::One).draw(&adopted, &target);
        }
        assert_ne!(before, census(gl), "the census sees Welkin's objects");
        close(adopted);
        assert_eq!(before, census(gl));
        let others = ["glIsFramebuffer", "glIsVertexArray"].map(|is| {
            // SAFETY: the context is current and the type is that of every `glIs..`.
            let is: unsafe extern "system" fn(u32) -> u8 = unsafe { egl::function(is) };
            // SAFETY: any name may be queried.
            (1..100).filter(|n| unsafe { is(*n) } != 0).count()
        });
        assert_eq!(others, [0, 0], "framebuffers and vertex arrays");
    }
}

#[test]
fn a_target_is_made_once_and_again_when_the_host_makes_it_anew() {
    let host = Host::new(Api::Core(4, 5), Window::None, GlMode::Shared);
    let gl = &host.gl;
    let name = texture(gl, glow::RGBA8);
    let adopted = host.adopt();
    let id = |desc: &GlTargetDesc| {
        let _current = adopted.host.enter().unwrap();
        adopted.host.target(&adopted.device.device, desc).unwrap().id
    };
    let first = desc(image_of(name), None);
    let once = id(&first);
    assert_eq!(once, id(&first));
    let later = GlTargetDesc { generation: 1, ..first };
    let again = id(&later);
    assert_ne!(once, again, "another generation");
    // SAFETY: the host's context is current; the same name gets another size and format, which is no new generation.
    unsafe {
        gl.bind_texture(glow::TEXTURE_2D, Some(name));
        let none = glow::PixelUnpackData::Slice(None);
        gl.tex_image_2d(glow::TEXTURE_2D, 0, glow::RGBA16F as i32, 32, 16, 0, glow::RGBA, glow::HALF_FLOAT, none);
    }
    let resized = GlTargetDesc { width: 32, height: 16, ..later };
    assert_ne!(again, id(&resized), "another size");
    {
        let _current = adopted.host.enter().unwrap();
        let target = adopted.host.target(&adopted.device.device, &resized).unwrap();
        assert_eq!(target.color.format(), wgpu::TextureFormat::Rgba16Float);
        let error = adopted.host.target(&adopted.device.device, &later).unwrap_err();
        assert!(error.to_string().contains("32 x 16"), "{error}");
    }
    // Many targets: the size of the cache is limited, and the first target can be used again.
    for _ in 0..40 {
        let name = texture(gl, glow::RGBA8);
        id(&desc(image_of(name), None));
        // SAFETY: the host's context is current and deletes its own.
        unsafe { gl.delete_texture(name) };
    }
    id(&resized);
    close(adopted);
}

#[test]
fn outside_there_are_no_targets() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::Shared);
    let adopted = host.adopt();
    let color = image_of(texture(&host.gl, glow::RGBA8));
    let error = adopted.host.target(&adopted.device.device, &desc(color, None)).unwrap_err();
    assert_eq!(error.status, Status::WrongOrder, "{error}");
    let switches = host.contexts.switches.load(Ordering::Relaxed);
    {
        let _outer = adopted.host.enter().unwrap();
        let _inner = adopted.host.enter().unwrap();
        assert!(!host.contexts.host.is_current());
    }
    assert_eq!(host.contexts.switches.load(Ordering::Relaxed) - switches, 2, "entering again costs nothing");
    close(adopted);
}

#[test]
fn a_host_that_destroys_its_context_first_is_survived() {
    for mode in [GlMode::HostContext, GlMode::Shared] {
        let host = Host::new(Api::Core(3, 3), Window::None, mode);
        let adopted = host.adopt();
        draws(&host, &adopted);
        egl::make_none_current();
        host.contexts.refusal.store(1, Ordering::Relaxed);
        if mode == GlMode::HostContext {
            let error = adopted.host.enter().err().unwrap();
            assert_eq!(error.status, Status::WrongOrder, "{error}");
        }
        let Host { contexts, .. } = host;
        if mode == GlMode::HostContext {
            drop(contexts);
            close(adopted);
        } else {
            // The callback and its argument must outlive the device; the contexts behind it need not.
            close(adopted);
            drop(contexts);
        }
        // A context made afterwards works as usual.
        let host = Host::new(Api::Core(3, 3), Window::None, mode);
        let adopted = host.adopt();
        draws(&host, &adopted);
        close(adopted);
    }
}

#[test]
fn an_error_the_host_has_not_read_stays() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::HostContext);
    let gl = &host.gl;
    let adopted = host.adopt();
    // SAFETY: the host's context is current; the calls are wrong on purpose.
    unsafe {
        for (wrong, error) in [
            (Box::new(|| gl.enable(0xFFFF)) as Box<dyn Fn()>, glow::INVALID_ENUM),
            (Box::new(|| gl.viewport(0, 0, -1, 0)), glow::INVALID_VALUE),
            (Box::new(|| gl.bind_sampler(100_000, None)), glow::INVALID_VALUE),
            (Box::new(|| gl.end_query(glow::SAMPLES_PASSED)), glow::INVALID_OPERATION),
        ] {
            wrong();
            drop(adopted.host.enter().unwrap());
            assert_eq!(gl.get_error(), error);
            assert_eq!(gl.get_error(), 0);
        }
    }
    close(adopted);
}

#[test]
fn a_current_program_marked_for_deletion_is_refused() {
    let host = Host::new(Api::Core(3, 3), Window::None, GlMode::HostContext);
    let gl = &host.gl;
    let adopted = host.adopt();
    // SAFETY: the host's context is current.
    unsafe {
        let program = gl.create_program().unwrap();
        for (kind, text) in [
            (glow::VERTEX_SHADER, "#version 330\nvoid main() { gl_Position = vec4(0.0); }"),
            (glow::FRAGMENT_SHADER, "#version 330\nout vec4 c; void main() { c = vec4(1.0); }"),
        ] {
            let shader = gl.create_shader(kind).unwrap();
            gl.shader_source(shader, text);
            gl.compile_shader(shader);
            gl.attach_shader(program, shader);
        }
        gl.link_program(program);
        gl.use_program(Some(program));
        gl.delete_program(program);
        let error = adopted.host.enter().err().unwrap();
        assert!(error.status == Status::WrongOrder && error.to_string().contains("marked for deletion"), "{error}");
        assert!(gl.is_program(program));
        gl.use_program(None);
    }
    close(adopted);
}
