//! OpenGL functions that this room calls itself, loaded through the host's `get_proc`.
//!
//! wgpu's own backend has its own table. This one exists because saving and restoring a host's state needs functions
//! that wgpu's table lacks: those of the compatibility profile, and getters per viewport and per buffer.

use std::ffi::{CStr, c_char, c_void};

use super::names::*;
use crate::error::{Error, Status};

/// A `GLsync`.
pub(crate) type Sync = *const c_void;

macro_rules! gl_functions {
    (
        plain { $($field:ident = $name:literal ($($arg:ident: $ty:ty),*) $(-> $ret:ty)?;)* }
        pointers { $($pfield:ident = $pname:literal ($($parg:ident: $pty:ty),*) $(-> $pret:ty)?;)* }
    ) => {
        /// Function pointers of one context. A call of a missing function does nothing and returns zero.
        #[allow(non_snake_case)]
        pub(crate) struct Api {
            $(pub(super) $field: Option<unsafe extern "system" fn($($ty),*) $(-> $ret)?>,)*
            $(pub(super) $pfield: Option<unsafe extern "system" fn($($pty),*) $(-> $pret)?>,)*
        }

        impl Api {
            /// Loads every function of the table.
            ///
            /// # Safety
            /// `get` returns NULL or the address of the named OpenGL function.
            pub(crate) unsafe fn load(get: &dyn Fn(&CStr) -> *const c_void) -> Self {
                // SAFETY: a data pointer and `Option<fn>` have the same size on every platform with OpenGL, NULL is
                // `None`, and the caller vouches that the address is the named function's.
                unsafe {
                    Self {
                        $($field: std::mem::transmute::<*const c_void, Option<unsafe extern "system" fn($($ty),*) $(-> $ret)?>>(get($name)),)*
                        $($pfield: std::mem::transmute::<*const c_void, Option<unsafe extern "system" fn($($pty),*) $(-> $pret)?>>(get($pname)),)*
                    }
                }
            }

            $(
                #[allow(non_snake_case, clippy::too_many_arguments, clippy::unused_unit)]
                pub(crate) fn $field(&self $(, $arg: $ty)*) $(-> $ret)? {
                    match self.$field {
                        // SAFETY: loaded under this name with this signature. OpenGL answers a wrong value with an
                        // error flag and touches no memory of Welkin's here.
                        Some(f) => unsafe { f($($arg),*) },
                        None => gl_functions!(@zero $($ret)?),
                    }
                }
            )*
            $(
                /// # Safety
                /// The pointers must have room for as many values as OpenGL reads or writes for these arguments.
                #[allow(non_snake_case, clippy::too_many_arguments, clippy::unused_unit)]
                pub(crate) unsafe fn $pfield(&self $(, $parg: $pty)*) $(-> $pret)? {
                    match self.$pfield {
                        // SAFETY: loaded under this name with this signature; the caller vouches for the pointers.
                        Some(f) => unsafe { f($($parg),*) },
                        None => gl_functions!(@zero $($pret)?),
                    }
                }
            )*
        }
    };
    (@zero) => { () };
    (@zero $t:ty) => { <$t as Zero>::ZERO };
}

/// Return value of a missing function.
trait Zero {
    const ZERO: Self;
}
impl Zero for u8 {
    const ZERO: Self = 0;
}
impl Zero for u32 {
    const ZERO: Self = 0;
}
impl Zero for *const u8 {
    const ZERO: Self = std::ptr::null();
}
impl Zero for Sync {
    const ZERO: Self = std::ptr::null();
}

