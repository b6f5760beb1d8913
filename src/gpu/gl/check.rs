//! Checks of the host's context before wgpu uses it. Where the context or a function is missing, wgpu and its loader
//! would panic; these checks return an error.

use std::{
    collections::HashSet,
    ffi::{CStr, c_void},
};

use super::{api::Api, names::*};
use crate::error::{Error, Result, Status};

/// Kind of OpenGL that a context provides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GlProfile {
    /// Desktop OpenGL, core profile.
    Core,
    /// Desktop OpenGL, compatibility profile.
    Compatibility,
    /// OpenGL ES.
    Es,
}

/// Properties that a context reported about itself.
#[derive(Clone, Debug)]
pub struct GlInfo {
    /// Core, compatibility or ES.
    pub profile: GlProfile,
    /// Major and minor version.
    pub version: (u32, u32),
    /// `GL_VERSION` as the driver spells it.
    pub version_text: String,
    /// `GL_VENDOR`.
    pub vendor: String,
    /// `GL_RENDERER`.
    pub renderer: String,
    pub(super) extensions: HashSet<String>,
}

impl GlInfo {
    /// Queries the current context.
    ///
    /// # Errors
    /// [`Status::WrongOrder`] if no context is current; [`Status::NoAdapter`] if its version cannot be read;
    /// [`Status::Unsupported`] if it is older than OpenGL 3.3 or OpenGL ES 3.0.
    pub(super) fn query(api: &Api) -> Result<Self> {
        let Some(version_text) = api.text(VERSION) else {
            return Err(Error::new(
                Status::WrongOrder,
                "no OpenGL context is current on this thread: make the context current before this call",
            ));
        };
        let Some((es, version)) = parse_version(&version_text) else {
            return Err(Error::new(
                Status::NoAdapter,
                format!("GL_VERSION must begin with a version number, got {version_text:?}"),
            ));
        };
        if version < (if es { (3, 0) } else { (3, 3) }) {
            let name = if es { "OpenGL ES" } else { "OpenGL" };
            return Err(Error::unsupported(format!(
                "the context must be OpenGL 3.3 or later or OpenGL ES 3.0 or later, got {name} {}.{}",
                version.0, version.1
            )));
        }
        let compatible = !es && api.uint(CONTEXT_PROFILE_MASK) & CONTEXT_COMPATIBILITY_PROFILE_BIT != 0;
        let profile = match (es, compatible) {
            (true, _) => GlProfile::Es,
            (false, true) => GlProfile::Compatibility,
            (false, false) => GlProfile::Core,
        };
        let vendor = api.text(VENDOR).unwrap_or_default();
        let renderer = api.text(RENDERER).unwrap_or_default();
        let extensions = api.extensions().into_iter().collect();
        Ok(Self { profile, version, version_text, vendor, renderer, extensions })
    }

    /// Whether the version is at least `desktop` or `es`, depending on the kind of context.
    pub(super) fn at_least(&self, desktop: (u32, u32), es: (u32, u32)) -> bool {
        self.version >= if self.profile == GlProfile::Es { es } else { desktop }
    }

    /// Whether this is OpenGL ES.
    pub fn is_es(&self) -> bool {
        self.profile == GlProfile::Es
    }

    /// Whether the context itself has compute shaders, even if tier 0 is forced.
    pub fn has_compute(&self) -> bool {
        self.at_least((4, 3), (3, 1)) || self.has("GL_ARB_compute_shader")
    }

    /// Whether the context has a feature that came with version `desktop` or `es`, or earlier with one of `extensions`.
    /// Version 0.0 means that no version has the feature, only extensions.
    pub(super) fn knows(&self, desktop: (u32, u32), es: (u32, u32), extensions: &[&str]) -> bool {
        let since = if self.is_es() { es } else { desktop };
        since != (0, 0) && self.version >= since || extensions.iter().any(|e| self.has(e))
    }

    pub(super) fn has(&self, extension: &str) -> bool {
        self.extensions.contains(extension)
    }
}

