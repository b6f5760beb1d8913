//! Functions of OpenGL ES 3.2 in contexts of ES 3.0 and 3.1, which have them as extensions under other names.
//!
//! wgpu asks for the ES 3.2 names. In an older context a strict driver returns functions for these names that raise an
//! error (ANGLE: GL_INVALID_OPERATION), although the same functions exist there with a suffix.

use std::ffi::{CStr, CString, c_void};

use super::check::GlInfo;

/// Functions that joined ES 3.2 together, and the extensions that have them in earlier versions.
struct Later {
    /// ES 3.2 names of the functions.
    functions: &'static [&'static str],
    /// Extensions with these functions, each with the suffix of its names.
    extensions: &'static [(&'static str, &'static str)],
}

/// Functions that came from extensions: OpenGL ES 3.2 specification, appendix F ("Changes from GLSL ES 3.1").
const LATER: &[Later] = &[
    Later {
        functions: &[
            "glDebugMessageCallback",
            "glDebugMessageControl",
            "glDebugMessageInsert",
            "glGetDebugMessageLog",
            "glGetObjectLabel",
            "glGetObjectPtrLabel",
            "glGetPointerv",
            "glObjectLabel",
            "glObjectPtrLabel",
            "glPopDebugGroup",
            "glPushDebugGroup",
        ],
        extensions: &[("GL_KHR_debug", "KHR")],
    },
    Later {
        functions: &[
            "glBlendEquationSeparatei",
            "glBlendEquationi",
            "glBlendFuncSeparatei",
            "glBlendFunci",
            "glColorMaski",
            "glDisablei",
            "glEnablei",
            "glIsEnabledi",
        ],
        extensions: &[("GL_EXT_draw_buffers_indexed", "EXT"), ("GL_OES_draw_buffers_indexed", "OES")],
    },
    Later {
        functions: &["glDrawElementsBaseVertex", "glDrawElementsInstancedBaseVertex", "glDrawRangeElementsBaseVertex"],
        extensions: &[("GL_EXT_draw_elements_base_vertex", "EXT"), ("GL_OES_draw_elements_base_vertex", "OES")],
    },
    Later {
        functions: &["glGetGraphicsResetStatus", "glGetnUniformfv", "glGetnUniformiv", "glReadnPixels"],
        extensions: &[("GL_KHR_robustness", "KHR"), ("GL_EXT_robustness", "EXT")],
    },
    Later { functions: &["glGetnUniformuiv"], extensions: &[("GL_KHR_robustness", "KHR")] },
    Later {
        functions: &["glCopyImageSubData"],
        extensions: &[("GL_EXT_copy_image", "EXT"), ("GL_OES_copy_image", "OES")],
    },
    Later {
        functions: &["glFramebufferTexture"],
        extensions: &[("GL_EXT_geometry_shader", "EXT"), ("GL_OES_geometry_shader", "OES")],
    },
    Later {
        functions: &["glPatchParameteri"],
        extensions: &[("GL_EXT_tessellation_shader", "EXT"), ("GL_OES_tessellation_shader", "OES")],
    },
    Later {
        functions: &[
            "glGetSamplerParameterIiv",
            "glGetSamplerParameterIuiv",
            "glGetTexParameterIiv",
            "glGetTexParameterIuiv",
            "glSamplerParameterIiv",
            "glSamplerParameterIuiv",
            "glTexParameterIiv",
            "glTexParameterIuiv",
        ],
        extensions: &[("GL_EXT_texture_border_clamp", "EXT"), ("GL_OES_texture_border_clamp", "OES")],
    },
    Later {
        functions: &["glTexBuffer", "glTexBufferRange"],
        extensions: &[("GL_EXT_texture_buffer", "EXT"), ("GL_OES_texture_buffer", "OES")],
    },
    Later {
        functions: &["glTexStorage3DMultisample"],
        extensions: &[("GL_OES_texture_storage_multisample_2d_array", "OES")],
    },
    Later { functions: &["glMinSampleShading"], extensions: &[("GL_OES_sample_shading", "OES")] },
    Later { functions: &["glBlendBarrier"], extensions: &[("GL_KHR_blend_equation_advanced", "KHR")] },
    Later {
        functions: &["glPrimitiveBoundingBox"],
        extensions: &[("GL_EXT_primitive_bounding_box", "EXT"), ("GL_OES_primitive_bounding_box", "OES")],
    },
];

/// Returns the ES 3.2 names of all functions in [`LATER`].
#[cfg(test)]
fn functions() -> impl Iterator<Item = &'static str> {
    LATER.iter().flat_map(|later| later.functions.iter().copied())
}

/// Returns the name of a function in this context, if it differs from `name`.
pub(super) fn name_here(info: &GlInfo, name: &CStr) -> Option<CString> {
    if !info.is_es() || info.version >= (3, 2) {
        return None;
    }
    let name = name.to_str().ok()?;
    let later = LATER.iter().find(|later| later.functions.contains(&name))?;
    let (_, suffix) = later.extensions.iter().find(|(extension, _)| info.has(extension))?;
    CString::new(format!("{name}{suffix}")).ok()
}

/// Returns a loader that finds functions by their names in this context, or else by the name that it is given.
pub(super) fn finder<'a>(
    info: &'a GlInfo,
    get: &'a dyn Fn(&CStr) -> *const c_void,
) -> impl Fn(&CStr) -> *const c_void + 'a {
    move |name| match name_here(info, name).map(|here| get(&here)) {
        Some(found) if !found.is_null() => found,
        _ => get(name),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::gl::GlProfile;

    fn info(profile: GlProfile, version: (u32, u32), extensions: &[&str]) -> GlInfo {
        let text = String::new;
        let extensions = extensions.iter().map(|e| (*e).to_owned()).collect();
        GlInfo { profile, version, version_text: text(), vendor: text(), renderer: text(), extensions }
    }

    #[test]
    fn functions_of_es_3_2_have_the_names_of_the_extension_that_is_there() {
        let here = |info: &GlInfo, name: &CStr| name_here(info, name).map(|n| n.into_string().unwrap());
        let oes = info(GlProfile::Es, (3, 1), &["GL_OES_draw_buffers_indexed", "GL_KHR_debug"]);
        assert_eq!(here(&oes, c"glEnablei").as_deref(), Some("glEnableiOES"));
        assert_eq!(here(&oes, c"glObjectLabel").as_deref(), Some("glObjectLabelKHR"));
        assert_eq!(here(&oes, c"glCopyImageSubData"), None, "no extension has it");
        assert_eq!(here(&oes, c"glEnable"), None, "a function of ES 2.0");
        for other in [(GlProfile::Es, (3, 2)), (GlProfile::Core, (3, 1))] {
            assert_eq!(here(&info(other.0, other.1, &["GL_KHR_debug"]), c"glObjectLabel"), None, "{other:?}");
        }
        let mut names: Vec<_> = functions().collect();
        names.sort_unstable();
        assert!(names.windows(2).all(|pair| pair[0] != pair[1]), "a function stands once");
    }
}