gl_functions! {
    plain {
        GetError = c"glGetError" () -> u32;
        GetString = c"glGetString" (name: u32) -> *const u8;
        GetStringi = c"glGetStringi" (name: u32, index: u32) -> *const u8;
        IsEnabled = c"glIsEnabled" (cap: u32) -> u8;
        IsEnabledi = c"glIsEnabledi" (cap: u32, index: u32) -> u8;
        Enable = c"glEnable" (cap: u32);
        Disable = c"glDisable" (cap: u32);
        Enablei = c"glEnablei" (cap: u32, index: u32);
        Disablei = c"glDisablei" (cap: u32, index: u32);
        Viewport = c"glViewport" (x: i32, y: i32, w: i32, h: i32);
        ViewportIndexedf = c"glViewportIndexedf" (i: u32, x: f32, y: f32, w: f32, h: f32);
        Scissor = c"glScissor" (x: i32, y: i32, w: i32, h: i32);
        ScissorIndexed = c"glScissorIndexed" (i: u32, x: i32, y: i32, w: i32, h: i32);
        DepthRange = c"glDepthRange" (near: f64, far: f64);
        DepthRangef = c"glDepthRangef" (near: f32, far: f32);
        DepthRangeIndexed = c"glDepthRangeIndexed" (i: u32, near: f64, far: f64);
        ColorMask = c"glColorMask" (r: u8, g: u8, b: u8, a: u8);
        ColorMaski = c"glColorMaski" (i: u32, r: u8, g: u8, b: u8, a: u8);
        BlendColor = c"glBlendColor" (r: f32, g: f32, b: f32, a: f32);
        BlendFuncSeparate = c"glBlendFuncSeparate" (sc: u32, dc: u32, sa: u32, da: u32);
        BlendFuncSeparatei = c"glBlendFuncSeparatei" (i: u32, sc: u32, dc: u32, sa: u32, da: u32);
        BlendEquationSeparate = c"glBlendEquationSeparate" (c: u32, a: u32);
        BlendEquationSeparatei = c"glBlendEquationSeparatei" (i: u32, c: u32, a: u32);
        DepthFunc = c"glDepthFunc" (func: u32);
        DepthMask = c"glDepthMask" (on: u8);
        ClearDepth = c"glClearDepth" (depth: f64);
        ClearDepthf = c"glClearDepthf" (depth: f32);
        ClearStencil = c"glClearStencil" (value: i32);
        StencilFuncSeparate = c"glStencilFuncSeparate" (face: u32, func: u32, reference: i32, mask: u32);
        StencilMaskSeparate = c"glStencilMaskSeparate" (face: u32, mask: u32);
        StencilOpSeparate = c"glStencilOpSeparate" (face: u32, fail: u32, zfail: u32, pass: u32);
        CullFace = c"glCullFace" (face: u32);
        FrontFace = c"glFrontFace" (mode: u32);
        PolygonMode = c"glPolygonMode" (face: u32, mode: u32);
        PolygonOffset = c"glPolygonOffset" (factor: f32, units: f32);
        PolygonOffsetClamp = c"glPolygonOffsetClamp" (factor: f32, units: f32, clamp: f32);
        ProvokingVertex = c"glProvokingVertex" (mode: u32);
        ClipControl = c"glClipControl" (origin: u32, depth: u32);
        ClampColor = c"glClampColor" (target: u32, clamp: u32);
        PixelStorei = c"glPixelStorei" (name: u32, value: i32);
        PixelTransferf = c"glPixelTransferf" (name: u32, value: f32);
        UseProgram = c"glUseProgram" (program: u32);
        BindVertexArray = c"glBindVertexArray" (array: u32);
        IsVertexArray = c"glIsVertexArray" (array: u32) -> u8;
        BindBuffer = c"glBindBuffer" (target: u32, buffer: u32);
        BindBufferBase = c"glBindBufferBase" (target: u32, index: u32, buffer: u32);
        BindBufferRange = c"glBindBufferRange" (target: u32, index: u32, buffer: u32, offset: isize, size: isize);
        ActiveTexture = c"glActiveTexture" (unit: u32);
        BindTexture = c"glBindTexture" (target: u32, texture: u32);
        IsTexture = c"glIsTexture" (texture: u32) -> u8;
        BindSampler = c"glBindSampler" (unit: u32, sampler: u32);
        BindImageTexture = c"glBindImageTexture"
            (unit: u32, texture: u32, level: i32, layered: u8, layer: i32, access: u32, format: u32);
        TexParameteri = c"glTexParameteri" (target: u32, name: u32, value: i32);
        TexImage2DMultisample = c"glTexImage2DMultisample" (target: u32, samples: i32, format: u32, w: i32, h: i32, fixed: u8);
        BindFramebuffer = c"glBindFramebuffer" (target: u32, framebuffer: u32);
        FramebufferTexture2D = c"glFramebufferTexture2D" (target: u32, attachment: u32, textarget: u32, texture: u32, level: i32);
        FramebufferRenderbuffer = c"glFramebufferRenderbuffer" (target: u32, attachment: u32, rbtarget: u32, renderbuffer: u32);
        CheckFramebufferStatus = c"glCheckFramebufferStatus" (target: u32) -> u32;
        BlitFramebuffer = c"glBlitFramebuffer"
            (sx0: i32, sy0: i32, sx1: i32, sy1: i32, dx0: i32, dy0: i32, dx1: i32, dy1: i32, mask: u32, filter: u32);
        ReadBuffer = c"glReadBuffer" (source: u32);
        BindRenderbuffer = c"glBindRenderbuffer" (target: u32, renderbuffer: u32);
        IsRenderbuffer = c"glIsRenderbuffer" (renderbuffer: u32) -> u8;
        FenceSync = c"glFenceSync" (condition: u32, flags: u32) -> Sync;
        WaitSync = c"glWaitSync" (sync: Sync, flags: u32, timeout_ns: u64);
        ClientWaitSync = c"glClientWaitSync" (sync: Sync, flags: u32, timeout_ns: u64) -> u32;
        DeleteSync = c"glDeleteSync" (sync: Sync);
        Flush = c"glFlush" ();
        CreateShader = c"glCreateShader" (kind: u32) -> u32;
        CompileShader = c"glCompileShader" (shader: u32);
        DeleteShader = c"glDeleteShader" (shader: u32);
        CreateProgram = c"glCreateProgram" () -> u32;
        AttachShader = c"glAttachShader" (program: u32, shader: u32);
        LinkProgram = c"glLinkProgram" (program: u32);
        DeleteProgram = c"glDeleteProgram" (program: u32);
        DrawArrays = c"glDrawArrays" (mode: u32, first: i32, count: i32);
        BeginQuery = c"glBeginQuery" (target: u32, query: u32);
        EndQuery = c"glEndQuery" (target: u32);
        BeginConditionalRender = c"glBeginConditionalRender" (query: u32, mode: u32);
        EndConditionalRender = c"glEndConditionalRender" ();
        PauseTransformFeedback = c"glPauseTransformFeedback" ();
        ResumeTransformFeedback = c"glResumeTransformFeedback" ();
    }
    pointers {
        GetIntegerv = c"glGetIntegerv" (name: u32, out: *mut i32);
        GetFloatv = c"glGetFloatv" (name: u32, out: *mut f32);
        GetDoublev = c"glGetDoublev" (name: u32, out: *mut f64);
        GetBooleanv = c"glGetBooleanv" (name: u32, out: *mut u8);
        GetIntegeri_v = c"glGetIntegeri_v" (name: u32, index: u32, out: *mut i32);
        GetInteger64i_v = c"glGetInteger64i_v" (name: u32, index: u32, out: *mut i64);
        GetBooleani_v = c"glGetBooleani_v" (name: u32, index: u32, out: *mut u8);
        GetFloati_v = c"glGetFloati_v" (name: u32, index: u32, out: *mut f32);
        GetDoublei_v = c"glGetDoublei_v" (name: u32, index: u32, out: *mut f64);
        GetProgramiv = c"glGetProgramiv" (program: u32, name: u32, out: *mut i32);
        GenVertexArrays = c"glGenVertexArrays" (n: i32, out: *mut u32);
        DeleteVertexArrays = c"glDeleteVertexArrays" (n: i32, names: *const u32);
        VertexAttribPointer = c"glVertexAttribPointer"
            (index: u32, size: i32, ty: u32, normalized: u8, stride: i32, pointer: *const c_void);
        GetVertexAttribPointerv = c"glGetVertexAttribPointerv" (index: u32, name: u32, out: *mut *const c_void);
        GenBuffers = c"glGenBuffers" (n: i32, out: *mut u32);
        DeleteBuffers = c"glDeleteBuffers" (n: i32, names: *const u32);
        BufferData = c"glBufferData" (target: u32, size: isize, data: *const c_void, usage: u32);
        GenTextures = c"glGenTextures" (n: i32, out: *mut u32);
        DeleteTextures = c"glDeleteTextures" (n: i32, names: *const u32);
        TexImage2D = c"glTexImage2D"
            (target: u32, level: i32, internal: i32, w: i32, h: i32, border: i32, format: u32, ty: u32, data: *const c_void);
        GetTexParameteriv = c"glGetTexParameteriv" (target: u32, name: u32, out: *mut i32);
        GetTexLevelParameteriv = c"glGetTexLevelParameteriv" (target: u32, level: i32, name: u32, out: *mut i32);
        GenFramebuffers = c"glGenFramebuffers" (n: i32, out: *mut u32);
        DeleteFramebuffers = c"glDeleteFramebuffers" (n: i32, names: *const u32);
        DrawBuffers = c"glDrawBuffers" (n: i32, bufs: *const u32);
        GetFramebufferAttachmentParameteriv = c"glGetFramebufferAttachmentParameteriv"
            (target: u32, attachment: u32, name: u32, out: *mut i32);
        GetRenderbufferParameteriv = c"glGetRenderbufferParameteriv" (target: u32, name: u32, out: *mut i32);
        ShaderSource = c"glShaderSource" (shader: u32, n: i32, texts: *const *const c_char, lengths: *const i32);
        GenQueries = c"glGenQueries" (n: i32, out: *mut u32);
        DeleteQueries = c"glDeleteQueries" (n: i32, names: *const u32);
        GetQueryiv = c"glGetQueryiv" (target: u32, name: u32, out: *mut i32);
        GetQueryObjectuiv = c"glGetQueryObjectuiv" (query: u32, name: u32, out: *mut u32);
        ReadPixels = c"glReadPixels" (x: i32, y: i32, w: i32, h: i32, format: u32, ty: u32, out: *mut c_void);
    }
}