/// Parses `GL_VERSION`, such as `4.5 (Core Profile) vendor` or `OpenGL ES 3.2 vendor`; returns (is ES, (major, minor)).
fn parse_version(text: &str) -> Option<(bool, (u32, u32))> {
    let (es, rest) = match text.strip_prefix("OpenGL ES ") {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let mut parts = rest.split(|c: char| !c.is_ascii_digit());
    let major = parts.next()?.parse().ok()?;
    let minor = parts.next()?.parse().ok()?;
    Some((es, (major, minor)))
}

/// Functions that wgpu calls without checking that they were found. wgpu panics when one is missing.
const NEEDED: &[&CStr] = &[
    c"glGetString",
    c"glGetStringi",
    c"glGetIntegerv",
    c"glGetError",
    c"glEnable",
    c"glDisable",
    c"glClear",
    c"glViewport",
    c"glScissor",
    c"glColorMask",
    c"glDepthFunc",
    c"glDepthMask",
    c"glDepthRangef", // OpenGL 4.1, and in practice every driver of 3.3
    c"glClearDepthf",
    c"glStencilFuncSeparate",
    c"glStencilOpSeparate",
    c"glStencilMaskSeparate",
    c"glCullFace",
    c"glFrontFace",
    c"glPolygonOffset",
    c"glBlendColor",
    c"glBlendFuncSeparate",
    c"glBlendEquationSeparate",
    c"glPixelStorei",
    c"glReadPixels",
    c"glReadBuffer",
    c"glFlush",
    c"glFinish",
    c"glGenTextures",
    c"glDeleteTextures",
    c"glBindTexture",
    c"glActiveTexture",
    c"glTexImage2D",
    c"glTexSubImage2D",
    c"glTexImage3D",
    c"glTexParameteri",
    c"glCopyTexSubImage2D",
    c"glGenBuffers",
    c"glDeleteBuffers",
    c"glBindBuffer",
    c"glBindBufferRange",
    c"glBufferData",
    c"glBufferSubData",
    c"glCopyBufferSubData",
    c"glMapBufferRange",
    c"glUnmapBuffer",
    c"glGenVertexArrays",
    c"glDeleteVertexArrays",
    c"glBindVertexArray",
    c"glEnableVertexAttribArray",
    c"glVertexAttribPointer",
    c"glVertexAttribIPointer",
    c"glVertexAttribDivisor",
    c"glCreateShader",
    c"glShaderSource",
    c"glCompileShader",
    c"glGetShaderiv",
    c"glGetShaderInfoLog",
    c"glDeleteShader",
    c"glCreateProgram",
    c"glAttachShader",
    c"glLinkProgram",
    c"glGetProgramiv",
    c"glGetProgramInfoLog",
    c"glUseProgram",
    c"glDeleteProgram",
    c"glGetUniformLocation",
    c"glUniform1i",
    c"glUniform1ui",
    c"glGetUniformBlockIndex",
    c"glUniformBlockBinding",
    c"glGenSamplers",
    c"glDeleteSamplers",
    c"glBindSampler",
    c"glSamplerParameteri",
    c"glSamplerParameterf",
    c"glGenFramebuffers",
    c"glDeleteFramebuffers",
    c"glBindFramebuffer",
    c"glFramebufferTexture2D",
    c"glFramebufferTextureLayer",
    c"glFramebufferRenderbuffer",
    c"glCheckFramebufferStatus",
    c"glBlitFramebuffer",
    c"glGenRenderbuffers",
    c"glDeleteRenderbuffers",
    c"glBindRenderbuffer",
    c"glRenderbufferStorage",
    c"glDrawBuffers",
    c"glClearBufferfv",
    c"glDrawArraysInstanced",
    c"glDrawElementsInstanced",
    c"glFenceSync",
    c"glClientWaitSync",
    c"glWaitSync",
    c"glDeleteSync",
    c"glGetSynciv",
];

/// Checks that the host's loader `get` finds all functions of [`NEEDED`].
///
/// # Errors
/// [`Status::InvalidArgument`] with the first missing name.
pub(super) fn loader_finds_all(get: &dyn Fn(&CStr) -> *const c_void) -> Result<()> {
    match NEEDED.iter().find(|name| get(name).is_null()) {
        None => Ok(()),
        Some(name) => {
            let rest = format!(
                "must find every function of OpenGL 3.3 or OpenGL ES 3.0, got NULL for {}: the functions of OpenGL 1.1 \
                 are often exported by the library itself and not by its address function",
                name.to_string_lossy()
            );
            Err(Error::invalid("get_proc", rest))
        }
    }
}

/// Checks that the context can draw now: no display list is being compiled, the render mode is GL_RENDER, and the
/// current program could be restored.
///
/// # Errors
/// [`Status::WrongOrder`], which names the mode or the program that prevents drawing.
pub(super) fn can_draw_now(api: &Api, info: &GlInfo) -> Result<()> {
    let refuse = |text: String| Err(Error::new(Status::WrongOrder, text));
    if info.profile == GlProfile::Compatibility {
        if api.uint(LIST_INDEX) != 0 {
            return refuse("a display list is being compiled: call glEndList before this call".into());
        }
        if api.uint(RENDER_MODE) != RENDER {
            return refuse("glRenderMode must be GL_RENDER for this call, not selection or feedback".into());
        }
    }
    let program = api.uint(CURRENT_PROGRAM);
    if program != 0 {
        let mut deleted = 0;
        // SAFETY: DELETE_STATUS writes one integer.
        unsafe { api.GetProgramiv(program, DELETE_STATUS, &mut deleted) };
        if deleted != 0 {
            // Using another program would destroy this one, which could then not be made current again.
            return refuse(format!(
                "the current program {program} is marked for deletion and could not be restored: make another \
                 program (or 0) current before this call"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_as_drivers_spell_them() {
        assert_eq!(parse_version("4.5 (Core Profile) Mesa 22.3.6"), Some((false, (4, 5))));
        assert_eq!(parse_version("3.3.0 NVIDIA 535.54"), Some((false, (3, 3))));
        assert_eq!(parse_version("4.10.13 Compatibility"), Some((false, (4, 10))));
        assert_eq!(parse_version("OpenGL ES 3.2 Mesa 22.3.6"), Some((true, (3, 2))));
        assert_eq!(parse_version("OpenGL ES 3.1"), Some((true, (3, 1))));
        for bad in ["", "four", "OpenGL ES-CM 1.1", "4"] {
            assert_eq!(parse_version(bad), None, "{bad}");
        }
    }

    #[test]
    fn a_loader_that_finds_nothing_is_named() {
        let error = loader_finds_all(&|_| std::ptr::null()).unwrap_err();
        assert_eq!(error.status, Status::InvalidArgument);
        assert!(error.to_string().contains("glGetString"), "{}", error);
    }
}
