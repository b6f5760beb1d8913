//! Check whether the window has the size that the host gives. OpenGL does not report a window's size, but it reports
//! whether any sample of a drawing passed the tests, and no sample outside the window passes.
//!
//! A few lines of pixels that change nothing are drawn in every frame, and their results are read in a later frame,
//! because waiting would stall. Only for a new target does the check wait.

use std::ffi::c_char;

use super::{api::Api, check::GlInfo, names::*};
use crate::error::{Error, Result};

/// Number of queries: one for the lines beyond the window's right and upper edges, and one each for its last column,
/// its last row and its first pixel.
const LINES: usize = 4;

/// Program and queries in one context.
pub(super) struct WindowSize {
    program: u32,
    queries: [u32; LINES],
    /// Size of the pending query, pixels.
    asked: Option<(u32, u32)>,
}

const VERTEX: &str = "void main() {
    gl_Position = vec4(float(gl_VertexID & 1) * 4.0 - 1.0, float(gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}";
const FRAGMENT: &str = "out vec4 color; void main() { color = vec4(0.0); }";

impl WindowSize {
    pub(super) fn new(api: &Api, info: &GlInfo) -> Self {
        let head = if info.is_es() { "#version 300 es\nprecision highp float;\n" } else { "#version 330\n" };
        let program = api.CreateProgram();
        for (kind, body) in [(VERTEX_SHADER, VERTEX), (FRAGMENT_SHADER, FRAGMENT)] {
            let shader = api.CreateShader(kind);
            let text = format!("{head}{body}");
            let (start, length) = (text.as_ptr().cast::<c_char>(), text.len() as i32);
            // SAFETY: one string with its length is passed.
            unsafe { api.ShaderSource(shader, 1, &start, &length) };
            api.CompileShader(shader);
            api.AttachShader(program, shader);
            api.DeleteShader(shader);
        }
        api.LinkProgram(program);
        let mut queries = [0; LINES];
        // SAFETY: the array has room for as many names as are requested.
        unsafe { api.GenQueries(LINES as i32, queries.as_mut_ptr()) };
        Self { program, queries, asked: None }
    }

    pub(super) fn delete(&self, api: &Api) {
        api.DeleteProgram(self.program);
        // SAFETY: the array has as many names as are passed.
        unsafe { api.DeleteQueries(LINES as i32, self.queries.as_ptr()) };
    }

    /// Starts a query about a window that should have this size, unless a query is pending or the host counts samples
    /// itself. The state that wgpu assumes must be set, with a vertex array bound; that state is kept.
    pub(super) fn ask(&mut self, api: &Api, (width, height): (u32, u32)) {
        let busy = [ANY_SAMPLES_PASSED, ANY_SAMPLES_PASSED_CONSERVATIVE].iter().any(|target| {
            let mut current = 0;
            // SAFETY: one integer is written.
            unsafe { api.GetQueryiv(*target, CURRENT_QUERY, &mut current) };
            current != 0
        });
        if self.asked.is_some() || busy {
            return;
        }
        let (w, h) = (width as i32, height as i32);
        let lines: [&[[i32; 4]]; LINES] =
            [&[[w, 0, 1, h + 1], [0, h, w + 1, 1]], &[[w - 1, 0, 1, h]], &[[0, h - 1, w, 1]], &[[0, 0, 1, 1]]];
        api.BindFramebuffer(FRAMEBUFFER, 0);
        api.Viewport(0, 0, w + 1, h + 1);
        api.Enable(SCISSOR_TEST);
        api.ColorMask(0, 0, 0, 0);
        api.DepthMask(0);
        api.UseProgram(self.program);
        for (query, boxes) in self.queries.iter().zip(lines) {
            api.BeginQuery(ANY_SAMPLES_PASSED, *query);
            for [x, y, w, h] in boxes {
                api.Scissor(*x, *y, *w, *h);
                api.DrawArrays(TRIANGLES, 0, 3);
            }
            api.EndQuery(ANY_SAMPLES_PASSED);
        }
        api.UseProgram(0);
        api.DepthMask(1);
        api.ColorMask(1, 1, 1, 1);
        api.Disable(SCISSOR_TEST);
        api.take_error();
        self.asked = Some((width, height));
    }

    /// Reads the result if it is available, or waits for it if `wait` is set.
    ///
    /// # Errors
    /// [`crate::Status::InvalidArgument`] if the window does not have the size of the query.
    pub(super) fn check(&mut self, api: &Api, wait: bool) -> Result<()> {
        let Some((width, height)) = self.asked else { return Ok(()) };
        let get = |query: u32, what: u32| {
            let mut value = 0;
            // SAFETY: one integer is written.
            unsafe { api.GetQueryObjectuiv(query, what, &mut value) };
            value != 0
        };
        if !wait && !self.queries.iter().all(|q| get(*q, QUERY_RESULT_AVAILABLE)) {
            return Ok(());
        }
        self.asked = None;
        let [beyond, column, row, first] = self.queries.map(|q| get(q, QUERY_RESULT));
        let relation = match (beyond, first && !(column && row)) {
            (true, _) => "larger",
            // If not even the first pixel was drawn, the window is hidden.
            (_, true) => "smaller",
            _ => return Ok(()),
        };
        let accepted = "with height the window's size now (tell it anew when the window is resized)";
        let got = format!("{width} x {height} for a {relation} one");
        Err(Error::range("target.width", accepted, got))
    }
}