impl Api {
    /// Loads under their suffixed names the functions that [`Api::load`] did not find and that OpenGL ES has with a
    /// suffix.
    ///
    /// # Safety
    /// The requirements of [`Api::load`].
    pub(crate) unsafe fn load_suffixed(&mut self, get: &dyn Fn(&CStr) -> *const c_void) {
        // SAFETY: as in `load`; the extensions kept the signatures.
        unsafe {
            if self.ClipControl.is_none() {
                type F = Option<unsafe extern "system" fn(u32, u32)>;
                self.ClipControl = std::mem::transmute::<*const c_void, F>(get(c"glClipControlEXT"));
            }
            if self.PolygonOffsetClamp.is_none() {
                type F = Option<unsafe extern "system" fn(f32, f32, f32)>;
                self.PolygonOffsetClamp = std::mem::transmute::<*const c_void, F>(get(c"glPolygonOffsetClampEXT"));
            }
        }
    }

    /// Returns `N` integers of state `name`, which has at most `N`.
    pub(crate) fn ints<const N: usize>(&self, name: u32) -> [i32; N] {
        let mut out = [0; N];
        // SAFETY: every caller passes a name with at most N values.
        unsafe { self.GetIntegerv(name, out.as_mut_ptr()) };
        out
    }

    /// Returns one integer of state `name`.
    pub(crate) fn int(&self, name: u32) -> i32 {
        self.ints::<4>(name)[0] // four, because some drivers write more for the polygon mode
    }

