//! The steps of `on_gpu`: each tests an OpenGL driver on the sky's first tables.
#![cfg(target_os = "linux")]

mod raw;
mod sky;

/// Result of a step: the driver is right, the driver is wrong, or there is nothing to test.
#[derive(Debug, PartialEq)]
pub enum Found {
    Right(String),
    Wrong(String),
    Nothing(String),
}

/// Result of work that may fail in any way.
pub type Fallible<T> = Result<T, Box<dyn std::error::Error>>;

/// Name of a step, its question, and its function.
pub type Step = (&'static str, &'static str, fn() -> Fallible<Found>);

/// All steps.
pub const STEPS: &[Step] = &[
    ("vulkan", "which Vulkan driver there is, and a texel of the sky's first table by it", sky::vulkan),
    ("opengl", "which OpenGL driver there is, and a texel cleared by it", sky::opengl),
    ("blocks-read", "blocks made with contents, read back before anything is drawn", sky::blocks_read),
    ("blocks-drawn", "blocks made with contents, drawn out as colours", sky::blocks_drawn),
    ("blocks-drawn-written", "blocks written by the queue, drawn out as colours", sky::blocks_drawn_written),
    ("blocks-drawn-plain", "blocks written by glBufferSubData, drawn out as colours", sky::blocks_drawn_plain),
    ("raw-for", "a texel by plain loops in GLSL by hand, bounds from a block", raw::plain_loops),
    ("raw-while", "a texel by loops in the form that wgpu's compiler writes, bounds from a block", raw::written_loops),
    ("norm-constants", "a texel of the first table with constants for bounds", sky::norm_constants),
    ("norm", "a texel of the first table as it is", sky::norm),
    ("norm-written", "a texel of the first table, blocks written by the queue", sky::norm_written),
    ("norm-plain", "a texel of the first table, blocks written by glBufferSubData", sky::norm_plain),
    ("norm-own", "a texel of the first table in wgpu's own context", sky::norm_own),
    ("norm-whole", "the whole first table in one draw", sky::norm_whole),
    ("norm-uncapped", "a texel of the first table without the caps of its loops", sky::norm_uncapped),
    ("welkin-own", "a device of Welkin's own on OpenGL, and its whole sky", sky::welkin_own),
];

/// Runs the step with this name. Returns the text to print and the exit status; `None` for an unknown name.
pub fn answer(name: &str) -> Option<(String, u8)> {
    let (_, _, step) = STEPS.iter().find(|(step, ..)| *step == name)?;
    // The tests' hosts panic if no context can be created.
    std::panic::set_hook(Box::new(|_| ()));
    let found = std::panic::catch_unwind(step).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        Ok(Found::Nothing(text.or_else(|| panic.downcast_ref::<&str>().map(|t| (*t).to_owned())).unwrap_or_default()))
    });
    let (word, text, code) = match found {
        Ok(Found::Right(text)) => ("ok", text, 0),
        Ok(Found::Wrong(text)) => ("wrong", text, 1),
        Ok(Found::Nothing(text)) => ("none", text, 3),
        Err(e) => ("wrong", e.to_string(), 1),
    };
    Some((format!("RESULT {word} {}", text.replace('\n', " ")), code))
}