    /// Returns one object name or enumerant of state `name`.
    pub(crate) fn uint(&self, name: u32) -> u32 {
        self.int(name) as u32
    }

    /// Returns `N` floats of state `name`.
    pub(crate) fn floats<const N: usize>(&self, name: u32) -> [f32; N] {
        let mut out = [0.0; N];
        // SAFETY: every caller passes a name with at most N values.
        unsafe { self.GetFloatv(name, out.as_mut_ptr()) };
        out
    }

    /// Returns `N` doubles of state `name`. They are read as floats on OpenGL ES, which has no doubles even if its
    /// library exports the function.
    pub(crate) fn doubles<const N: usize>(&self, name: u32, desktop: bool) -> [f64; N] {
        let mut out = [0.0; N];
        if !desktop {
            return self.floats::<N>(name).map(f64::from);
        }
        // SAFETY: every caller passes a name with at most N values.
        unsafe { self.GetDoublev(name, out.as_mut_ptr()) };
        out
    }

    /// Returns one integer of indexed state `name`.
    pub(crate) fn int_at(&self, name: u32, index: u32) -> i32 {
        let mut out = [0; 4];
        // SAFETY: no indexed state that this room reads has more than four values.
        unsafe { self.GetIntegeri_v(name, index, out.as_mut_ptr()) };
        out[0]
    }

    /// Creates one object with `glGen..`.
    pub(crate) fn one(&self, generate: unsafe fn(&Self, i32, *mut u32)) -> u32 {
        let mut name = 0;
        // SAFETY: one name is requested and there is room for one.
        unsafe { generate(self, 1, &mut name) };
        name
    }

    /// Deletes one object with `glDelete..`; zero is ignored.
    pub(crate) fn delete(&self, delete: unsafe fn(&Self, i32, *const u32), name: u32) {
        if name != 0 {
            // SAFETY: the count is 1, and the pointer is to one name.
            unsafe { delete(self, 1, &name) };
        }
    }

    /// Returns the string of `glGetString` as text; `None` if no context is current.
    pub(crate) fn text(&self, name: u32) -> Option<String> {
        let text = self.GetString(name);
        if text.is_null() {
            return None;
        }
        // SAFETY: a non-null result of glGetString is a NUL-terminated string that lives as long as the context.
        Some(unsafe { CStr::from_ptr(text.cast()) }.to_string_lossy().into_owned())
    }

    /// Returns the names of the context's extensions.
    pub(crate) fn extensions(&self) -> Vec<String> {
        let count = self.int(NUM_EXTENSIONS).max(0) as u32;
        let name = |i| {
            let text = self.GetStringi(EXTENSIONS, i);
            if text.is_null() {
                return None;
            }
            // SAFETY: as in `text`.
            Some(unsafe { CStr::from_ptr(text.cast()) }.to_string_lossy().into_owned())
        };
        (0..count).filter_map(name).collect()
    }

    /// Reads and clears the error flags; returns the first one, or `NO_ERROR`. The number of reads is bounded, because
    /// without a context some drivers return an error every time.
    pub(crate) fn take_error(&self) -> u32 {
        let first = self.GetError();
        if first != NO_ERROR {
            for _ in 0..8 {
                if self.GetError() == NO_ERROR {
                    break;
                }
            }
        }
        first
    }

    /// Turns one switch on or off.
    pub(super) fn set_enabled(&self, cap: u32, is_on: bool) {
        if is_on { self.Enable(cap) } else { self.Disable(cap) }
    }
}

/// Converts an error flag that Welkin's own calls raised into an error; `None` for `NO_ERROR`.
pub(crate) fn raised_in_welkin(error: u32) -> Option<Error> {
    let status = if error == OUT_OF_MEMORY { Status::OutOfMemory } else { Status::Internal };
    (error != NO_ERROR).then(|| Error::new(status, format!("OpenGL answered {} to Welkin's calls", spell(error))))
}
